// A fixed piece of work for an instruction counter: cold solves of 200 windows of the base link.
//   bench_instructions SOLVER PROBLEM     e.g. lawson_hanson base11
// Callgrind counts inside shapeid_measured only (--toggle-collect); publish divides by the count
// that this prints.
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>

#include "shapeid/tests/bench/peers/mass_peer.hpp"
#include "shapeid/tests/bench/problems/windows.hpp"

namespace {

using namespace shapeid::bench;

struct Work {
  std::unique_ptr<MassPeer> peer;
  std::vector<DenseProblem> problems;
  std::vector<Prepared> prepared;
  Eigen::VectorXd m;
  bool succeeded = true;
};

}  // namespace

extern "C" __attribute__((noinline)) void shapeid_measured(void* work_) {
  Work& work = *static_cast<Work*>(work_);
  for (std::size_t i = 0; i < work.problems.size(); ++i)
    work.succeeded =
        work.peer->solve(work.problems[i], work.prepared[i], nullptr, work.m) && work.succeeded;
}

int main(int argc, char** argv) {
  const std::string solver = argc == 3 ? argv[1] : "", row = argc == 3 ? argv[2] : "";
  const auto kind = std::ranges::find(mass_peers(), solver, &PeerKind::name);
  if (kind == mass_peers().end() || (row != "base11" && row != "base54")) {
    std::cerr << "usage: bench_instructions SOLVER base11|base54\n";
    return 2;
  }
  Work work;
  work.peer = kind->make();
  work.problems = base_windows(row == "base11" ? base_shapes() : base_points(), SeedSet::published,
                               shapeid::test::Noise::sensors, Density::none, 8, 25);
  for (const DenseProblem& problem : work.problems)
    prepare(problem, Form::normal, work.prepared.emplace_back());
  // Once outside: memory is asked for, and symbols are resolved.
  work.peer->solve(work.problems[0], work.prepared[0], nullptr, work.m);
  shapeid_measured(&work);
  std::cout << work.problems.size() << '\n';
  return work.succeeded ? 0 : 1;
}

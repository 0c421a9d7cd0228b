// Whole division runs: the same recorded problems for everybody, from one shape to a thousand.
#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>

#include "shapeid/tests/bench/harness.hpp"
#include "shapeid/tests/bench/problems/divisions.hpp"

namespace shapeid::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Run = std::vector<DenseProblem>;

constexpr int runs = 3;
/// Beyond this, solvers that need H take minutes a run.
constexpr int most_for_normal_form = 300;

double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

/// What reading the clock twice costs: not the solver's.
double clock_overhead() {
  static const double overhead = [] {
    std::vector<double> all(1001);
    for (double& d : all) {
      const auto from = Clock::now();
      d = seconds(Clock::now() - from);
    }
    std::nth_element(all.begin(), all.begin() + 500, all.end());
    return all[500];
  }();
  return overhead;
}

/// Seconds in the solver from one shape to `shapes`. What the solver starts from is prepared
/// beforehand, problem by problem, so that it lies in the cache as it would in use.
double time_run(const Run& run, std::size_t shapes, const PeerKind& kind) {
  const std::unique_ptr<MassPeer> peer = kind.make();
  Prepared prepared;
  Eigen::VectorXd m, start;
  bool succeeded = false;
  double total = 0.0;
  for (std::size_t k = 0; k < shapes; ++k) {
    const DenseProblem& problem = run[k];
    prepare(problem, peer->form(), prepared);
    const bool warm = kind.warm && problem.follows && succeeded;
    if (warm) carry_over(problem, m, start);
    const auto from = Clock::now();
    succeeded = peer->solve(problem, prepared, warm ? &start : nullptr, m);
    total += seconds(Clock::now() - from) - clock_overhead();
    if (!succeeded) m.resize(0);
  }
  return total;
}

/// The first `shapes` problems of every run.
Run beginnings(const std::vector<Run>& all, int shapes) {
  Run problems;
  for (const Run& run : all) problems.insert(problems.end(), run.begin(), run.begin() + shapes);
  return problems;
}

void register_runs(const std::string& row, int shapes,
                   const std::function<std::shared_ptr<const std::vector<Run>>()>& recorded) {
  std::vector<PeerKind> peers;
  const auto name = [&row](const PeerKind& kind) { return row + "/" + kind.name + "/solve"; };
  for (const PeerKind& kind : mass_peers()) {
    const bool fits = shapes <= most_for_normal_form || kind.make()->form() != Form::normal;
    // A hotstart needs as many unknowns as before.
    const bool divides = kind.name.find("hotstart") == std::string::npos;
    if (wanted(name(kind)) && fits && divides && shapes <= kind.most_shapes) peers.push_back(kind);
  }
  if (peers.empty()) return;
  const std::size_t timed = peers.size();
  add_lawson_hanson(peers);
  const std::shared_ptr<const std::vector<Run>> all = recorded();
  const std::vector<Verdict> verdicts = judge(peers, beginnings(*all, shapes));
  for (std::size_t p = 0; p < timed; ++p) {
    benchmark::RegisterBenchmark(name(peers[p]).c_str(), [=, kind = peers[p],
                                                          verdict = verdicts[p]](
                                                             benchmark::State& state) {
      std::size_t next = 0;
      for (auto _ : state) {
        const Run& run = (*all)[next++ % all->size()];
        state.SetIterationTime(time_run(run, static_cast<std::size_t>(shapes), kind));
      }
      add_counters(state, verdict);
    })->UseManualTime();
  }
}

/// Records when first asked: runs to a thousand shapes take a second each.
class Recorder {
 public:
  Recorder(SeedSet seeds, Noise noise) : seeds_(seeds), noise_(noise) {}

  std::shared_ptr<const std::vector<Run>> operator()(int shapes) {
    std::shared_ptr<const std::vector<Run>>& runs_to = made_[shapes <= 300 ? 300 : 1000];
    if (!runs_to) {
      auto made = std::make_shared<std::vector<Run>>();
      for (std::uint64_t k = 0; k < runs; ++k)
        made->push_back(division_run(seeds_, k, noise_, shapes <= 300 ? 300 : 1000));
      runs_to = made;
    }
    return runs_to;
  }

 private:
  SeedSet seeds_;
  Noise noise_;
  std::map<int, std::shared_ptr<const std::vector<Run>>> made_;
};

}  // namespace
}  // namespace shapeid::bench

int main(int argc, char** argv) {
  using namespace shapeid::bench;
  const SeedSet seeds = start(argc, argv);
  for (const auto& [suffix, noise] :
       {std::pair("", Noise::sensors), std::pair("_noisefree", Noise::none)}) {
    Recorder recorder(seeds, noise);
    for (const int shapes : {7, 11, 30, 60, 100, 200, 300, 600, 1000}) {
      register_runs("division" + std::to_string(shapes) + suffix, shapes,
                    [&recorder, shapes] { return recorder(shapes); });
    }
  }
  finish();
}

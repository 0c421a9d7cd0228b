#include "shapeid/tests/bench/harness.hpp"

#include <cstdlib>
#include <iostream>
#include <memory>
#include <regex>
#include <string_view>

namespace shapeid::bench {
namespace {

std::string filter = ".";

std::string row_name(const std::string& row, const PeerKind& kind, bool triangle) {
  return row + "/" + kind.name + (triangle ? "/triangle" : "/solve");
}

struct Timed {
  std::vector<DenseProblem> problems;
  std::vector<Prepared> prepared;
};

void time_solves(benchmark::State& state, const Timed& set, const PeerKind& kind,
                 bool from_triangle, const Verdict& verdict) {
  const std::unique_ptr<MassPeer> peer = kind.make();
  Prepared own;
  Eigen::VectorXd m, previous;
  std::size_t i = 0;
  bool succeeded = false;
  for (auto _ : state) {
    const DenseProblem& problem = set.problems[i];
    if (from_triangle) prepare(problem, peer->form(), own);
    const bool warm = kind.warm && problem.follows && succeeded;
    m.swap(previous);
    succeeded =
        peer->solve(problem, from_triangle ? own : set.prepared[i], warm ? &previous : nullptr, m);
    benchmark::DoNotOptimize(m.data());
    i = i + 1 == set.problems.size() ? 0 : i + 1;
  }
  add_counters(state, verdict);
}

}  // namespace

SeedSet start(int argc, char** argv) {
  SeedSet seeds = SeedSet::tuning;
  std::vector<char*> others;
  for (int i = 0; i < argc; ++i) {
    const std::string_view argument = argv[i];
    constexpr std::string_view filtered = "--benchmark_filter=";
    if (argument.starts_with(filtered)) filter = argument.substr(filtered.size());
    if (argument == "--seeds=published") {
      seeds = SeedSet::published;
    } else if (argument != "--seeds=tuning") {
      others.push_back(argv[i]);
    }
  }
  int count = static_cast<int>(others.size());
  benchmark::Initialize(&count, others.data());
  if (benchmark::ReportUnrecognizedArguments(count, others.data())) std::exit(2);
  benchmark::AddCustomContext("seeds", seeds == SeedSet::published ? "published" : "tuning");
  benchmark::AddCustomContext("flags", SHAPEID_BENCH_FLAGS);
  for (const std::string& peer : missing_peers()) {
    benchmark::AddCustomContext("missing " + peer, "peer not found: row not met");
  }
  return seeds;
}

bool wanted(const std::string& name) { return std::regex_search(name, std::regex(filter)); }

void add_counters(benchmark::State& state, const Verdict& verdict) {
  state.counters["problems"] = verdict.problems;
  state.counters["failures"] = verdict.failures;
  state.counters["wrong"] = verdict.wrong;
  state.counters["worst_gap"] = verdict.worst_gap;
  state.counters["worst_kkt"] = verdict.worst_kkt;
}

void finish() {
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}

void register_solves(const std::string& row,
                     const std::function<std::vector<DenseProblem>()>& make_problems) {
  std::vector<PeerKind> peers;
  for (const PeerKind& kind : mass_peers()) {
    if (wanted(row_name(row, kind, false)) || wanted(row_name(row, kind, true))) {
      peers.push_back(kind);
    }
  }
  if (peers.empty()) return;

  const auto set = std::make_shared<Timed>();
  set->problems = make_problems();
  std::erase_if(peers, [&set](const PeerKind& kind) {
    return kind.most_shapes < set->problems.front().triangle.shapes();
  });
  // However few are timed, somebody else must be there to be compared with.
  const std::size_t timed = peers.size();
  add_lawson_hanson(peers);
  for (const DenseProblem& problem : set->problems) {
    set->prepared.emplace_back();
    prepare(problem, Form::normal, set->prepared.back());
  }
  const std::vector<Verdict> verdicts = judge(peers, set->problems);
  for (std::size_t p = 0; p < timed; ++p) {
    for (const bool triangle : {false, true}) {
      benchmark::RegisterBenchmark(
          row_name(row, peers[p], triangle).c_str(),
          [set, kind = peers[p], triangle, verdict = verdicts[p]](benchmark::State& state) {
            time_solves(state, *set, kind, triangle, verdict);
          });
    }
  }
}

}  // namespace shapeid::bench

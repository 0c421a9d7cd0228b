#include "shapeid/tests/bench/harness.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <regex>
#include <string_view>

namespace shapeid::bench {
namespace {

std::string filter = ".";

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string row_name(const std::string& row, const PeerKind& kind, bool triangle) {
  return row + "/" + kind.name + (triangle ? "/triangle" : "/solve");
}

struct Timed {
  std::vector<DenseProblem> problems;
  std::vector<Prepared> prepared;
};

/// Goes through the problems again and again, one an iteration.
class Solving {
 public:
  Solving(const Timed& set, const PeerKind& kind, bool from_triangle)
      : set_(&set), warm_(kind.warm), from_triangle_(from_triangle), peer_(kind.make()) {}

  /// The next problem has nothing to start from.
  [[nodiscard]] bool at_start() const { return !set_->problems[next_].follows; }

  void solve_next() {
    const DenseProblem& problem = set_->problems[next_];
    if (from_triangle_) prepare(problem, peer_->form(), own_);
    m_.swap(last_);
    const bool warm = warm_ && problem.follows && succeeded_;
    succeeded_ = peer_->solve(problem, from_triangle_ ? own_ : set_->prepared[next_],
                              warm ? &last_ : nullptr, m_);
    benchmark::DoNotOptimize(m_.data());
    next_ = next_ + 1 == set_->problems.size() ? 0 : next_ + 1;
  }

 private:
  const Timed* set_;
  bool warm_, from_triangle_;
  std::unique_ptr<MassPeer> peer_;
  Prepared own_;
  Eigen::VectorXd m_, last_;
  std::size_t next_ = 0;
  bool succeeded_ = false;
};

void time_solves(benchmark::State& state, const Timed& set, const PeerKind& kind,
                 bool from_triangle, const Verdict& verdict) {
  Solving solving(set, kind, from_triangle);
  for (auto _ : state) {
    if (kind.warm && solving.at_start()) {
      state.PauseTiming();
      solving.solve_next();
      state.ResumeTiming();
    }
    solving.solve_next();
  }
  add_counters(state, verdict);
}

/// From here on a solve can take so long that the clock would see the first problem only: then
/// every problem is solved once, whatever the time.
constexpr Eigen::Index long_solve = 200;  // shapes

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
  benchmark::AddCustomContext("cpu", cpu_name());
  benchmark::AddCustomContext("flags", SHAPEID_BENCH_FLAGS);
  benchmark::AddCustomContext("peers", SHAPEID_BENCH_PEERS);
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

Field field(const DenseProblem& largest, const std::function<bool(const PeerKind&)>& also) {
  Field f;
  const bool density = largest.triangle.lambda > 0.0;
  const auto able = [&](const PeerKind& kind) {
    return largest.triangle.shapes() <= kind.most_shapes && (!density || kind.density);
  };
  for (const PeerKind& kind : mass_peers()) {
    if (able(kind) && also(kind)) f.peers.push_back(kind);
  }
  f.timed = f.peers.size();
  std::vector<PeerKind> compared;
  density ? add_reference(compared) : add_lawson_hanson(compared);
  if (able(compared.front())) f.peers.push_back(compared.front());
  return f;
}

void register_solves(const std::string& row,
                     const std::function<std::vector<DenseProblem>()>& make_problems) {
  const auto asked_for = [&row](const PeerKind& kind) {
    return wanted(row_name(row, kind, false)) || wanted(row_name(row, kind, true));
  };
  if (std::ranges::none_of(mass_peers(), asked_for)) return;
  const auto set = std::make_shared<Timed>();
  set->problems = make_problems();
  const auto [peers, timed] = field(set->problems.front(), asked_for);
  for (const DenseProblem& problem : set->problems) {
    set->prepared.emplace_back();
    prepare(problem, Form::normal, set->prepared.back());
  }
  const std::vector<Verdict> verdicts = judge(peers, set->problems);
  for (std::size_t p = 0; p < timed; ++p) {
    for (const bool triangle : {false, true}) {
      auto* registered = benchmark::RegisterBenchmark(
          row_name(row, peers[p], triangle).c_str(),
          [set, kind = peers[p], triangle, verdict = verdicts[p]](benchmark::State& state) {
            time_solves(state, *set, kind, triangle, verdict);
          });
      if (set->problems.front().triangle.shapes() > long_solve) {
        registered->Iterations(static_cast<benchmark::IterationCount>(set->problems.size()));
      }
    }
  }
}

}  // namespace shapeid::bench

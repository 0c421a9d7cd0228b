// Whole division runs: the same recorded problems for everybody, from one shape to a thousand.
// Speed of Claims C4, C5, C13.
#include <time.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include "shapeid/tests/bench/harness.hpp"
#include "shapeid/tests/bench/problems/divisions.hpp"
#include "shapeid/tests/bench/problems/variants.hpp"

namespace shapeid::bench {
namespace {

using Run = std::vector<DenseProblem>;

constexpr int runs = 3;
/// Beyond this, solvers that need H take minutes a run.
constexpr int most_for_normal_form = 300;
/// Problems that are timed at once, or one run's: so many that readings of the clock, a microsecond
/// or two each, are a few hundredths of the quickest time and fall out of the difference.
constexpr std::size_t timed_at_once = 420;

/// Seconds of this thread: what neighbours on the same core take does not count.
double processor_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// From one shape to `shapes`: what `form` needs is made for each problem, and the last masses are
/// carried over, whether or not `solve` looks at them.
template <typename Solve>
void go_through(const Run& run, std::size_t shapes, Form form, const Solve& solve) {
  Prepared prepared;
  Eigen::VectorXd m, start;
  for (std::size_t k = 0; k < shapes; ++k) {
    const DenseProblem& problem = run[k];
    prepare(problem, form, prepared);
    if (problem.cut) {
      // The parts were just computed, so they are in the cache for everybody, not only for those
      // whose A or H was made of them.
      const Eigen::MatrixXd& U = problem.triangle.U;
      double read = U.col(problem.cut->place).sum() + U.rightCols<1>().sum();
      benchmark::DoNotOptimize(read);
    }
    if (m.size() > 0) carry_over(problem, m, start);
    if (!solve(problem, prepared, m.size() > 0 ? &start : nullptr, m)) m.resize(0);
    benchmark::DoNotOptimize(m.data());
  }
}

/// Seconds in the solver for `count` runs, which take turns. A clock of the thread may take as long
/// to read as a short run, and the kernel leaves caches behind that are not as they were: so short
/// runs are timed together, and again without the solver; the difference is the solver's.
double time_runs(const std::vector<Run>& all, std::size_t first, std::size_t count,
                 std::size_t shapes, MassPeer& peer, bool warm) {
  const auto go = [&](const auto& solve) {
    const double begun = processor_time();
    for (std::size_t k = first; k < first + count; ++k) {
      go_through(all[k % all.size()], shapes, peer.form(), solve);
    }
    return processor_time() - begun;
  };
  const double solved = go(
      [&](const auto& problem, const auto& prepared, const Eigen::VectorXd* start,
          Eigen::VectorXd& m) { return peer.solve(problem, prepared, warm ? start : nullptr, m); });
  const double walked =
      go([](const auto& problem, const auto&, const Eigen::VectorXd*, Eigen::VectorXd& m) {
        m.setConstant(problem.triangle.shapes(), 1.0);
        return true;
      });
  return std::max(0.0, solved - walked);
}

/// An iteration is a run.
void time_runs(benchmark::State& state, const std::vector<Run>& all, int shapes,
               const PeerKind& kind) {
  const std::unique_ptr<MassPeer> peer = kind.make();
  const auto problems = static_cast<std::size_t>(shapes);
  const std::size_t count = std::max<std::size_t>(1, timed_at_once / problems);
  std::size_t first = 0;
  while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(count))) {
    state.SetIterationTime(time_runs(all, first, count, problems, *peer, kind.warm));
    first += count;
  }
}

/// The first `shapes` problems of every run.
Run beginnings(const std::vector<Run>& all, int shapes) {
  Run problems;
  for (const Run& run : all) problems.insert(problems.end(), run.begin(), run.begin() + shapes);
  return problems;
}

void register_runs(const std::string& row, int shapes,
                   const std::function<std::shared_ptr<const std::vector<Run>>()>& recorded) {
  const auto name = [&row](const PeerKind& kind) { return row + "/" + kind.name + "/solve"; };
  const auto asked_for = [&](const PeerKind& kind) {
    const bool fits = shapes <= most_for_normal_form || kind.make()->form() != Form::normal;
    // A hotstart needs as many unknowns as before.
    const bool divides = kind.name.find("hotstart") == std::string::npos;
    return wanted(name(kind)) && fits && divides;
  };
  if (std::ranges::none_of(mass_peers(), asked_for)) return;
  const std::shared_ptr<const std::vector<Run>> all = recorded();
  const auto [peers, timed] = field(all->front()[static_cast<std::size_t>(shapes) - 1], asked_for);
  const std::vector<Verdict> verdicts = judge(peers, beginnings(*all, shapes));
  for (std::size_t p = 0; p < timed; ++p) {
    benchmark::RegisterBenchmark(name(peers[p]).c_str(), [=, kind = peers[p],
                                                          verdict = verdicts[p]](auto& state) {
      time_runs(state, *all, shapes, kind);
      add_counters(state, verdict);
    })->UseManualTime();
  }
}

/// Records when first asked: runs to a thousand shapes take a second each.
class Recorder {
 public:
  Recorder(SeedSet seeds, test::Noise noise, Density density, PickedBy picked_by)
      : seeds_(seeds), noise_(noise), density_(density), picked_by_(picked_by) {}

  std::shared_ptr<const std::vector<Run>> operator()(int shapes) {
    std::shared_ptr<const std::vector<Run>>& runs_to = made_[shapes <= 300 ? 300 : 1000];
    if (!runs_to) {
      auto made = std::make_shared<std::vector<Run>>();
      for (std::uint64_t k = 0; k < runs; ++k)
        made->push_back(
            division_run(seeds_, k, noise_, density_, picked_by_, shapes <= 300 ? 300 : 1000));
      runs_to = made;
    }
    return runs_to;
  }

 private:
  SeedSet seeds_;
  test::Noise noise_;
  Density density_;
  PickedBy picked_by_;
  std::map<int, std::shared_ptr<const std::vector<Run>>> made_;
};

}  // namespace
}  // namespace shapeid::bench

int main(int argc, char** argv) {
  using namespace shapeid::bench;
  const SeedSet seeds = start(argc, argv);
  for (const Variant& variant : variants()) {
    Recorder recorder(seeds, variant.noise, variant.density, PickedBy::lawson_hanson);
    for (const int shapes : {7, 11, 30, 60, 100, 200, 300, 600, 1000}) {
      register_runs("division" + std::to_string(shapes) + variant.suffix, shapes,
                    [&recorder, shapes] { return recorder(shapes); });
    }
  }
  Recorder recorder(seeds, shapeid::test::Noise::sensors, Density::none, PickedBy::ours);
  for (const int shapes : {7, 11, 30, 100, 300}) {
    register_runs("division" + std::to_string(shapes) + "_ours", shapes,
                  [&recorder, shapes] { return recorder(shapes); });
  }
  finish();
}

// Samples in, parameters out: one window of ten samples, the base link as eleven shapes.
// Speed of Claims C3, C8.
#include <algorithm>
#include <limits>
#include <memory>

#include "shapeid/tests/bench/harness.hpp"
#include "shapeid/tests/bench/peers/window_stack.hpp"
#include "shapeid/tests/bench/problems/windows.hpp"

namespace shapeid::bench {
namespace {

constexpr int windows = 100;

std::vector<Verdict> judge_stacks(const std::vector<StackKind>& kinds, const BodyModel& model,
                                  const std::vector<Sample>& samples,
                                  const std::vector<DenseProblem>& problems) {
  std::vector<Verdict> verdicts(kinds.size());
  std::vector<std::vector<Answer>> answers(kinds.size());
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const auto stack = kinds[k].make(quadruped(), model);
    stack->take(samples);
    for (std::size_t w = 0; w < problems.size(); ++w) {
      Eigen::VectorXd m;
      const bool succeeded = stack->solve(w * window_samples, window_samples, m);
      answers[k].push_back(answer(problems[w], succeeded, m));
    }
  }
  return compare(answers, problems);
}

void register_windows(const std::string& row, const BodyModel& model, SeedSet seeds) {
  const std::uint64_t seed = seed_of(seeds, 0);
  const auto samples = std::make_shared<const std::vector<Sample>>(test::trot(
      quadruped(), some_truth(seed), seed, windows * window_samples, test::Noise::sensors));
  // The same samples, so the same windows.
  const std::vector<DenseProblem> problems =
      base_windows(model, seeds, test::Noise::sensors, Density::none, 1, windows);
  const std::vector<StackKind> kinds = window_stacks();
  const std::vector<Verdict> verdicts = judge_stacks(kinds, model, *samples, problems);
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    benchmark::RegisterBenchmark(
        (row + "/" + kinds[k].name).c_str(),
        [=, kind = kinds[k], verdict = verdicts[k]](benchmark::State& state) {
          const auto stack = kind.make(quadruped(), model);
          stack->take(*samples);
          Eigen::VectorXd m;
          std::size_t w = 0;
          for (auto _ : state) {
            stack->solve(w * window_samples, window_samples, m);
            benchmark::DoNotOptimize(m.data());
            w = (w + 1) % windows;
          }
          add_counters(state, verdict);
        });
  }
}

}  // namespace
}  // namespace shapeid::bench

int main(int argc, char** argv) {
  using namespace shapeid::bench;
  const SeedSet seeds = start(argc, argv);
  register_windows("window11", base_shapes(), seeds);
  finish();
}

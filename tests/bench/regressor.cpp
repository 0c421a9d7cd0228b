// The regressor of one sample: all thirteen links, and the base alone.
// Speed of Claim C1.
#include "shapeid/fast/regressor.hpp"

#include <numeric>

#include "shapeid/tests/bench/harness.hpp"
#include "shapeid/tests/bench/problems/windows.hpp"
#ifdef SHAPEID_PINOCCHIO
#include "shapeid/tests/bench/peers/pinocchio_robot.hpp"
#endif

namespace shapeid::bench {
namespace {

constexpr std::size_t count = 200;  // samples, one after the other

std::vector<int> all_links() {
  std::vector<int> links(static_cast<std::size_t>(quadruped().link_count()));
  std::iota(links.begin(), links.end(), 0);
  return links;
}

void register_ours(const std::string& name, const std::vector<int>& links,
                   const std::vector<Sample>& samples) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    fast::Regressor regressor(quadruped(), links);
    std::size_t i = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(regressor(samples[i++ % count]).data());
      benchmark::ClobberMemory();
    }
  });
}

#ifdef SHAPEID_PINOCCHIO
/// Largest difference of an entry over the largest entry, over all samples.
double difference(const std::vector<Sample>& samples) {
  PinocchioRobot theirs(quadruped(), stacked_parameters(quadruped()));
  fast::Regressor ours(quadruped(), all_links());
  double worst = 0.0;
  for (const Sample& s : samples) {
    Eigen::MatrixXd Y = theirs.regressor(PinocchioRobot::motion(s));
    to_our_order(Y);
    worst = std::max(worst, (ours(s) - Y).cwiseAbs().maxCoeff() / Y.cwiseAbs().maxCoeff());
  }
  return worst;
}

void register_pinocchio(const std::vector<Sample>& samples) {
  std::vector<PinocchioMotion> motions;
  for (const Sample& s : samples) motions.push_back(PinocchioRobot::motion(s));
  benchmark::RegisterBenchmark(
      "regressor_full/pinocchio", [=, apart = difference(samples)](benchmark::State& state) {
        PinocchioRobot robot(quadruped(), stacked_parameters(quadruped()));
        std::size_t i = 0;
        for (auto _ : state) {
          benchmark::DoNotOptimize(robot.regressor(motions[i++ % count]).data());
          benchmark::ClobberMemory();
        }
        state.counters["difference"] = apart;
      });
  benchmark::RegisterBenchmark("regressor_base/pinocchio_body", [=](benchmark::State& state) {
    std::size_t i = 0;
    for (auto _ : state) {
      Eigen::Matrix<double, 6, 10> Y = PinocchioRobot::base_regressor(motions[i++ % count]);
      benchmark::DoNotOptimize(Y.data());
      benchmark::ClobberMemory();
    }
  });
}
#endif

}  // namespace
}  // namespace shapeid::bench

int main(int argc, char** argv) {
  using namespace shapeid;
  using namespace shapeid::bench;
  const std::uint64_t seed = seed_of(start(argc, argv), 0);
  const std::vector<Sample> samples =
      test::trot(quadruped(), some_truth(seed), seed, count, test::Noise::sensors);
  register_ours("regressor_full/fast", all_links(), samples);
  register_ours("regressor_base/fast", {0}, samples);
#ifdef SHAPEID_PINOCCHIO
  register_pinocchio(samples);
#endif
  finish();
}

// What the parts of a window cost, with the least that each must compute and move: counters say
// floating-point operations ("flops") and bytes read or written at least once ("bytes").
// Speed of Claims C1, C2, C8.
#include <algorithm>
#include <functional>
#include <memory>

#include "shapeid/fast/contact.hpp"
#include "shapeid/fast/inverse_dynamics.hpp"
#include "shapeid/fast/kinematics.hpp"
#include "shapeid/fast/regressor.hpp"
#include "shapeid/fast/sample_rows.hpp"
#include "shapeid/fast/triangle.hpp"
#include "shapeid/fast/window.hpp"
#include "shapeid/tests/bench/harness.hpp"
#include "shapeid/tests/bench/problems/windows.hpp"

namespace shapeid::bench {
namespace {

using Samples = std::vector<Sample>;

struct Least {
  double flops, bytes;
};
constexpr double number = sizeof(double);

/// `work` is called with one sample after the other.
template <typename Work>
void register_stage(const std::string& name, Least least, const Samples& samples,
                    const std::function<Work()>& make) {
  benchmark::RegisterBenchmark(("stage/" + name).c_str(), [=, &samples](benchmark::State& state) {
    Work work = make();
    std::size_t i = 0;
    for (auto _ : state) {
      work(samples[i]);
      benchmark::ClobberMemory();
      i = i + 1 == samples.size() ? 0 : i + 1;
    }
    state.counters["flops"] = least.flops;
    state.counters["bytes"] = least.bytes;
  });
}

template <typename Make>
void stage(const std::string& name, Least least, const Samples& samples, const Make& make) {
  register_stage<decltype(make())>(name, least, samples, make);
}

/// The rate that a product of matrices in the first cache reaches: what this machine and this build
/// can do.
void register_machine() {
  benchmark::RegisterBenchmark("stage/machine: 64 x 64 matrix product",
                               [](benchmark::State& state) {
                                 constexpr Eigen::Index n = 64;
                                 const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
                                 const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n, n);
                                 Eigen::MatrixXd C(n, n);
                                 for (auto _ : state) {
                                   C.noalias() = A * B;
                                   benchmark::DoNotOptimize(C.data());
                                   benchmark::ClobberMemory();
                                 }
                                 state.counters["flops"] = 2.0 * n * n * n;
                                 state.counters["bytes"] = 3.0 * n * n * number;
                               });
}

/// QR of rows x columns by reflections.
double qr_flops(double rows, double columns) {
  return 2.0 * columns * columns * (rows - columns / 3.0);
}

void register_sample_stages(const Samples& samples) {
  const Robot& robot = quadruped();
  const BodyModel model = base_shapes();
  const Eigen::VectorXd weight = Eigen::VectorXd::Ones(robot.dof());
  const double joints = robot.joint_count(), links = robot.link_count();
  const double sample_bytes = (9.0 + 4.0 * joints) * number;

  // K = S(alpha) + S(omega) S(omega): 15; 60 entries of which most are copies of K and a.
  stage("base columns of the regressor, a sample", {15.0, 60.0 * number}, samples, [&robot] {
    return [regressor = std::make_shared<fast::Regressor>(robot, std::vector<int>{0})](
               const Sample& s) { benchmark::DoNotOptimize((*regressor)(s).data()); };
  });
  // Recursive Newton-Euler: 92 multiplications and 81 additions a link (Khalil and Kleinfinger
  // 1987).
  stage("known links by Newton-Euler, a sample",
        {173.0 * links, sample_bytes + 13.0 * links * number}, samples, [&robot, model] {
          return [kinematics = std::make_shared<fast::Kinematics>(robot),
                  known = std::make_shared<fast::InverseDynamics>(robot, model.known)](
                     const Sample& s) {
            kinematics->start(s);
            benchmark::DoNotOptimize((*known)(*kinematics).data());
          };
        });
  // Two legs of three joints: poses, and for each joint a cross product.
  stage("contact Jacobian of two feet, a sample", {2.0 * 3.0 * (16.0 + 9.0), 18.0 * 6.0 * number},
        samples, [&robot] {
          return [kinematics = std::make_shared<fast::Kinematics>(robot),
                  J = std::make_shared<fast::ContactJacobian>(robot)](const Sample& s) {
            kinematics->start(s);
            J->update(*kinematics, s);
          };
        });
  // All of the above, then six rows of eleven columns: forces from torques, their moments.
  stage("contact-free rows, a sample",
        {15.0 + 173.0 * links + 150.0 + 2.0 * 6.0 * 6.0 * 11.0, sample_bytes + 66.0 * number},
        samples, [&robot, model, weight] {
          return [rows = std::make_shared<fast::SampleRows>(robot, model, ContactTreatment::project,
                                                            weight)](const Sample& s) {
            benchmark::DoNotOptimize(rows->update(s));
          };
        });
  stage("compression, the six rows of a sample", {qr_flops(60.0, 11.0) / 10.0, 66.0 * number},
        samples, [&robot, model, weight, &samples] {
          fast::SampleRows rows(robot, model, ContactTreatment::project, weight);
          const auto all = std::make_shared<Eigen::MatrixXd>(60, 11);
          for (std::size_t i = 0; i < window_samples; ++i) {
            static_cast<void>(rows.update(samples[i]));
            all->middleRows<6>(6 * static_cast<Eigen::Index>(i)) = rows.rows();
          }
          // All ten samples' rows at every tenth call: that is how a window compresses them.
          return [all, triangle = std::make_shared<fast::Triangle>(10),
                  calls = std::size_t{0}](const Sample&) mutable {
            if (++calls % window_samples != 0) return;
            triangle->clear();
            triangle->add(all->leftCols<10>(), all->col(10));
            benchmark::DoNotOptimize(triangle->R().data());
          };
        });
  stage("all that a sample needs",
        {15.0 + 173.0 * links + 150.0 + 792.0 + qr_flops(60.0, 11.0) / 10.0,
         sample_bytes + 132.0 * number},
        samples, [&robot, model, weight] {
          return [window = std::make_shared<fast::Window>(robot, model, ContactTreatment::project,
                                                          weight)](const Sample& s) {
            benchmark::DoNotOptimize(window->add(s));
            if (window->samples() == window_samples) {
              benchmark::DoNotOptimize(window->triangle().R().data());
              window->clear();
            }
          };
        });
}

/// The least is to check an answer that is already there: residual, gradient, every shape's price.
void register_solve(const std::string& name, const std::string& peer_name,
                    const std::vector<DenseProblem>& problems) {
  const auto kind = std::ranges::find(mass_peers(), peer_name, &PeerKind::name);
  if (kind == mass_peers().end()) return;
  const double shapes = static_cast<double>(problems.front().triangle.shapes());
  benchmark::RegisterBenchmark(
      ("stage/" + name).c_str(), [=, kind = *kind](benchmark::State& state) {
        const std::unique_ptr<MassPeer> peer = kind.make();
        const Prepared unused;
        Eigen::VectorXd m, last;
        std::size_t i = 0;
        for (auto _ : state) {
          last.swap(m);
          peer->solve(problems[i], unused, kind.warm && problems[i].follows ? &last : nullptr, m);
          benchmark::DoNotOptimize(m.data());
          i = i + 1 == problems.size() ? 0 : i + 1;
        }
        state.counters["flops"] = 2.0 * 110.0 + 20.0 * shapes;
        state.counters["bytes"] = (66.0 + 11.0 * shapes) * number;
      });
}

}  // namespace
}  // namespace shapeid::bench

int main(int argc, char** argv) {
  using namespace shapeid::bench;
  const SeedSet seeds = start(argc, argv);
  const std::uint64_t seed = seed_of(seeds, 0);
  const std::vector<shapeid::Sample> samples =
      shapeid::test::trot(quadruped(), some_truth(seed), seed, 200, shapeid::test::Noise::sensors);
  register_machine();
  register_sample_stages(samples);
  for (const auto& [name, model] :
       {std::pair("11 shapes", base_shapes()), {"54 points", base_points()}}) {
    const std::vector<DenseProblem> problems =
        base_windows(model, seeds, shapeid::test::Noise::sensors, Density::none, 10, 25);
    register_solve(std::string("solve of ") + name + ", cold", "fast", problems);
    register_solve(std::string("solve of ") + name + ", warm", "fast/warm", problems);
  }
  finish();
}

// A robot without friction, logged without noise, must not be given any by the filter: the same one
// goes over every channel.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <map>
#include <optional>
#include <vector>

#include "shapeid/models/motion.hpp"
#include "shapeid/reference/projection.hpp"
#include "shapeid/reference/sample_rows.hpp"
#include "shapeid/reference/triangle.hpp"
#include "shapeid/tests/recovery/noisy_logs.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::bundled_quadruped;
using test::Quadruped;

std::vector<Sample> read(const std::string& log, const Quadruped& quadruped, Smoothing smoothing,
                         double cutoff) {
  MotionOptions options;
  options.smoothing = smoothing;
  options.cutoff = cutoff;
  MotionReader reader(log, quadruped.robot, quadruped.notes, std::nullopt, options);
  std::vector<Sample> samples;
  while (std::optional<Sample> sample = reader.next()) samples.push_back(std::move(*sample));
  return samples;
}

/// Viscous coefficients (N m s, one a joint) by least squares along with the base's ten parameters.
Eigen::VectorXd viscous_friction(const Quadruped& quadruped, const std::vector<Sample>& samples) {
  const Robot& robot = quadruped.robot;
  const Eigen::Index joints = robot.joint_count();
  const Eigen::Index columns = 10 + joints;
  const Eigen::VectorXd weight = Eigen::VectorXd::Ones(robot.dof());
  Eigen::MatrixXd R(0, columns + 1);
  for (std::size_t i = 0; i < samples.size(); i += 5) {
    const auto rows = reference::sample_rows(robot, quadruped.base.known, quadruped.base.free_links,
                                             ContactTreatment::project, samples[i]);
    Eigen::MatrixXd Y = Eigen::MatrixXd::Zero(robot.dof(), columns);
    Y.leftCols<10>() = rows.Y;
    Y.bottomRightCorner(joints, joints) = samples[i].dq.asDiagonal();
    const auto free = reference::eliminate_contacts(Y, rows.F, rows.J, weight);
    Eigen::MatrixXd YF(free.Y.rows(), columns + 1);
    YF << free.Y, free.F;
    R = reference::triangle(reference::stacked(R, YF));
  }
  return R.leftCols(columns).colPivHouseholderQr().solve(R.col(columns)).tail(joints);
}

/// N m, one a joint: root mean square of the friction torque.
Eigen::VectorXd friction_torque(const Eigen::VectorXd& friction,
                                const std::vector<Sample>& samples) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(friction.size());
  for (const Sample& s : samples) squares += s.dq.cwiseAbs2();
  return friction.cwiseAbs().cwiseProduct(
      (squares / static_cast<double>(samples.size())).cwiseSqrt());
}

// What remains with one filter is distortion: torques are not linear in q. It must be less than
// what the torque channels could show at all, their noise, and vanish as the cutoff rises. With the
// torque left unfiltered, as published, there is more friction than noise.
TEST(QuadrupedFriction, OneFilterOverAllChannelsInventsNone) {
  const Quadruped quadruped = bundled_quadruped();
  const test::ScratchFolder scratch;
  const std::string log = scratch.path("exact.csv");
  test::write_log(log, quadruped, test::trot(quadruped.robot, {4.0, 500.0, 1, {}}), false, 0);
  const double sigma = quadruped.notes.noise_sigma.at("tau");
  const auto invented = [&](const char* name, const std::vector<Sample>& samples) {
    const Eigen::VectorXd friction = viscous_friction(quadruped, samples);
    const double torque = friction_torque(friction, samples).maxCoeff();
    fmt::print("{}: up to {:.4f} N m s, {:.3f} N m\n", name, friction.cwiseAbs().maxCoeff(),
               torque);
    return torque;
  };
  const double zero_phase =
      invented("zero phase, 20 Hz", read(log, quadruped, Smoothing::zero_phase, 20.0));
  const double wider =
      invented("zero phase, 80 Hz", read(log, quadruped, Smoothing::zero_phase, 80.0));
  std::vector<Sample> late = read(log, quadruped, Smoothing::causal, 20.0);
  const double causal = invented("causal, 20 Hz", late);
  EXPECT_LT(zero_phase, sigma);
  EXPECT_LT(causal, sigma);
  EXPECT_LT(wider, 0.5 * zero_phase);

  std::map<double, Eigen::VectorXd> torque;
  for (const Sample& s : read(log, quadruped, Smoothing::none, 20.0)) torque[s.time] = s.tau;
  for (Sample& s : late) s.tau = torque.at(s.time);
  const double trap = invented("causal, 20 Hz, but not over the torque", late);
  EXPECT_GT(trap, sigma);
  EXPECT_GT(trap, 10.0 * causal);
}

}  // namespace
}  // namespace shapeid

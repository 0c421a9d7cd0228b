#include "shapeid/tests/recovery/noisy_logs.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>

#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/models/simbody/sensors.hpp"
#include "shapeid/reference/identify.hpp"

namespace shapeid::test {
namespace {

InertialParameters base_of(const Quadruped& quadruped) { return quadruped.robot.links[0].inertia; }

Eigen::Vector3d principal_inertias(const InertialParameters& body) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(body.tensor_about_centre()).eigenvalues();
}

}  // namespace

void write_log(const std::string& path, const Quadruped& quadruped,
               const std::vector<SimulatedSample>& motion, bool noise, std::uint64_t seed) {
  Sensors sensors(quadruped.robot, quadruped.notes, {noise, false, seed});
  LogWriter log(path, sensors.columns());
  for (const SimulatedSample& s : motion) {
    log.write(sensors.measure(s.sample, Eigen::Quaterniond(s.state.base.linear())));
  }
  log.close();
}

InertialParameters fit_base(const std::string& log, const Quadruped& quadruped,
                            const Cutoffs& cutoffs, double seconds) {
  constexpr int keep_every = 5;
  const Robot& robot = quadruped.robot;
  MotionOptions options;
  options.smoothing = cutoffs.signals ? Smoothing::zero_phase : Smoothing::none;
  if (cutoffs.signals) options.cutoff = *cutoffs.signals;
  MotionReader reader(log, robot, quadruped.notes, std::nullopt, options);

  reference::IdentifySettings settings;
  settings.expected_mass = base_of(quadruped).mass();
  settings.division.most_divisions = 0;
  if (cutoffs.rows) settings.row_filter = {*cutoffs.rows, 2, 500.0, keep_every};
  int count = 0;
  const auto next = [&]() -> std::optional<Sample> {
    while (std::optional<Sample> sample = reader.next()) {
      if (sample->time > seconds) return std::nullopt;
      if (cutoffs.rows || count++ % keep_every == 0) return sample;
    }
    return std::nullopt;
  };
  const auto found = reference::identify(robot, quadruped.base, next, settings);
  return {found.Phi.head<10>()};
}

BaseError base_error(const Quadruped& quadruped, const InertialParameters& found) {
  const InertialParameters truth = base_of(quadruped);
  const Eigen::Array3d p = principal_inertias(found), p0 = principal_inertias(truth);
  return {std::abs(found.mass() - truth.mass()),
          (found.first_moment() - truth.first_moment()).norm(),
          (found.tensor() - truth.tensor()).norm(), ((p - p0) / p0).abs().maxCoeff()};
}

BaseError rms(const std::vector<BaseError>& errors) {
  const auto of = [&](double BaseError::*entry) {
    double squares = 0.0;
    for (const BaseError& e : errors) squares += e.*entry * (e.*entry);
    return std::sqrt(squares / static_cast<double>(errors.size()));
  };
  return {of(&BaseError::mass), of(&BaseError::first_moment), of(&BaseError::tensor),
          of(&BaseError::principal)};
}

}  // namespace shapeid::test

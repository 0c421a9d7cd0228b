// The method as it runs on the robot: a window of samples every few milliseconds, warm-started
// masses, filter (17).
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <deque>
#include <optional>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/reference/filter.hpp"
#include "shapeid/reference/window.hpp"

namespace shapeid::reference {

struct OnlineSettings {
  ContactTreatment contacts = ContactTreatment::project;
  Eigen::VectorXd weight;      ///< diagonal of W; empty: ones
  std::size_t window = 10;     ///< samples a window
  std::size_t stride = 10;     ///< samples from one window to the next: 10 at 500 Hz is 20 ms
  double alpha = 0.5;          ///< equation (17)
  double expected_mass = 0.0;  ///< M0 > 0, kg
  /// Default: computed from each window until one's forces are a thousandth of the weight of all
  /// links (squares_of_weight()), then fixed.
  std::optional<double> lambda;
};

/// One window's answer.
struct OnlineResult {
  double time = 0.0;         ///< s, of the window's last sample
  MassSolution solution;     ///< before the filter
  Eigen::VectorXd filtered;  ///< Phi_bar of the free links (17); minimises no single window's f
};

/// Feed samples; every `stride` samples a window is solved, started at the last masses.
class OnlineIdentifier {
 public:
  /// `robot` must outlive the object. Throws InputError for settings that make no sense.
  OnlineIdentifier(const Robot& robot, BodyModel model, OnlineSettings settings);

  std::optional<OnlineResult> feed(const Sample& sample);

 private:
  BodyModel model_;
  OnlineSettings settings_;
  Window rows_;
  ParameterFilter filter_;
  std::deque<Sample> recent_;
  std::size_t since_last_ = 0;
  double squares_of_weight_;  ///< of || b ||^2
  Eigen::VectorXd masses_;
};

}  // namespace shapeid::reference

// The run behind `shapeid diagnose`: logs in, a richer model and what it is worth out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shapeid/app/inputs.hpp"
#include "shapeid/diagnosis/causes_alone.hpp"
#include "shapeid/diagnosis/consistent.hpp"
#include "shapeid/diagnosis/curve_fit.hpp"
#include "shapeid/diagnosis/unexplained.hpp"
#include "shapeid/diagnosis/unnoticed.hpp"

namespace shapeid::app {

struct DiagnoseOptions {
  MotionInputs inputs;
  std::vector<std::string> also;  ///< further logs that are fitted together with the first
  /// Logs for the final comparison; none: every fifth two seconds.
  std::vector<std::string> test;
  std::string reference;  ///< earlier log of the same robot; may be empty
  std::string shapes;     ///< shapes.yaml; empty: generous boxes
  std::vector<std::string> free_links;
  bool whole_body = false;
  bool trust = false;          ///< the given inertias are right: no link is sought
  double expected_mass = 0.0;  ///< kg; 0: as given
  /// Write the richer model with curves for what it leaves unexplained.
  bool curves = false;
  diagnosis::SelectionRule rule;
  diagnosis::Path path = diagnosis::Path::reference;
  std::size_t threads = 1;  ///< that go over a log at once
};

/// Residuals on motion that was used for nothing else, per generalised row, rms.
struct TestErrors {
  std::string where;
  std::size_t samples = 0;
  Eigen::VectorXd zero, given, usual, found;  ///< usual: diagnosis::usual_model()
  Eigen::VectorXd with_curves;  ///< found, and DiagnosisRun::curves; empty if there are none
  Eigen::VectorXd at_rest;      ///< share of the samples in which a row does not count
  /// The same against the torque as logged, without any filter, joints only.
  Eigen::VectorXd unfiltered_zero, unfiltered_given, unfiltered_found;
  /// What noise of the logged torque leaves after the filter, joints only, N m: from what the
  /// filter takes away, as though it were white. NaN if there is no filter.
  Eigen::VectorXd noise_floor;
};

struct DiagnosisRun {
  diagnosis::LoopSettings settings;
  diagnosis::LoopResult loop;
  diagnosis::Consistent consistent;
  diagnosis::Unnoticed unnoticed;
  std::optional<diagnosis::Consistent> causes_alone;  ///< if there are effects that are no causes
  TestErrors errors;
  std::vector<diagnosis::Structure> structures;
  std::vector<diagnosis::Curve> curves;  ///< of structures that a model can predict with
  diagnosis::Recording test;
  std::size_t test_stride = 1;      ///< every how many samples of it count: its rate may be another
  diagnosis::Series before, after;  ///< on the test motion
  MotionReport motion;
  std::vector<std::string> notes;
  std::string robot_yaml{};               ///< that was read; may be empty
  Eigen::VectorXd moves_behind_filter{};  ///< diagnosis::moves_behind(); empty if it was not asked
};

[[nodiscard]] DiagnosisRun run_diagnosis(const RobotInputs& robot, const DiagnoseOptions& options);

}  // namespace shapeid::app

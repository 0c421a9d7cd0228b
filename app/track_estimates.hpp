// What a stream of samples says about the free links: by the last window, by the last tenths of a
// second, by all that came before; and whether a load was put on or taken off.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>

#include "shapeid/app/track_noise.hpp"
#include "shapeid/fast/identifier.hpp"
#include "shapeid/fast/mass_solver.hpp"
#include "shapeid/fast/parameter_tracker.hpp"
#include "shapeid/fast/sliding_triangle.hpp"
#include "shapeid/fast/triangle.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::app {

struct EstimateSettings {
  fast::IdentifierSettings identifier;
  Eigen::VectorXd natural_size;  ///< of the free links' parameters, reference::natural_sizes()
  double recent = 0.3;           ///< s, of the longer window
  /// Share of its natural size by which a parameter may wander in a second.
  double wander = 0.02;
};

/// The total mass of the free links changed.
struct LoadChange {
  double since = 0.0;           ///< s
  double mass = 0.0;            ///< kg, negative when taken off
  double standard_error = 0.0;  ///< kg
  bool settled = false;         ///< only rows after the change are in it
  bool holds = false;           ///< large enough, still
};

class Estimates {
 public:
  Estimates(const Robot& robot, const BodyModel& model, const EstimateSettings& settings,
            double rate);

  /// `repeats`: it says again what the sample before said (RepeatWatch).
  fast::Identifier::Fed feed(const Sample& sample, bool repeats);
  /// The next sample does not follow the last one.
  void forget_samples();
  /// So much time went by without a sample that says anything, s.
  void pass(double seconds);

  [[nodiscard]] const fast::Identifier& identifier() const { return identifier_; }
  /// By the last tenths of a second, within the cone of the shapes; 10 a free link.
  [[nodiscard]] const Eigen::VectorXd& recent() const { return recent_; }
  /// By the Kalman filter, within the cone of the shapes; 10 a free link.
  [[nodiscard]] const Eigen::VectorXd& tracked() const { return tracked_; }
  /// kg, the total mass by the Kalman filter's own mean, of which nothing asks that shapes can have
  /// it.
  [[nodiscard]] double mass_by_rows() const;
  /// kg, its standard deviation: by the noise of the rows it comes from, and by what the mass may
  /// have wandered while nothing was said about it.
  [[nodiscard]] double mass_error() const { return std::sqrt(mass_variance_); }
  /// Whether it is the rows that the error comes from: less than half of what was believed before
  /// the first.
  [[nodiscard]] bool rows_tell_mass() const;
  /// Whether the rows ask, for certain, for what no masses of the shapes can give.
  [[nodiscard]] bool contradicts_rows() const;
  /// Whether the tracked answer is none (docs/tracking.md): for the last seconds it foretold next
  /// to nothing of each window's rows, and the rows ask, for certain, for masses that cannot be.
  [[nodiscard]] bool finds_no_mass() const;
  /// Whether it foretold more than next to nothing at any time.
  [[nodiscard]] bool ever_explained() const { return ever_explained_; }
  /// Whether the last tenths of a second ask for so many times the expected mass that torques
  /// cannot be in N m. The Kalman filter, which believes in masses of the size that is expected,
  /// then lags.
  [[nodiscard]] bool asks_too_much() const;
  /// Whether these tenths of a second are whole, and tell a scale.
  [[nodiscard]] bool fills_recent() const;
  /// Found at the last window that was answered.
  [[nodiscard]] const std::optional<LoadChange>& load_change() const { return change_; }

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("identifier", identifier_);
    archive("sliding", sliding_);
    archive("tracker", tracker_);
    archive("recent", recent_);
    archive("tracked", tracked_);
    archive("mass_variance", mass_variance_);
    archive("noise", noise_);
    archive("windows", windows_);
    archive("correlation", correlation_);
    archive("mean_square", mean_square_);
    archive("asked", asked_);
    archive("pulls", pulls_);
    archive("lately", lately_);
    archive("rows", rows_);
    archive("recent_rows", recent_rows_);
    archive("past", past_);
    archive("disagreeing", disagreeing_);
    archive("found", found_);
    archive("settles_in", settles_in_);
    archive("explained", explained_);
    archive("ever_explained", ever_explained_);
  }

 private:
  void take_window(double time);
  void learn_noise();
  void learn_explained();
  [[nodiscard]] bool explains() const;
  void learn_correlation();
  void set_correlation();
  void measure();
  [[nodiscard]] double total_variance() const;
  [[nodiscard]] bool solve(const Eigen::MatrixXd& R, Eigen::VectorXd& Phi);
  [[nodiscard]] double recent_variance() const;
  [[nodiscard]] double least_change(double error) const;
  void watch_load(double time);

  /// Of samples, free of contact forces.
  struct Rows {
    double all = 0.0;
    double changing = 0.0;  ///< of samples that do not repeat
    template <class Archive>
    void state(Archive& archive) {
      archive("all", all);
      archive("changing", changing);
    }
  };

  /// The filter's mean, averaged over some stances.
  struct Lately {
    Eigen::VectorXd mean;
    std::size_t windows = 0;  ///< since a break
    template <class Archive>
    void state(Archive& archive) {
      archive("mean", mean);
      archive("windows", windows);
    }
  };

  /// What was believed behind a window.
  struct Past {
    double mass = 0.0;         ///< kg, tracked
    double variance = 0.0;     ///< kg^2, by the filter's own covariance
    double mean_square = 0.0;  ///< of pulls
    std::size_t asked = 0;     ///< windows that it is of
    template <class Archive>
    void state(Archive& archive) {
      archive("mass", mass);
      archive("variance", variance);
      archive("mean_square", mean_square);
      archive("asked", asked);
    }
  };

  /// A change that has not settled.
  struct Found {
    double before = 0.0;    ///< kg, tracked mass
    double variance = 0.0;  ///< kg^2, of before
    double change = 0.0;    ///< kg, as first seen
    double time = 0.0;      ///< s
    template <class Archive>
    void state(Archive& archive) {
      archive("before", before);
      archive("variance", variance);
      archive("change", change);
      archive("time", time);
    }
  };

  fast::MassSolver solver_;
  fast::Identifier identifier_;
  const Robot& robot_;
  EstimateSettings settings_;
  double window_seconds_;
  double samples_in_stance_;
  double correlation_;  ///< samples that say as much as one
  std::size_t windows_in_recent_;
  TrackNoise noise_;
  fast::Triangle recent_block_;  ///< the last window as sliding_ got it
  fast::SlidingTriangle sliding_;
  fast::ParameterTracker tracker_;
  Eigen::VectorXd recent_, tracked_;
  double mass_variance_;      ///< kg^2, mass_error()
  double prior_variance_;     ///< kg^2, of the total mass, before the first row
  std::size_t windows_ = 0;   ///< that were answered
  double mean_square_ = 0.0;  ///< of the pulls of windows, running: learn_correlation()
  std::size_t asked_ = 0;     ///< windows whose pulls were learned
  std::deque<double> pulls_;  ///< of the windows of a stance, newest first
  Lately lately_;
  Rows rows_;                     ///< since the window began
  std::deque<Past> past_;         ///< of as many windows as the longer one has
  std::size_t disagreeing_ = 0;   ///< windows in a row
  std::deque<Rows> recent_rows_;  ///< of each of the windows in sliding_
  std::optional<Found> found_;
  std::size_t settles_in_ = 0;  ///< windows
  std::optional<LoadChange> change_;
  double explained_ = 0.0;  ///< share of the squares of a window's rows, running mean
  bool ever_explained_ = false;
};

/// kg, of all links: 10 parameters each.
[[nodiscard]] double total_mass(const Eigen::VectorXd& Phi);

}  // namespace shapeid::app

// Units and signs that cannot be right are refused before they become inertias.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shapeid/models/channels.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/value_range.hpp"

namespace shapeid {

/// Throws InputError for a median step (s) that only a clock in other units than seconds has.
void check_clock(const std::string& path, const std::string& column, double median_step);

/// Throws InputError that names the option by which a regular grid (Hz) was chosen if it is slower
/// than the rows of the log are.
void check_grid(std::string_view option, double grid_rate, double logged_rate);

/// Watches the measured rows of a log, block by block:
///  * positions far outside the joint's limits, which fit them in radians if they are degrees;
///  * logged dq that follows the slope of q with another factor than one (degrees, milliseconds),
///    with the opposite sign, or the slope of another joint's q;
///  * an accelerometer whose mean magnitude is not gravity (g as unit, mm/s^2, gravity removed);
///  * channels that never change while the joints move, positions while their own velocity does,
///    and torques of which none does;
///  * readings that no robot has, by orders of magnitude;
///  * angles that jump by a turn from one row to the next, positions that are elsewhere for one
///    row, and such that jump elsewhere and stay there;
///  * rows at another rate than before.
/// A block decides only what it has motion enough to decide. Throws InputError.
class Plausibility {
 public:
  struct Options {
    double longest_step = 0.0;  ///< s between rows; slopes are not taken across longer ones
    bool expect_gravity = true;
    bool refuse_frozen = true;
    /// Single ones that no robot has, angles that wrap, and rows at another rate.
    bool refuse_readings = true;
    /// Without noise and not resampled: an axis of the IMU may read zero, rows may come at any
    /// time.
    bool exact = false;
  };
  Plausibility(std::string path, const Robot& robot, const ChannelPlan& plan, Options options);

  /// Takes a row in and judges when a block is full.
  void add(const MeasuredRow& row);
  /// Judges what has come since the last block, and forgets it.
  void judge();

 private:
  /// Of a channel, and where the largest magnitude stood.
  struct Range : ValueRange {
    int line = 0;
    void add(double value, int at);
    [[nodiscard]] bool frozen() const { return least == most; }
  };
  /// Of a short span: the change of q, the integral of dq, and how long it is (s).
  struct Span {
    double change = 0.0, integral = 0.0, seconds = 0.0;
  };
  struct Slope {
    double changes = 0.0, integrals = 0.0;  ///< sums of squares over spans
    std::vector<Span> spans;
    int in_span = 0;
    double start = 0.0, began = 0.0, integral = 0.0;  ///< of the present span
    double time = 0.0, dq = 0.0;                      ///< last row
    /// The span, if one ends here.
    std::optional<Span> add(double t, double position, double velocity, double longest_step);
  };

  /// The last rows of a position.
  struct Steps {
    double time = 0.0, position = 0.0;
    double last = 0.0, before = 0.0;  ///< the steps that led there
    int line = 0;
    int rows = 0;  ///< that followed each other
  };

  [[nodiscard]] const Range& range(int channel) const {
    return ranges_[static_cast<std::size_t>(channel)];
  }
  [[nodiscard]] Place place(int channel, int line = 0) const;
  void add_gravity(const MeasuredRow& row);
  void add_slopes(const MeasuredRow& row);
  void add_step(int joint, const MeasuredRow& row);
  void judge_size() const;
  void judge_angle(int joint) const;
  void judge_length(int joint) const;
  void judge_slope(int joint) const;
  void judge_other_slopes(int joint) const;
  [[nodiscard]] double slope(int position, int velocity) const;
  [[nodiscard]] double correlation(int position, int velocity) const;
  void judge_gravity() const;
  [[nodiscard]] bool moves(int j) const;
  [[nodiscard]] bool moves_by_velocity(int j) const;
  [[nodiscard]] bool base_turns() const;
  void judge_frozen() const;
  void judge_rate();

  std::string path_;
  const Robot& robot_;
  const ChannelPlan& plan_;
  Options options_;
  std::size_t rows_ = 0;
  std::vector<Range> ranges_;  ///< one a channel
  std::vector<Slope> slopes_;  ///< one a joint
  /// Sums over spans of the change of a position (row) times the integral of a velocity (column).
  Eigen::MatrixXd products_;
  std::vector<Steps> steps_;  ///< likewise
  double force_sum_ = 0.0;
  std::size_t force_count_ = 0;
  std::vector<double> row_steps_;  ///< s
  double last_time_ = 0.0, first_median_ = 0.0;
  int first_line_ = 0;  ///< of the block
};

}  // namespace shapeid

// Which column of a log is which quantity of a robot, and the rows of a log in these terms.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/log.hpp"
#include "shapeid/models/resampler.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid {

/// One of our quantities in a log: value = scale * column + offset.
struct Channel {
  std::string name;  ///< ours, e.g. q.knee
  std::string from;  ///< the log's
  std::size_t column = 0;
  double scale = 1.0, offset = 0.0;
  int hold_group = -1;  ///< of sample-and-hold columns; -1: every row is a measurement
};

/// The channels that a robot's motion needs, in this order as far as the log has them.
struct ChannelPlan {
  Channel time;
  std::vector<Channel> channels;  ///< all that is interpolated and filtered
  /// Where each quantity starts in `channels`; -1 where the log does not have it. Three numbers
  /// each for gyro, accel and gyrodot, one a joint for q to tau, three a contact for force.
  int gyro = -1, accel = -1, gyrodot = -1, q = -1, dq = -1, ddq = -1, tau = -1, force = -1;
  std::vector<Channel> contacts;  ///< one a contact of the robot, or none
  struct Keep {
    std::size_t column = 0;
    double value = 0.0;
  };
  std::vector<Keep> keep;  ///< rows that do not have these values are left out
  int hold_groups = 0;
  std::vector<std::string> extra;          ///< columns that are neither ours nor mapped
  std::vector<std::size_t> extra_columns;  ///< where these are in the log

  [[nodiscard]] bool floating() const { return gyro >= 0; }
};

/// Finds the channels by name. Throws InputError for missing columns, for a floating log of a
/// fixed robot and the reverse, for contacts that the robot does not have, and for torque channels
/// whose name says current or motor while the mapping does not declare them; what a mapping says
/// is complained of at its line.
[[nodiscard]] ChannelPlan plan_channels(const LogTable& log, const Robot& robot,
                                        const std::optional<Mapping>& mapping);

/// The links that the log, or the mapping, has contact.<link> columns for; in alphabetical order.
[[nodiscard]] std::vector<std::string> contact_names(const LogTable& log,
                                                     const std::optional<Mapping>& mapping);

/// Where a quantity of ours is said to be a column: in the mapping, or else in the log's header.
[[nodiscard]] Place place_of_column(const std::string& ours, const LogTable& log,
                                    const std::optional<Mapping>& mapping);

/// What the rows of a table say in the order of its plan: SI units, sample-and-hold resolved.
class RowMeaning {
 public:
  RowMeaning(const LogTable& log, const Robot& robot, const std::optional<Mapping>& mapping);

  [[nodiscard]] const ChannelPlan& plan() const { return plan_; }
  /// The mapping's row filter lets it pass.
  [[nodiscard]] bool kept(const LogRow& row) const;
  /// Throws InputError for a row without time and for contact flags other than 0, 1, -1 or nothing.
  /// Rows must come in the order of the log.
  [[nodiscard]] MeasuredRow read(const LogRow& row);

  /// What is remembered from row to row, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("held", held_);
  }

 private:
  [[nodiscard]] double time(const LogRow& row) const;
  [[nodiscard]] std::vector<int> contacts(const LogRow& row) const;
  void blank_held(const LogRow& row, Eigen::VectorXd& values);

  std::string path_;
  ChannelPlan plan_;
  std::vector<double> held_;  ///< last seen value of every channel, NaN before the first
};

/// The rows of a log in the order of its plan, row filters resolved.
class MeasuredRows {
 public:
  MeasuredRows(const std::string& path, const Robot& robot, const std::optional<Mapping>& mapping);

  [[nodiscard]] const ChannelPlan& plan() const { return meaning_.plan(); }
  [[nodiscard]] const std::string& path() const { return log_.path(); }
  /// Throws InputError as RowMeaning does, and for a clock that stands still or runs backwards.
  [[nodiscard]] std::optional<MeasuredRow> next();
  [[nodiscard]] std::size_t rows() const { return rows_; }          ///< read so far
  [[nodiscard]] std::size_t filtered() const { return filtered_; }  ///< of these, left out

 private:
  void check_clock(const MeasuredRow& row);

  LogReader log_;
  RowMeaning meaning_;
  std::optional<double> last_time_;
  std::size_t rows_ = 0, filtered_ = 0;
};

}  // namespace shapeid

// Irregular, partly missing measurements onto a regular grid, never across a gap.
#pragma once

#include <Eigen/Core>

#include <deque>
#include <optional>
#include <vector>

namespace shapeid {

/// What one row of a log measured.
struct MeasuredRow {
  int line = 0;               ///< in the log
  double time = 0.0;          ///< s
  Eigen::VectorXd values;     ///< one a channel; NaN where this row measured nothing new
  std::vector<int> contacts;  ///< one a contact: 1 touches, 0 does not, -1 not known
  std::vector<double> extra;  ///< the log's other columns, carried along; NaN where empty

  template <class Archive>
  void state(Archive& archive) {
    archive("line", line);
    archive("time", time);
    archive("values", values);
    archive("contacts", contacts);
    archive("extra", extra);
  }
};

/// What goes along with a row and is not interpolated, as in MeasuredRow.
struct Stamp {
  double time;
  std::vector<int> contacts;
  std::vector<double> extra;

  template <class Archive>
  void state(Archive& archive) {
    archive("time", time);
    archive("contacts", contacts);
    archive("extra", extra);
  }
};

/// A row of the regular grid.
struct GridRow {
  bool starts_segment = false;  ///< the first one, or the first after a gap
  double time = 0.0;            ///< s
  Eigen::VectorXd values;       ///< one a channel
  std::vector<int> contacts;    ///< those of the nearest measured row
  std::vector<double> extra;    ///< likewise
};

/// Interpolates every channel from its own measurements by the cubic through two of them on either
/// side (fewer beside a gap), in fixed memory. A segment ends where any channel has a gap, and the
/// next one starts on a measured row. Rows must come with increasing time.
class Resampler {
 public:
  /// `rate`: Hz of the grid. `longest_step`: s, one a channel; two measurements further apart than
  /// this leave a gap.
  Resampler(double rate, Eigen::VectorXd longest_step);

  void push(const MeasuredRow& row);
  /// No more rows will come.
  void finish();
  /// The next row of the grid, as soon as the measurements around it are known.
  [[nodiscard]] std::optional<GridRow> next();
  /// Measurements in memory, of the channel that has most.
  [[nodiscard]] std::size_t held() const;

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("tracks", tracks_);
    archive("flags", flags_);
    archive("newest", newest_);
    archive("any", any_);
    archive("finished", finished_);
    archive("starts_segment", starts_segment_);
    archive("anchor", anchor_);
    archive("steps", steps_);
  }

 private:
  struct Point {
    double time, value;
    template <class Archive>
    void state(Archive& archive) {
      archive("t", time);
      archive("v", value);
    }
  };
  using Track = std::deque<Point>;
  enum class State { ready, wait, gap };
  struct Look {
    State state;
    double until = 0.0;  ///< where the gap ends as far as known
  };

  [[nodiscard]] double time() const { return anchor_ + static_cast<double>(steps_) / rate_; }
  [[nodiscard]] Look look(Track& track, double longest) const;
  [[nodiscard]] double interpolate(const Track& track, double longest) const;
  void trim_contacts();
  void restart(double time);

  double rate_;
  Eigen::VectorXd longest_step_;
  std::vector<Track> tracks_;
  std::deque<Stamp> flags_;
  double newest_ = 0.0;
  bool any_ = false, finished_ = false;
  bool starts_segment_ = true;
  double anchor_ = 0.0;  ///< time of the segment's first grid row
  long long steps_ = 0;  ///< grid rows since then
};

}  // namespace shapeid

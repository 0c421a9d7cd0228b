// Low-pass filtering of the rows instead of the signals: the equations stay exact, noise in them
// falls. Derivation: docs/derivations/noise-in-y.md.
#pragma once

#include <Eigen/Core>

#include <deque>
#include <optional>
#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/butterworth.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/models/segment_filter.hpp"
#include "shapeid/reference/sample_rows.hpp"

namespace shapeid::reference {

struct RowFilterOptions {
  double cutoff = 20.0;          ///< Hz, -3 dB of one of the two passes
  int order = log_filter_order;  ///< of one pass
  double rate = 500.0;           ///< Hz, of the samples
  int keep_every = 1;            ///< of the filtered samples, whose neighbours say much the same
};

/// Rows of one instant after the filter: Y Phi = F.
struct FilteredRows {
  double time;        ///< s
  Eigen::MatrixXd Y;  ///< dof x (10 per free link)
  Eigen::VectorXd F;  ///< dof
};

/// Each sample's rows with contact forces projected out, P W^(1/2) [Y F] with
/// P = Q2 Q2^T, filtered in time without phase. P, unlike Q2, is unique, so that rows of
/// neighbouring samples belong together. Feed samples that were filtered lightly, if at all.
class RowFilter {
 public:
  /// `weight`: diagonal of W. The robot must outlive the filter. Throws InputError for a cutoff
  /// that is not below half the rate, std::invalid_argument for keep_every < 1.
  RowFilter(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
            Eigen::VectorXd weight, const RowFilterOptions& options);

  /// In the order of time. A step that is not one of the grid begins a new segment.
  void push(const Sample& sample);
  /// The same with the sample's time (s) and rows given.
  void push(double time, const SampleRows& rows);
  /// No more samples.
  void finish();
  [[nodiscard]] std::optional<FilteredRows> next();

 private:
  void collect();

  const Robot* robot_;
  Eigen::VectorXd known_;
  std::vector<int> free_links_;
  ContactTreatment contacts_;
  Eigen::VectorXd weight_;
  RowFilterOptions options_;
  SegmentFilter filter_;
  std::deque<double> times_;  ///< of the present segment, from the next row that comes out on
  std::optional<double> last_;
  long count_ = 0;
  std::deque<FilteredRows> done_;
};

}  // namespace shapeid::reference

#include "shapeid/reference/row_filter.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "shapeid/reference/projection.hpp"

namespace shapeid::reference {
namespace {

Eigen::Index channels(const Robot& robot, const BodyModel& model) {
  return robot.dof() * (10 * static_cast<Eigen::Index>(model.free_links.size()) + 1);
}

}  // namespace

RowFilter::RowFilter(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
                     Eigen::VectorXd weight, const RowFilterOptions& options)
    : robot_(&robot),
      known_(model.known),
      free_links_(model.free_links),
      contacts_(contacts),
      weight_(std::move(weight)),
      options_(options),
      filter_(Smoothing::zero_phase, Butterworth(options.order, options.cutoff, options.rate),
              channels(robot, model)) {
  SHAPEID_CONTRACT(why_no_weight(weight_, robot.dof()));
  if (options.keep_every < 1) throw std::invalid_argument("RowFilter: keep_every is below 1");
}

void RowFilter::push(const Sample& sample) {
  push(sample.time, sample_rows(*robot_, known_, free_links_, contacts_, sample));
}

void RowFilter::push(double time, const SampleRows& rows) {
  constexpr double step_of_grid = 1.5;  // a missing sample makes it two
  if (last_ && !(time > *last_ && time - *last_ <= step_of_grid / options_.rate)) finish();
  last_ = time;
  times_.push_back(time);

  const Eigen::MatrixXd Q2 = contact_free_basis(rows.J, weight_).Q2;
  Eigen::MatrixXd YF(rows.Y.rows(), rows.Y.cols() + 1);
  YF << rows.Y, rows.F;
  YF = (Q2 * (Q2.transpose() * (weight_.cwiseSqrt().asDiagonal() * YF))).eval();
  filter_.push(YF.reshaped());
  collect();
}

void RowFilter::finish() {
  filter_.finish();
  collect();
  filter_.reset();
  times_.clear();  // of a segment too short to filter
}

// No row is left out near a segment's ends: what the filter starts from are sums of rows, too, and
// obey the same equation.
void RowFilter::collect() {
  while (const std::optional<Eigen::VectorXd> row = filter_.next()) {
    const double time = times_.front();
    times_.pop_front();
    if (count_++ % options_.keep_every != 0) continue;
    const auto YF = row->reshaped(robot_->dof(), row->size() / robot_->dof());
    done_.push_back({time, YF.leftCols(YF.cols() - 1), YF.rightCols<1>()});
  }
}

std::optional<FilteredRows> RowFilter::next() {
  if (done_.empty()) return std::nullopt;
  FilteredRows rows = std::move(done_.front());
  done_.pop_front();
  return rows;
}

}  // namespace shapeid::reference

#include "shapeid/fast/window.hpp"

#include <cmath>

namespace shapeid::fast {
namespace {

// Enough rows that a pass over them is not all latency; few enough to stay in the nearest cache,
// and that the call in which they are compressed is no burst.
constexpr Eigen::Index rows_at_once = 64;

}  // namespace

Window::Window(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
               const Eigen::VectorXd& weight)
    : sample_rows_(robot, model, contacts, weight),
      triangle_(10 * static_cast<Eigen::Index>(model.free_links.size())),
      waiting_(rows_at_once + robot.dof() + 1, triangle_.R().cols()) {}

Verdict Window::add(const Sample& sample) noexcept {
  const Verdict verdict = sample_rows_.update(sample);
  if (verdict != Verdict::taken) return verdict;
  const auto rows = sample_rows_.rows();
  waiting_.middleRows(used_, rows.rows()) = rows;  // (5)
  used_ += rows.rows();
  constant_ += sample_rows_.constant();
  ++samples_;
  if (sample_rows_.by_six_rows()) ++samples_by_six_rows_;
  if (used_ >= rows_at_once) compress();
  return Verdict::taken;
}

void Window::clear() noexcept {
  triangle_.clear();
  used_ = 0;
  constant_ = 0.0;
  samples_ = samples_by_six_rows_ = 0;
}

void Window::forget(double factor) noexcept {
  compress();
  triangle_.forget(factor);
}

const Triangle& Window::triangle() noexcept {
  compress();
  return triangle_;
}

void Window::compress() noexcept {
  if (constant_ > 0.0) {  // one row that is zero in Y
    waiting_.row(used_).setZero();
    waiting_(used_, waiting_.cols() - 1) = std::sqrt(constant_);
    ++used_;
    constant_ = 0.0;
  }
  triangle_.absorb(waiting_.topRows(used_));
  used_ = 0;
}

}  // namespace shapeid::fast

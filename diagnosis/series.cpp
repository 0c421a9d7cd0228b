#include "shapeid/diagnosis/series.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace shapeid::diagnosis {

Eigen::VectorXd row_rms(
    const Eigen::MatrixXd& rows,
    const Eigen::Ref<const Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>>& counted) {
  Eigen::VectorXd rms(rows.rows());
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    double sum = 0.0, count = 0.0;
    for (Eigen::Index i = 0; i < rows.cols(); ++i) {
      const double x = rows(r, i);
      if (!counted(r, i) || std::isnan(x)) continue;
      sum += x * x;
      count += 1.0;
    }
    rms[r] = count > 0.0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
  }
  return rms;
}

Series series(const Robot& robot, RowSource source, const RichModel& model,
              const Recording& recording, std::size_t stride) {
  const Viewer viewer(robot, source, model.acting());
  Series result;
  result.index = recording.usable(stride);
  result.residual.resize(robot.dof(), std::ssize(result.index));
  result.predicted.resize(robot.dof(), std::ssize(result.index));
  result.counted.resize(robot.dof(), std::ssize(result.index));
  for (std::size_t i = 0; i < result.index.size(); ++i) {
    const View view = viewer.view(recording, result.index[i]);
    const auto column = static_cast<Eigen::Index>(i);
    result.residual.col(column) = residual(viewer, view, model);
    result.counted.col(column) = counted_rows(viewer, recording, result.index[i], view);
    result.predicted.col(column) = logged_force(viewer, view) + result.residual.col(column);
  }
  return result;
}

Eigen::VectorXd centred(const Series& series, const Eigen::MatrixXd& of, Eigen::Index row) {
  const Eigen::ArrayXd counts = series.counted.row(row).cast<double>().transpose();
  const Eigen::ArrayXd y = of.row(row).transpose();
  return (y - (y * counts).sum() / std::max(counts.sum(), 1.0)) * counts;
}

namespace {

/// What a ripple is sought in: readings of one joint's row, and where the other stood.
struct Readings {
  Eigen::ArrayXd x, size;  ///< position (rad or m); what the ripple is in proportion to
  Eigen::VectorXd y;
};

/// The frequency from `lower` to `upper`, in steps, that explains most of the stretches of readings
/// that begin at `starts`, of each with a phase of its own.
double strongest(const Readings& of, const std::vector<Eigen::Index>& starts, double lower,
                 double upper, double step) {
  // From one frequency to the next by the sum of angles: a sine costs as much as all the rest.
  Eigen::ArrayXd cosine = (lower * of.x).cos(), sine = (lower * of.x).sin();
  const Eigen::ArrayXd cosine_of_step = (step * of.x).cos(), sine_of_step = (step * of.x).sin();
  double best = lower, most = 0.0;
  Eigen::MatrixX3d A(of.x.size(), 3);
  double N = lower;
  while (N <= upper) {
    A << of.size * cosine, of.size * sine, of.size;
    double explained = 0.0;
    for (std::size_t k = 0; k < starts.size(); ++k) {
      const Eigen::Index end = k + 1 < starts.size() ? starts[k + 1] : of.x.size();
      const auto part = A.middleRows(starts[k], end - starts[k]);
      const Eigen::Vector3d g = part.transpose() * of.y.segment(starts[k], end - starts[k]);
      explained += g.dot((part.transpose() * part).ldlt().solve(g));
    }
    if (explained > most) {
      most = explained;
      best = N;
    }
    N += step;
    const Eigen::ArrayXd turned = cosine * cosine_of_step - sine * sine_of_step;
    sine = sine * cosine_of_step + cosine * sine_of_step;
    cosine = turned;
  }
  return best;
}

/// The readings in the order of their positions, and where stretches of `widest` rad begin.
std::vector<Eigen::Index> sort_by_position(Readings& of, double widest) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(of.x.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::stable_sort(order, {}, [&](Eigen::Index i) { return of.x[i]; });
  of = {of.x(order), of.size(order), of.y(order)};
  std::vector<Eigen::Index> starts;
  double end = -std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < of.x.size(); ++i) {
    if (of.x[i] < end) continue;
    starts.push_back(i);
    end = of.x[i] + widest;
  }
  return starts;
}

}  // namespace

double strongest_ripple(const Robot& robot, const Recording& recording, const Series& left,
                        int joint, int over, RippleOf of, double lower, double upper) {
  const Eigen::Index row = robot.base_dof() + joint;
  std::vector<Eigen::Index> counted;
  for (Eigen::Index i = 0; i < left.residual.cols(); ++i) {
    if (left.counted(row, i)) counted.push_back(i);
  }
  if (counted.empty()) return lower;
  Readings readings{Eigen::ArrayXd(std::ssize(counted)), Eigen::ArrayXd::Ones(std::ssize(counted)),
                    left.residual(row, counted)};
  for (Eigen::Index i = 0; i < readings.x.size(); ++i) {
    const Eigen::Index at = counted[static_cast<std::size_t>(i)];
    readings.x[i] = recording[left.index[static_cast<std::size_t>(at)]].q[over];
  }
  if (of == RippleOf::load) readings.size = left.predicted(row, counted).transpose();
  // Over the whole range the phases of two neighbours differ by half a radian: between them hardly
  // anything of a ripple is lost.
  const double range = readings.x.maxCoeff() - readings.x.minCoeff();
  constexpr double least_range = 0.05;  // rad or m
  const auto step_over = [](double x) { return 0.5 / x; };
  // Of a joint that turns on and on there would be frequencies without end: they are first told
  // apart as finely as stretches of it do, and where these have most as finely as the whole.
  constexpr double widest = 30.0;
  if (!(range > widest)) {
    return strongest(readings, {0}, lower, upper, step_over(std::max(range, least_range)));
  }
  const std::vector<Eigen::Index> starts = sort_by_position(readings, widest);
  const double step = step_over(widest);
  const double about = strongest(readings, starts, lower, upper, step);
  const double around = 4.0 * step;  // noise moves the best of a ripple that is hardly seen
  return strongest(readings, {0}, std::max(lower, about - around), std::min(upper, about + around),
                   step_over(range));
}

}  // namespace shapeid::diagnosis

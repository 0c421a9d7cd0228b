#include "shapeid/diagnosis/series.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

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

double strongest_ripple(const Robot& robot, const Recording& recording, const Series& left,
                        int joint, int over, RippleOf of, double lower, double upper) {
  const Eigen::Index row = robot.base_dof() + joint;
  std::vector<Eigen::Index> counted;
  for (Eigen::Index i = 0; i < left.residual.cols(); ++i) {
    if (left.counted(row, i)) counted.push_back(i);
  }
  if (counted.empty()) return lower;
  Eigen::ArrayXd x(std::ssize(counted));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Eigen::Index at = counted[static_cast<std::size_t>(i)];
    x[i] = recording[left.index[static_cast<std::size_t>(at)]].q[over];
  }
  const Eigen::VectorXd y = left.residual(row, counted);
  Eigen::ArrayXd size = Eigen::ArrayXd::Ones(x.size());
  if (of == RippleOf::load) size = left.predicted(row, counted).transpose();
  // Over the whole range the phases of two neighbours differ by half a radian: between them hardly
  // anything of a ripple is lost.
  const double range = x.maxCoeff() - x.minCoeff();
  constexpr double least_range = 0.05, most_range = 500.0;  // rad or m
  const double step = 0.5 / std::clamp(range, least_range, most_range);
  // From one frequency to the next by the sum of angles: a sine costs as much as all the rest.
  Eigen::ArrayXd cosine = (lower * x).cos(), sine = (lower * x).sin();
  const Eigen::ArrayXd cosine_of_step = (step * x).cos(), sine_of_step = (step * x).sin();
  double best = lower, most = 0.0;
  double N = lower;
  while (N <= upper) {
    Eigen::MatrixX3d A(x.size(), 3);
    A << size * cosine, size * sine, size;
    const Eigen::Vector3d g = A.transpose() * y;
    const double explained = g.dot((A.transpose() * A).ldlt().solve(g));
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

}  // namespace shapeid::diagnosis

#include "shapeid/tests/experiments/methods/mass_columns.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::experiments {

Eigen::MatrixXd triangle_of(const DataTerm& f) {
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(11, 11);
  R.topLeftCorner<10, 10>() = f.R();
  R.col(10).head<10>() = f.c();
  R(10, 10) = std::sqrt(f.constant());
  return R;
}

MassColumns::MassColumns(const BodyModel& model, int more)
    : U_(10, 0), solver_(1, static_cast<int>(model.shapes.size()) + more) {
  for (const SoughtShape& s : model.shapes) append(unit_parameters(s.shape).values);
}

void MassColumns::append(const Vector10& u) {
  constexpr double no_density_term = 1.0;  // a volume is asked for, and unused at lambda = 0
  if (!solver_.append(0, u, no_density_term)) throw std::logic_error("no room for a column");
  U_.conservativeResize(10, U_.cols() + 1);
  U_.rightCols<1>() = u;
}

Vector10 MassColumns::solve(const DataTerm& f) {
  const Eigen::MatrixXd R = triangle_of(f);
  solver_.forget_masses();
  if (solver_.solve(R) == fast::Outcome::solved) return solver_.Phi();
  MassProblem problem;
  problem.Y = R.leftCols(10);
  problem.F = R.col(10);
  problem.W = Eigen::VectorXd::Ones(11);
  problem.U = U_;
  problem.V = Eigen::VectorXd::Ones(U_.cols());
  return reference::solve_masses(problem).Phi;
}

double MassColumns::floor(const DataTerm& f, const Vector10& Phi) const {
  Vector10 z = f.gradient(Phi);
  // Every column has mass one, so this makes its slope nonnegative.
  z[0] -= std::min(0.0, (U_.transpose() * z).minCoeff());
  return f.dual(z);
}

}  // namespace shapeid::experiments

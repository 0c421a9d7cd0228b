#include "shapeid/tests/experiments/methods/data_term.hpp"

namespace shapeid::experiments {

DataTerm::DataTerm(const Eigen::MatrixXd& triangle)
    : R_(triangle.topLeftCorner<10, 10>()),
      c_(triangle.col(10).head<10>()),
      constant_(triangle(10, 10) * triangle(10, 10)) {}

double DataTerm::value(const Vector10& Phi) const {
  return (R_ * Phi - c_).squaredNorm() + constant_;
}

Vector10 DataTerm::gradient(const Vector10& Phi) const {
  return 2.0 * R_.transpose() * (R_ * Phi - c_);
}

Vector10 DataTerm::free_optimum() const { return R_.triangularView<Eigen::Upper>().solve(c_); }

double DataTerm::dual(const Vector10& z) const {
  // With y = R Phi - c: || y ||^2 - z . Phi has its minimum at 2 y = R^-T z.
  const Vector10 y = 0.5 * R_.transpose().triangularView<Eigen::Lower>().solve(z);
  return constant_ - y.squaredNorm() - 2.0 * y.dot(c_);
}

}  // namespace shapeid::experiments

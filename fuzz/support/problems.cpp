#include "shapeid/fuzz/support/problems.hpp"

#include <cmath>

namespace shapeid::fuzz {
namespace {

double positive(Bytes& bytes, int decades) {
  const double value = std::abs(bytes.wild(decades));
  return value > 0.0 ? value : 1.0;
}

/// A new column of ten numbers, or one that depends on an earlier one of the link.
void fill_column(Bytes& bytes, int decades, Eigen::Index first, Eigen::Index j,
                 Eigen::MatrixXd& U) {
  const int kind = bytes.count(0, 7);
  if (kind == 0) return;
  auto column = U.col(j).segment<10>(first);
  if (kind <= 2 && j > 0) {
    column = (kind == 1 ? 1.0 : bytes.wild(decades)) * U.col(j - 1).segment<10>(first);
    return;
  }
  for (double& entry : column) entry = bytes.wild(decades);
}

}  // namespace

MassProblem any_problem(Bytes& bytes, int decades) {
  const int links = bytes.count(1, 2), rows = bytes.count(0, 12), shapes = bytes.count(0, 8);
  MassProblem p;
  p.Y = Eigen::MatrixXd::Zero(rows, Eigen::Index{10} * links);
  p.F.resize(rows);
  p.W.resize(rows);
  p.U = Eigen::MatrixXd::Zero(Eigen::Index{10} * links, shapes);
  p.V.resize(shapes);
  switch (bytes.count(0, 2)) {
    case 0:
      p.lambda = 0.0;
      break;
    case 1:
      p.lambda = std::pow(10.0, bytes.between(-14.0, 0.0));
      break;
    default:
      p.lambda = std::abs(bytes.wild(decades));
  }
  for (Eigen::Index j = 0; j < shapes; ++j) {
    p.V[j] = positive(bytes, decades);
    fill_column(bytes, decades, Eigen::Index{10} * bytes.count(0, links - 1), j, p.U);
  }
  for (Eigen::Index i = 0; i < rows; ++i) {
    p.W[i] = positive(bytes, decades);
    p.F[i] = bytes.wild(decades);
    for (Eigen::Index k = 0; k < p.Y.cols(); ++k) p.Y(i, k) = bytes.wild(decades);
  }
  p.mass_bound = bytes.flag() ? positive(bytes, decades) : 0.0;
  return p;
}

}  // namespace shapeid::fuzz

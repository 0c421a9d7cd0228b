#include "shapeid/proofs/certificate/exact_problem.hpp"

#include <cmath>

namespace shapeid::certificate {
namespace {

std::vector<std::optional<Rational>> bounds(const Eigen::VectorXd& b) {
  std::vector<std::optional<Rational>> exact_bounds;
  for (const double value : b) {
    exact_bounds.push_back(std::isfinite(value) ? std::optional(exact(value)) : std::nullopt);
  }
  return exact_bounds;
}

}  // namespace

SparseRows::SparseRows(const Eigen::MatrixXd& M)
    : rows_(static_cast<std::size_t>(M.rows())), columns_(static_cast<std::size_t>(M.cols())) {
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    for (Eigen::Index j = 0; j < M.cols(); ++j) {
      if (M(i, j) == 0.0) continue;
      rows_[static_cast<std::size_t>(i)].push_back({static_cast<std::size_t>(j), exact(M(i, j))});
    }
  }
}

Vector SparseRows::times(const Vector& x) const {
  Vector y(rows());
  for (std::size_t i = 0; i < rows(); ++i) {
    for (const Entry& e : rows_[i]) {
      if (sgn(x[e.column]) != 0) y[i] += e.value * x[e.column];
    }
  }
  return y;
}

Vector SparseRows::transposed_times(const Vector& y) const {
  Vector x(columns_);
  for (std::size_t i = 0; i < rows(); ++i) {
    if (sgn(y[i]) == 0) continue;
    for (const Entry& e : rows_[i]) x[e.column] += e.value * y[i];
  }
  return x;
}

SparseRows SparseRows::squared() const {
  SparseRows squares = *this;
  for (std::vector<Entry>& row : squares.rows_) {
    for (Entry& e : row) e.value *= e.value;
  }
  return squares;
}

Vector products(const Vector& a, const Vector& b) {
  Vector c(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) c[i] = a[i] * b[i];
  return c;
}

ExactProblem::ExactProblem(const StatedProblem& stated)
    : Y(stated.masses.Y),
      U(stated.masses.U),
      C(stated.others.values),
      F(exact(stated.masses.F)),
      W(exact(stated.masses.W)),
      V(exact(stated.masses.V)),
      lambda(stated.masses.lambda),
      lower(bounds(stated.others.lower)),
      upper(bounds(stated.others.upper)) {
  if (stated.masses.mass_bound > 0.0) mass_bound = exact(stated.masses.mass_bound);
}

Vector ExactProblem::residual(const Vector& Phi, const Vector& x) const {
  Vector r = Y.times(Phi);
  const Vector Cx = C.times(x);
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (!Cx.empty()) r[i] += Cx[i];
    r[i] -= F[i];
  }
  return r;
}

Rational ExactProblem::data_term(const Vector& r) const { return dot(products(W, r), r); }

Rational ExactProblem::density_term(const Vector& m) const {
  if (sgn(lambda) == 0) return 0;
  Vector terms;
  for (std::size_t j = 0; j < m.size(); ++j) {
    if (sgn(m[j]) != 0) terms.emplace_back(m[j] * m[j] / V[j]);
  }
  return lambda * sum(terms);
}

Slopes slopes(const ExactProblem& p, const Vector& r) {
  const Vector Wr = products(p.W, r);
  Slopes s;
  s.g = p.Y.transposed_times(Wr);
  s.a = p.U.transposed_times(s.g);
  s.c = p.C.transposed_times(Wr);
  return s;
}

}  // namespace shapeid::certificate

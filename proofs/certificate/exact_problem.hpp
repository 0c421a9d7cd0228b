// A stated problem in exact numbers: what every proof here evaluates.
#pragma once

#include <optional>
#include <vector>

#include "shapeid/models/stated_problem.hpp"
#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// A matrix by rows, its zeros left out.
class SparseRows {
 public:
  SparseRows() = default;
  explicit SparseRows(const Eigen::MatrixXd& M);

  [[nodiscard]] Vector times(const Vector& x) const;
  /// M^T y.
  [[nodiscard]] Vector transposed_times(const Vector& y) const;
  /// Every entry squared.
  [[nodiscard]] SparseRows squared() const;
  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] std::size_t columns() const { return columns_; }

 private:
  struct Entry {
    std::size_t column;
    Rational value;
  };
  std::vector<std::vector<Entry>> rows_;
  std::size_t columns_ = 0;
};

/// Entry by entry.
[[nodiscard]] Vector products(const Vector& a, const Vector& b);

/// The same letters as StatedProblem.
struct ExactProblem {
  explicit ExactProblem(const StatedProblem& stated);

  SparseRows Y, U, C;
  Vector F, W, V;
  Rational lambda;
  std::optional<Rational> mass_bound;                 ///< M, empty if none is declared
  std::vector<std::optional<Rational>> lower, upper;  ///< of x, empty where there is none

  [[nodiscard]] std::size_t shapes() const { return V.size(); }
  [[nodiscard]] std::size_t others() const { return lower.size(); }

  /// r = Y Phi + C x - F
  [[nodiscard]] Vector residual(const Vector& Phi, const Vector& x) const;
  /// r^T W r
  [[nodiscard]] Rational data_term(const Vector& r) const;
  /// lambda sum_j m_j^2 / V_j
  [[nodiscard]] Rational density_term(const Vector& m) const;
};

/// Half the slopes of the data term where the residual is r: with respect to Phi, to each mass and
/// to each x.
struct Slopes {
  Vector g;  ///< Y^T W r
  Vector a;  ///< U^T g
  Vector c;  ///< C^T W r
};

[[nodiscard]] Slopes slopes(const ExactProblem& problem, const Vector& r);

}  // namespace shapeid::certificate

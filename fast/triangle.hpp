// Rows compressed as they come: a triangle of fixed size with the same sum of squares.
#pragma once

#include <Eigen/Core>

namespace shapeid::fast {

/// R of the QR decomposition of all rows [Y F] added so far, as `reference::triangle` computes it
/// from the rows at once: || Y x - F || = || R (x, -1) || for every x. Its size is fixed, unknowns
/// + 1; before there are as many rows, and where columns depend on each other, rows of R are zero
/// or of the size of rounding errors. R is unique up to the signs of its rows if Y has full rank;
/// R^T R is unique always.
///
/// After construction nothing allocates or throws. Entries' squares must not overflow. A number
/// that is not finite makes R not finite until clear().
class Triangle {
 public:
  /// `unknowns`: columns of Y.
  explicit Triangle(Eigen::Index unknowns);

  /// Adds the rows [Y F] by Householder reflections: 2 rows (unknowns + 1)^2 operations. A Y or F
  /// that does not lie in memory column by column is copied, and then allocated, before the call.
  void add(const Eigen::Ref<const Eigen::MatrixXd>& Y,
           const Eigen::Ref<const Eigen::VectorXd>& F) noexcept;

  /// The same for rows that already are one matrix [Y F]: they are overwritten.
  void absorb(Eigen::Ref<Eigen::MatrixXd> rows) noexcept;

  /// As if all rows of `other`, of as many unknowns, had been added: 2/3 (unknowns + 1)^3
  /// operations. So windows compressed apart become one, in any order.
  void merge(const Triangle& other) noexcept;

  /// As `other`, of as many unknowns; unlike a copy it never asks for memory.
  void assign(const Triangle& other) noexcept;

  /// All rows so far count `factor` times (0 to 1) in the sum of squares.
  void forget(double factor) noexcept;

  /// As constructed: no rows.
  void clear() noexcept;

  /// (unknowns + 1) x (unknowns + 1), zero below the diagonal; the last column belongs to F.
  [[nodiscard]] const Eigen::MatrixXd& R() const noexcept { return R_; }

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("R", R_);
  }

 private:
  void annihilate(Eigen::Index first, Eigen::Ref<Eigen::MatrixXd>& rows) noexcept;

  Eigen::Index at_once_;  ///< reflections that are made before other columns see them
  Eigen::MatrixXd R_;
  Eigen::MatrixXd pending_;  ///< rows on their way into R
};

}  // namespace shapeid::fast

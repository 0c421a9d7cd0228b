// Held-out errors of a set of terms, and of every set with one term more or fewer.
#pragma once

#include <Eigen/Cholesky>

#include <vector>

#include "shapeid/diagnosis/fits.hpp"

namespace shapeid::diagnosis {

/// The same as BlockFits::held_out() of each set, but for rounding: one factorisation a fold and
/// one copy of the blocks do for all of them.
class FitsAround {
 public:
  /// `fits` must outlive this, and keep its prior.
  FitsAround(const BlockFits& fits, std::vector<Term> terms);

  [[nodiscard]] const std::vector<Term>& terms() const { return terms_; }
  /// Of the set itself.
  [[nodiscard]] const Eigen::VectorXd& error() const { return error_; }
  [[nodiscard]] Eigen::VectorXd without(std::size_t term) const;
  /// With a term's numbers given, and not fitted.
  [[nodiscard]] Eigen::VectorXd fixed_at(std::size_t term, const Eigen::VectorXd& value) const;
  [[nodiscard]] Eigen::VectorXd with(const Term& more) const;

 private:
  struct Fold {
    Eigen::LDLT<Eigen::MatrixXd> factor;
    Eigen::VectorXd x;
  };
  void add_fold(int fold);
  void add_block(std::size_t block);
  /// Error of every block, of an answer for each fold.
  [[nodiscard]] Eigen::VectorXd errors_of(const std::vector<Eigen::VectorXd>& answers) const;

  const BlockFits& fits_;
  std::vector<Term> terms_;
  BlockFits::Columns columns_;
  std::vector<Fold> folds_;
  /// Of every block that can be held out: squares of the columns and, last, F; of columns that are
  /// not active yet zero.
  std::vector<Eigen::MatrixXd> blocks_;
  Eigen::VectorXd error_;
};

}  // namespace shapeid::diagnosis

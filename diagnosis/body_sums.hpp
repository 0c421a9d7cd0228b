// Sums over a log for the masses of links and loads, with all other effects eliminated.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/diagnosis/tally.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/reference/determination.hpp"

namespace shapeid::diagnosis {

inline constexpr int tenths = 10;  ///< of a log: the jackknife leaves out one

/// Rows with the sums' squares, after the effects have taken what they can.
struct Eliminated {
  Eigen::MatrixXd rows;  ///< [Y_free, loads, F]
  Eigen::MatrixXd gain;  ///< effects x (columns of rows)

  /// The effects' numbers for these of free links and loads.
  [[nodiscard]] Eigen::VectorXd effects(const Eigen::VectorXd& Phi) const;
};

/// Sums over [Y_free, loads, E, F], with known links moved to F. Loads are bodies, too, and come
/// first among the tally's effects.
class BodySums {
 public:
  BodySums(const BodyModel& shapes, Tally tally);

  /// Numbers of free links, ten each; of these and loads.
  [[nodiscard]] Eigen::Index links() const { return links_; }
  [[nodiscard]] Eigen::Index bodies() const { return bodies_; }
  /// Numbers of loads and of effects; of effects alone.
  [[nodiscard]] Eigen::Index linear() const { return linear_; }
  [[nodiscard]] Eigen::Index effects() const { return links_ + linear_ - bodies_; }

  /// Of all blocks but a tenth of each log; -1: of all. Were the two logs one, a tenth of a long
  /// reference and a short log would hold all that came since.
  [[nodiscard]] Eliminated rows_without(int tenth) const;
  /// Rows of [Y_free, loads, E, F] with each block's squares. `size`: of all but F. What is smaller
  /// than the sums' own rounding counts as nothing.
  [[nodiscard]] std::vector<reference::RowBlock> blocks(const Eigen::VectorXd& size) const;
  /// Of each column of loads and effects the number with which it alone would be as large as F.
  [[nodiscard]] Eigen::VectorXd linear_sizes() const;
  /// In how many tenths each column of loads and effects is anything at all.
  [[nodiscard]] Eigen::ArrayXi tenths_with_columns() const;

 private:
  [[nodiscard]] int tenth_of(std::size_t b) const;
  [[nodiscard]] Eigen::MatrixXd without(int tenth) const;
  void reduce(Block& block) const;

  Tally tally_;
  std::size_t reference_blocks_ = 0;  ///< which come first
  Eigen::Index target_;               ///< column of F before anything is left out
  Eigen::Index linear_, links_, bodies_ = 0;
  Eigen::VectorXd precision_;  ///< of effects: one over each number's variance before any data
  std::vector<Eigen::Index> kept_;
  Eigen::VectorXd known_;
};

}  // namespace shapeid::diagnosis

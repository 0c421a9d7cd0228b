// The triangle of a single link, and what masses come to on it, four numbers at a time.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

#include "shapeid/fast/shape_columns.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {

/// Passive shapes of a link at up to a dozen places.
struct AtPlaces {
  static constexpr std::size_t most = 12;

  const std::array<Dozen, 10>* U;  ///< a place's column in each lane; any numbers where none is
  const Dozen* inverse;            ///< of A^T A + lambda V^-1, a row a place
  const int* shape;                ///< of each place
  const Dozen* m;                  ///< kg
  const Dozen* sizes;              ///< sum_i |u_i| lengths_i of each place's column
  unsigned used;                   ///< a bit a place
};

/// [R c] of one link, column by column and row by row.
class LinkRows {
 public:
  /// R: 11 x 11 as Triangle::R() has it.
  void take(const Eigen::MatrixXd& R) noexcept;

  /// Ten rows: R, then c, then zero.
  [[nodiscard]] const std::array<Dozen, 10>& rows() const noexcept { return rows_; }
  /// Eleven columns: ten numbers each, then zero. The last is c.
  [[nodiscard]] const std::array<Dozen, 11>& columns() const noexcept { return columns_; }
  /// Sums of the absolute values in each column of R: upper bounds of their lengths. Not finite if
  /// a number in R's columns is not.
  [[nodiscard]] const Dozen& lengths() const noexcept { return lengths_; }
  /// || b ||: of c and what no parameter reaches.
  [[nodiscard]] double length() const noexcept { return length_; }

  /// What masses come to.
  struct Value {
    Dozen Phi;      ///< U m
    Dozen slopes;   ///< R^T (c - R Phi), and two zeros
    double square;  ///< of || c - R Phi ||
  };
  /// Of the shapes `passive` with these masses (kg).
  void evaluate(const ShapeColumns& columns, const std::vector<int>& passive,
                const std::vector<double>& masses, Value& value) const noexcept;

  /// Masses that have been corrected.
  struct Settled {
    Value at;
    Dozen m;               ///< zero where no shape is
    double density = 0.0;  ///< lambda sum_j m_j^2 / V_j
    int corrections = 0;
    bool is_settled = false;  ///< masses are positive, and their slopes rounding
    unsigned below = 0;  ///< a bit a place whose mass came out zero or negative, if that ended it
  };
  /// Corrects the masses until each slope is at most `refined` of its terms; in `most` corrections
  /// or not at all. Where the square of the whole residual is below `exact` of || b ||^2, once
  /// more. `stiffness`: lambda / V of each place.
  void settle(const ShapeColumns& columns, const AtPlaces& passive, const Dozen& stiffness,
              double refined, int most, double exact, Settled& settled) const noexcept;

 private:
  std::array<Dozen, 10> rows_;
  std::array<Dozen, 11> columns_;
  Dozen lengths_;
  double length_ = 0.0;
  double unreached_ = 0.0;  ///< of the right-hand side
};

}  // namespace shapeid::fast

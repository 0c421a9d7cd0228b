// The masses of the passive shapes, what they come to on the rows, and whether that is the minimum.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "shapeid/fast/link_rows.hpp"
#include "shapeid/fast/passive_set.hpp"
#include "shapeid/fast/shape_columns.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::fast {

/// Slopes below this share of their terms are rounding: a hundred roundings.
inline constexpr double smallest_slope = 1e-14;

/// Slopes of passive shapes that are larger than this share of their terms are worth a step of
/// refinement: a few roundings more than a well-conditioned factorisation leaves.
inline constexpr double refined_slope = 3e-15;

/// Each step gains the digits that the condition leaves, six or more; the last ones are noise.
inline constexpr int most_refinements = 3;

/// A shape's place among the columns, and its mass (kg).
struct ShapeMass {
  int place;
  double mass;
};

/// Masses of  || R U m - c ||^2 + lambda sum_j m_j^2 / V_j  for the passive shapes, all others at
/// zero. What they come to is made from the masses alone, so that no error of a factorisation's
/// updates is in it. After construction nothing allocates or throws.
class PassiveMasses {
 public:
  PassiveMasses(const PassiveMasses&) = delete;
  PassiveMasses& operator=(const PassiveMasses&) = delete;
  ~PassiveMasses() = default;

  /// `columns` and `V` (m^3, an entry a shape) must outlive the object; `columns` has no shapes
  /// yet.
  PassiveMasses(ShapeColumns& columns, const Eigen::VectorXd& V);

  /// From now on for this triangle [R c], which must stay as it is. False if a number of it is not
  /// finite: then nothing changes.
  [[nodiscard]] bool take(const Eigen::MatrixXd& R) noexcept;
  /// Back to the triangle before the last take().
  void take_back() noexcept;
  /// Tells the columns what prices are measured by, if they do not know yet.
  void scale_prices() noexcept;
  void set_lambda(double lambda) noexcept;

  void clear() noexcept;
  void add(int j, double mass) noexcept {
    passive_.push_back(j);
    masses_.push_back(mass);
    stiffness_.push_back(lambda_ / (*V_)[j]);
    judged_ = false;
    if (mass != 0.0) evaluated_ = false;
  }
  void erase(std::size_t place) noexcept;
  /// The shape at this place, whose volume is another now, gives `part` of its mass to shape
  /// `other`.
  void divide(std::size_t place, int other, double part) noexcept {
    change()[place] -= part;
    if (lambda_ > 0.0) stiffness_[place] = lambda_ / (*V_)[passive_[place]];
    add(other, part);
  }
  /// As many as there are, kg.
  void set(const Eigen::VectorXd& masses) noexcept;
  /// The masses, to be changed.
  [[nodiscard]] std::vector<double>& change() noexcept {
    evaluated_ = false;
    return masses_;
  }

  /// No corrections are counted yet.
  void count_anew() noexcept { corrections_ = 0; }
  /// Remembers masses and what belongs to them, and goes back to it.
  void save() noexcept;
  void restore() noexcept;

  /// Phi, slopes and value of the masses, unless they are there already.
  void evaluate() noexcept;
  /// Of the passive shapes, whose slopes should be zero; over their terms.
  [[nodiscard]] double largest_slope() noexcept;

  /// At the minimum for lambda = 0: on to that for this lambda, by `set`, if it has the same
  /// passive shapes. False if that is not certain; then the masses stay.
  [[nodiscard]] bool damp(ColumnSet& set, double lambda) noexcept;
  /// From a guess at the minimum: whether it is the minimum once its masses are corrected. If not,
  /// nothing changes.
  [[nodiscard]] bool settles_at(Guess& guess) noexcept;
  /// Whether the answer stands if nothing has changed but that these shapes, without mass, have
  /// other columns.
  [[nodiscard]] bool stays_settled(const std::vector<int>& massless) noexcept;
  /// Whether every shape that is not passive would certainly raise the objective, and there are no
  /// more passive ones than independent columns.
  [[nodiscard]] bool is_at_a_vertex() noexcept;

  [[nodiscard]] const std::vector<int>& passive() const noexcept { return passive_; }
  /// The place of shape `j` among these; their number if it is none of them.
  [[nodiscard]] std::size_t place_of(int j) const noexcept {
    return static_cast<std::size_t>(std::find(passive_.begin(), passive_.end(), j) -
                                    passive_.begin());
  }
  [[nodiscard]] const std::vector<double>& masses() const noexcept { return masses_; }
  [[nodiscard]] const Eigen::VectorXd& Phi() const noexcept { return Phi_; }
  /// R^T (c - R Phi), 10 per link.
  [[nodiscard]] const Eigen::VectorXd& slopes() const noexcept { return slopes_; }
  [[nodiscard]] const Objective& value() const noexcept { return value_; }
  [[nodiscard]] double lambda() const noexcept { return lambda_; }
  /// Of the masses since save() or count_anew(), or of the guess that was settled at.
  [[nodiscard]] int corrections() const noexcept { return corrections_; }
  [[nodiscard]] bool has_rows() const noexcept { return rows_->R != nullptr; }
  [[nodiscard]] const Eigen::MatrixXd& R() const noexcept { return *rows_->R; }
  /// Of one link.
  [[nodiscard]] const LinkRows& link_rows() const noexcept { return rows_->link; }
  /// Upper bounds of the lengths of the columns of R.
  [[nodiscard]] const Eigen::VectorXd& lengths() const noexcept { return rows_->lengths; }
  /// Of b, the last column of the triangle.
  [[nodiscard]] double length() const noexcept { return rows_->length; }

 private:
  struct Rows {
    LinkRows link;  ///< where there is one link only
    const Eigen::MatrixXd* R = nullptr;
    Eigen::VectorXd lengths;  ///< of the columns of R, from above
    double length = 0.0;      ///< of b
  };

  void evaluate_links() noexcept;
  void take_value(double density) noexcept;
  [[nodiscard]] bool settle(NormalEquations& normal) noexcept;
  [[nodiscard]] bool correct(NormalEquations& normal) noexcept;
  /// Whether the rows determine the passive masses.
  [[nodiscard]] bool tells_apart(NormalEquations& normal) noexcept;
  [[nodiscard]] bool tells_apart(Guess& guess, const AtPlaces& at, const Dozen& m) noexcept;
  [[nodiscard]] bool tells_apart(NormalEquations& normal, const std::vector<int>& passive,
                                 const std::vector<double>& masses) noexcept;

  // First what is most strictly aligned.
  LinkRows::Value at_masses_;  ///< if evaluated_ and there is one link
  const Dozen no_stiffness_;   ///< zeros that were written long ago, and are quick to read
  std::array<Rows, 2> both_rows_;
  Rows* rows_ = both_rows_.data();
  Rows* other_rows_ = rows_ + 1;
  ShapeColumns* columns_;
  const Eigen::VectorXd* V_;
  double lambda_ = 0.0;
  std::vector<int> passive_;
  std::vector<double> masses_;     ///< of the passive shapes
  std::vector<double> stiffness_;  ///< lambda / V of the passive shapes
  std::vector<double> tried_;      ///< masses to come back to, or of a guess
  std::vector<int> guessed_;       ///< its passive shapes
  Eigen::VectorXd coefficients_, Phi_, r_, slopes_;
  Eigen::VectorXd gradient_;  ///< -1/2 df/dm of the passive shapes, if judged_
  Objective value_;
  double largest_slope_ = 0.0;  ///< over its terms
  std::vector<ShapeMass> saved_;
  Eigen::VectorXd saved_Phi_, saved_slopes_;
  Objective saved_value_;
  int corrections_ = 0;
  bool evaluated_ = false;  ///< Phi_, slopes_ and value_ are those of the masses
  bool judged_ = false;     ///< largest_slope_ is that of the passive shapes at slopes_
};

}  // namespace shapeid::fast

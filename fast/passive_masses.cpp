// Derivation and the reasons for the tolerances: docs/derivations/fast-masses.md.
#include "shapeid/fast/passive_masses.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "shapeid/fast/column_products.hpp"
#include "shapeid/fast/triangle_products.hpp"

namespace shapeid::fast {
namespace {

/// A slope further below zero than ten times what counts as rounding is certainly negative.
constexpr double certainly_held = 10.0 * smallest_slope;

/// Where rounding of slopes may move a mass by more than this share of all masses, the rows hardly
/// tell the passive shapes apart, and the density term, beside which rounding is nothing, should
/// hold them.
constexpr double told_apart = 1e-9;

/// Signs of rounding errors, one a bit, in no order that divided shapes could have: the binary
/// digits of the golden ratio.
constexpr std::uint64_t some_signs = 0x9E3779B97F4A7C15;

/// A residual's square below this share of || b ||^2 comes from rows without noise: sensors leave
/// more than a millionth, a hundred times this root.
constexpr double met_exactly = 1e-16;

Eigen::Map<const ShapeColumns::Column> first_ten(const Dozen& dozen) noexcept {
  return Eigen::Map<const ShapeColumns::Column>(dozen.data());
}

}  // namespace

PassiveMasses::PassiveMasses(ShapeColumns& columns, const Eigen::VectorXd& V)
    : columns_(&columns),
      V_(&V),
      Phi_(Eigen::VectorXd::Zero(Eigen::Index{10} * columns.links())),
      r_(Phi_),
      slopes_(Phi_),
      saved_Phi_(Phi_),
      saved_slopes_(Phi_) {
  rows_->lengths = other_rows_->lengths = Phi_;
  coefficients_.setZero(std::max<Eigen::Index>(Phi_.size(), columns.capacity()));
  gradient_ = coefficients_;
  const auto room = static_cast<std::size_t>(columns.capacity());
  passive_.reserve(room);
  masses_.reserve(room);
  stiffness_.reserve(room);
  tried_.reserve(room);
  guessed_.reserve(room);
  saved_.reserve(room);
}

bool PassiveMasses::take(const Eigen::MatrixXd& R) noexcept {
  if (columns_->links() == 1) {
    other_rows_->link.take(R);
    other_rows_->lengths = first_ten(other_rows_->link.lengths());
    other_rows_->length = other_rows_->link.length();
  } else {
    column_sizes(R, other_rows_->lengths);
    other_rows_->length = R.col(Phi_.size()).norm();
  }
  if (!std::isfinite(other_rows_->lengths.sum() + other_rows_->length)) return false;
  other_rows_->R = &R;
  take_back();
  return true;
}

void PassiveMasses::take_back() noexcept {
  std::swap(rows_, other_rows_);
  columns_->forget_scale();
  evaluated_ = false;
}

void PassiveMasses::scale_prices() noexcept {
  if (!columns_->has_scale()) columns_->set_scale(rows_->lengths, rows_->length);
}

void PassiveMasses::set_lambda(double lambda) noexcept {
  evaluated_ = false;
  if (lambda == lambda_) return;
  lambda_ = lambda;
  for (std::size_t i = 0; i < passive_.size(); ++i) stiffness_[i] = lambda / (*V_)[passive_[i]];
}

void PassiveMasses::clear() noexcept {
  passive_.clear();
  masses_.clear();
  stiffness_.clear();
  evaluated_ = false;
}

void PassiveMasses::erase(std::size_t place) noexcept {
  const auto at = static_cast<std::ptrdiff_t>(place);
  judged_ = false;
  if (masses_[place] != 0.0) evaluated_ = false;
  passive_.erase(passive_.begin() + at);
  masses_.erase(masses_.begin() + at);
  stiffness_.erase(stiffness_.begin() + at);
}

void PassiveMasses::set(const Eigen::VectorXd& masses) noexcept {
  if (!std::equal(masses_.begin(), masses_.end(), masses.data())) evaluated_ = false;
  std::copy_n(masses.data(), masses_.size(), masses_.data());
}

void PassiveMasses::save() noexcept {
  corrections_ = 0;
  saved_.clear();
  for (std::size_t i = 0; i < passive_.size(); ++i) saved_.push_back({passive_[i], masses_[i]});
  saved_Phi_ = Phi_;
  saved_slopes_ = slopes_;
  saved_value_ = value_;
}

void PassiveMasses::restore() noexcept {
  clear();
  for (const ShapeMass& saved : saved_) add(saved.place, saved.mass);
  Phi_ = saved_Phi_;
  slopes_ = saved_slopes_;
  value_ = saved_value_;
}

// From the masses alone, so that no error of the factorisation's updates is in it.
void PassiveMasses::evaluate() noexcept {
  if (evaluated_) return;
  double density = 0.0;
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    density += stiffness_[i] * masses_[i] * masses_[i];
  }
  if (columns_->links() == 1) {
    rows_->link.evaluate(*columns_, passive_, masses_, at_masses_);
    take_value(density);
    return;
  }
  evaluated_ = true;
  judged_ = false;
  value_.density = density;
  evaluate_links();
}

/// Of one link: Phi, slopes and value are those at `at_masses_`.
void PassiveMasses::take_value(double density) noexcept {
  evaluated_ = true;
  judged_ = false;
  Phi_ = first_ten(at_masses_.Phi);
  slopes_ = first_ten(at_masses_.slopes);
  const double unreached = (*rows_->R)(10, 10);
  value_ = {at_masses_.square + unreached * unreached, density};
}

void PassiveMasses::evaluate_links() noexcept {
  Phi_.setZero();
  // Of shapes one after the other on a link, in registers.
  ShapeColumns::Column sum = ShapeColumns::Column::Zero();
  int link = 0;
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    const int j = passive_[i];
    if (columns_->link(j) != link) {
      Phi_.segment<10>(Eigen::Index{10} * link) += sum;
      sum.setZero();
      link = columns_->link(j);
    }
    sum += masses_[i] * columns_->column(j);
  }
  if (columns_->links() > 0) Phi_.segment<10>(Eigen::Index{10} * link) += sum;
  r_ = right_hand_side(*rows_->R);
  for (int l = 0; l < columns_->links(); ++l) {
    const ShapeColumns::Column minus = -Phi_.segment<10>(Eigen::Index{10} * l);
    add_column(*rows_->R, l, minus.data(), r_.data());
  }
  const double unreached = (*rows_->R)(Phi_.size(), Phi_.size());
  value_.data = r_.squaredNorm() + unreached * unreached;
  slopes_of(*rows_->R, r_, slopes_);
}

/// Of the passive shapes, whose slopes should be zero; over their terms.
double PassiveMasses::largest_slope() noexcept {
  if (judged_) return largest_slope_;
  judged_ = true;
  column_products(*columns_, passive_, slopes_, gradient_);
  largest_slope_ = 0.0;
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    double& slope = gradient_[static_cast<Eigen::Index>(i)];
    slope -= stiffness_[i] * masses_[i];
    largest_slope_ = std::max(largest_slope_, columns_->price(passive_[i], std::abs(slope)));
  }
  return largest_slope_;
}

// Masses at the minimum for lambda = 0 solve A^T A m = A^T c; those for lambda add -lambda V^-1 m
// to the right-hand side, which moves them by lambda over the square of the smallest singular value
// of A: little where columns do not nearly depend on each other, so that refinement converges. The
// shapes that are held stay so if their slopes, now lambda's size apart, are certainly negative.
bool PassiveMasses::damp(ColumnSet& set, double lambda) noexcept {
  if (!is_at_a_vertex() || !tells_apart(set)) return false;
  lambda_ = lambda;
  for (std::size_t i = 0; i < passive_.size(); ++i) stiffness_[i] = lambda / (*V_)[passive_[i]];
  evaluated_ = false;
  tried_ = masses_;
  // Of a stiffness that overflows no mass is a number.
  if (settle(set) && std::isfinite(value_.total()) && is_at_a_vertex()) return true;
  masses_ = tried_;
  evaluated_ = false;
  return false;
}

// The pivots may have gone astray, and the masses have the digits that a squared condition leaves.
// Whether they are the minimum is asked of the masses alone, as of any other answer, and more
// strictly: where no correction reaches the last digits the method itself is called.
bool PassiveMasses::settles_at(Guess& guess) noexcept {
  const bool is_damped = lambda_ > 0.0;
  const AtPlaces at = guess.answer();
  Dozen stiffness;
  for (unsigned left = is_damped ? at.used : 0U; left != 0; left &= left - 1) {
    const auto place = static_cast<std::size_t>(std::countr_zero(left));
    stiffness[place] = lambda_ / (*V_)[at.shape[place]];
  }
  LinkRows::Settled settled;
  rows_->link.settle(*columns_, at, is_damped ? stiffness : no_stiffness_, refined_slope,
                     most_refinements, met_exactly, settled);
  corrections_ = settled.corrections;
  guess.let_go(settled.below);
  if (!settled.is_settled || !std::isfinite(settled.at.square + settled.density) ||
      !guess.none_enters(settled.at.slopes, is_damped ? -certainly_held : smallest_slope) ||
      (is_damped && !tells_apart(guess, at, settled.m))) {
    return false;
  }
  const auto n = static_cast<std::size_t>(std::popcount(at.used));
  passive_.resize(n);
  masses_.resize(n);
  stiffness_.resize(n);
  std::size_t i = 0;
  for (unsigned left = at.used; left != 0; left &= left - 1, ++i) {
    const auto place = static_cast<std::size_t>(std::countr_zero(left));
    passive_[i] = at.shape[place];
    masses_[i] = settled.m[place];
    stiffness_[i] = stiffness[place];
  }
  at_masses_ = settled.at;
  take_value(settled.density);
  guess.correct(settled.m, settled.at.slopes);
  return true;
}

// All others were asked at the same slopes.
bool PassiveMasses::stays_settled(const std::vector<int>& massless) noexcept {
  corrections_ = 0;
  scale_prices();
  const double threshold = lambda_ > 0.0 ? -certainly_held : smallest_slope;
  return std::ranges::all_of(massless, [this, threshold](int j) {
    const auto g = slopes_.segment<10>(Eigen::Index{10} * columns_->link(j));
    return columns_->price(j, columns_->column(j).dot(g)) <= threshold;
  });
}

/// Corrects the masses until the slopes of the passive shapes are rounding. False if that does not
/// come about, or takes a mass away.
bool PassiveMasses::settle(NormalEquations& normal) noexcept {
  evaluate();
  bool is_positive = true;
  for (int k = 0; k < most_refinements && is_positive && largest_slope() > refined_slope; ++k) {
    is_positive = correct(normal);
    evaluate();
  }
  return is_positive && largest_slope() <= refined_slope;
}

/// One step of refinement of the masses; whether all stay positive.
bool PassiveMasses::correct(NormalEquations& normal) noexcept {
  ++corrections_;
  static_cast<void>(largest_slope());
  coefficients_.head(static_cast<Eigen::Index>(masses_.size())) =
      gradient_.head(static_cast<Eigen::Index>(masses_.size()));
  normal.solve_normal(coefficients_);
  evaluated_ = false;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    masses_[i] += coefficients_[static_cast<Eigen::Index>(i)];
    smallest = std::min(smallest, masses_[i]);
  }
  return smallest > 0.0;
}

// What a rounding of each slope does to the masses. The signs that do the most are found as in
// Hager's estimate of a condition: from any signs, by those of what they lead to.
bool PassiveMasses::tells_apart(NormalEquations& normal) noexcept {
  return tells_apart(normal, passive_, masses_);
}

bool PassiveMasses::tells_apart(Guess& guess, const AtPlaces& at, const Dozen& m) noexcept {
  guessed_.clear();
  tried_.clear();
  for (unsigned left = at.used; left != 0; left &= left - 1) {
    const auto place = static_cast<std::size_t>(std::countr_zero(left));
    guessed_.push_back(at.shape[place]);
    tried_.push_back(m[place]);
  }
  return guessed_.size() <= 10 && tells_apart(guess, guessed_, tried_);
}

bool PassiveMasses::tells_apart(NormalEquations& normal, const std::vector<int>& passive,
                                const std::vector<double>& masses) noexcept {
  scale_prices();
  const auto n = static_cast<Eigen::Index>(masses.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    coefficients_[i] = ((some_signs >> (i % 64)) & 1U) != 0 ? 1.0 : -1.0;
  }
  double all = 0.0;
  for (int turn = 0; turn < 2; ++turn) {
    all = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto place = static_cast<std::size_t>(i);
      const double terms = 1.0 / columns_->price(passive[place], 1.0);
      coefficients_[i] =
          std::copysign(std::numeric_limits<double>::epsilon() * terms, coefficients_[i]);
      all += masses[place];
    }
    normal.solve_normal(coefficients_);
  }
  return n == 0 || coefficients_.head(n).lpNorm<Eigen::Infinity>() <= told_apart * all;
}

bool PassiveMasses::is_at_a_vertex() noexcept {
  return static_cast<Eigen::Index>(passive_.size()) <= Phi_.size() &&
         columns_->steepest(slopes_, -certainly_held) < 0;
}

}  // namespace shapeid::fast

#include "shapeid/fast/even_density.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "shapeid/fast/column_products.hpp"
#include "shapeid/fast/triangle_products.hpp"

namespace shapeid::fast {
namespace {

/// Of a residual's length: what a slope R^T r that should be zero may come to, in sums of a few
/// dozen terms.
constexpr double few_roundings = 32.0 * std::numeric_limits<double>::epsilon();

/// Of a slope's rounding: a density's share lambda m / V that is so much larger is known to six
/// digits, as many as a step of refinement gains.
constexpr double certainly_felt = 1e6;

/// Rows of the damped least-squares problem that a link has: ten of R, ten of damping.
constexpr Eigen::Index rows_of_link = 20;

}  // namespace

EvenDensity::EvenDensity(const ShapeColumns& columns, const Eigen::VectorXd& V)
    : columns_(&columns),
      V_(&V),
      densities_(static_cast<std::size_t>(columns.links())),
      qr_(rows_of_link * columns.links(), Eigen::Index{10} * columns.links()),
      b_(Eigen::VectorXd::Zero(rows_of_link * columns.links())),
      y_(Eigen::VectorXd::Zero(Eigen::Index{10} * columns.links())),
      correction_(y_),
      target_(Eigen::VectorXd::Zero(columns.capacity())),
      slopes_(y_),
      weights_(y_),
      missing_(y_),
      along_(target_),
      noise_(y_),
      ends_(static_cast<std::size_t>(y_.size())) {
  passive_.reserve(static_cast<std::size_t>(columns.capacity()));
  unfelt_.reserve(static_cast<std::size_t>(y_.size()));
}

void EvenDensity::set_lambda(double lambda) noexcept {
  lambda_ = lambda;
  solved_ = false;
  factorised_ = 0;
}

void EvenDensity::start(const Eigen::MatrixXd& R) noexcept {
  R_ = &R;
  passive_.clear();
  sound_ = true;
  solved_ = false;
  factorised_ = 0;
  for (Density& density : densities_) density.rows.clear();
  for (int l = 0; l < columns_->links(); ++l) {
    b_.segment<10>(rows_of_link * l) = right_hand_side(R).segment<10>(Eigen::Index{10} * l);
  }
  const double rounding = few_roundings * right_hand_side(R).norm();
  for (Eigen::Index i = 0; i < noise_.size(); ++i) {
    noise_[i] = rounding * R.col(i).head(i + 1).norm();
  }
}

bool EvenDensity::enter(int j) noexcept {
  passive_.push_back(j);
  densities_[static_cast<std::size_t>(columns_->link(j))].rows.enter(row_of(j));
  solved_ = false;
  return true;
}

// No column depends on others once lambda > 0, so this is never asked.
void EvenDensity::dependence(Eigen::VectorXd& coefficients) noexcept { coefficients.setZero(); }

void EvenDensity::leave(int place) noexcept {
  const int j = passive_[static_cast<std::size_t>(place)];
  passive_.erase(passive_.begin() + place);
  densities_[static_cast<std::size_t>(columns_->link(j))].rows.leave(row_of(j));
  solved_ = false;
}

// Where V u = V1 u1 + V2 u2, X^T X grows by one row's square alone: V1 V2 / V of the difference's.
void EvenDensity::divide(int place, int other, bool adds_up) noexcept {
  const int j = passive_[static_cast<std::size_t>(place)];
  LinkDensity& rows = densities_[static_cast<std::size_t>(columns_->link(j))].rows;
  const double V1 = (*V_)[j], V2 = (*V_)[other];
  const double root = std::sqrt(V1) * std::sqrt(V2 / (V1 + V2));
  if (!adds_up) rows.outdate();
  rows.enter(root * (columns_->column(j) - columns_->column(other)));
  passive_.push_back(other);
  solved_ = false;
}

EvenDensity::Ten EvenDensity::row_of(int j) const noexcept {
  return std::sqrt((*V_)[j]) * columns_->column(j);
}

void EvenDensity::rebuild(int link) noexcept {
  LinkDensity& rows = densities_[static_cast<std::size_t>(link)].rows;
  rows.begin_anew();
  for (const int j : passive_) {
    if (columns_->link(j) == link) rows.again(row_of(j));
  }
}

EvenDensity::Ten EvenDensity::Density::share_of(const Eigen::VectorXd& y) const noexcept {
  Ten share = Ten::Zero();
  share.head(rows.rank()) = y.segment(first, rows.rank());
  return share;
}

EvenDensity::Ten EvenDensity::Density::weights(const Ten& y) const noexcept {
  return rows.weights(rows.rank(), y, Ten::Zero());
}

void EvenDensity::factorise() noexcept {
  int unchanged = factorised_;
  for (int l = 0; l < columns_->links(); ++l) {
    LinkDensity& rows = densities_[static_cast<std::size_t>(l)].rows;
    if (rows.outdated()) rebuild(l);
    if (rows.reveal()) unchanged = std::min(unchanged, l);
  }
  if (is_one_link()) {
    const LinkDensity& rows = densities_.front().rows;
    ten_.factorise(*R_, rows.E(), rows.rank(), lambda_);
  } else {
    factorise_from(unchanged);
  }
}

/// Columns of the links before `link`, which have not changed, stay: mostly one link has. (One that
/// changes could not be the last one for that: its columns are longer than those of links before.)
void EvenDensity::factorise_from(int link) noexcept {
  const double damping = std::sqrt(lambda_);
  Eigen::Index first = 0;
  if (link > 0) {
    const Density& before = densities_[static_cast<std::size_t>(link) - 1];
    first = before.first + before.rows.rank();
  }
  // A column that counts as dependent and those behind it stay out: a set that is not sound gives
  // no answer.
  if (first > 0) {
    qr_.keep(first, b_);
  } else {
    qr_.start(b_);
  }
  while (!unfelt_.empty() && unfelt_.back() >= first) unfelt_.pop_back();
  Eigen::Index count = 0;
  for (int l = link; l < columns_->links(); ++l) {
    Density& density = densities_[static_cast<std::size_t>(l)];
    density.first = first + count;
    const int rank = density.rows.rank();
    if (rank == 0) continue;
    link_columns(*R_, l, density.rows.E(), rank, rows_of_link, qr_.entering(count).data(),
                 qr_.stride());
    for (int k = 0; k < rank; ++k) {
      double* a = qr_.entering(count).data();
      const Eigen::Index damped = rows_of_link * l + 10 + k;
      for (int b = 0; b < l; ++b) std::fill_n(a + rows_of_link * b + 10, 10, 0.0);
      std::fill_n(a + rows_of_link * l + 10, k, 0.0);
      a[damped] = damping;
      if (qr_.entering(count).head(damped).isZero(0.0)) unfelt_.push_back(first + count);
      ends_[static_cast<std::size_t>(count++)] = damped + 1;
    }
  }
  const std::span ends(ends_.data(), static_cast<std::size_t>(count));
  const bool have_entered = qr_.push_all(ends) == count;
  sound_ = have_entered && sound_;
  factorised_ = have_entered ? columns_->links() : 0;
}

void EvenDensity::solve() noexcept {
  factorise();
  if (is_one_link()) {
    ten_.solve(y_);
  } else {
    qr_.solve(y_);
    // What no row feels is zero; rounding, over the root of lambda, would make masses of it.
    for (const Eigen::Index k : unfelt_) y_[k] = 0.0;
  }
  spread(y_);
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    target_[place] = (*V_)[passive_[i]] * along_[place];
  }
  solved_ = true;
}

/// The densities u_j . w of the passive shapes, where w has these unknowns.
void EvenDensity::spread(const Eigen::VectorXd& y) noexcept {
  for (int l = 0; l < columns_->links(); ++l) {
    const Density& density = densities_[static_cast<std::size_t>(l)];
    weights_.segment<10>(Eigen::Index{10} * l) = density.weights(density.share_of(y));
  }
  column_products(*columns_, passive_, weights_, along_);
}

void EvenDensity::solve_normal(Eigen::VectorXd& x) const noexcept {
  if (is_one_link()) {
    ten_.solve_normal(x);
  } else {
    qr_.solve_normal(x);
  }
}

const Eigen::VectorXd& EvenDensity::target() noexcept {
  if (!solved_) solve();
  return target_;
}

// The residual of the damped problem: slopes are those of the masses, to the last digits, and y is
// kept as the sum of its corrections. (From Phi it would be lost where columns of X nearly depend
// on each other.) Its correction solves the normal equations by the triangle that is there. Masses
// are corrected, not made anew from w: there w is large, and u_j . w loses digits. What they lost
// before, each shape's slope tells.
void EvenDensity::refine(const Eigen::VectorXd& slopes) noexcept {
  correction_.setZero();
  for (int l = 0; l < columns_->links(); ++l) {
    const Density& density = densities_[static_cast<std::size_t>(l)];
    const int rank = density.rows.rank();
    Ten missing = density.rows.share_of(slopes.segment<10>(Eigen::Index{10} * l));
    missing.head(rank) -= lambda_ * y_.segment(density.first, rank);
    correction_.segment(density.first, rank) = missing.head(rank);
    missing_.segment<10>(Eigen::Index{10} * l) = density.weights(missing);
  }
  solve_normal(correction_);
  y_ += correction_;
  spread(correction_);
  const double rounding = certainly_felt * few_roundings * right_hand_side(*R_).norm();
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    const int j = passive_[i];
    const double V = (*V_)[j];
    double& mass = target_[static_cast<Eigen::Index>(i)];
    if (lambda_ * mass > rounding * columns_->bound(j) * V) mass += V / lambda_ * lost(i, slopes);
    mass += V * along_[static_cast<Eigen::Index>(i)];
  }
}

/// What is left of the slope of a shape that feels lambda, beyond what y's residual explains and
/// rounding.
double EvenDensity::lost(std::size_t place, const Eigen::VectorXd& slopes) const noexcept {
  const int j = passive_[place];
  const Eigen::Index link = Eigen::Index{10} * columns_->link(j);
  const auto u = columns_->column(j);
  const auto missing = missing_.segment<10>(link);
  const double stiffness = lambda_ / (*V_)[j];
  const double slope =
      u.dot(slopes.segment<10>(link)) - stiffness * target_[static_cast<Eigen::Index>(place)];
  const double left = slope - u.dot(missing);
  const double rounding = u.cwiseAbs().dot(noise_.segment<10>(link)) +
                          few_roundings * u.cwiseAbs().dot(missing.cwiseAbs());
  return std::abs(left) > rounding ? left : 0.0;
}

// Of the slopes R^T r of a link those in the span of its passive columns are lambda w there, which
// is known to more digits than the difference r. The others come from r.
const Eigen::VectorXd& EvenDensity::slopes(const Eigen::VectorXd& of_residual) noexcept {
  for (int l = 0; l < columns_->links(); ++l) {
    const Density& density = densities_[static_cast<std::size_t>(l)];
    Ten g = of_residual.segment<10>(Eigen::Index{10} * l);
    for (int i = 0; i < 10; ++i) {
      if (std::abs(g[i]) <= noise_[Eigen::Index{10} * l + i]) g[i] = 0.0;
    }
    slopes_.segment<10>(Eigen::Index{10} * l) =
        density.rows.weights(density.rows.certain(), lambda_ * density.share_of(y_), g);
  }
  return slopes_;
}

}  // namespace shapeid::fast

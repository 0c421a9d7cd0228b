#include "shapeid/fast/even_density.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "shapeid/fast/triangle_products.hpp"

namespace shapeid::fast {
namespace {

/// Columns of X, divided by their sizes, whose part that is new is smaller than this share of the
/// first pivot count as dependent: a hundred roundings of ten-term sums.
constexpr double smallest_pivot = 1e-13;

/// Slopes along a direction in which the passive shapes spread by less than this share are taken
/// from the residual. Its rounding, 1e-16 of the terms, reaches these shapes as 1e-18, still
/// nothing to the slopes that lambda makes (1e-12); to make it exact there would cost all other
/// shapes the inverse of this in digits.
constexpr double well_spread = 1e-2;

/// A square that is left of one by subtraction and smaller than this has lost six digits.
constexpr double cancelled = 1e-6;

/// A row whose leverage is closer to one than this is not taken out of a triangle but left out of a
/// new one: taking it out would multiply rounding errors by the inverse of the distance's root.
constexpr double smallest_distance = 1e-2;

/// Of a residual's length: what a slope R^T r that should be zero may come to, in sums of a few
/// dozen terms.
constexpr double few_roundings = 32.0 * std::numeric_limits<double>::epsilon();

/// Of a slope's rounding: a density's share lambda m / V that is so much larger is known to six
/// digits, as many as a step of refinement gains.
constexpr double certainly_felt = 1e6;

/// Rows of the damped least-squares problem that a link has: ten of R, ten of damping.
constexpr Eigen::Index rows_of_link = 20;

/// What the ten columns measure, from their lengths: masses, first moments (mass and tensor bound
/// them), tensor. One where there is nothing.
Eigen::Matrix<double, 10, 1> sizes_of(const Eigen::Matrix<double, 10, 1>& lengths) noexcept {
  const double mass = lengths[0];
  const double tensor = lengths.tail<6>().maxCoeff();
  Eigen::Matrix<double, 10, 1> sizes;
  sizes << mass, Eigen::Vector3d::Constant(std::sqrt(mass * tensor)),
      Eigen::Matrix<double, 6, 1>::Constant(tensor);
  return (sizes.array() > 0.0).select(sizes, 1.0);
}

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
      noise_(y_) {
  passive_.reserve(static_cast<std::size_t>(columns.capacity()));
  unfelt_.reserve(static_cast<std::size_t>(y_.size()));
}

void EvenDensity::set_lambda(double lambda) noexcept {
  lambda_ = lambda;
  solved_ = false;
}

void EvenDensity::start(const Eigen::MatrixXd& R) noexcept {
  R_ = &R;
  passive_.clear();
  sound_ = true;
  solved_ = false;
  for (Density& density : densities_) {
    density.X.setZero();
    density.shapes = 0;
    density.outdated = false;
    density.revealed = false;
  }
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
  Density& density = densities_[static_cast<std::size_t>(columns_->link(j))];
  ++density.shapes;
  density.revealed = false;
  solved_ = false;
  if (!density.outdated) add_row(density, row_of(j));
  return true;
}

// No column depends on others once lambda > 0, so this is never asked.
void EvenDensity::dependence(Eigen::VectorXd& coefficients) noexcept { coefficients.setZero(); }

void EvenDensity::leave(int place) noexcept {
  const int j = passive_[static_cast<std::size_t>(place)];
  passive_.erase(passive_.begin() + place);
  Density& density = densities_[static_cast<std::size_t>(columns_->link(j))];
  --density.shapes;
  density.revealed = false;
  solved_ = false;
  if (!density.outdated && !remove_row(density, row_of(j))) density.outdated = true;
}

EvenDensity::Ten EvenDensity::row_of(int j) const noexcept {
  return std::sqrt((*V_)[j]) * columns_->column(j);
}

// Rotations with the rows of the triangle, one after the other, make the new row zero.
void EvenDensity::add_row(Density& density, Ten row) noexcept {
  Square& X = density.X;
  for (int i = 0; i < 10; ++i) {
    if (row[i] == 0.0) continue;
    const double length = std::sqrt(X(i, i) * X(i, i) + row[i] * row[i]);
    const double c = X(i, i) / length, s = row[i] / length;
    for (int k = i; k < 10; ++k) {
      const double upper = X(i, k), lower = row[k];
      X(i, k) = c * upper + s * lower;
      row[k] = c * lower - s * upper;
    }
  }
}

// With X^T a = row, X^T X - row row^T = X^T (1 - a a^T) X: rotations that gather (a, d), with
// d^2 = 1 - || a ||^2 the distance, in its last entry turn X below a row of zeros into what is
// left above the row that goes (Saunders; LINPACK's dchdd).
bool EvenDensity::remove_row(Density& density, const Ten& row) noexcept {
  Square& X = density.X;
  Ten a = row;
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < i; ++k) a[i] -= X(k, i) * a[k];
    if (X(i, i) == 0.0) return false;
    a[i] /= X(i, i);
  }
  const double distance = 1.0 - a.squaredNorm();
  if (!(distance > smallest_distance)) return false;
  double d = std::sqrt(distance);
  Ten gone = Ten::Zero();
  for (int i = 9; i >= 0; --i) {
    const double length = std::sqrt(d * d + a[i] * a[i]);
    const double c = d / length, s = a[i] / length;
    d = length;
    for (int k = i; k < 10; ++k) {
      const double x = X(i, k), g = gone[k];
      gone[k] = c * g + s * x;
      X(i, k) = c * x - s * g;
    }
  }
  return true;
}

void EvenDensity::rebuild(int link) noexcept {
  Density& density = densities_[static_cast<std::size_t>(link)];
  density.X.setZero();
  for (const int j : passive_) {
    if (columns_->link(j) == link) add_row(density, row_of(j));
  }
  density.outdated = false;
}

// Householder's QR with column pivots of the triangle. Its columns are first divided by what bodies
// of this mass and size have in them, so that the rank does not depend on units: and not by their
// own lengths, which would make a direction out of rounding where shapes lie symmetrically.
void EvenDensity::reveal_rank(Density& density) noexcept {
  Square& T = density.T;
  T = density.X;
  density.lengths = sizes_of(T.colwise().norm());
  for (int i = 0; i < 10; ++i) {
    T.col(i) /= density.lengths[i];
    density.pivots[static_cast<std::size_t>(i)] = i;
  }
  // Squares of what is left of the columns: less by what each row takes, and computed anew where so
  // much is gone that the difference is no good.
  const Ten whole = T.colwise().squaredNorm();
  Ten squares = whole;
  double smallest = 0.0;
  density.rank = 0;
  density.certain = 0;
  for (int k = 0; k < std::min(10, density.shapes); ++k) {
    int pivot = k;
    for (int i = k; i < 10; ++i) {
      const int place = density.pivots[static_cast<std::size_t>(i)];
      if (squares[i] < cancelled * whole[place]) squares[i] = T.col(i).tail(10 - k).squaredNorm();
      if (squares[i] > squares[pivot]) pivot = i;
    }
    T.col(k).swap(T.col(pivot));
    std::swap(squares[k], squares[pivot]);
    std::swap(density.pivots[static_cast<std::size_t>(k)],
              density.pivots[static_cast<std::size_t>(pivot)]);
    Ten v = T.col(k);
    for (int i = 0; i < k; ++i) v[i] = 0.0;
    const double length = v.norm();
    if (k == 0) smallest = smallest_pivot * length;
    if (!(length > smallest)) break;
    T.col(k) -= v;
    const double image = v[k] > 0.0 ? -length : length;
    v[k] -= image;
    const double scale = 1.0 / (length * std::abs(v[k]));
    for (int i = k + 1; i < 10; ++i) {
      const double share = scale * v.dot(T.col(i));
      T.col(i) -= share * v;
      squares[i] -= T(k, i) * T(k, i);
    }
    T(k, k) = image;
    density.rank = k + 1;
    if (length > well_spread * std::abs(T(0, 0))) density.certain = k + 1;
  }
  density.revealed = true;
}

// The w that satisfies the first `rank` rows of T P^T D w = y, with the other entries of `rest`.
EvenDensity::Ten EvenDensity::weights(const Density& density, int rank, const Ten& y,
                                      const Ten& rest) noexcept {
  Ten v;
  for (int i = 9; i >= 0; --i) {
    const int place = density.pivots[static_cast<std::size_t>(i)];
    if (i >= rank) {
      v[i] = density.lengths[place] * rest[place];
      continue;
    }
    double sum = y[i];
    for (int k = i + 1; k < 10; ++k) sum -= density.T(i, k) * v[k];
    v[i] = sum / density.T(i, i);
  }
  Ten w;
  for (int i = 0; i < 10; ++i) {
    const int place = density.pivots[static_cast<std::size_t>(i)];
    w[place] = v[i] / density.lengths[place];
  }
  return w;
}

void EvenDensity::solve() noexcept {
  const double damping = std::sqrt(lambda_);
  qr_.start(b_);
  unfelt_.clear();
  for (int l = 0; l < columns_->links(); ++l) {
    Density& density = densities_[static_cast<std::size_t>(l)];
    if (density.outdated) rebuild(l);
    if (!density.revealed) reveal_rank(density);
    density.first = qr_.size();
    for (int k = 0; k < density.rank; ++k) {
      Ten e = Ten::Zero();
      for (int i = k; i < 10; ++i) {
        const int place = density.pivots[static_cast<std::size_t>(i)];
        e[place] = density.lengths[place] * density.T(k, i);
      }
      double* a = qr_.entering().data();
      const Eigen::Index damped = rows_of_link * l + 10 + k;
      std::fill(a, a + damped, 0.0);
      for (int b = 0; b <= l; ++b) {
        Eigen::Map<Ten>(a + rows_of_link * b).noalias() =
            R_->block<10, 10>(Eigen::Index{10} * b, Eigen::Index{10} * l).lazyProduct(e);
      }
      a[damped] = damping;
      if (qr_.entering().head(damped).isZero(0.0)) unfelt_.push_back(density.first + k);
      sound_ = qr_.push(damped + 1) == ColumnQr::Push::entered && sound_;
    }
  }
  qr_.solve(y_);
  // What no row feels is zero; rounding, over the root of lambda, would make masses of it.
  for (const Eigen::Index k : unfelt_) y_[k] = 0.0;
  for (Density& density : densities_) {
    Ten y = Ten::Zero();
    y.head(density.rank) = y_.segment(density.first, density.rank);
    density.w = weights(density, density.rank, y, Ten::Zero());
  }
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    const int j = passive_[i];
    const Ten& w = densities_[static_cast<std::size_t>(columns_->link(j))].w;
    target_[static_cast<Eigen::Index>(i)] = (*V_)[j] * columns_->column(j).dot(w);
  }
  solved_ = true;
}

const Eigen::VectorXd& EvenDensity::target() noexcept {
  if (!solved_) solve();
  return target_;
}

// T P^T D g: what the unknowns y of a link feel of ten slopes.
EvenDensity::Ten EvenDensity::share_of(const Density& density, const Ten& slopes) noexcept {
  Ten share = Ten::Zero();
  for (int i = 0; i < 10; ++i) {
    const int place = density.pivots[static_cast<std::size_t>(i)];
    share += (density.lengths[place] * slopes[place]) * density.T.col(i);
  }
  share.tail(10 - density.rank).setZero();
  return share;
}

// The residual of the damped problem: slopes are those of the masses, to the last digits, and y is
// kept as the sum of its corrections. (From Phi it would be lost where columns of X nearly depend
// on each other.) Its correction solves the normal equations by the triangle that is there. Masses
// are corrected, not made anew from w: there w is large, and u_j . w loses digits. What they lost
// before, each shape's slope tells: it is left of it beyond what y's residual explains.
void EvenDensity::refine(const Eigen::VectorXd& slopes) noexcept {
  for (int l = 0; l < columns_->links(); ++l) {
    Density& density = densities_[static_cast<std::size_t>(l)];
    Ten missing = share_of(density, slopes.segment<10>(Eigen::Index{10} * l));
    missing.head(density.rank) -= lambda_ * y_.segment(density.first, density.rank);
    correction_.segment(density.first, density.rank) = missing.head(density.rank);
    density.missing = weights(density, density.rank, missing, Ten::Zero());
  }
  qr_.solve_normal(correction_);
  y_.head(qr_.size()) += correction_.head(qr_.size());
  for (int l = 0; l < columns_->links(); ++l) {
    Density& density = densities_[static_cast<std::size_t>(l)];
    Ten y = Ten::Zero();
    y.head(density.rank) = correction_.segment(density.first, density.rank);
    density.change = weights(density, density.rank, y, Ten::Zero());
  }
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    const int j = passive_[i];
    const int link = columns_->link(j);
    const Density& density = densities_[static_cast<std::size_t>(link)];
    const auto u = columns_->column(j);
    const double V = (*V_)[j];
    double& mass = target_[static_cast<Eigen::Index>(i)];
    const double rounding = u.cwiseAbs().dot(noise_.segment<10>(Eigen::Index{10} * link));
    if (lambda_ * mass > certainly_felt * rounding * V) {
      const double slope = u.dot(slopes.segment<10>(Eigen::Index{10} * link)) - lambda_ * mass / V;
      const double lost = slope - u.dot(density.missing);
      const double more_rounding = few_roundings * u.cwiseAbs().dot(density.missing.cwiseAbs());
      if (std::abs(lost) > rounding + more_rounding) mass += V / lambda_ * lost;
    }
    mass += V * u.dot(density.change);
  }
}

// Of the slopes R^T r of a link those in the span of its passive columns are lambda w there, which
// is known to more digits than the difference r. The others come from r.
const Eigen::VectorXd& EvenDensity::slopes(const Eigen::VectorXd& of_residual) noexcept {
  for (int l = 0; l < columns_->links(); ++l) {
    const Density& density = densities_[static_cast<std::size_t>(l)];
    Ten y = Ten::Zero();
    y.head(density.rank) = lambda_ * y_.segment(density.first, density.rank);
    Ten g = of_residual.segment<10>(Eigen::Index{10} * l);
    for (int i = 0; i < 10; ++i) {
      if (std::abs(g[i]) <= noise_[Eigen::Index{10} * l + i]) g[i] = 0.0;
    }
    slopes_.segment<10>(Eigen::Index{10} * l) = weights(density, density.certain, y, g);
  }
  return slopes_;
}

}  // namespace shapeid::fast

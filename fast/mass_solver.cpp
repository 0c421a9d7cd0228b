// Derivation and the reasons for the tolerances: docs/derivations/fast-masses.md.
#include "shapeid/fast/mass_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "shapeid/fast/many_links.hpp"
#include "shapeid/fast/one_link.hpp"
#include "shapeid/fast/triangle_products.hpp"

namespace shapeid::fast {
namespace {

/// Slopes below this share of their terms are rounding: a hundred roundings.
constexpr double smallest_slope = 1e-14;

/// The same among slopes of the size of lambda, whose terms nearly cancel by nature.
constexpr double smallest_damped_slope = 1e-12;

/// Slopes of passive shapes that are larger than this share of their terms are worth a step of
/// refinement: a few roundings more than a well-conditioned factorisation leaves.
constexpr double refined_slope = 3e-15;

/// Each step gains the digits that the condition leaves, six or more; the last ones are noise.
constexpr int most_refinements = 3;

/// What an answer must satisfy to be given out: every gradient entry that should be zero or
/// positive is so to this share of its terms. The objective is then within as much of its minimum,
/// in units of || c ||^2.
constexpr double allowed_slope = 1e-10;

std::unique_ptr<PassiveSet> undamped_set(const ShapeColumns& columns) {
  if (columns.links() == 1) return std::make_unique<OneLink>(columns);
  return std::make_unique<ManyLinks>(columns);
}

}  // namespace

MassSolver::MassSolver(int links, int most_shapes)
    : columns_(links, most_shapes),
      m_(Eigen::VectorXd::Zero(most_shapes)),
      V_(Eigen::VectorXd::Ones(most_shapes)),
      undamped_(undamped_set(columns_)),
      damped_(columns_, V_),
      set_(undamped_.get()),
      lengths_(Eigen::VectorXd::Zero(Eigen::Index{10} * links)),
      coefficients_(Eigen::VectorXd::Zero(std::max<Eigen::Index>(lengths_.size(), most_shapes))),
      Phi_(lengths_),
      r_(lengths_),
      slopes_(lengths_),
      sizes_(lengths_),
      other_lengths_(lengths_),
      saved_Phi_(lengths_),
      saved_slopes_(lengths_) {
  const auto room = static_cast<std::size_t>(most_shapes);
  passive_.reserve(room);
  masses_.reserve(room);
  tried_.reserve(room);
  refused_.reserve(room);
  saved_.reserve(room);
  entering_.reserve(room);
}

void MassSolver::clear() noexcept {
  columns_.clear();
  passive_.clear();
  masses_.clear();
  started_ = false;
}

bool MassSolver::append(int link, const Column& u, double V) noexcept {
  const int j = columns_.size();
  if (!columns_.append(link, u)) return false;
  m_[j] = 0.0;
  V_[j] = V;
  return true;
}

void MassSolver::set_lambda(double lambda) noexcept {
  lambda_ = lambda;
  damped_.set_lambda(lambda);
  set_ = lambda > 0.0 ? &damped_ : undamped_.get();
  started_ = false;
}

void MassSolver::forget_masses() noexcept {
  for (const int j : passive_) m_[j] = 0.0;
  passive_.clear();
  masses_.clear();
  started_ = false;
}

void MassSolver::start_at(int j, double mass) noexcept {
  const auto place = std::find(passive_.begin(), passive_.end(), j);
  if (place == passive_.end()) {
    passive_.push_back(j);
    masses_.push_back(mass);
  } else {
    masses_[static_cast<std::size_t>(place - passive_.begin())] = mass;
  }
  m_[j] = mass;
  started_ = false;
}

Outcome MassSolver::solve(const Eigen::MatrixXd& R) noexcept {
  column_sizes(R, other_lengths_);
  const double length = R.col(lengths_.size()).norm();
  if (!std::isfinite(other_lengths_.sum() + length)) return Outcome::not_finite;
  const Eigen::MatrixXd* R_before = R_;
  const double length_before = length_;
  const auto take = [&](const Eigen::MatrixXd* triangle, double of_its_right_hand_side) {
    R_ = triangle;
    length_ = of_its_right_hand_side;
    lengths_.swap(other_lengths_);
    columns_.set_scale(lengths_, length_);
  };
  take(&R, length);
  started_ = false;
  const Outcome outcome = solve_again();
  if (outcome != Outcome::solved) take(R_before, length_before);
  return outcome;
}

Outcome MassSolver::solve_again() noexcept {
  save();
  iterations_ = 0;
  if (!started_) start();
  Outcome outcome = iterate();
  if (outcome == Outcome::solved && !passes_check()) {
    // Rounding of many updates, perhaps: once more from a fresh factorisation.
    start();
    outcome = iterate();
    if (outcome == Outcome::solved && !passes_check()) outcome = Outcome::ill_conditioned;
  }
  if (outcome != Outcome::solved) restore();
  return outcome;
}

void MassSolver::save() noexcept {
  saved_.clear();
  for (const int j : passive_) saved_.push_back({j, m_[j]});
  saved_Phi_.swap(Phi_);
  saved_slopes_.swap(slopes_);
  saved_value_ = value_;
}

void MassSolver::restore() noexcept {
  passive_.clear();
  masses_.clear();
  m_.head(shapes()).setZero();
  for (const ShapeMass& saved : saved_) {
    passive_.push_back(saved.place);
    masses_.push_back(saved.mass);
    m_[saved.place] = saved.mass;
  }
  saved_Phi_.swap(Phi_);
  saved_slopes_.swap(slopes_);
  value_ = saved_value_;
  started_ = false;
}

/// A fresh factorisation of the passive shapes.
void MassSolver::start() noexcept {
  set_->start(*R_);
  columns_.unbar_all();
  started_ = true;
  entering_.clear();
  for (std::size_t i = 0; i < passive_.size(); ++i) entering_.push_back({passive_[i], masses_[i]});
  passive_.clear();
  masses_.clear();
  // Link by link: columns of the first links are short, and stay so if no long one came before.
  if (links() > 1) {
    std::sort(entering_.begin(), entering_.end(), [this](const ShapeMass& a, const ShapeMass& b) {
      return std::pair(columns_.link(a.place), a.place) <
             std::pair(columns_.link(b.place), b.place);
    });
  }
  for (const ShapeMass& shape : entering_) enter_with_mass(shape.place, shape.mass);
}

void MassSolver::add(int j, double mass) noexcept {
  passive_.push_back(j);
  masses_.push_back(mass);
  columns_.bar(j, true);
}

// A column that depends on the passive ones: its mass moves over to them, with R U m as it is,
// until it has none left, or one of them has none; then that one leaves.
void MassSolver::enter_with_mass(int j, double mass) noexcept {
  while (!set_->enter(j)) {
    set_->dependence(coefficients_);
    double moved = mass;
    int leaving = -1;
    for (std::size_t i = 0; i < passive_.size(); ++i) {
      const double share = coefficients_[static_cast<Eigen::Index>(i)];
      if (share < 0.0 && masses_[i] < -moved * share) {
        moved = -masses_[i] / share;
        leaving = static_cast<int>(i);
      }
    }
    for (std::size_t i = 0; i < passive_.size(); ++i) {
      masses_[i] += moved * coefficients_[static_cast<Eigen::Index>(i)];
    }
    m_[j] = 0.0;
    if (leaving < 0) return;
    mass -= moved;
    leave(leaving);
  }
  add(j, mass);
}

void MassSolver::leave(int place) noexcept {
  const int j = passive_[static_cast<std::size_t>(place)];
  columns_.bar(j, false);
  m_[j] = 0.0;
  passive_.erase(passive_.begin() + place);
  masses_.erase(masses_.begin() + place);
  set_->leave(place);
}

// Goes toward the target until the first mass becomes zero, and holds it there. False if nothing is
// in the way: then the masses are the target.
bool MassSolver::step_is_blocked() noexcept {
  const Eigen::VectorXd& target = set_->target();
  double length = 1.0;
  int blocking = -1;
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    const double to = target[static_cast<Eigen::Index>(i)];
    if (to > 0.0) continue;
    const double reach = masses_[i] > 0.0 ? masses_[i] / (masses_[i] - to) : 0.0;
    if (blocking < 0 || reach < length) {
      length = reach;
      blocking = static_cast<int>(i);
    }
  }
  if (blocking < 0) {
    std::copy_n(target.data(), masses_.size(), masses_.data());
    return false;
  }
  if (lambda_ > 0.0 && may_cut_off(target)) return true;
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    masses_[i] += length * (target[static_cast<Eigen::Index>(i)] - masses_[i]);
  }
  masses_[static_cast<std::size_t>(blocking)] = 0.0;
  leave_without_mass();
  return true;
}

void MassSolver::leave_without_mass() noexcept {
  for (int i = static_cast<int>(masses_.size()) - 1; i >= 0; --i) {
    if (!(masses_[static_cast<std::size_t>(i)] > 0.0)) leave(i);
  }
}

// With hundreds of passive shapes a step at a time is long: all shapes whose target is negative
// leave at once, if the objective falls all the same.
bool MassSolver::may_cut_off(const Eigen::VectorXd& target) noexcept {
  evaluate();
  const double before = value_.total();
  tried_ = masses_;
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    masses_[i] = std::max(target[static_cast<Eigen::Index>(i)], 0.0);
  }
  evaluate();
  if (value_.total() < before) {
    leave_without_mass();
    return true;
  }
  masses_ = tried_;
  return false;
}

const std::vector<int>& MassSolver::entering_shapes() noexcept {
  if (!set_->keeps_slopes()) evaluate();
  const Eigen::VectorXd& slopes = set_->slopes(slopes_);
  if (columns_.steepest(slopes, smallest_slope) < 0 && lambda_ > 0.0) {
    // Slopes of the size of lambda decide how mass spreads among shapes that the data do not tell
    // apart: judged against each other.
    sizes_ = slopes.cwiseAbs();
    columns_.set_scale(sizes_, 1.0);
    static_cast<void>(columns_.steepest(slopes, smallest_damped_slope));
    columns_.set_scale(lengths_, length_);
  }
  // A damped system has as many unknowns however many shapes enter.
  using Among = ShapeColumns::Among;
  return columns_.steep_ones(lambda_ > 0.0 ? Among::groups : Among::links);
}

void MassSolver::refuse(int j) noexcept {
  columns_.bar(j, true);
  refused_.push_back(j);
}

void MassSolver::admit_refused() noexcept {
  for (const int j : refused_) columns_.bar(j, false);
  refused_.clear();
}

// The steepest shape enters, and steep ones of other links with it, if they take positive masses.
// In exact arithmetic at least one does: the way to the target goes down, and only the slopes of
// those that enter are not zero. False if none enters: then the masses are the minimiser.
bool MassSolver::some_enter() noexcept {
  const std::size_t before = passive_.size();
  while (passive_.size() == before) {
    const std::vector<int>& shapes = entering_shapes();
    if (shapes.empty()) break;
    for (const int j : shapes) {
      if (set_->enter(j)) {
        add(j, 0.0);
      } else {
        refuse(j);
      }
    }
    refuse_without_mass(before);
    if (passive_.size() == before) ++iterations_;
  }
  if (passive_.size() == before) return false;
  admit_refused();
  return true;
}

/// Of the shapes that entered at place `first` and behind it.
void MassSolver::refuse_without_mass(std::size_t first) noexcept {
  while (passive_.size() > first && some_are_refused(first)) {
  }
}

/// Those at place `first` and behind it whose target is not positive.
bool MassSolver::some_are_refused(std::size_t first) noexcept {
  const std::size_t before = passive_.size();
  const Eigen::VectorXd& target = set_->target();
  for (std::size_t i = before; i-- > first;) {
    if (target[static_cast<Eigen::Index>(i)] > 0.0) continue;
    const int j = passive_[i];
    leave(static_cast<int>(i));
    refuse(j);
  }
  return passive_.size() < before;
}

// Masses to the last digits that the factorisation allows. False if a shape had its mass from
// rounding alone: then it is refused, for it would enter and leave for ever.
bool MassSolver::refine() noexcept {
  // Shapes that were refused have been in the set and out again: the target is made anew.
  if (step_is_blocked()) return false;
  evaluate();
  for (int k = 0; k < most_refinements && largest_slope() > refined_slope; ++k) {
    ++iterations_;
    set_->refine(slopes_);
    if (some_are_refused(0)) return false;
    static_cast<void>(step_is_blocked());
    evaluate();
  }
  return true;
}

Outcome MassSolver::iterate() noexcept {
  // Every step ends at a lower objective with another set of passive shapes, so none comes twice.
  // In practice two or three steps a passive shape are taken; the bound is for rounding and for
  // clocks.
  const int most_steps = 100 + 4 * (static_cast<int>(lengths_.size()) + shapes());
  const int last = iterations_ + most_steps;
  while (true) {
    ++iterations_;
    if (step_is_blocked()) continue;  // takes a shape out, so comes to an end
    const bool in_time = iterations_ <= last;
    if (in_time && some_enter()) continue;
    if (set_->keeps_slopes() || !in_time) evaluate();
    if (!(largest_slope() > refined_slope)) break;
    if (refine() && (!in_time || set_->keeps_slopes() || !some_enter())) break;
  }
  admit_refused();
  if (!set_->sound()) return Outcome::ill_conditioned;
  // Rounding may let a shape in and out for ever. It is no matter if the answer is right all the
  // same.
  if (iterations_ > last && columns_.steepest(slopes_, allowed_slope) >= 0) {
    return Outcome::too_many_steps;
  }
  for (std::size_t i = 0; i < passive_.size(); ++i) m_[passive_[i]] = masses_[i];
  return std::isfinite(value_.total()) ? Outcome::solved : Outcome::not_finite;
}

// From the masses alone, so that no error of the factorisation's updates is in it.
void MassSolver::evaluate() noexcept {
  Phi_.setZero();
  value_.density = 0.0;
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    const int j = passive_[i];
    Phi_.segment<10>(Eigen::Index{10} * columns_.link(j)) += masses_[i] * columns_.column(j);
    value_.density += lambda_ * masses_[i] * masses_[i] / V_[j];
  }
  r_ = right_hand_side(*R_);
  for (int l = 0; l < links(); ++l) {
    const Column minus = -Phi_.segment<10>(Eigen::Index{10} * l);
    add_column(*R_, l, minus, r_.data());
  }
  const double unreached = (*R_)(Phi_.size(), Phi_.size());
  value_.data = r_.squaredNorm() + unreached * unreached;
  slopes_of(*R_, r_, slopes_);
}

/// Of the passive shapes, whose slopes should be zero; over their terms.
double MassSolver::largest_slope() const noexcept {
  double largest = 0.0;
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    const int j = passive_[i];
    const double slope =
        columns_.column(j).dot(slopes_.segment<10>(Eigen::Index{10} * columns_.link(j))) -
        lambda_ * masses_[i] / V_[j];
    largest = std::max(largest, columns_.price(j, std::abs(slope)));
  }
  return largest;
}

bool MassSolver::passes_check() noexcept {
  if (!(largest_slope() <= allowed_slope)) return false;
  // No other shape enters at the slopes of the factorisation. Mostly these are the slopes of the
  // masses to the last digits; where a row is hardly felt they need not be, and shapes are asked.
  const Eigen::VectorXd& slopes = set_->slopes(slopes_);
  const auto allowed = allowed_slope * length_ * lengths_.array();
  if (((slopes_ - slopes).array().abs() <= allowed).all()) return true;
  return columns_.steepest(slopes_, allowed_slope) < 0;
}

bool MassSolver::divide(int j, const Column& first, double V1, const Column& second,
                        double V2) noexcept {
  const int other = shapes();
  if (!append(columns_.link(j), second, V2)) return false;
  const double mass = m_[j];
  if (R_ == nullptr) {  // before the first solve() masses are but a place to start at
    columns_.replace(j, first);
    V_[j] = V1;
    if (mass > 0.0) start_at(j, mass * V1 / (V1 + V2));
    if (mass > 0.0) start_at(other, mass * V2 / (V1 + V2));
    return true;
  }
  if (mass > 0.0) {
    if (!started_) start();
    leave(static_cast<int>(std::find(passive_.begin(), passive_.end(), j) - passive_.begin()));
  }
  columns_.replace(j, first);
  V_[j] = V1;
  if (!(mass > 0.0)) return true;
  enter_with_mass(j, mass * V1 / (V1 + V2));
  enter_with_mass(other, mass * V2 / (V1 + V2));
  for (std::size_t i = 0; i < passive_.size(); ++i) m_[passive_[i]] = masses_[i];
  SHAPEID_CONTRACT(why_changed());
  return true;
}

// As far as the rows feel Phi: mass may move among shapes whose columns R u depend on each other.
// Judged by the length of R (U m - Phi), not row by row: what moves lies where R is hardly more
// than rounding. No vector is made, so that a call asks for no memory where contracts are checked
// either.
Violation MassSolver::why_changed() const {
  double density = 0.0, felt = 0.0, square = 0.0;
  for (const int j : passive_) {
    density += lambda_ * m_[j] * m_[j] / V_[j];
    felt += m_[j] * columns_.column(j).cwiseAbs().dot(
                        lengths_.segment<10>(Eigen::Index{10} * columns_.link(j)));
  }
  for (int b = 0; b < links(); ++b) {
    Column moved = Column::Zero();
    const auto add = [&](int link, double factor, const Column& x) {
      if (link < b) return;
      moved +=
          factor * R_->block<10, 10>(Eigen::Index{10} * b, Eigen::Index{10} * link).lazyProduct(x);
    };
    for (const int j : passive_) add(columns_.link(j), m_[j], columns_.column(j));
    for (int l = b; l < links(); ++l) add(l, -1.0, Phi_.segment<10>(Eigen::Index{10} * l));
    square += moved.squaredNorm();
  }
  // A few hundred roundings, as in any chain of a dozen stable steps; a wrong share of a mass is
  // off by 1e10 of them.
  const double allowed = 300.0 * std::numeric_limits<double>::epsilon() * (10.0 + shapes());
  if (!(std::sqrt(square) <= allowed * felt)) {
    return "the division changes R Phi by " + std::to_string(std::sqrt(square));
  }
  // At lambda = 0 masses may move among dependent shapes, and no density term holds them.
  if (!(std::abs(density - value_.density) <= allowed * density)) {
    return "the division changes the density term from " + std::to_string(value_.density) + " to " +
           std::to_string(density);
  }
  return std::nullopt;
}

double MassSolver::gap(double mass_bound) const noexcept {
  double lowest = 0.0, product = 0.0;
  for (int j = 0; j < shapes(); ++j) {
    const double z =
        2.0 * (lambda_ * m_[j] / V_[j] -
               columns_.column(j).dot(slopes_.segment<10>(Eigen::Index{10} * columns_.link(j))));
    product += z * m_[j];
    lowest = std::min(lowest, z);
  }
  return product - mass_bound * lowest;
}

}  // namespace shapeid::fast

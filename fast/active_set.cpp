// Derivation and the reasons for the tolerances: docs/derivations/fast-masses.md.
#include "shapeid/fast/active_set.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace shapeid::fast {
namespace {

/// Slopes of the size of lambda, whose terms nearly cancel by nature, are rounding below this share
/// of them.
constexpr double smallest_damped_slope = 1e-12;

/// Where more than this share of the passive shapes is to leave, the others are not worth keeping:
/// measured on windows of whole bodies that follow each other, a fifth does alike, and so does a
/// twentieth; two fifths are slower.
constexpr double of_little_use = 0.1;

/// What an answer must satisfy to be given out: every gradient entry that should be zero or
/// positive is so to this share of its terms. The objective is then within as much of its minimum,
/// in units of || b ||^2.
constexpr double allowed_slope = 1e-10;

}  // namespace

ActiveSet::ActiveSet(ShapeColumns& columns, const Eigen::VectorXd& V)
    : now_(columns, V), columns_(&columns) {
  const auto room = static_cast<std::size_t>(columns.capacity());
  coefficients_.setZero(std::max<Eigen::Index>(now_.Phi().size(), columns.capacity()));
  tried_.reserve(room);
  refused_.reserve(room);
  entering_.reserve(room);
  joining_.reserve(room);
}

void ActiveSet::use(PassiveSet& set, double lambda) noexcept {
  if (set_ != &set) started_ = false;
  set_ = &set;
  now_.set_lambda(lambda);
}

bool ActiveSet::take(const Eigen::MatrixXd& R) noexcept {
  if (!now_.take(R)) return false;
  started_ = false;
  return true;
}

void ActiveSet::take_back() noexcept {
  now_.take_back();
  started_ = false;
}

void ActiveSet::clear() noexcept {
  now_.clear();
  started_ = false;
}

double ActiveSet::divide(int j, int other, double share, bool adds_up) noexcept {
  const std::size_t at = now_.place_of(j);
  if (at == now_.masses().size()) return 0.0;
  const double part = share * now_.masses()[at];
  now_.divide(at, other, part);
  if (divides_where_it_stands()) {
    set_->divide(static_cast<int>(at), other, adds_up);
    columns_->bar(other, true);
  } else {
    started_ = false;
  }
  return part;
}

void ActiveSet::start_at(int j, double mass) noexcept {
  const std::size_t at = now_.place_of(j);
  if (at == now_.masses().size()) {
    now_.add(j, mass);
  } else {
    now_.change()[at] = mass;
  }
  started_ = false;
}

void ActiveSet::start() noexcept {
  if (!started_) factorise();
}

void ActiveSet::drop(int j) noexcept {
  start();
  leave(now_.place_of(j));
}

bool ActiveSet::enter_beside(int j, double mass) noexcept {
  start();
  if (!set_->enter(j)) return false;
  add(j, mass);
  return true;
}

bool ActiveSet::is_far_off() noexcept {
  start();
  const auto n = static_cast<Eigen::Index>(now_.passive().size());
  const Eigen::Index without = (set_->target().head(n).array() <= 0.0).count();
  return static_cast<double>(without) > of_little_use * static_cast<double>(n);
}

Outcome ActiveSet::run() noexcept {
  start();
  Outcome outcome = iterate();
  if (outcome == Outcome::solved && !passes_check()) {
    // Rounding of many updates, perhaps, or too many that entered together: once more from a fresh
    // factorisation.
    factorise();
    one_by_one_ = true;
    outcome = iterate();
    one_by_one_ = false;
    if (outcome == Outcome::solved && !passes_check()) outcome = Outcome::ill_conditioned;
  }
  return outcome;
}

void ActiveSet::restore() noexcept {
  now_.restore();
  started_ = false;
}

/// A fresh factorisation of the passive shapes.
void ActiveSet::factorise() noexcept {
  now_.scale_prices();
  set_->start(now_.R());
  columns_->unbar_all();
  started_ = true;
  entering_.clear();
  for (std::size_t i = 0; i < now_.passive().size(); ++i) {
    entering_.push_back({now_.passive()[i], now_.masses()[i]});
  }
  now_.clear();
  // Link by link: columns of the first links are short, and stay so if no long one came before.
  if (columns_->links() > 1) {
    std::sort(entering_.begin(), entering_.end(), [this](const ShapeMass& a, const ShapeMass& b) {
      return std::pair(columns_->link(a.place), a.place) <
             std::pair(columns_->link(b.place), b.place);
    });
  }
  joining_.clear();
  for (const ShapeMass& shape : entering_) joining_.push_back(shape.place);
  const std::size_t joined = set_->enter_first(joining_);
  for (std::size_t i = 0; i < entering_.size(); ++i) {
    const auto [j, mass] = entering_[i];
    if (i < joined) {
      add(j, mass);
    } else {
      enter_with_mass(j, mass);
    }
  }
}

void ActiveSet::add(int j, double mass) noexcept {
  now_.add(j, mass);
  columns_->bar(j, true);
}

// A column that depends on the passive ones: its mass moves over to them, with R U m as it is,
// until it has none left, or one of them has none; then that one leaves.
void ActiveSet::enter_with_mass(int j, double mass) noexcept {
  start();
  while (!set_->enter(j)) {
    set_->dependence(coefficients_);
    std::vector<double>& masses = now_.change();
    double moved = mass;
    std::size_t leaving = masses.size();
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const double share = coefficients_[static_cast<Eigen::Index>(i)];
      if (share < 0.0 && masses[i] < -moved * share) {
        moved = -masses[i] / share;
        leaving = i;
      }
    }
    for (std::size_t i = 0; i < masses.size(); ++i) {
      // Of two that are at zero together one may be a rounding below.
      masses[i] = std::max(0.0, masses[i] + moved * coefficients_[static_cast<Eigen::Index>(i)]);
    }
    if (leaving == masses.size()) return;
    mass -= moved;
    leave(leaving);
  }
  add(j, mass);
}

void ActiveSet::leave(std::size_t place) noexcept {
  columns_->bar(now_.passive()[place], false);
  now_.erase(place);
  set_->leave(static_cast<int>(place));
}

// Goes toward the target until the first mass becomes zero, and holds it there. False if nothing is
// in the way: then the masses are the target.
bool ActiveSet::step_is_blocked() noexcept {
  const Eigen::VectorXd& target = set_->target();
  const std::size_t n = now_.masses().size();
  double length = 1.0;
  std::size_t blocking = n;
  for (std::size_t i = 0; i < n; ++i) {
    const double to = target[static_cast<Eigen::Index>(i)], from = now_.masses()[i];
    if (to > 0.0) continue;
    const double reach = from > 0.0 ? from / (from - to) : 0.0;
    if (blocking == n || reach < length) {
      length = reach;
      blocking = i;
    }
  }
  if (blocking == n) {
    now_.set(target);
    return false;
  }
  if (now_.lambda() > 0.0 && may_cut_off(target)) return true;
  std::vector<double>& masses = now_.change();
  for (std::size_t i = 0; i < n; ++i) {
    masses[i] += length * (target[static_cast<Eigen::Index>(i)] - masses[i]);
  }
  masses[blocking] = 0.0;
  leave_without_mass();
  return true;
}

void ActiveSet::leave_without_mass() noexcept {
  for (std::size_t i = now_.masses().size(); i-- > 0;) {
    if (!(now_.masses()[i] > 0.0)) leave(i);
  }
}

// With hundreds of passive shapes a step at a time is long: all shapes whose target is negative
// leave at once, if the objective falls all the same.
bool ActiveSet::may_cut_off(const Eigen::VectorXd& target) noexcept {
  now_.evaluate();
  const double before = now_.value().total();
  tried_ = now_.masses();
  std::vector<double>& masses = now_.change();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    masses[i] = std::max(target[static_cast<Eigen::Index>(i)], 0.0);
  }
  now_.evaluate();
  if (now_.value().total() < before) {
    leave_without_mass();
    return true;
  }
  now_.change() = tried_;
  return false;
}

const std::vector<int>& ActiveSet::entering_shapes() noexcept {
  if (!set_->keeps_slopes()) now_.evaluate();
  const Eigen::VectorXd& slopes = set_->slopes(now_.slopes());
  if (now_.lambda() > 0.0) {
    // Slopes of the size of lambda decide how mass spreads among shapes that the data do not tell
    // apart: judged against each other.
    static_cast<void>(
        columns_->steepest_or_by_terms(slopes, smallest_slope, smallest_damped_slope));
  } else {
    static_cast<void>(columns_->steepest(slopes, smallest_slope));
  }
  // A damped system has as many unknowns however many shapes enter.
  using Among = ShapeColumns::Among;
  const bool any = now_.lambda() > 0.0 && !one_by_one_;
  return columns_->steep_ones(any ? Among::all : Among::links);
}

bool ActiveSet::none_enters(const std::vector<int>& shapes) noexcept {
  if (!started_) return false;
  iterations_ = 1;
  now_.count_anew();
  const bool is_damped = now_.lambda() > 0.0;
  if (is_damped && !set_->can_divide()) return now_.stays_settled(shapes);
  const Eigen::VectorXd& slopes = set_->slopes(now_.slopes());
  return std::ranges::none_of(shapes, [&](int j) {
    const ShapeColumns::Column terms =
        columns_->column(j).cwiseProduct(slopes.segment<10>(Eigen::Index{10} * columns_->link(j)));
    const double slope = terms.sum();
    return columns_->price(j, slope) > smallest_slope ||
           (is_damped && slope > smallest_damped_slope * terms.cwiseAbs().sum());
  });
}

void ActiveSet::refuse(int j) noexcept {
  columns_->bar(j, true);
  refused_.push_back(j);
}

void ActiveSet::admit_refused() noexcept {
  for (const int j : refused_) columns_->bar(j, false);
  refused_.clear();
}

// The steepest shape enters, and steep ones of other links with it, if they take positive masses.
// In exact arithmetic at least one does: the way to the target goes down, and only the slopes of
// those that enter are not zero. False if none enters: then the masses are the minimiser.
bool ActiveSet::some_enter() noexcept {
  const std::size_t before = now_.passive().size();
  while (now_.passive().size() == before) {
    const std::vector<int>& shapes = entering_shapes();
    if (shapes.empty()) break;
    for (std::span<const int> left = shapes; !left.empty();) {
      const std::size_t entered = set_->enter_first(left);
      for (const int j : left.first(entered)) add(j, 0.0);
      if (entered < left.size()) refuse(left[entered]);
      left = left.subspan(std::min(entered + 1, left.size()));
    }
    refuse_without_mass(before);
    if (now_.passive().size() == before) ++iterations_;
  }
  if (now_.passive().size() == before) return false;
  admit_refused();
  return true;
}

/// Of the shapes that entered at place `first` and behind it.
void ActiveSet::refuse_without_mass(std::size_t first) noexcept {
  while (now_.passive().size() > first && some_are_refused(first)) {
  }
}

/// Those at place `first` and behind it whose target is not positive.
bool ActiveSet::some_are_refused(std::size_t first) noexcept {
  const std::size_t before = now_.passive().size();
  const Eigen::VectorXd& target = set_->target();
  for (std::size_t i = before; i-- > first;) {
    if (target[static_cast<Eigen::Index>(i)] > 0.0) continue;
    const int j = now_.passive()[i];
    leave(i);
    refuse(j);
  }
  return now_.passive().size() < before;
}

// Masses to the last digits that the factorisation allows. False if a shape had its mass from
// rounding alone: then it is refused, for it would enter and leave for ever.
bool ActiveSet::refine() noexcept {
  // Shapes that were refused have been in the set and out again: the target is made anew.
  if (step_is_blocked()) return false;
  now_.evaluate();
  for (int k = 0; k < most_refinements && now_.largest_slope() > refined_slope; ++k) {
    ++iterations_;
    set_->refine(now_.slopes());
    if (some_are_refused(0)) return false;
    static_cast<void>(step_is_blocked());
    now_.evaluate();
  }
  return true;
}

Outcome ActiveSet::iterate() noexcept {
  // Every step ends at a lower objective with another set of passive shapes, so none comes twice.
  // In practice two or three steps a passive shape are taken; the bound is for rounding and for
  // clocks.
  const int most_steps = 100 + 4 * (static_cast<int>(now_.Phi().size()) + columns_->size());
  const int last = iterations_ + most_steps;
  while (true) {
    ++iterations_;
    if (step_is_blocked()) continue;  // takes a shape out, so comes to an end
    const bool in_time = iterations_ <= last;
    if (in_time && some_enter()) continue;
    if (set_->keeps_slopes() || !in_time) now_.evaluate();
    if (!(now_.largest_slope() > refined_slope)) break;
    if (refine() && (!in_time || set_->keeps_slopes() || !some_enter())) break;
  }
  ended_with_refused_ = !refused_.empty();
  admit_refused();
  if (!set_->sound()) return Outcome::ill_conditioned;
  // Rounding may let a shape in and out for ever. It is no matter if the answer is right all the
  // same.
  if (iterations_ > last && columns_->steepest(now_.slopes(), allowed_slope) >= 0) {
    return Outcome::too_many_steps;
  }
  return std::isfinite(now_.value().total()) ? Outcome::solved : Outcome::not_finite;
}

bool ActiveSet::passes_check() noexcept {
  if (!(now_.largest_slope() <= allowed_slope)) return false;
  // No other shape enters at the slopes of the factorisation. Mostly these are the slopes of the
  // masses to the last digits; where a row is hardly felt they need not be, and shapes are asked.
  // So are they if some were refused: a target that is all rounding refuses any.
  const Eigen::VectorXd& slopes = set_->slopes(now_.slopes());
  const auto allowed = allowed_slope * now_.length() * now_.lengths().array();
  const bool same_slopes = ((now_.slopes() - slopes).array().abs() <= allowed).all();
  if (same_slopes && !ended_with_refused_) return true;
  return columns_->steepest(now_.slopes(), allowed_slope) < 0;
}

}  // namespace shapeid::fast

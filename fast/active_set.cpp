// Derivation and the reasons for the tolerances: docs/derivations/fast-masses.md.
#include "shapeid/fast/active_set.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "shapeid/fast/triangle_products.hpp"

namespace shapeid::fast {
namespace {

/// Slopes below this share of their terms are rounding: a hundred roundings.
constexpr double smallest_slope = 1e-14;

/// The same among slopes of the size of lambda, whose terms nearly cancel by nature.
constexpr double smallest_damped_slope = 1e-12;

/// A slope further below zero than ten times what counts as rounding is certainly negative.
constexpr double certainly_held = 10.0 * smallest_slope;

/// Slopes of passive shapes that are larger than this share of their terms are worth a step of
/// refinement: a few roundings more than a well-conditioned factorisation leaves.
constexpr double refined_slope = 3e-15;

/// Where rounding of slopes may move a mass by more than this share of all masses, the rows hardly
/// tell the passive shapes apart, and the density term, beside which rounding is nothing, should
/// hold them.
constexpr double told_apart = 1e-9;

/// Signs of rounding errors, one a bit, in no order that divided shapes could have: the binary
/// digits of the golden ratio.
constexpr std::uint64_t some_signs = 0x9E3779B97F4A7C15;

/// Where more than this share of the passive shapes is to leave, the others are not worth keeping:
/// measured on windows that follow each other, a quarter to a half does alike.
constexpr double of_little_use = 1.0 / 3.0;

/// Each step gains the digits that the condition leaves, six or more; the last ones are noise.
constexpr int most_refinements = 3;

/// A residual's square below this share of || c ||^2 comes from rows without noise: sensors leave
/// more than a millionth, a hundred times this root.
constexpr double met_exactly = 1e-16;

/// What an answer must satisfy to be given out: every gradient entry that should be zero or
/// positive is so to this share of its terms. The objective is then within as much of its minimum,
/// in units of || c ||^2.
constexpr double allowed_slope = 1e-10;

}  // namespace

ActiveSet::ActiveSet(ShapeColumns& columns, const Eigen::VectorXd& V)
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
  refused_.reserve(room);
  guessed_.reserve(room);
  saved_.reserve(room);
  entering_.reserve(room);
}

void ActiveSet::use(PassiveSet& set, double lambda) noexcept {
  if (set_ != &set) started_ = false;
  set_ = &set;
  lambda_ = lambda;
  evaluated_ = false;
}

bool ActiveSet::take(const Eigen::MatrixXd& R) noexcept {
  if (columns_->links() == 1) {
    other_rows_->link.take(R);
    std::copy_n(other_rows_->link.lengths().data(), 10, other_rows_->lengths.data());
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

void ActiveSet::take_back() noexcept {
  std::swap(rows_, other_rows_);
  scaled_ = false;
  started_ = false;
  evaluated_ = false;
}

void ActiveSet::scale_prices() noexcept {
  if (!scaled_) columns_->set_scale(rows_->lengths, rows_->length);
  scaled_ = true;
}

void ActiveSet::clear() noexcept {
  passive_.clear();
  masses_.clear();
  started_ = false;
  evaluated_ = false;
}

double ActiveSet::divide(int j, int other, double share) noexcept {
  const auto at = std::find(passive_.begin(), passive_.end(), j) - passive_.begin();
  started_ = false;
  if (at == std::ssize(passive_)) return 0.0;
  evaluated_ = false;
  double& mass = masses_[static_cast<std::size_t>(at)];
  const double part = share * mass;
  mass -= part;
  passive_.push_back(other);
  masses_.push_back(part);
  return part;
}

void ActiveSet::start_at(int j, double mass) noexcept {
  const auto place = std::find(passive_.begin(), passive_.end(), j);
  if (place == passive_.end()) {
    passive_.push_back(j);
    masses_.push_back(mass);
  } else {
    masses_[static_cast<std::size_t>(place - passive_.begin())] = mass;
  }
  started_ = false;
  evaluated_ = false;
}

void ActiveSet::start() noexcept {
  if (!started_) factorise();
}

void ActiveSet::drop(int j) noexcept {
  start();
  leave(static_cast<int>(std::find(passive_.begin(), passive_.end(), j) - passive_.begin()));
}

bool ActiveSet::enter_beside(int j, double mass) noexcept {
  start();
  if (!set_->enter(j)) return false;
  add(j, mass);
  return true;
}

bool ActiveSet::is_far_off() noexcept {
  start();
  const auto n = static_cast<Eigen::Index>(passive_.size());
  const Eigen::Index without = (set_->target().head(n).array() <= 0.0).count();
  return static_cast<double>(without) > of_little_use * static_cast<double>(n);
}

Outcome ActiveSet::run() noexcept {
  start();
  Outcome outcome = iterate();
  if (outcome == Outcome::solved && !passes_check()) {
    // Rounding of many updates, perhaps: once more from a fresh factorisation.
    factorise();
    outcome = iterate();
    if (outcome == Outcome::solved && !passes_check()) outcome = Outcome::ill_conditioned;
  }
  return outcome;
}

// Masses at the minimum for lambda = 0 solve A^T A m = A^T c; those for lambda add -lambda V^-1 m
// to the right-hand side, which moves them by lambda over the square of the smallest singular value
// of A: little where columns do not nearly depend on each other, so that refinement converges. The
// shapes that are held stay so if their slopes, now lambda's size apart, are certainly negative.
bool ActiveSet::damp(ColumnSet& set, double lambda) noexcept {
  if (!is_at_a_vertex() || !tells_apart(set)) return false;
  lambda_ = lambda;
  for (std::size_t i = 0; i < passive_.size(); ++i) stiffness_[i] = lambda / (*V_)[passive_[i]];
  evaluated_ = false;
  tried_ = masses_;
  if (settle(set) && is_at_a_vertex()) return true;
  masses_ = tried_;
  evaluated_ = false;
  return false;
}

// The pivots may have gone astray, and the masses have the digits that a squared condition leaves.
// Whether they are the minimum is asked of the masses alone, as of any other answer, and more
// strictly: where no correction reaches the last digits the method itself is called.
bool ActiveSet::settles_at(Guess& guess) noexcept {
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
  iterations_ = guess.pivots() + 1 + settled.corrections;  // one to see that nothing is left to do
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
  started_ = false;
  take_value(settled.density);
  guess.correct(settled.m, settled.at.slopes);
  return true;
}

// All others were asked at the same slopes.
bool ActiveSet::stays_settled(const std::vector<int>& massless) noexcept {
  iterations_ = 1;
  const double threshold = lambda_ > 0.0 ? -certainly_held : smallest_slope;
  return std::ranges::all_of(massless, [this, threshold](int j) {
    return columns_->price(j, columns_->column(j).dot(slopes_)) <= threshold;
  });
}

/// Corrects the masses until the slopes of the passive shapes are rounding. False if that does not
/// come about, or takes a mass away.
bool ActiveSet::settle(NormalEquations& normal) noexcept {
  evaluate();
  bool is_positive = true;
  for (int k = 0; k < most_refinements && is_positive && largest_slope() > refined_slope; ++k) {
    is_positive = correct(normal);
    evaluate();
  }
  return is_positive && largest_slope() <= refined_slope;
}

// What a rounding of each slope does to the masses. The signs that do the most are found as in
// Hager's estimate of a condition: from any signs, by those of what they lead to.
bool ActiveSet::tells_apart(NormalEquations& normal) noexcept {
  return tells_apart(normal, passive_, masses_);
}

bool ActiveSet::tells_apart(Guess& guess, const AtPlaces& at, const Dozen& m) noexcept {
  guessed_.clear();
  tried_.clear();
  for (unsigned left = at.used; left != 0; left &= left - 1) {
    const auto place = static_cast<std::size_t>(std::countr_zero(left));
    guessed_.push_back(at.shape[place]);
    tried_.push_back(m[place]);
  }
  return guessed_.size() <= 10 && tells_apart(guess, guessed_, tried_);
}

bool ActiveSet::tells_apart(NormalEquations& normal, const std::vector<int>& passive,
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

/// use(place, -1/2 df/dm) for every passive shape. Shapes of a link often stand together: its
/// slopes are fetched once for them.
template <typename Use>
void ActiveSet::for_each_slope(Use use) const noexcept {
  ShapeColumns::Column g = ShapeColumns::Column::Zero();
  int link = -1;
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    const int j = passive_[i];
    if (columns_->link(j) != link) {
      link = columns_->link(j);
      g = slopes_.segment<10>(Eigen::Index{10} * link);
    }
    use(i, columns_->column(j).dot(g) - stiffness_[i] * masses_[i]);
  }
}

/// One step of refinement of the masses; whether all stay positive.
bool ActiveSet::correct(NormalEquations& normal) noexcept {
  ++iterations_;
  if (columns_->links() == 1) {
    static_cast<void>(largest_slope());
    coefficients_.head(static_cast<Eigen::Index>(masses_.size())) =
        gradient_.head(static_cast<Eigen::Index>(masses_.size()));
  } else {
    for_each_slope([this](std::size_t i, double slope) {
      coefficients_[static_cast<Eigen::Index>(i)] = slope;
    });
  }
  normal.solve_normal(coefficients_);
  evaluated_ = false;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    masses_[i] += coefficients_[static_cast<Eigen::Index>(i)];
    smallest = std::min(smallest, masses_[i]);
  }
  return smallest > 0.0;
}

bool ActiveSet::is_at_a_vertex() noexcept {
  return static_cast<Eigen::Index>(passive_.size()) <= Phi_.size() &&
         columns_->steepest(slopes_, -certainly_held) < 0;
}

void ActiveSet::save() noexcept {
  iterations_ = 0;
  saved_.clear();
  for (std::size_t i = 0; i < passive_.size(); ++i) saved_.push_back({passive_[i], masses_[i]});
  saved_Phi_ = Phi_;
  saved_slopes_ = slopes_;
  saved_value_ = value_;
}

void ActiveSet::restore() noexcept {
  clear();
  for (const ShapeMass& saved : saved_) {
    passive_.push_back(saved.place);
    masses_.push_back(saved.mass);
  }
  Phi_ = saved_Phi_;
  slopes_ = saved_slopes_;
  value_ = saved_value_;
}

/// A fresh factorisation of the passive shapes.
void ActiveSet::factorise() noexcept {
  scale_prices();
  set_->start(*rows_->R);
  columns_->unbar_all();
  started_ = true;
  entering_.clear();
  for (std::size_t i = 0; i < passive_.size(); ++i) entering_.push_back({passive_[i], masses_[i]});
  passive_.clear();
  masses_.clear();
  stiffness_.clear();
  evaluated_ = false;
  // Link by link: columns of the first links are short, and stay so if no long one came before.
  if (columns_->links() > 1) {
    std::sort(entering_.begin(), entering_.end(), [this](const ShapeMass& a, const ShapeMass& b) {
      return std::pair(columns_->link(a.place), a.place) <
             std::pair(columns_->link(b.place), b.place);
    });
  }
  for (const ShapeMass& shape : entering_) enter_with_mass(shape.place, shape.mass);
}

void ActiveSet::add(int j, double mass) noexcept {
  passive_.push_back(j);
  masses_.push_back(mass);
  stiffness_.push_back(lambda_ / (*V_)[j]);
  columns_->bar(j, true);
  judged_ = false;
  if (mass != 0.0) evaluated_ = false;
}

// A column that depends on the passive ones: its mass moves over to them, with R U m as it is,
// until it has none left, or one of them has none; then that one leaves.
void ActiveSet::enter_with_mass(int j, double mass) noexcept {
  start();
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
    evaluated_ = false;
    if (leaving < 0) return;
    mass -= moved;
    leave(leaving);
  }
  add(j, mass);
}

void ActiveSet::leave(int place) noexcept {
  const int j = passive_[static_cast<std::size_t>(place)];
  columns_->bar(j, false);
  judged_ = false;
  if (masses_[static_cast<std::size_t>(place)] != 0.0) evaluated_ = false;
  passive_.erase(passive_.begin() + place);
  masses_.erase(masses_.begin() + place);
  stiffness_.erase(stiffness_.begin() + place);
  set_->leave(place);
}

// Goes toward the target until the first mass becomes zero, and holds it there. False if nothing is
// in the way: then the masses are the target.
bool ActiveSet::step_is_blocked() noexcept {
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
    if (!std::equal(masses_.begin(), masses_.end(), target.data())) evaluated_ = false;
    std::copy_n(target.data(), masses_.size(), masses_.data());
    return false;
  }
  if (lambda_ > 0.0 && may_cut_off(target)) return true;
  evaluated_ = false;
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    masses_[i] += length * (target[static_cast<Eigen::Index>(i)] - masses_[i]);
  }
  masses_[static_cast<std::size_t>(blocking)] = 0.0;
  leave_without_mass();
  return true;
}

void ActiveSet::leave_without_mass() noexcept {
  for (int i = static_cast<int>(masses_.size()) - 1; i >= 0; --i) {
    if (!(masses_[static_cast<std::size_t>(i)] > 0.0)) leave(i);
  }
}

// With hundreds of passive shapes a step at a time is long: all shapes whose target is negative
// leave at once, if the objective falls all the same.
bool ActiveSet::may_cut_off(const Eigen::VectorXd& target) noexcept {
  evaluate();
  const double before = value_.total();
  tried_ = masses_;
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    masses_[i] = std::max(target[static_cast<Eigen::Index>(i)], 0.0);
  }
  evaluated_ = false;
  evaluate();
  if (value_.total() < before) {
    leave_without_mass();
    return true;
  }
  masses_ = tried_;
  evaluated_ = false;
  return false;
}

const std::vector<int>& ActiveSet::entering_shapes() noexcept {
  if (!set_->keeps_slopes()) evaluate();
  const Eigen::VectorXd& slopes = set_->slopes(slopes_);
  if (lambda_ > 0.0) {
    // Slopes of the size of lambda decide how mass spreads among shapes that the data do not tell
    // apart: judged against each other.
    static_cast<void>(
        columns_->steepest_or_by_terms(slopes, smallest_slope, smallest_damped_slope));
  } else {
    static_cast<void>(columns_->steepest(slopes, smallest_slope));
  }
  // A damped system has as many unknowns however many shapes enter.
  using Among = ShapeColumns::Among;
  return columns_->steep_ones(lambda_ > 0.0 ? Among::groups : Among::links);
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
void ActiveSet::refuse_without_mass(std::size_t first) noexcept {
  while (passive_.size() > first && some_are_refused(first)) {
  }
}

/// Those at place `first` and behind it whose target is not positive.
bool ActiveSet::some_are_refused(std::size_t first) noexcept {
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
bool ActiveSet::refine() noexcept {
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

Outcome ActiveSet::iterate() noexcept {
  // Every step ends at a lower objective with another set of passive shapes, so none comes twice.
  // In practice two or three steps a passive shape are taken; the bound is for rounding and for
  // clocks.
  const int most_steps = 100 + 4 * (static_cast<int>(Phi_.size()) + columns_->size());
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
  ended_with_refused_ = !refused_.empty();
  admit_refused();
  if (!set_->sound()) return Outcome::ill_conditioned;
  // Rounding may let a shape in and out for ever. It is no matter if the answer is right all the
  // same.
  if (iterations_ > last && columns_->steepest(slopes_, allowed_slope) >= 0) {
    return Outcome::too_many_steps;
  }
  return std::isfinite(value_.total()) ? Outcome::solved : Outcome::not_finite;
}

// From the masses alone, so that no error of the factorisation's updates is in it.
void ActiveSet::evaluate() noexcept {
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
void ActiveSet::take_value(double density) noexcept {
  evaluated_ = true;
  judged_ = false;
  std::copy_n(at_masses_.Phi.data(), 10, Phi_.data());
  std::copy_n(at_masses_.slopes.data(), 10, slopes_.data());
  const double unreached = (*rows_->R)(10, 10);
  value_ = {at_masses_.square + unreached * unreached, density};
}

void ActiveSet::evaluate_links() noexcept {
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
    add_column(*rows_->R, l, minus, r_.data());
  }
  const double unreached = (*rows_->R)(Phi_.size(), Phi_.size());
  value_.data = r_.squaredNorm() + unreached * unreached;
  slopes_of(*rows_->R, r_, slopes_);
}

/// Of the passive shapes, whose slopes should be zero; over their terms.
double ActiveSet::largest_slope() noexcept {
  if (judged_) return largest_slope_;
  judged_ = true;
  if (columns_->links() == 1) {
    return largest_slope_ = rows_->link.judge(*columns_, passive_, masses_, stiffness_,
                                              at_masses_.slopes, gradient_);
  }
  largest_slope_ = 0.0;
  for_each_slope([this](std::size_t i, double slope) {
    largest_slope_ = std::max(largest_slope_, columns_->price(passive_[i], std::abs(slope)));
  });
  return largest_slope_;
}

bool ActiveSet::passes_check() noexcept {
  if (!(largest_slope() <= allowed_slope)) return false;
  // No other shape enters at the slopes of the factorisation. Mostly these are the slopes of the
  // masses to the last digits; where a row is hardly felt they need not be, and shapes are asked.
  // So are they if some were refused: a target that is all rounding refuses any.
  const Eigen::VectorXd& slopes = set_->slopes(slopes_);
  const auto allowed = allowed_slope * rows_->length * rows_->lengths.array();
  const bool same_slopes = ((slopes_ - slopes).array().abs() <= allowed).all();
  if (same_slopes && !ended_with_refused_) return true;
  return columns_->steepest(slopes_, allowed_slope) < 0;
}

}  // namespace shapeid::fast

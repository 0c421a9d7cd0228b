#include "shapeid/fast/mass_solver.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "shapeid/fast/asked_of_masses.hpp"
#include "shapeid/fast/many_links.hpp"
#include "shapeid/fast/one_link.hpp"

namespace shapeid::fast {
namespace {

std::unique_ptr<ColumnSet> column_set(const ShapeColumns& columns) {
  if (columns.links() == 1) return std::make_unique<OneLink>(columns);
  return std::make_unique<ManyLinks>(columns);
}

/// Where this share of the passive shapes stays passive from one triangle to the next, all are
/// worth starting from; elsewhere only those that have the other share of all mass.
constexpr double enough_stay = 0.5, heavy_share = 0.1;

}  // namespace

MassSolver::MassSolver(int links, int most_shapes)
    : columns_(links, most_shapes),
      m_(Eigen::VectorXd::Zero(most_shapes)),
      V_(Eigen::VectorXd::Ones(most_shapes)),
      vertex_(column_set(columns_)),
      few_(V_),
      table_(columns_, V_),
      method_(columns_, V_),
      even_(columns_, V_) {
  before_.reserve(static_cast<std::size_t>(most_shapes));
  heavy_.reserve(static_cast<std::size_t>(most_shapes));
  failed_guess_.reserve(AtPlaces::most);
  massless_.reserve(static_cast<std::size_t>(most_shapes));
  method_.use(*vertex_, 0.0);
}

void MassSolver::clear() noexcept {
  columns_.clear();
  few_.clear();
  forget_masses();
}

bool MassSolver::append(int link, const Column& u, double V) noexcept {
  SHAPEID_CONTRACT(why_no_shape(link, u, V, links()));
  guess_ = nullptr;  // which knows nothing of it
  only_massless_ = false;
  return add(link, u, V);
}

bool MassSolver::add(int link, const Column& u, double V) noexcept {
  const int j = columns_.size();
  if (!columns_.append(link, u)) return false;
  few_.put(j, u);
  m_[j] = 0.0;
  V_[j] = V;
  return true;
}

void MassSolver::set_lambda(double lambda) noexcept {
  SHAPEID_CONTRACT(why_no_lambda(lambda));
  if (lambda == lambda_) return;
  lambda_ = lambda;
  guess_ = nullptr;
  has_answer_ = false;
  if (lambda > 0.0) even_.set_lambda(lambda);
  method_.use(*vertex_, 0.0);
  at_vertex_ = true;
}

void MassSolver::forget_masses() noexcept {
  guess_ = nullptr;
  take_masses_out();
  method_.clear();
  at_vertex_ = true;
  has_answer_ = false;
}

void MassSolver::start_at(int j, double mass) noexcept {
  SHAPEID_CONTRACT(why_no_start(j, mass, shapes()));
  guess_ = nullptr;
  has_answer_ = false;
  method_.start_at(j, mass);
  m_[j] = mass;
}

Outcome MassSolver::solve(const Eigen::MatrixXd& R) noexcept {
  SHAPEID_CONTRACT(why_no_triangle(R, links()));
  if (!method_.take(R)) return Outcome::not_finite;
  const bool has_many = links() == 1 && !few_.fits();  // few enter at little cost
  failed_guess_.clear();
  if (!start_guess(has_many ? worth_starting_from() : passive()) || !try_guess()) {
    is_new_ = true;
    const Outcome outcome = solve_by_method();
    is_new_ = false;
    if (outcome != Outcome::solved) {
      method_.take_back();
      return outcome;
    }
  }
  if (has_many) see_what_stayed();
  start_watching();
  has_answer_ = true;
  return Outcome::solved;
}

Outcome MassSolver::solve_again() noexcept {
  SHAPEID_CONTRACT(why_no_rows(method_.has_rows()));
  if (guess_ != nullptr && guess_again()) {
    start_watching();
    has_answer_ = true;
    return Outcome::solved;
  }
  if (has_answer_ && only_massless_ && method_.none_enters(massless_)) {
    start_watching();
    return Outcome::solved;
  }
  const Outcome outcome = solve_by_method();
  if (outcome == Outcome::solved) {
    start_watching();
    has_answer_ = true;
  }
  return outcome;
}

// Rounding of many divisions, perhaps: once more from the rows.
bool MassSolver::guess_again() noexcept {
  return (only_massless_ && method_.stays_settled(massless_)) || try_guess() ||
         (start_guess(passive()) && try_guess());
}

/// From an answer on, which shapes without mass are divided.
void MassSolver::start_watching() noexcept {
  only_massless_ = true;
  massless_.clear();
}

void MassSolver::watch(int j, int other) noexcept {
  only_massless_ = only_massless_ && m_[j] == 0.0 && massless_.size() + 2 <= massless_.capacity();
  if (!only_massless_) return;
  massless_.push_back(j);
  massless_.push_back(other);
}

Outcome MassSolver::solve_by_method() noexcept {
  method_.save();
  take_masses_out();
  const bool was_at_vertex = at_vertex_;
  Outcome outcome = Outcome::solved;
  if (lambda_ == 0.0) {
    outcome = method_.run();
  } else {
    if (is_new_ && links() > 1) forget_useless_masses();
    outcome = is_new_ && links() == 1 ? solve_damped_anew() : solve_damped();
  }
  if (outcome != Outcome::solved) {
    method_.restore();
    at_vertex_ = was_at_vertex;
  }
  put_masses_in();
  return outcome;
}

// Most answers for one link are found by pivots: of few shapes on their own normal equations, of
// more in the link's parameters.
bool MassSolver::start_guess(const std::vector<int>& start) noexcept {
  guess_ = nullptr;
  if (links() != 1) return false;
  if (!few_.fits()) method_.scale_prices();
  Guess& guess = few_.fits() ? static_cast<Guess&>(few_) : table_;
  if (guess.start(method_.link_rows(), lambda_, start)) guess_ = &guess;
  return guess_ != nullptr;
}

// Where windows have little in common, shapes that enter to leave again cost more than they save;
// heavy ones are the likeliest to stay.
const std::vector<int>& MassSolver::worth_starting_from() noexcept {
  before_ = passive();
  if (most_stay_) return before_;
  const double enough = heavy_share * m().sum();
  heavy_.clear();
  for (const int j : before_) {
    if (m_[j] > enough) heavy_.push_back(j);
  }
  return heavy_;
}

void MassSolver::see_what_stayed() noexcept {
  const auto stayed =
      std::count_if(before_.begin(), before_.end(), [this](int j) { return m_[j] > 0.0; });
  if (!before_.empty()) {
    most_stay_ = static_cast<double>(stayed) >= enough_stay * static_cast<double>(before_.size());
  }
}

bool MassSolver::try_guess() noexcept {
  for (int round = 0; round < Guess::most_rounds && guess_->settle(); ++round) {
    if (settles_at_guess()) return true;
    if (!guess_->can_go_on()) break;
  }
  keep_failed_guess();
  guess_ = nullptr;
  return false;
}

// It is near the minimum as a rule: what is missing are shapes for which it has no place, or
// digits.
void MassSolver::keep_failed_guess() noexcept {
  failed_guess_.clear();
  const AtPlaces at = guess_->answer();
  for (unsigned left = at.used; left != 0; left &= left - 1) {
    const auto place = static_cast<std::size_t>(std::countr_zero(left));
    const double mass = (*at.m)[place];
    if (mass > 0.0 && std::isfinite(mass)) failed_guess_.push_back({at.shape[place], mass});
  }
}

void MassSolver::start_at_failed_guess() noexcept {
  method_.clear();
  for (const ShapeMass& shape : failed_guess_) method_.start_at(shape.place, shape.mass);
  failed_guess_.clear();
}

bool MassSolver::settles_at_guess() noexcept {
  for (const int j : passive()) m_[j] = 0.0;
  method_.use(*vertex_, lambda_);
  const bool is_right = method_.settles_at(*guess_);
  if (is_right) at_vertex_ = true;
  put_masses_in();
  return is_right;
}

void MassSolver::take_masses_out() noexcept {
  for (const int j : passive()) m_[j] = 0.0;
}

void MassSolver::put_masses_in() noexcept {
  for (std::size_t i = 0; i < passive().size(); ++i) m_[passive()[i]] = method_.masses()[i];
}

// With noise the rows alone mostly decide which shapes have mass; then lambda moves the masses by
// its own size, and the answer costs what it costs at lambda = 0. Only where shapes are left that
// the rows do not tell apart, the even density among them is sought.
Outcome MassSolver::solve_damped() noexcept {
  if (at_vertex_) {
    method_.use(*vertex_, 0.0);
    const Outcome outcome = method_.run();
    if (outcome == Outcome::solved && method_.damp(*vertex_, lambda_)) return outcome;
    if (outcome != Outcome::solved) method_.restore();
  }
  return spread_evenly();
}

/// Of several links, on new rows: masses that are worse than none.
void MassSolver::forget_useless_masses() noexcept {
  if (at_vertex_) return;
  method_.use(even_, lambda_);
  if (!method_.is_far_off()) return;
  method_.clear();
  at_vertex_ = true;
}

// On new rows of one link a guess has looked for a vertex already; or there were more masses than
// it has places for, which are worse than none where they are far off.
Outcome MassSolver::solve_damped_anew() noexcept {
  method_.use(even_, lambda_);
  const bool has_no_guess = failed_guess_.empty() && method_.passive().size() > AtPlaces::most;
  if (has_no_guess && method_.is_far_off()) {
    method_.clear();
    if (start_guess(method_.passive()) && try_guess()) return Outcome::solved;
  }
  if (failed_guess_.empty()) return spread_evenly();
  start_at_failed_guess();
  const Outcome outcome = spread_evenly();
  if (outcome == Outcome::solved) return outcome;
  method_.restore();  // pivots may have gone astray
  return solve_damped();
}

Outcome MassSolver::spread_evenly() noexcept {
  method_.use(even_, lambda_);
  const Outcome outcome = method_.run();
  if (outcome == Outcome::solved) at_vertex_ = method_.is_at_a_vertex();
  return outcome;
}

// A thirteenth shape needs the other guess. Called when the shape to be divided is still whole.
bool MassSolver::keep_guess_to_divide() noexcept {
  if (guess_ == nullptr) return false;
  return guess_ != &few_ || few_.fits() || start_guess(passive());
}

bool MassSolver::divide(int j, const Column& first, double V1, const Column& second,
                        double V2) noexcept {
  SHAPEID_CONTRACT(why_no_parts(columns_.column(j), V_[j], first, V1, second, V2));
  const int other = shapes();
  if (!add(columns_.link(j), second, V2)) return false;
  // Where nothing is factorised yet, masses are but a place to start at.
  const bool by_guess = keep_guess_to_divide();
  const bool at_once = by_guess || method_.divides_where_it_stands() ||
                       (method_.has_rows() && !method_.has_started());
  // Where a guess follows the division its own check corrects what it keeps of the whole: then only
  // the contract needs to know.
  const bool exact = (by_guess && !contracts_are_checked) ||
                     adds_up(columns_.column(j), V_[j], first, V1, second, V2);
  has_answer_ = has_answer_ && exact;
  if (at_once) {
    columns_.replace(j, first);
    few_.put(j, first);
    V_[j] = V1;
    if (by_guess && !guess_->divide(j, other, V1, V2)) guess_ = nullptr;
    watch(j, other);
    m_[other] = method_.divide(j, other, V2 / (V1 + V2), exact);
    m_[j] -= m_[other];
    SHAPEID_CONTRACT(why_changed());
    return true;
  }
  watch(j, other);
  const double mass = m_[j];
  take_masses_out();
  if (mass > 0.0 && method_.has_rows()) method_.drop(j);
  columns_.replace(j, first);
  few_.put(j, first);
  V_[j] = V1;
  if (mass > 0.0) {
    give(j, mass * V1 / (V1 + V2));
    give(other, mass * V2 / (V1 + V2));
  }
  put_masses_in();
  SHAPEID_CONTRACT(why_changed());
  return true;
}

void MassSolver::give(int j, double mass) noexcept {
  if (!method_.has_rows()) {  // before the first solve() masses are but a place to start at
    method_.start_at(j, mass);
  } else if (lambda_ == 0.0 || method_.uses(even_)) {
    method_.enter_with_mass(j, mass);
  } else if (!method_.enter_beside(j, mass)) {
    // Mass that moved among dependent columns would change the density term.
    method_.use(even_, lambda_);
    method_.enter_with_mass(j, mass);
    at_vertex_ = false;
  }
}

// As far as the rows feel Phi: mass may move among shapes whose columns R u depend on each other.
// Judged by the length of R (U m - Phi), not row by row: what moves lies where R is hardly more
// than rounding. No vector is made, so that a call asks for no memory where contracts are checked
// either.
Violation MassSolver::why_changed() const {
  if (!has_answer_) return std::nullopt;
  const Eigen::VectorXd& rows = method_.lengths();
  double density = 0.0, felt = 0.0, square = 0.0;
  for (const int j : passive()) {
    density += lambda_ * m_[j] * m_[j] / V_[j];
    felt += m_[j] * columns_.column(j).cwiseAbs().dot(
                        rows.segment<10>(Eigen::Index{10} * columns_.link(j)));
  }
  for (int b = 0; b < links(); ++b) {
    Column moved = Column::Zero();
    const auto add = [&](int link, double factor, const Column& x) {
      if (link < b) return;
      moved +=
          factor *
          method_.R().block<10, 10>(Eigen::Index{10} * b, Eigen::Index{10} * link).lazyProduct(x);
    };
    for (const int j : passive()) add(columns_.link(j), m_[j], columns_.column(j));
    for (int l = b; l < links(); ++l) add(l, -1.0, Phi().segment<10>(Eigen::Index{10} * l));
    square += moved.squaredNorm();
  }
  // A few hundred roundings, as in any chain of a dozen stable steps; a wrong share of a mass is
  // off by 1e10 of them.
  const double allowed = 300.0 * std::numeric_limits<double>::epsilon() * (10.0 + shapes());
  if (!(std::sqrt(square) <= allowed * felt)) {
    return "the division changes R Phi by " + std::to_string(std::sqrt(square));
  }
  // At lambda = 0 masses may move among dependent shapes, and no density term holds them.
  const double change = std::abs(density - value().density);
  if (!(change <= allowed * density + std::numeric_limits<double>::min())) {
    return "the division changes the density term from " + std::to_string(value().density) +
           " to " + std::to_string(density);
  }
  return std::nullopt;
}

double MassSolver::gap(double mass_bound) const noexcept {
  double lowest = 0.0, product = 0.0;
  for (int j = 0; j < shapes(); ++j) {
    const double z =
        2.0 * (lambda_ * m_[j] / V_[j] - columns_.column(j).dot(method_.slopes().segment<10>(
                                             Eigen::Index{10} * columns_.link(j))));
    product += z * m_[j];
    lowest = std::min(lowest, z);
  }
  return product - mass_bound * lowest;
}

}  // namespace shapeid::fast

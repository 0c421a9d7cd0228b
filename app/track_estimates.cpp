#include "shapeid/app/track_estimates.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/reference/identify.hpp"

namespace shapeid::app {
namespace {

using fast::Identifier;
using fast::Outcome;

// s: a stance. What contacts do differently from the model lasts no longer; until it is learned how
// long, it is taken to last as long.
constexpr double stance = 0.1;
// s: of which the filter's mean is averaged, to measure pulls against. Long beside what the filter
// itself remembers, a stance at most, or what lasts a stance would be hidden; short beside the
// seconds in which it learns what windows before could not say.
constexpr double lately = 3.0 * stance;
// s: over which the variance of the rows is learned. Some strides.
constexpr double noise_memory = 2.0;
// s: over which it is learned how long errors last. Tens of strides.
constexpr double correlation_memory = 10.0;
// s, of windows that were asked: until then a stance is believed instead.
constexpr double correlation_start = 1.0;
// Standard deviations.
constexpr double outstanding = 3.0;
// Standard errors, and windows in a row, by which a changed mass must stand out.
constexpr double certain = 5.0;
constexpr std::size_t certain_windows = 3;
// Of the expected mass: smaller loads are left to the Kalman filter. Errors of the model make the
// mass of a third of a second wander by a tenth of this (docs/tracking.md).
constexpr double least_load = 0.08;

// Of the squares of the rows: to foretell no more is to foretell nothing. Robots whose torques are
// commands and whose contacts are derived foretell a tenth (docs/tracking.md).
constexpr double least_explained = 0.02;

// Relative, of all that a window's right-hand side went through.
constexpr double rounding = 100.0 * std::numeric_limits<double>::epsilon();

std::size_t windows_in(double seconds, double window) {
  return std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(seconds / window)));
}

void append_shapes(const BodyModel& model, fast::MassSolver& solver) {
  const Eigen::MatrixXd U = shape_columns(model);
  const Eigen::VectorXd V = shape_volumes(model);
  for (Eigen::Index j = 0; j < U.cols(); ++j) {
    const int link = model.shapes[static_cast<std::size_t>(j)].link;
    const auto place = std::find(model.free_links.begin(), model.free_links.end(), link) -
                       model.free_links.begin();
    static_cast<void>(
        solver.append(static_cast<int>(place), U.col(j).segment<10>(10 * place), V[j]));
  }
}

/// Windows that the longer one is made of. What they take, in memory and in a checkpoint, is
/// limited before the first one comes.
std::size_t recent_windows(const EstimateSettings& settings, double window_seconds) {
  constexpr double most_numbers = 1e7;  // of eight bytes, and of some twenty in a checkpoint
  const double size = static_cast<double>(settings.natural_size.size()) + 1.0;
  const double most = most_numbers / (fast::SlidingTriangle::triangles_a_block * size * size);
  if (settings.recent > most * window_seconds) {
    throw InputError(
        fmt::format("--recent {:g}: {:.0f} windows of {} parameters are kept", settings.recent,
                    settings.recent / window_seconds, settings.natural_size.size()),
        fmt::format("at most {:.3g} s here, or longer windows", most * window_seconds));
  }
  return windows_in(settings.recent, window_seconds);
}

/// Of the forces and moments that all contacts of a link together can give it: a point gives three,
/// two points five, what else there is six.
Eigen::Index numbers_on(const Robot& robot, const Sample& sample, int link) {
  constexpr double same = 1e-6;  // m
  constexpr Eigen::Index of_a_point = 3, of_a_line = 5, of_all = 6;
  std::vector<Eigen::Vector3d> places;
  Eigen::Index numbers = 0;
  for (std::size_t c = 0; c < sample.in_contact.size(); ++c) {
    const Contact& contact = robot.contacts[c];
    if (!sample.in_contact[c] || contact.link != link) continue;
    const Eigen::Vector3d place = contact.frame.translation();
    const bool is_there = std::any_of(places.begin(), places.end(), [&](const auto& other) {
      return (place - other).norm() < same;
    });
    const Eigen::Index own = force_numbers(contact.kind);
    if (places.empty() || is_there) {
      numbers = std::max(numbers, own);
    } else {
      numbers = numbers == of_a_point && own == of_a_point ? of_a_line : of_all;
    }
    places.push_back(place);
  }
  return numbers;
}

/// Rows of a sample that are left when contact forces are out.
double rows_of(const Robot& robot, const Sample& sample, ContactTreatment treatment) {
  Eigen::Index rows = robot.dof();
  if (treatment != ContactTreatment::project) return static_cast<double>(rows);
  for (int link = 0; link < robot.link_count(); ++link) rows -= numbers_on(robot, sample, link);
  return static_cast<double>(std::max<Eigen::Index>(rows, 0));
}

/// The squared error that least squares leaves of a triangle's rows. Samples that never change
/// leave rounding errors, of which no window is made certain.
double left_of(const Eigen::MatrixXd& R) {
  const Eigen::Index n = R.cols() - 1;
  return std::max(R(n, n) * R(n, n), rounding * rounding * R.col(n).squaredNorm());
}

}  // namespace

Estimates::Estimates(const Robot& robot, const BodyModel& model, const EstimateSettings& settings,
                     double rate)
    : solver_(static_cast<int>(model.free_links.size()), static_cast<int>(model.shapes.size())),
      identifier_(robot, model, settings.identifier),
      robot_(robot),
      settings_(settings),
      window_seconds_(static_cast<double>(settings.identifier.window) / rate),
      samples_in_stance_(rate * stance),
      correlation_(std::max(1.0, samples_in_stance_)),
      windows_in_recent_(recent_windows(settings, window_seconds_)),
      noise_(windows_in(noise_memory, window_seconds_)),
      recent_block_(settings.natural_size.size()),
      sliding_(settings.natural_size.size(), windows_in_recent_),
      tracker_(Eigen::VectorXd::Zero(settings.natural_size.size()), settings.natural_size,
               settings.wander * settings.natural_size),
      recent_(Eigen::VectorXd::Zero(settings.natural_size.size())),
      tracked_(recent_),
      lately_{recent_} {
  append_shapes(model, solver_);
  mass_variance_ = prior_variance_ = total_variance();
}

Identifier::Fed Estimates::feed(const Sample& sample, bool repeats) {
  change_.reset();
  const Identifier::Fed fed = identifier_.feed(sample);
  if (fed == Identifier::Fed::sample_declined) return fed;
  const double rows = rows_of(robot_, sample, settings_.identifier.contacts);
  rows_.all += rows;
  if (!repeats) rows_.changing += rows;
  if (fed == Identifier::Fed::kept) return fed;
  if (fed == Identifier::Fed::answered) take_window(sample.time);
  rows_ = {};
  return fed;
}

void Estimates::forget_samples() {
  identifier_.forget_samples();
  rows_ = {};
  disagreeing_ = 0;
  pulls_.clear();
  lately_.windows = 0;
}

void Estimates::take_window(double time) {
  // Without any force (drives that are off) a window has no scale, neither of errors nor of lambda.
  const Eigen::MatrixXd& R = identifier_.window().R();
  if (!identifier_.lambda() || R.col(R.cols() - 1).isZero(0.0)) return;
  learn_noise();
  recent_block_.assign(identifier_.window());
  // One that stands out weighs as much less as it is noisier.
  recent_block_.forget(noise_.last() > 0.0 ? noise_.usual() / noise_.last() : 1.0);
  sliding_.push(recent_block_);
  recent_rows_.push_back(rows_);
  if (recent_rows_.size() > windows_in_recent_) recent_rows_.pop_front();
  // Here and below: what the tracker cannot take is as if it had not been said.
  static_cast<void>(tracker_.drift(window_seconds_));
  learn_correlation();
  learn_explained();
  measure();
  static_cast<void>(solve(sliding_.triangle().R(), recent_));
  static_cast<void>(solve(tracker_.rows().R(), tracked_));
  watch_load(time);
}

/// From what least squares leaves of the window. One that has hardly more rows than unknowns is
/// explained whatever they say: then by the longer window before it, and as long as that is as
/// short, all that the rows say may be noise. Rows that repeat others are no further ones: they
/// repeat their errors too, and leave nothing, however wrong they are. So while a robot rests
/// behind sensors that round, nothing is learned.
void Estimates::learn_noise() {
  constexpr double enough = 10.0;
  const Eigen::MatrixXd& R = identifier_.window().R();
  const auto unknowns = static_cast<double>(R.cols() - 1);
  const double needed = unknowns + enough;
  Rows before;
  for (const Rows& rows : recent_rows_) {
    before.all += rows.all;
    before.changing += rows.changing;
  }
  const double all_noise = R.col(R.cols() - 1).squaredNorm() / std::max(rows_.all, 1.0);
  if (rows_.changing >= needed) {
    noise_.learn(left_of(R) / (rows_.changing - unknowns));
  } else if (before.changing >= needed) {
    noise_.learn(left_of(sliding_.triangle().R()) / (before.changing - unknowns));
  } else if (std::max(rows_.all, before.all) >= needed) {
    noise_.suppose(all_noise);
  } else {
    noise_.learn(all_noise);
  }
  ++windows_;
}

/// How far a window pulls at the total mass is a sum over its rows, measured here by the standard
/// deviation that it would have if their noise were white. Its mean square, covariances with the
/// windows of a stance before included (Newey and West 1987), is how many samples say as much as
/// one. It pulls away from where the filter was lately, on the whole: where it is now it has
/// followed the noise that the next window repeats, and the pulls would hide it. What is not known
/// at first and a load pull as well: no window is asked before that mean is whole, what stands out
/// is cut off, and forgotten once a load is seen.
void Estimates::learn_correlation() {
  if (windows_ <= windows_in_recent_ || found_ || disagreeing_ > 0) return;
  const Eigen::MatrixXd& R = identifier_.window().R();
  const Eigen::Index n = R.cols() - 1;
  Eigen::VectorXd total = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; i += 10) total[i] = 1.0;
  const Eigen::VectorXd v = R.topLeftCorner(n, n) * (tracker_.covariance() * total);
  const double white = noise_.last() * v.squaredNorm();
  if (!(white > 0.0)) return;
  const Eigen::VectorXd now = tracker_.mean();
  if (lately_.windows == 0) lately_.mean = now;
  const std::size_t whole = windows_in(lately, window_seconds_);
  const bool is_whole = lately_.windows == whole;
  lately_.windows = std::min(lately_.windows + 1, whole);
  lately_.mean += (now - lately_.mean) / static_cast<double>(lately_.windows);
  if (!is_whole) return;
  const double raw = v.dot(R.col(n).head(n) - R.topLeftCorner(n, n) * lately_.mean);
  const double limit = outstanding * std::sqrt(correlation_);
  const double pull = std::clamp(raw / std::sqrt(white), -limit, limit);
  const std::size_t lags = windows_in(stance, window_seconds_);
  double square = pull * pull;
  for (std::size_t k = 0; k < pulls_.size(); ++k) {
    const double weight = 1.0 - static_cast<double>(k + 1) / static_cast<double>(lags + 1);
    square += 2.0 * weight * pull * pulls_[k];
  }
  pulls_.push_front(pull);
  if (pulls_.size() > lags) pulls_.pop_back();

  const auto learned = static_cast<double>(++asked_);
  mean_square_ += (square - mean_square_) / std::min(learned, correlation_memory / window_seconds_);
  set_correlation();
}

/// By few windows, of which one may be half under a load, it would jump, and hide the load.
void Estimates::set_correlation() {
  const bool is_learned = static_cast<double>(asked_) * window_seconds_ >= correlation_start;
  correlation_ = std::max(1.0, is_learned ? mean_square_ : samples_in_stance_);
}

/// By the answer from before the window, which has not seen its rows. Those that are left whatever
/// the parameters are say nothing here. Windows count alike, however large their forces and noise.
void Estimates::learn_explained() {
  const Eigen::MatrixXd& R = identifier_.window().R();
  const Eigen::Index n = R.cols() - 1;
  const auto c = R.col(n).head(n);
  const double asked = c.squaredNorm();
  if (windows_ <= windows_in_recent_ || !(asked > 0.0)) return;
  const double left = (R.topLeftCorner(n, n) * tracked_ - c).squaredNorm();
  const auto learned = static_cast<double>(windows_ - windows_in_recent_);
  const double steps = std::min(learned, noise_memory / window_seconds_);
  // One window is worth no more against an answer than for it.
  explained_ += (std::max(1.0 - left / asked, -1.0) - explained_) / steps;
  ever_explained_ = ever_explained_ || explains();
}

bool Estimates::explains() const { return explained_ > least_explained; }

bool Estimates::finds_no_mass() const { return !explains() && contradicts_rows(); }

/// Masses that hold to m >= 0 are as far from what the filter believes as its rows say, in standard
/// deviations. Noise alone takes them so far in each direction by one.
bool Estimates::contradicts_rows() const {
  if (windows_ <= windows_in_recent_) return false;
  const Eigen::MatrixXd& R = tracker_.rows().R();
  const Eigen::Index n = tracked_.size();
  const double distance = (R.topLeftCorner(n, n) * tracked_ - R.col(n).head(n)).norm();
  return distance > std::sqrt(static_cast<double>(n)) + certain;
}

bool Estimates::asks_too_much() const {
  return windows_ > windows_in_recent_ &&
         total_mass(recent_) > reference::most_times_expected * settings_.identifier.expected_mass;
}

bool Estimates::fills_recent() const {
  return windows_ > windows_in_recent_ && recent_rows_.size() == windows_in_recent_;
}

/// From no masses on: the answer depends on the rows alone. If the solver declines, the last answer
/// stays.
bool Estimates::solve(const Eigen::MatrixXd& R, Eigen::VectorXd& Phi) {
  solver_.set_lambda(*identifier_.lambda());
  solver_.forget_masses();
  if (solver_.solve(R) != Outcome::solved) return false;
  Phi = solver_.Phi();
  return true;
}

double total_mass(const Eigen::VectorXd& Phi) {
  double mass = 0.0;
  for (Eigen::Index i = 0; i < Phi.size(); i += 10) mass += Phi[i];
  return mass;
}

double Estimates::mass_by_rows() const { return total_mass(tracker_.mean()); }

double Estimates::total_variance() const {
  const Eigen::MatrixXd P = tracker_.covariance();
  double variance = 0.0;
  for (Eigen::Index i = 0; i < P.rows(); i += 10) {
    for (Eigen::Index k = 0; k < P.cols(); k += 10) variance += P(i, k);
  }
  return variance;
}

/// The filter's own covariance allows, at every window, for what the mass may have wandered since
/// the last; a mass that rests is known better. With the gain g of the total mass, what was wrong
/// before counts by 1 - g, and the window's noise by g.
void Estimates::measure() {
  const double before = total_variance();
  static_cast<void>(tracker_.measure(identifier_.window(), noise_.last() * correlation_));
  const double after = total_variance();
  const double kept = after / before;
  mass_variance_ = kept * kept * mass_variance_ + (1.0 - kept) * after;
}

bool Estimates::rows_tell_mass() const {
  constexpr double half = 0.5;
  return mass_error() < half * std::sqrt(prior_variance_);
}

void Estimates::pass(double seconds) {
  const double before = total_variance();
  static_cast<void>(tracker_.drift(seconds));
  mass_variance_ += total_variance() - before;
}

/// Of the total mass by the longer window, which knows no more of a parameter than its natural
/// size where its rows say nothing.
double Estimates::recent_variance() const {
  const Eigen::Index n = recent_.size();
  const auto scaled =
      (sliding_.triangle().R().topLeftCorner(n, n) / std::sqrt(noise_.usual() * correlation_)) *
      settings_.natural_size.asDiagonal();
  const Eigen::MatrixXd A = scaled;
  const Eigen::MatrixXd information = A.transpose() * A + Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd total = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; i += 10) total[i] = settings_.natural_size[i];
  return total.dot(information.llt().solve(total));
}

/// kg, below which a change is not told from errors.
double Estimates::least_change(double error) const {
  return std::max(certain * error, least_load * settings_.identifier.expected_mass);
}

/// The longer window against the tracked mass from before its first row: no row is in both.
void Estimates::watch_load(double time) {
  const double now = total_mass(recent_);
  if (found_) {
    if (--settles_in_ > 0) return;
    const double error = std::sqrt(recent_variance() + found_->variance);
    const double change = now - found_->before;
    // The window was mixed by as much as the first change fell short of the whole.
    const double share = std::clamp(found_->change / change, 0.0, 1.0);
    change_ = {found_->time - share * settings_.recent, change, error, true,
               std::abs(change) > least_change(error)};
    found_.reset();
    return;
  }
  past_.push_back({total_mass(tracked_), total_variance(), mean_square_, asked_});
  if (past_.size() <= windows_in_recent_) return;
  const Past before = past_.front();
  past_.pop_front();
  const double change = now - before.mass;
  const double error = std::sqrt(recent_variance() + before.variance);
  disagreeing_ = std::abs(change) > least_change(error) ? disagreeing_ + 1 : 0;
  if (disagreeing_ < certain_windows) return;
  change_ = {time - static_cast<double>(certain_windows) * window_seconds_, change, error, false,
             true};
  found_ = {before.mass, before.variance, change, time};
  settles_in_ = windows_in_recent_;
  disagreeing_ = 0;
  past_.clear();
  sliding_.clear();
  recent_rows_.clear();
  // What the load did to the pulls is no noise.
  pulls_.clear();
  lately_.windows = 0;
  mean_square_ = before.mean_square;
  asked_ = before.asked;
  set_correlation();
  static_cast<void>(tracker_.loosen());
  mass_variance_ = total_variance();
}

}  // namespace shapeid::app

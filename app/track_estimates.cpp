#include "shapeid/app/track_estimates.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace shapeid::app {
namespace {

using fast::Identifier;
using fast::Outcome;

// Noise through a Butterworth filter of second order has the bandwidth of 1.11 cutoffs, and as many
// independent values a second as twice that.
constexpr double noise_bandwidth = 1.11;
// s: a stance. What contacts do differently from the model lasts about as long, so samples within
// one tell of it only once (docs/tracking.md has the share of intervals that hold the truth).
constexpr double stance = 0.1;
// s: over which the variance of the rows is learned. Some strides.
constexpr double noise_memory = 2.0;
// Standard errors, and windows in a row, by which a changed mass must stand out.
constexpr double certain = 5.0;
constexpr std::size_t certain_windows = 3;
// Of the expected mass: smaller loads are left to the Kalman filter. Errors of the model make the
// mass of a third of a second wander by a tenth of this (docs/tracking.md).
constexpr double least_load = 0.08;

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

/// Rows of a sample that are left when contact forces are out.
double rows_of(const Robot& robot, const Sample& sample, ContactTreatment treatment) {
  double rows = robot.dof();
  if (treatment != ContactTreatment::project) return rows;
  for (std::size_t c = 0; c < sample.in_contact.size(); ++c) {
    if (!sample.in_contact[c]) continue;
    const ContactKind kind = robot.contacts[c].kind;
    rows -= kind == ContactKind::point ? 3.0 : kind == ContactKind::line ? 5.0 : 6.0;
  }
  return std::max(rows, 0.0);
}

}  // namespace

Estimates::Estimates(const Robot& robot, const BodyModel& model, const EstimateSettings& settings,
                     double rate)
    : robot_(robot),
      settings_(settings),
      window_seconds_(static_cast<double>(settings.identifier.window) / rate),
      correlation_(rate *
                   std::max({1.0 / rate, 1.0 / (2.0 * noise_bandwidth * settings.cutoff), stance})),
      windows_in_recent_(windows_in(settings.recent, window_seconds_)),
      identifier_(robot, model, settings.identifier),
      sliding_(settings.natural_size.size(), windows_in_recent_),
      tracker_(Eigen::VectorXd::Zero(settings.natural_size.size()), settings.natural_size,
               settings.wander * settings.natural_size),
      solver_(static_cast<int>(model.free_links.size()), static_cast<int>(model.shapes.size())),
      recent_(Eigen::VectorXd::Zero(settings.natural_size.size())),
      tracked_(recent_) {
  append_shapes(model, solver_);
}

Identifier::Fed Estimates::feed(const Sample& sample) {
  change_.reset();
  const Identifier::Fed fed = identifier_.feed(sample);
  if (fed == Identifier::Fed::sample_declined) return fed;
  rows_ += rows_of(robot_, sample, settings_.identifier.contacts);
  if (fed != Identifier::Fed::answered) return fed;
  take_window(sample.time);
  rows_ = 0.0;
  return fed;
}

void Estimates::forget_samples() {
  identifier_.forget_samples();
  rows_ = 0.0;
  disagreeing_ = 0;
}

void Estimates::take_window(double time) {
  learn_noise();
  const fast::Triangle& window = identifier_.window();
  sliding_.push(window);
  tracker_.drift(window_seconds_);
  tracker_.measure(window, noise_ * correlation_);
  static_cast<void>(solve(sliding_.triangle().R(), recent_));
  static_cast<void>(solve(tracker_.rows().R(), tracked_));
  watch_load(time);
}

/// From what least squares leaves of the window: the last entry of its triangle.
void Estimates::learn_noise() {
  const Eigen::MatrixXd& R = identifier_.window().R();
  const Eigen::Index n = R.cols() - 1;
  const double left = std::max(rows_ - static_cast<double>(n), 1.0);
  const double variance = R(n, n) * R(n, n) / left;
  ++windows_;
  const double most = noise_memory / window_seconds_;
  const double share = 1.0 / std::min(static_cast<double>(windows_), most);
  noise_ += share * (variance - noise_);
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

double Estimates::mass_error() const {
  const Eigen::MatrixXd P = tracker_.covariance();
  double variance = 0.0;
  for (Eigen::Index i = 0; i < P.rows(); i += 10) {
    for (Eigen::Index k = 0; k < P.cols(); k += 10) variance += P(i, k);
  }
  return std::sqrt(variance);
}

/// Of the total mass by the longer window, which knows no more of a parameter than its natural
/// size where its rows say nothing.
double Estimates::recent_variance() const {
  const Eigen::Index n = recent_.size();
  const auto scaled =
      (sliding_.triangle().R().topLeftCorner(n, n) / std::sqrt(noise_ * correlation_)) *
      settings_.natural_size.asDiagonal();
  const Eigen::MatrixXd A = scaled;
  const Eigen::MatrixXd information = A.transpose() * A + Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd total = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; i += 10) total[i] = settings_.natural_size[i];
  return total.dot(information.llt().solve(total));
}

/// The longer window against the tracked mass from before its first row: no row is in both.
void Estimates::watch_load(double time) {
  const double now = total_mass(recent_);
  const double tracked_error = mass_error();
  const double error = std::sqrt(recent_variance() + tracked_error * tracked_error);
  const double least = std::max(certain * error, least_load * settings_.identifier.expected_mass);
  if (found_) {
    if (--settles_in_ > 0) return;
    const double change = now - found_->before;
    // The window was mixed by as much as the first change fell short of the whole.
    const double share = std::clamp(found_->change / change, 0.0, 1.0);
    change_ = {found_->time - share * settings_.recent, change, error, true,
               std::abs(change) > least};
    found_.reset();
    return;
  }
  masses_.push_back(total_mass(tracked_));
  if (masses_.size() <= windows_in_recent_) return;
  const double before = masses_.front();
  masses_.pop_front();
  disagreeing_ = std::abs(now - before) > least ? disagreeing_ + 1 : 0;
  if (disagreeing_ < certain_windows) return;
  const double change = now - before;
  change_ = {time - static_cast<double>(certain_windows) * window_seconds_, change, error, false,
             true};
  found_ = {before, change, time};
  settles_in_ = windows_in_recent_;
  disagreeing_ = 0;
  masses_.clear();
  sliding_.clear();
  tracker_.loosen();
}

}  // namespace shapeid::app

#include "shapeid/fast/identifier.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "shapeid/models/error.hpp"
#include "shapeid/models/online_numbers.hpp"

namespace shapeid::fast {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) noexcept {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

const IdentifierSettings& checked(const IdentifierSettings& settings, const Robot& robot,
                                  const BodyModel& model) {
  check_sought(robot, model);
  check_online(
      {settings.window, settings.stride, settings.alpha, settings.expected_mass, settings.lambda});
  if (settings.mass_bound &&
      (!(*settings.mass_bound > 0.0) || !std::isfinite(*settings.mass_bound))) {
    throw InputError("the mass bound is no positive number", "kg, of all free shapes together");
  }
  return settings;
}

/// Squares of the weight beyond which forces are none of a robot's, see Identifier. Legs carry and
/// throw some weights of their robot; the rest is for links whose masses are unknown or expected
/// wrongly.
constexpr double most_share_of_weight = 100.0 * 100.0;

DivisionOptions options_of(const IdentifierSettings& settings) {
  DivisionOptions options = settings.division;
  options.expected_mass = settings.expected_mass;
  if (const Violation reason = why_senseless(options)) {
    throw InputError(*reason, "see DivisionOptions");
  }
  return options;
}

}  // namespace

Identifier::Identifier(const Robot& robot, const BodyModel& model,
                       const IdentifierSettings& settings)
    : joints_(robot.joint_count()),
      contacts_(robot.contacts.size()),
      division_(model, options_of(checked(settings, robot, model))),
      block_(std::gcd(settings.window, settings.stride)),
      window_(settings.window),
      stride_(settings.stride),
      warm_(settings.warm),
      alpha_(settings.alpha),
      expected_mass_(settings.expected_mass),
      mass_bound_(settings.mass_bound.value_or(10.0 * settings.expected_mass)),
      lambda_(settings.lambda),
      squares_of_weight_(squares_of_weight(model, settings.expected_mass, settings.window,
                                           online_weight(settings.weight, robot.dof()))),
      volume_(shape_volumes(model).sum()),
      rows_(robot, model, settings.contacts, online_weight(settings.weight, robot.dof())),
      last_window_(10 * static_cast<Eigen::Index>(model.free_links.size())),
      Phi_(Eigen::VectorXd::Zero(10 * static_cast<Eigen::Index>(model.free_links.size()))),
      filtered_(Phi_) {
  if (block_ < window_) sliding_.emplace(Phi_.size(), window_ / block_);
}

Identifier::Fed Identifier::feed(const Sample& sample) noexcept {
  const Clock::time_point start = Clock::now();
  if (!has_sizes(sample, joints_, contacts_) || rows_.add(sample) != Verdict::taken) {
    return Fed::sample_declined;
  }
  ++since_last_;
  if (++in_block_ == block_) {
    if (sliding_) sliding_->push(rows_.triangle());
    in_window_ = std::min(in_window_ + block_, window_);
  }
  const bool complete = in_block_ == block_ && in_window_ == window_ && since_last_ >= stride_;
  bool solved = false;
  if (complete) {
    last_window_.assign(sliding_ ? sliding_->triangle() : rows_.triangle());
    solved = solve(last_window_.R());
  }
  if (in_block_ == block_) {
    by_six_rows_ += rows_.samples_by_six_rows();
    rows_.clear();
    in_block_ = 0;
  }

  const double spent = seconds_since(start);
  spent_ += spent;
  if (!complete) {
    slowest_ = std::max(slowest_, spent);
    return Fed::kept;
  }
  if (solved) answer_.time = sample.time;
  answer_.seconds = spent_;
  answer_.slowest_sample = slowest_;
  answer_.last_call = spent;
  since_last_ = 0;
  spent_ = 0.0;
  slowest_ = 0.0;
  return solved ? Fed::answered : Fed::window_declined;
}

void Identifier::forget_samples() noexcept {
  by_six_rows_ += rows_.samples_by_six_rows();
  spent_ = slowest_ = 0.0;
  rows_.clear();
  if (sliding_) sliding_->clear();
  in_block_ = in_window_ = since_last_ = 0;
}

bool Identifier::solve(const Eigen::MatrixXd& R) noexcept {
  // || b ||^2 is the sum of squares of the triangle's last column.
  const double squares = R.col(R.cols() - 1).squaredNorm();
  if (!(squares <= most_share_of_weight * squares_of_weight_)) {
    outcome_ = Outcome::out_of_scale;
    return false;
  }
  // default_lambda()
  const double lambda =
      lambda_.value_or(1e-12 * squares * volume_ / (expected_mass_ * expected_mass_));
  division_.set_lambda(lambda);
  outcome_ = division_.start(R, warm_ ? Division::Start::last_masses : Division::Start::no_masses);
  if (outcome_ != Outcome::solved) return false;
  if (squares >= least_share_of_weight * squares_of_weight_) lambda_ = lambda;
  int iterations = division_.masses().iterations();
  answer_.stopped_by = division_.run();
  for (const Division::Cut& cut : division_.history()) iterations += cut.iterations;

  const MassSolver& masses = division_.masses();
  answer_.value = masses.value();
  answer_.gap = masses.gap(mass_bound_);
  answer_.iterations = iterations;
  answer_.divisions = static_cast<int>(division_.history().size());
  Phi_ = masses.Phi();
  const double alpha = has_answer_ ? alpha_ : 1.0;
  filtered_ = alpha * Phi_ + (1.0 - alpha) * filtered_;  // (17)
  has_answer_ = true;
  return true;
}

}  // namespace shapeid::fast

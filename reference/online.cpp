#include "shapeid/reference/online.hpp"

#include <utility>

#include "shapeid/models/online_numbers.hpp"
#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::reference {
namespace {

OnlineSettings checked(OnlineSettings settings, const Robot& robot, const BodyModel& model) {
  check_sought(robot, model);
  check_online(
      {settings.window, settings.stride, settings.alpha, settings.expected_mass, settings.lambda});
  return settings;
}

}  // namespace

OnlineIdentifier::OnlineIdentifier(const Robot& robot, BodyModel model, OnlineSettings settings)
    : model_(std::move(model)),
      settings_(checked(std::move(settings), robot, model_)),
      rows_(robot, model_, settings_.contacts, online_weight(settings_.weight, robot.dof())),
      filter_(settings_.alpha),
      squares_of_weight_(squares_of_weight(model_, settings_.expected_mass, settings_.window,
                                           online_weight(settings_.weight, robot.dof()))),
      masses_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model_.shapes.size()))) {}

std::optional<OnlineResult> OnlineIdentifier::feed(const Sample& sample) {
  recent_.push_back(sample);
  if (recent_.size() > settings_.window) recent_.pop_front();
  ++since_last_;
  if (recent_.size() < settings_.window || since_last_ < settings_.stride) return std::nullopt;
  since_last_ = 0;

  rows_.clear();
  for (const Sample& s : recent_) rows_.add(s);
  MassProblem problem = rows_.problem(model_);
  problem.lambda =
      settings_.lambda ? *settings_.lambda : default_lambda(problem, settings_.expected_mass);

  OnlineResult result{sample.time, solve_masses(problem, masses_), {}};
  const double squares = problem.F.dot(problem.W.cwiseProduct(problem.F));
  if (squares >= least_share_of_weight * squares_of_weight_) settings_.lambda = problem.lambda;
  masses_ = result.solution.m;
  result.filtered = filter_.update(result.solution.Phi);
  return result;
}

}  // namespace shapeid::reference

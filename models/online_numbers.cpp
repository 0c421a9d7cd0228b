#include "shapeid/models/online_numbers.hpp"

#include <cmath>

#include "shapeid/models/error.hpp"

namespace shapeid {

void check_online(const OnlineNumbers& numbers) {
  if (numbers.window == 0 || numbers.stride == 0) {
    throw InputError("a window or stride of no samples", "both count samples, at least 1");
  }
  if (numbers.window > longest_window || numbers.stride > longest_window) {
    throw InputError("a window or stride of more than a billion samples", "some dozens");
  }
  constexpr double lightest = 1e-6, heaviest = 1e6;
  if (!(numbers.expected_mass >= lightest && numbers.expected_mass <= heaviest)) {
    throw InputError("the expected mass is not from 1e-6 to 1e6 kg",
                     "kg, of all free shapes together");
  }
  if (!(numbers.alpha > 0.0 && numbers.alpha <= 1.0)) {
    throw InputError("alpha of filter (17) is not in (0, 1]", "1 does not smooth");
  }
  if (numbers.lambda && (!(*numbers.lambda >= 0.0) || !std::isfinite(*numbers.lambda))) {
    throw InputError("lambda is negative, or no number", "zero or positive");
  }
}

Eigen::VectorXd online_weight(const Eigen::VectorXd& given, Eigen::Index dof) {
  Eigen::VectorXd weight = given.size() > 0 ? given : Eigen::VectorXd::Ones(dof).eval();
  if (weight.size() != dof || !(weight.array() > 0.0).all() || !weight.allFinite()) {
    throw InputError("the weight is not a positive number for each of the robot's equations",
                     "one entry a generalised coordinate, 1 / sigma^2");
  }
  if (dof == 0) return weight;  // a fixed base without joints has no equations
  constexpr double smallest = 1e-100, largest = 1e100;  // squares of what they weigh are numbers
  if (!(weight.minCoeff() >= smallest && weight.maxCoeff() <= largest)) {
    throw InputError("the weight's numbers are not from 1e-100 to 1e100",
                     "1 / sigma^2 of each equation, in SI units");
  }
  constexpr double widest = 1.000001e12;  // twelve decades, however they are rounded
  if (!(weight.maxCoeff() <= widest * weight.minCoeff())) {
    throw InputError("the weight's numbers are more than twelve decades apart",
                     "1 / sigma^2 of each equation, in SI units");
  }
  return weight;
}

double squares_of_weight(const BodyModel& model, double expected_mass, std::size_t window,
                         const Eigen::VectorXd& weight) {
  constexpr double gravity = 9.81;
  double mass = expected_mass;
  for (Eigen::Index i = 0; i < model.known.size(); i += 10) mass += std::abs(model.known[i]);
  const double force = gravity * mass;
  return force * force * static_cast<double>(window) * weight.sum();
}

void check_sought(const Robot& robot, const BodyModel& model) {
  if (const Violation reason = why_malformed(robot)) {
    throw InputError("the robot is malformed: " + *reason,
                     "links after their parents, axes of length one, contacts on links");
  }
  if (const Violation reason = why_malformed(model, robot)) {
    throw InputError("the model is not this robot's: " + *reason,
                     "make it for the robot that is given");
  }
  if (!model.known.allFinite()) {
    throw InputError("a known parameter is not finite", "zeros for a link that is sought");
  }
  if (robot.root == Root::fixed && !model.free_links.empty() && model.free_links.front() == 0) {
    throw InputError("the base of a robot that does not move is sought",
                     "links that move: no torque shows the base's masses");
  }
}

}  // namespace shapeid

#include "shapeid/models/online_numbers.hpp"

#include <cmath>

#include "shapeid/models/error.hpp"

namespace shapeid {

void check_online(const OnlineNumbers& numbers) {
  if (numbers.window == 0 || numbers.stride == 0) {
    throw InputError("a window or stride of no samples", "both count samples, at least 1");
  }
  constexpr std::size_t longest = 1'000'000'000;  // a negative number in C comes as more
  if (numbers.window > longest || numbers.stride > longest) {
    throw InputError("a window or stride of more than a billion samples", "some dozens");
  }
  if (!(numbers.expected_mass > 0.0) || !std::isfinite(numbers.expected_mass)) {
    throw InputError("the expected mass is no positive number", "kg, of all free shapes together");
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
  if (weight.size() == dof && (weight.array() > 0.0).all() && weight.allFinite()) return weight;
  throw InputError("the weight is not a positive number for each of the robot's equations",
                   "one entry a generalised coordinate, 1 / sigma^2");
}

}  // namespace shapeid

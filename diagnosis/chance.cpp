#include "shapeid/diagnosis/chance.hpp"

#include <unsupported/Eigen/SpecialFunctions>

#include <algorithm>
#include <cmath>

namespace shapeid::diagnosis {
namespace {

constexpr int halvings = 60;

}  // namespace

double least_z(double probability, double parameters) {
  const double each = probability / std::max(parameters, 1.0);
  double lower = 0.0, upper = 20.0;
  for (int i = 0; i < halvings; ++i) {
    const double z = 0.5 * (lower + upper);
    (std::erfc(z / std::sqrt(2.0)) > each ? lower : upper) = z;
  }
  return upper;
}

double least_squares_sum(double probability, Eigen::Index numbers) {
  const double half = 0.5 * static_cast<double>(numbers);
  double lower = 0.0, upper = 1000.0 + 4.0 * half;
  for (int i = 0; i < halvings; ++i) {
    const double x = 0.5 * (lower + upper);
    (Eigen::numext::igammac(half, 0.5 * x) > probability ? lower : upper) = x;
  }
  return upper;
}

double both(double blocks, double squares) {
  constexpr double most = 1.5;
  return std::sqrt(std::max(blocks, 0.0) * std::min(std::sqrt(std::max(squares, 0.0)), most));
}

}  // namespace shapeid::diagnosis

// A log that asks for no mass where some is sought.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace shapeid::app {

/// Whether these links (10 numbers each in Phi, kg first) have together less than a thousandth of
/// what is expected: what bounds that are active leave, or shapes a thousand times too large. No
/// links are asked for none.
[[nodiscard]] inline bool is_no_mass(const Eigen::VectorXd& Phi, const std::vector<int>& links,
                                     double expected_mass) {
  if (links.empty()) return false;
  constexpr double nothing = 1e-3;
  double found = 0.0;
  for (const int link : links) found += Phi[Eigen::Index{10} * link];
  return !(found > nothing * expected_mass);
}

/// Of the refusal "no-mass", behind what was seen.
inline constexpr const char* causes_of_no_mass =
    "the sign of the torques or of the accelerometer is wrong, the given inertias are too large, "
    "what carries the robot is no contact of it, or lengths of shapes or contacts are no metres";

}  // namespace shapeid::app

// Two arms on a table, no link like another: what is found for one link fits no other one.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"

namespace shapeid::test {

/// m, sides along the axes of the link.
struct PlacedBox {
  Eigen::Vector3d centre, sides;
};

/// kg, of the two boxes that a link is made of.
using BoxMasses = std::array<double, 2>;

/// The table l0, which has no mass, and l1, ..., l12: odd ones are one arm, even ones the other.
inline constexpr int links_of_arms = 13;

/// kg, a link: all different.
[[nodiscard]] std::vector<BoxMasses> masses_of_arms();

[[nodiscard]] std::array<PlacedBox, 2> boxes_of_arm(int link);

/// Of a link whose two boxes weigh this.
[[nodiscard]] InertialParameters arm_link(int link, const BoxMasses& masses);

/// The boxes are the collision geometry, so that their masses are what `identify --free` seeks.
[[nodiscard]] std::string arms_urdf(const std::vector<BoxMasses>& masses);

/// Standard deviation of what is added to the torques, N m, of odd and of even joints.
struct NoiseOfArms {
  double odd = 0.0, even = 0.0;
};

[[nodiscard]] Robot read_arms(const std::string& path);

[[nodiscard]] constexpr std::size_t at(int link) { return static_cast<std::size_t>(link); }

/// Moves arms of these masses and logs it exactly, torques as Simbody has them but for the noise,
/// to NAME.csv in scratch().
void write_arms_log(const std::string& name, const std::vector<BoxMasses>& masses,
                    const NoiseOfArms& noise);

}  // namespace shapeid::test

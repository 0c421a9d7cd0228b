// Cases of the vectors, one function a kind. Everything is drawn from a seed, so that the files can
// be made again bit for bit.
#pragma once

#include <Eigen/Geometry>

#include <nlohmann/json.hpp>

#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::vectors {

/// Of an expected number: how far a correct program in doubles may be from it, relative to the size
/// of the terms it is computed from. Good formulas need a few hundred eps, 1e-13.
inline constexpr double forgiven = 1e-11;

/// As in URDF.
[[nodiscard]] Eigen::Isometry3d pose_of(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy);

[[nodiscard]] nlohmann::json convert_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json moments_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json regressor_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json projection_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json masses_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json division_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json certify_cases(test::Draw& draw);

/// Names of the cases' flags, each with what it means and when a difference is no bug.
[[nodiscard]] nlohmann::json flags();

}  // namespace shapeid::vectors

// Cases of the vectors, one function a kind. Everything is drawn from a seed, so that the files can
// be made again bit for bit.
#pragma once

#include <Eigen/Geometry>

#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::vectors {

/// Of an expected number: how far a correct program in doubles may be from it, relative to the size
/// of the terms it is computed from. Good formulas need a few hundred eps, 1e-13.
inline constexpr double forgiven = 1e-11;

/// As in URDF.
[[nodiscard]] Eigen::Isometry3d pose_of(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy);

/// Asymmetric, turned, off the origin.
[[nodiscard]] InertialParameters drawn_body(test::Draw& draw);

[[nodiscard]] Eigen::MatrixXd drawn_matrix(test::Draw& draw, Eigen::Index rows,
                                           Eigen::Index columns);

/// The sizes of a body's ten parameters: its mass, times its reach (m), times its reach squared.
[[nodiscard]] Eigen::VectorXd sizes_of(double mass, double reach);

/// A case that asks for one list of numbers, each `forgiven` relative to its size.
[[nodiscard]] nlohmann::json number_case(const nlohmann::json& input, const std::string& name,
                                         const Eigen::VectorXd& expected,
                                         const Eigen::VectorXd& sizes);
/// The same with one size for all.
[[nodiscard]] nlohmann::json number_case(const nlohmann::json& input, const std::string& name,
                                         const Eigen::VectorXd& expected, double size);

[[nodiscard]] nlohmann::json convert_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json existence_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json moments_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json regressor_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json robot_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json projection_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json masses_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json division_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json run_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json load_cases(test::Draw& draw);
[[nodiscard]] nlohmann::json certify_cases(test::Draw& draw);

/// Names of the cases' flags, each with what it means and when a difference is no bug.
[[nodiscard]] nlohmann::json flags();

}  // namespace shapeid::vectors

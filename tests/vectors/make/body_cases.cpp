// Cases of one body: orders of its parameters, whether it can exist, its equations of motion.
#include <string>

#include "shapeid/models/orders.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/tests/vectors/make/cases.hpp"

namespace shapeid::vectors {
namespace {

using nlohmann::json;

/// A body of these principal moments (kg m^2) about its centre, turned and off the origin.
InertialParameters with_principal_moments(test::Draw& draw, double mass,
                                          const Eigen::Vector3d& principal) {
  const Eigen::Matrix3d tensor = principal.asDiagonal();
  const Eigen::Vector3d xyz = draw.vector(0.2), rpy = draw.vector(3.0);
  return moved(from_centre(mass, Eigen::Vector3d::Zero(), tensor), pose_of(xyz, rpy));
}

json existence_case(const InertialParameters& body, bool exists, const std::string& flag) {
  return {{"flags", json::array({flag})},
          {"input", {{"parameters", vector_json(body.values)}}},
          {"expected", {{"exists", exists}}}};
}

}  // namespace

Eigen::Isometry3d pose_of(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = xyz;
  pose.linear() = rotation_from_rpy(rpy);
  return pose;
}

InertialParameters drawn_body(test::Draw& draw) {
  const Eigen::Vector3d sides = draw.sides(0.1, 0.5), rpy = draw.vector(3.0),
                        centre = draw.vector(0.3);
  const double mass = draw.between(0.5, 20.0);
  return moved(test::cuboid_body(mass, centre, sides), pose_of(Eigen::Vector3d::Zero(), rpy));
}

Eigen::MatrixXd drawn_matrix(test::Draw& draw, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd M(rows, columns);
  for (double& x : M.reshaped()) x = draw.sign();
  return M;
}

Eigen::VectorXd sizes_of(double mass, double reach) {
  Eigen::VectorXd sizes(10);
  sizes << mass, Eigen::Vector3d::Constant(mass * reach),
      Eigen::VectorXd::Constant(6, mass * reach * reach);
  return sizes;
}

json number_case(const json& input, const std::string& name, const Eigen::VectorXd& expected,
                 const Eigen::VectorXd& sizes) {
  return {{"flags", json::array()},
          {"input", input},
          {"expected", {{name, vector_json(expected)}}},
          {"within", {{name, vector_json(forgiven * sizes)}}}};
}

json number_case(const json& input, const std::string& name, const Eigen::VectorXd& expected,
                 double size) {
  return {{"flags", json::array()},
          {"input", input},
          {"expected", {{name, vector_json(expected)}}},
          {"within", {{name, forgiven * size}}}};
}

json convert_cases(test::Draw& draw) {
  json cases = json::array();
  for (const std::string_view from : order_names) {
    for (const std::string_view to : order_names) {
      const Order source = order_named(from), target = order_named(to);
      const InertialParameters body = drawn_body(draw);
      Eigen::VectorXd numbers = to_order(source, body);
      if (source == Order::urdf) numbers.segment<3>(4) = draw.vector(3.0);  // any frame will do
      const InertialParameters meant = from_order(source, numbers);
      // Sums of tensors about two points: no number is larger than this.
      const double size = 10.0 * numbers.cwiseAbs().maxCoeff();
      cases.push_back(number_case({{"from", from}, {"to", to}, {"numbers", vector_json(numbers)}},
                                  "numbers", to_order(target, meant), size));
    }
  }
  return cases;
}

json existence_cases(test::Draw& draw) {
  json cases = json::array();
  const auto add = [&](const InertialParameters& body, bool exists, const std::string& flag) {
    cases.push_back(existence_case(body, exists, flag));
  };
  // How far from the edge a doubtful case is: rounding of moments about another point moves them by
  // 1e-14, so doubles decide this safely.
  constexpr double margin = 1e-5;
  for (int i = 0; i < 4; ++i) {
    add(drawn_body(draw), true, "SolidBody");
    const double mass = draw.between(0.5, 5.0), a = mass * draw.between(0.001, 0.02),
                 b = mass * draw.between(0.001, 0.02);
    const auto third = [&](double c) { return with_principal_moments(draw, mass, {a, c, b}); };
    add(third((a + b) * (1.0 - margin)), true, "TriangleInequalityTight");
    add(third((a + b) * (1.0 + margin)), false, "TriangleInequalityTight");
    add(third((a + b) * 1.5), false, "TriangleInequalityBroken");

    const InertialParameters whole = drawn_body(draw);
    add(-1.0 * whole, false, "NegativeMass");
    InertialParameters light = whole;
    light.values[0] *= 0.5 * whole.first_moment().squaredNorm() / whole.mass() /
                       pseudo_inertia(whole).topLeftCorner<3, 3>().trace();
    add(light, false, "CentreOutside");
  }
  InertialParameters massless;
  add(massless, true, "Massless");  // nothing at all
  massless.values.tail<6>() << 1.0, 0.0, 0.0, 1.0, 0.0, 1.0;
  add(massless, false, "Massless");
  massless.values[1] = 0.01;
  add(massless, false, "Massless");
  return cases;
}

json regressor_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d omega = draw.vector(i == 0 ? 0.0 : 3.0), alpha = draw.vector(20.0),
                          a = Eigen::Vector3d(0.0, 0.0, 9.81) + draw.vector(5.0);
    const Eigen::Matrix<double, 6, 10> Y = test::body_rows(omega, alpha, a);
    const Eigen::VectorXd rows = Y.reshaped<Eigen::RowMajor>();
    cases.push_back(number_case({{"angular_velocity", vector_json(omega)},
                                 {"angular_acceleration", vector_json(alpha)},
                                 {"specific_force", vector_json(a)}},
                                "rows", rows, a.norm() + alpha.norm() + omega.squaredNorm()));
    if (i == 0) cases.back()["flags"].push_back("NoRotation");
  }
  return cases;
}

}  // namespace shapeid::vectors

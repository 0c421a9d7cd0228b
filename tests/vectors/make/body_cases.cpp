// Cases of one body: orders of its parameters, moments of its shapes, its equations of motion.
#include <string>
#include <vector>

#include "shapeid/models/orders.hpp"
#include "shapeid/models/shape.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/tests/vectors/make/cases.hpp"

namespace shapeid::vectors {
namespace {

using nlohmann::json;

/// Asymmetric, turned, off the origin.
InertialParameters drawn_body(test::Draw& draw) {
  const Eigen::Vector3d sides(draw.between(0.1, 0.5), draw.between(0.1, 0.5),
                              draw.between(0.1, 0.5));
  const Eigen::Isometry3d turn = pose_of(Eigen::Vector3d::Zero(), draw.vector(3.0));
  return moved(test::cuboid_body(draw.between(0.5, 20.0), draw.vector(0.3), sides), turn);
}

json number_case(const json& input, const std::string& name, const Eigen::VectorXd& expected,
                 const Eigen::VectorXd& sizes) {
  json flags = json::array();
  return {{"flags", flags},
          {"input", input},
          {"expected", {{name, vector_json(expected)}}},
          {"within", {{name, vector_json(forgiven * sizes)}}}};
}

/// The size of a unit body's terms: 1, its reach, its reach squared.
Eigen::VectorXd sizes_of(double mass, double reach) {
  Eigen::VectorXd sizes(10);
  sizes << mass, Eigen::Vector3d::Constant(mass * reach),
      Eigen::VectorXd::Constant(6, mass * reach * reach);
  return sizes;
}

json posed(const std::string& kind, const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy) {
  return {{"kind", kind}, {"xyz", vector_json(xyz)}, {"rpy", vector_json(rpy)}};
}

json moments_case(json input, const Shape& shape) {
  Eigen::VectorXd expected(11), sizes(11);
  const auto [lower, upper] = bounds(shape);
  expected << volume(shape), unit_parameters(shape).values;
  sizes << volume(shape), sizes_of(1.0, lower.cwiseAbs().cwiseMax(upper.cwiseAbs()).norm());
  return number_case(input, "volume_and_parameters", expected, sizes);
}

}  // namespace

Eigen::Isometry3d pose_of(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = xyz;
  pose.linear() = rotation_from_rpy(rpy);
  return pose;
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
      const Eigen::VectorXd expected = to_order(target, meant);
      cases.push_back(number_case({{"from", from}, {"to", to}, {"numbers", vector_json(numbers)}},
                                  "numbers", expected,
                                  Eigen::VectorXd::Constant(expected.size(), size)));
    }
  }
  return cases;
}

json moments_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d xyz = draw.vector(0.5), rpy = draw.vector(3.0);
    const Eigen::Isometry3d pose = pose_of(xyz, rpy);
    const Eigen::Vector3d size(draw.between(0.05, 0.5), draw.between(0.05, 0.5),
                               draw.between(0.05, 0.5));
    json cuboid = posed("cuboid", xyz, rpy), cylinder = posed("cylinder", xyz, rpy),
         ellipsoid = posed("ellipsoid", xyz, rpy), tetrahedron = posed("tetrahedron", xyz, rpy);
    cuboid["size"] = vector_json(size);
    cases.push_back(moments_case(cuboid, make_cuboid(size, pose)));
    cylinder["radius"] = size.x();
    cylinder["length"] = size.y();
    cases.push_back(moments_case(cylinder, make_cylinder(size.x(), size.y(), pose)));
    ellipsoid["semi_axes"] = vector_json(size);
    cases.push_back(moments_case(ellipsoid, make_ellipsoid(size, pose)));
    std::vector<Eigen::Vector3d> corners = {draw.vector(0.1), draw.vector(0.1), draw.vector(0.1)};
    corners.emplace_back(0.4 + draw.between(0.0, 0.2), 0.3, -0.3);
    for (const Eigen::Vector3d& corner : corners) {
      tetrahedron["vertices"].push_back(vector_json(corner));
    }
    cases.push_back(moments_case(tetrahedron, make_convex_hull(corners, pose)));
  }
  return cases;
}

json regressor_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d omega = draw.vector(i == 0 ? 0.0 : 3.0), alpha = draw.vector(20.0),
                          a = Eigen::Vector3d(0.0, 0.0, 9.81) + draw.vector(5.0);
    const Eigen::Matrix<double, 6, 10> Y = test::body_rows(omega, alpha, a);
    const Eigen::VectorXd rows = Y.reshaped<Eigen::RowMajor>();
    const double size = a.norm() + alpha.norm() + omega.squaredNorm();
    cases.push_back(number_case({{"angular_velocity", vector_json(omega)},
                                 {"angular_acceleration", vector_json(alpha)},
                                 {"specific_force", vector_json(a)}},
                                "rows", rows, Eigen::VectorXd::Constant(60, size)));
    if (i == 0) cases.back()["flags"].push_back("NoRotation");
  }
  return cases;
}

}  // namespace shapeid::vectors

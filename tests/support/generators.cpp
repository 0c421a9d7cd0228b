#include "shapeid/tests/support/generators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace shapeid::test {
namespace {

// rapidcheck's own doubles are few and never large: draw a 40-bit fraction instead. Shrinking
// halves it toward zero, so the mapped value walks to the anchor of its range.
constexpr std::int64_t fraction_steps = std::int64_t{1} << 40;

rc::Gen<double> signed_fraction() {
  return rc::gen::map(rc::gen::inRange<std::int64_t>(0, 2 * fraction_steps), [](std::int64_t k) {
    // Even and odd k take the two signs, so that k = 0 (the end of shrinking) is the value 0.
    const std::int64_t half = k / 2;
    const double size = static_cast<double>(half) / static_cast<double>(fraction_steps);
    return k % 2 == 0 ? size : -size;
  });
}

rc::Gen<double> fraction() {
  return rc::gen::map(signed_fraction(), [](double x) { return std::abs(x); });
}

}  // namespace

rc::Gen<double> real(double lower, double upper) {
  if (lower < 0.0 && upper > 0.0) {
    return rc::gen::map(signed_fraction(),
                        [=](double x) { return x >= 0.0 ? x * upper : -x * lower; });
  }
  return rc::gen::map(fraction(), [=](double x) { return lower + x * (upper - lower); });
}

rc::Gen<double> magnitude(double lower, double upper) {
  return rc::gen::map(real(std::log(lower), std::log(upper)), [](double x) { return std::exp(x); });
}

rc::Gen<Eigen::Vector3d> vector3(double bound) {
  return rc::gen::map(rc::gen::tuple(real(-bound, bound), real(-bound, bound), real(-bound, bound)),
                      [](const auto& t) {
                        return Eigen::Vector3d(std::get<0>(t), std::get<1>(t), std::get<2>(t));
                      });
}

rc::Gen<Eigen::VectorXd> vector(Eigen::Index size, double bound) {
  return rc::gen::map(
      rc::gen::container<std::vector<double>>(static_cast<std::size_t>(size), real(-bound, bound)),
      [](const std::vector<double>& v) -> Eigen::VectorXd {
        return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
      });
}

rc::Gen<Eigen::Vector3d> direction() {
  return rc::gen::map(vector3(1.0), [](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return v.norm() > 1e-3 ? v.normalized() : Eigen::Vector3d::UnitX();
  });
}

rc::Gen<Eigen::Matrix3d> rotation() {
  return rc::gen::map(vector3(std::numbers::pi), [](const Eigen::Vector3d& v) -> Eigen::Matrix3d {
    const double angle = v.norm();
    if (angle == 0.0) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
  });
}

rc::Gen<Eigen::Isometry3d> pose(double reach) {
  return rc::gen::map(rc::gen::pair(rotation(), vector3(reach)), [](const auto& p) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = p.first;
    T.translation() = p.second;
    return T;
  });
}

rc::Gen<InertialParameters> body() {
  // Sigma = m [[ L L^T + c c^T, c ], [ c^T, 1 ]] with L lower triangular: L L^T is the covariance
  // of the mass distribution (m^2), c its centre. Positive definite whatever the numbers are.
  const auto spread = real(0.02, 0.3);
  const auto skew = real(-0.1, 0.1);
  return rc::gen::map(
      rc::gen::tuple(magnitude(0.05, 20.0), vector3(0.4), rc::gen::tuple(spread, spread, spread),
                     rc::gen::tuple(skew, skew, skew)),
      [](const auto& t) {
        const auto& [mass, c, d, s] = t;
        Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
        L.diagonal() << std::get<0>(d), std::get<1>(d), std::get<2>(d);
        L(1, 0) = std::get<0>(s);
        L(2, 0) = std::get<1>(s);
        L(2, 1) = std::get<2>(s);
        PseudoInertia sigma;
        sigma << mass * (L * L.transpose() + c * c.transpose()), mass * c, mass * c.transpose(),
            mass;
        return from_pseudo_inertia(sigma);
      });
}

namespace {

/// Everything random about one link; its parent is parent_draw modulo the links before it, so
/// that removing links while shrinking leaves a valid tree.
rc::Gen<Link> link() {
  return rc::gen::map(rc::gen::tuple(rc::gen::inRange(0, 1 << 20),
                                     rc::gen::element(JointKind::revolute, JointKind::continuous,
                                                      JointKind::prismatic),
                                     pose(0.4), direction(), body()),
                      [](const auto& t) {
                        Link result;
                        result.parent = std::get<0>(t);
                        result.joint.kind = std::get<1>(t);
                        result.joint.placement = std::get<2>(t);
                        result.joint.axis = std::get<3>(t);
                        result.inertia = std::get<4>(t);
                        return result;
                      });
}

rc::Gen<Contact> contact() {
  return rc::gen::map(
      rc::gen::tuple(rc::gen::inRange(0, 1 << 20),
                     rc::gen::element(ContactKind::point, ContactKind::line, ContactKind::plane),
                     pose(0.3)),
      [](const auto& t) {
        Contact result;
        result.link = std::get<0>(t);
        result.kind = std::get<1>(t);
        result.frame = std::get<2>(t);
        return result;
      });
}

}  // namespace

rc::Gen<Robot> robot(const TreeShape& shape) {
  const auto links =
      rc::gen::mapcat(rc::gen::inRange(shape.fewest_links, shape.most_links + 1), [](int count) {
        return rc::gen::container<std::vector<Link>>(static_cast<std::size_t>(count), link());
      });
  const auto contacts = rc::gen::mapcat(rc::gen::inRange(0, 5), [](int count) {
    return rc::gen::container<std::vector<Contact>>(static_cast<std::size_t>(count), contact());
  });
  return rc::gen::map(rc::gen::pair(links, contacts), [shape](const auto& drawn) {
    Robot result;
    result.name = "arbitrary";
    result.root = shape.root;
    result.links = drawn.first;
    result.contacts = drawn.second;
    for (int i = 0; i < result.link_count(); ++i) {
      Link& l = result.links[static_cast<std::size_t>(i)];
      l.name = fmt::format("link{}", i);
      l.joint.name = fmt::format("joint{}", i);
      l.parent = i == 0 ? -1 : l.parent % i;
      l.members = {{l.name, Eigen::Isometry3d::Identity(), true, l.inertia, 0}};
    }
    for (std::size_t c = 0; c < result.contacts.size(); ++c) {
      result.contacts[c].name = fmt::format("contact{}", c);
      result.contacts[c].link %= result.link_count();
    }
    return result;
  });
}

rc::Gen<Sample> sample(const Robot& robot) {
  const Eigen::Index n = robot.joint_count();
  const bool floating = robot.root == Root::floating;
  return rc::gen::map(
      rc::gen::tuple(
          vector3(8.0), vector3(40.0), vector3(20.0),
          rc::gen::tuple(vector(n, 3.0), vector(n, 10.0), vector(n, 100.0), vector(n, 30.0)),
          rc::gen::container<std::vector<bool>>(robot.contacts.size(), rc::gen::arbitrary<bool>())),
      [floating](const auto& t) {
        Sample s;
        if (floating) {
          s.base_angular_velocity = std::get<0>(t);
          s.base_angular_acceleration = std::get<1>(t);
          s.base_specific_force = std::get<2>(t);
        }
        std::tie(s.q, s.dq, s.ddq, s.tau) = std::get<3>(t);
        s.in_contact = std::get<4>(t);
        return s;
      });
}

}  // namespace shapeid::test

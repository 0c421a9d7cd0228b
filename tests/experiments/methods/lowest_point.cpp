#include "shapeid/tests/experiments/methods/lowest_point.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

namespace shapeid::experiments {
namespace {

constexpr int sides = 48;

/// x^T A x + b . x + c
struct Quadric {
  Eigen::Matrix3d A;
  Eigen::Vector3d b;
  double c;

  [[nodiscard]] double at(const Eigen::Vector3d& x) const { return x.dot(A * x + b) + c; }
  /// The polynomial of y with x = frame y.
  [[nodiscard]] Quadric seen_from(const Eigen::Affine3d& frame) const {
    const Eigen::Matrix3d L = frame.linear();
    const Eigen::Vector3d t = frame.translation();
    return {L.transpose() * A * L, L.transpose() * (2.0 * A * t + b), at(t)};
  }
};

/// (1, x, y, z, y^2 + z^2, -x y, -x z, x^2 + z^2, -y z, x^2 + y^2) times z.
Quadric cost_of_point(const Vector10& z) {
  Quadric q;
  q.c = z[0];
  q.b = z.segment<3>(1);
  q.A << z[7] + z[9], -0.5 * z[5], -0.5 * z[6],  //
      -0.5 * z[5], z[4] + z[9], -0.5 * z[8],     //
      -0.5 * z[6], -0.5 * z[8], z[4] + z[7];
  return q;
}

LowestPoint nowhere() { return {std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero()}; }

void take_lower(LowestPoint& lowest, const LowestPoint& other) {
  if (other.value < lowest.value) lowest = other;
}

/// Each coordinate is held at a number, or free.
using Held = std::array<std::optional<double>, 3>;

/// The point with these coordinates at which the polynomial is stationary in the free ones. Not
/// finite if there is none, or a whole line of them, which then meets another face.
Eigen::Vector3d stationary(const Quadric& q, const Held& held) {
  std::vector<Eigen::Index> loose;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (const auto& value = held[static_cast<std::size_t>(i)]) {
      x[i] = *value;
    } else {
      loose.push_back(i);
    }
  }
  if (loose.empty()) return x;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;
  const Eigen::Vector3d slope = 2.0 * q.A * x + q.b;
  const Small A = q.A(loose, loose), right = slope(loose);
  x(loose) = -0.5 * A.partialPivLu().solve(right);
  return x;
}

/// The lowest of all stationary points of the box's inside, faces, edges and corners: the minimum
/// is one of them, and those outside the box do not count. `half`: half the lengths of the sides; a
/// coordinate with `held` given has that value.
LowestPoint in_box(const Quadric& q, const Eigen::Vector3d& half, const Held& held) {
  LowestPoint lowest = nowhere();
  constexpr int ways = 3;  // free, at the lower end, at the upper end
  for (int code = 0; code < ways * ways * ways; ++code) {
    const std::array<int, 3> way = {code % ways, code / ways % ways, code / (ways * ways)};
    Held here = held;
    bool repeated = false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (way[i] == 0) continue;
      repeated = repeated || held[i].has_value();
      const double end = half[static_cast<Eigen::Index>(i)];
      here[i] = way[i] == 1 ? -end : end;
    }
    if (repeated) continue;
    const Eigen::Vector3d x = stationary(q, here);
    bool inside = x.allFinite();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto place = static_cast<Eigen::Index>(i);
      inside = inside && (here[i].has_value() || std::abs(x[place]) <= half[place]);
    }
    if (inside) take_lower(lowest, {q.at(x), x});
  }
  return lowest;
}

LowestPoint in_unit_box(const Quadric& q) { return in_box(q, Eigen::Vector3d::Constant(0.5), {}); }

/// Radius 1, z in [-1/2, 1/2], inside a prism that touches it.
LowestPoint in_unit_prism(const Quadric& q) {
  const double angle = std::numbers::pi / sides;
  LowestPoint lowest = nowhere();
  for (int k = 0; k < sides; ++k) {  // each side is a rectangle at x = 1 after a turn
    const Eigen::Affine3d turn(Eigen::AngleAxisd(2.0 * k * angle, Eigen::Vector3d::UnitZ()));
    LowestPoint side =
        in_box(q.seen_from(turn), Eigen::Vector3d(1.0, std::tan(angle), 0.5), {1.0, {}, {}});
    side.point = turn * side.point;
    take_lower(lowest, side);
  }
  // Inside, and on the two ends: what is stationary within the circle through the prism's corners.
  for (const std::optional<double> height :
       {std::optional<double>(), std::optional(-0.5), std::optional(0.5)}) {
    const Eigen::Vector3d x = stationary(q, {std::nullopt, std::nullopt, height});
    if (!x.allFinite() || x.head<2>().norm() > 1.0 / std::cos(angle)) continue;
    if (std::abs(x.z()) <= 0.5) take_lower(lowest, {q.at(x), x});
  }
  return lowest;
}

}  // namespace

LowestPoint lowest_point(const BodyModel& regions, const Vector10& z) {
  const Quadric q = cost_of_point(z);
  LowestPoint lowest = nowhere();
  for (const SoughtShape& region : regions.shapes) {
    LowestPoint here;
    if (const auto* cuboid = std::get_if<Cuboid>(&region.shape)) {
      here = in_unit_box(q.seen_from(cuboid->frame));
      here.point = cuboid->frame * here.point;
    } else if (const auto* cylinder = std::get_if<Cylinder>(&region.shape)) {
      here = in_unit_prism(q.seen_from(cylinder->frame));
      here.point = cylinder->frame * here.point;
    } else {
      throw std::invalid_argument("regions are cuboids and cylinders");
    }
    take_lower(lowest, here);
  }
  return lowest;
}

}  // namespace shapeid::experiments

#include "shapeid/diagnosis/load_places.hpp"

#include <algorithm>
#include <array>

#include "shapeid/models/shape.hpp"

namespace shapeid::diagnosis {
namespace {

/// What a unit of mass at a point adds to the objective.
double slope(const Eigen::VectorXd& gradient, const Eigen::Vector3d& place) {
  return gradient.dot(unit_parameters(make_point(place, 1.0)).values);
}

/// Where along an axis the slope, a parabola, is least in the room.
double least_along(const Eigen::VectorXd& gradient, Eigen::Vector3d place, int axis,
                   const Box& room) {
  const double from = room.lower[axis], to = room.upper[axis], half = 0.5 * (to - from);
  const auto at = [&](double x) {
    place[axis] = x;
    return slope(gradient, place);
  };
  const double first = at(from), middle = at(from + half), last = at(to);
  const double bend = first - 2.0 * middle + last;
  if (!(bend > 0.0)) return first < last ? from : to;
  return std::clamp(from + half * (1.0 + 0.5 * (first - last) / bend), from, to);
}

}  // namespace

Box room_for_load(const Robot& robot, int link) {
  Box room = box_around(robot, {}, link);
  const InertialParameters& given = robot.links[static_cast<std::size_t>(link)].inertia;
  if (given.mass() > 0.0) {
    room.lower = room.lower.cwiseMin(given.centre_of_mass());
    room.upper = room.upper.cwiseMax(given.centre_of_mass());
  }
  room.lower.array() -= furthest_load;
  room.upper.array() += furthest_load;
  return room;
}

std::vector<Eigen::Vector3d> first_places(const Box& room) {
  // The link itself takes up the room but for what lies beyond it.
  constexpr std::array<double, 4> beyond = {0.0, 0.8, 0.95, 1.0};
  std::array<std::vector<double>, 3> along;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double share : beyond) {
      auto& places = along[static_cast<std::size_t>(axis)];
      places.push_back(room.lower[axis] + share * furthest_load);
      places.push_back(room.upper[axis] - share * furthest_load);
    }
  }
  std::vector<Eigen::Vector3d> places;
  for (const double x : along[0]) {
    for (const double y : along[1]) {
      for (const double z : along[2]) places.emplace_back(x, y, z);
    }
  }
  return places;
}

SteepestPlace steepest_place(const Eigen::VectorXd& gradient, const Box& room) {
  const std::vector<Eigen::Vector3d> first = first_places(room);
  Eigen::Vector3d best = *std::min_element(
      first.begin(), first.end(),
      [&](const auto& a, const auto& b) { return slope(gradient, a) < slope(gradient, b); });
  constexpr int sweeps = 20;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int axis = 0; axis < 3; ++axis) best[axis] = least_along(gradient, best, axis, room);
  }
  return {best, slope(gradient, best)};
}

}  // namespace shapeid::diagnosis

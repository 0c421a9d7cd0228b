#include "shapeid/models/orders.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "shapeid/models/error.hpp"
#include "shapeid/models/text.hpp"

namespace shapeid {
namespace {

/// What an order's moments are about, and in which unit.
enum class Reference { origin, origin_per_mass, centre, rotated_centre };

/// One of the six independent entries of a symmetric tensor.
struct Entry {
  Eigen::Index row, column;
};

struct Layout {
  Eigen::Index mass;    ///< place of m
  Eigen::Index centre;  ///< first of three places: m r if the reference is the origin, else r
  Eigen::Index moment;  ///< first of six places
  std::array<Entry, 6> entries;
  Reference reference;
};

constexpr Entry xx{0, 0}, xy{0, 1}, xz{0, 2}, yy{1, 1}, yz{1, 2}, zz{2, 2};

Layout layout_of(Order order) {
  switch (order) {
    case Order::shapeid:
    case Order::idyntree:
      return {0, 1, 4, {xx, xy, xz, yy, yz, zz}, Reference::origin};
    case Order::pinocchio:
      return {0, 1, 4, {xx, xy, yy, xz, yz, zz}, Reference::origin};
    case Order::drake:
      return {0, 1, 4, {xx, yy, zz, xy, xz, yz}, Reference::origin_per_mass};
    case Order::mujoco:
      return {0, 1, 4, {xx, yy, zz, xy, xz, yz}, Reference::centre};
    case Order::urdf:
      return {0, 1, 7, {xx, xy, xz, yy, yz, zz}, Reference::rotated_centre};
    case Order::spatial_v2:
      return {0, 1, 4, {xx, yy, zz, yz, xz, xy}, Reference::origin};
    case Order::symoro:
      return {9, 6, 0, {xx, xy, xz, yy, yz, zz}, Reference::origin};
  }
  throw Defect("an order without a layout");
}

/// Where URDF's roll, pitch, yaw stand.
constexpr Eigen::Index urdf_rpy = 4;

/// The one thing a massless body cannot say in orders that divide by its mass.
void refuse_moments_without_mass(Order order, const InertialParameters& body) {
  if (body.mass() == 0.0 && !body.values.isZero(0.0)) {
    throw InputError(fmt::format("a body with moments but no mass has no centre of mass, which the "
                                 "order {} needs",
                                 order_names[static_cast<std::size_t>(order)]),
                     "give it a mass, or choose an order about the origin");
  }
}

}  // namespace

Order order_named(std::string_view name) {
  const auto* const found = std::find(order_names.begin(), order_names.end(), name);
  if (found == order_names.end()) {
    throw InputError(fmt::format("no order of inertial parameters is called {}", name),
                     fmt::format("choose one of {}", fmt::join(order_names, ", ")));
  }
  return static_cast<Order>(found - order_names.begin());
}

Eigen::Index number_count(Order order) { return order == Order::urdf ? 13 : 10; }

InertialParameters from_order(Order order, const Eigen::VectorXd& numbers) {
  const std::string_view name = order_names[static_cast<std::size_t>(order)];
  if (numbers.size() != number_count(order)) {
    throw InputError(fmt::format("{} numbers for the order {}", numbers.size(), name),
                     fmt::format("it has {}", number_count(order)));
  }
  if (!numbers.allFinite()) {
    throw InputError(fmt::format("a number for the order {} is not finite", name),
                     "write finite numbers");
  }
  const Layout layout = layout_of(order);
  const double mass = numbers[layout.mass];
  const Eigen::Vector3d centre = numbers.segment<3>(layout.centre);
  Eigen::Matrix3d moments;
  for (std::size_t i = 0; i < layout.entries.size(); ++i) {
    const auto [row, column] = layout.entries[i];
    moments(row, column) = moments(column, row) =
        numbers[layout.moment + static_cast<Eigen::Index>(i)];
  }
  switch (layout.reference) {
    case Reference::origin:
      return from_origin(mass, centre, moments);
    case Reference::origin_per_mass:
      return from_origin(mass, mass * centre, mass * moments);
    case Reference::centre:
      return from_centre(mass, centre, moments);
    case Reference::rotated_centre: {
      const Eigen::Vector3d rpy = numbers.segment<3>(urdf_rpy);
      if (rpy.cwiseAbs().maxCoeff() > largest_angle) {
        throw InputError(fmt::format("roll, pitch or yaw turns by {:g}", rpy.cwiseAbs().maxCoeff()),
                         "radians, a turn at most");
      }
      const Eigen::Matrix3d R = rotation_from_rpy(rpy);
      return from_centre(mass, centre, R * moments * R.transpose());
    }
  }
  throw Defect("an order without a reference");
}

Eigen::VectorXd to_order(Order order, const InertialParameters& body) {
  const Layout layout = layout_of(order);
  Eigen::Vector3d centre = body.first_moment();
  Eigen::Matrix3d moments = body.tensor();
  if (layout.reference != Reference::origin) {
    refuse_moments_without_mass(order, body);
    centre = body.centre_of_mass();
    if (layout.reference != Reference::origin_per_mass) {
      moments = body.tensor_about_centre();
    } else if (body.mass() != 0.0) {
      moments /= body.mass();
    }
  }
  // URDF's roll, pitch, yaw stay zero: link axes are as good as principal ones.
  Eigen::VectorXd numbers = Eigen::VectorXd::Zero(number_count(order));
  numbers[layout.mass] = body.mass();
  numbers.segment<3>(layout.centre) = centre;
  for (std::size_t i = 0; i < layout.entries.size(); ++i) {
    const auto [row, column] = layout.entries[i];
    numbers[layout.moment + static_cast<Eigen::Index>(i)] = moments(row, column);
  }
  return numbers;
}

}  // namespace shapeid

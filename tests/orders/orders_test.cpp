// Every order against numbers worked by hand, and every order against every other.
//
// The golden body, chosen so that its moments are small integers, none zero, no two of one size:
// point masses of 1 kg at (0, -1, 1), 2 kg at (2, -1, 0), 3 kg at the origin and 2 kg at
// (-1, 1, -2) (metres). By hand, with sums over the points:
//
//   m      1 + 2 + 3 + 2 = 8
//   m r    x: 0 + 4 - 2 = 2       y: -1 - 2 + 2 = -1     z: 1 + 0 - 4 = -3
//   m xx   0 + 8 + 2 = 10         m yy  1 + 2 + 2 = 5    m zz  1 + 0 + 8 = 9
//   m xy   0 - 4 - 2 = -6         m xz  0 + 0 + 4 = 4    m yz  -1 + 0 - 4 = -5
//
// About the origin: Ixx = yy + zz = 14, Iyy = xx + zz = 19, Izz = xx + yy = 15,
// Ixy = -xy = 6, Ixz = -xz = -4, Iyz = -yz = 5.
// Centre of mass r = (1/4, -1/8, -3/8). Parallel axis term m (r^2 1 - r r^T) with
// m r^2 = (4 + 1 + 9) / 8 = 1.75, so about the centre
// Ixx = 14 - 1.75 + 4/8 = 12.75, Iyy = 19 - 1.75 + 1/8 = 17.375, Izz = 15 - 1.75 + 9/8 = 14.375,
// Ixy = 6 - 2/8 = 5.75, Ixz = -4 - 6/8 = -4.75, Iyz = 5 + 3/8 = 5.375.
#include "shapeid/models/orders.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled_difference;

constexpr std::array<Order, 8> all_orders = {Order::shapeid,    Order::pinocchio, Order::idyntree,
                                             Order::drake,      Order::mujoco,    Order::urdf,
                                             Order::spatial_v2, Order::symoro};

Eigen::VectorXd numbers(std::initializer_list<double> list) {
  return Eigen::Map<const Eigen::VectorXd>(std::data(list), static_cast<Eigen::Index>(list.size()));
}

InertialParameters point(double mass, double x, double y, double z) {
  return from_centre(mass, {x, y, z}, Eigen::Matrix3d::Zero());
}

InertialParameters golden_body() {
  return point(1, 0, -1, 1) + point(2, 2, -1, 0) + point(3, 0, 0, 0) + point(2, -1, 1, -2);
}

Eigen::VectorXd golden(Order order) {
  switch (order) {
    case Order::shapeid:
    case Order::idyntree:
      return numbers({8, 2, -1, -3, 14, 6, -4, 19, 5, 15});
    case Order::pinocchio:
      return numbers({8, 2, -1, -3, 14, 6, 19, -4, 5, 15});
    case Order::drake:  // all but the mass divided by 8
      return numbers({8, 0.25, -0.125, -0.375, 1.75, 2.375, 1.875, 0.75, -0.5, 0.625});
    case Order::mujoco:
      return numbers({8, 0.25, -0.125, -0.375, 12.75, 17.375, 14.375, 5.75, -4.75, 5.375});
    case Order::urdf:
      return numbers({8, 0.25, -0.125, -0.375, 0, 0, 0, 12.75, 5.75, -4.75, 17.375, 5.375, 14.375});
    case Order::spatial_v2:
      return numbers({8, 2, -1, -3, 14, 19, 15, 5, -4, 6});
    case Order::symoro:
      return numbers({14, 6, -4, 19, 5, 15, 2, -1, -3, 8});
  }
  return {};
}

std::string name_of(Order order) {
  return std::string(order_names[static_cast<std::size_t>(order)]);
}

// All numbers above are dyadic, so agreement is exact.
TEST(Orders, GoldenBodyInEveryOrder) {
  for (const Order order : all_orders) {
    EXPECT_EQ(to_order(order, golden_body()), golden(order)) << name_of(order);
    EXPECT_EQ(from_order(order, golden(order)).values, golden_body().values) << name_of(order);
  }
}

// URDF's inertial frame rotated: a yaw of 90 degrees turns x' to link y and y' to link -x. In that
// frame Ix'x' = Iyy, Iy'y' = Ixx, Ix'y' = -Ixy, Ix'z' = Iyz, Iy'z' = -Ixz.
TEST(Orders, UrdfAnglesAreHonoured) {
  const auto yawed = numbers({8, 0.25, -0.125, -0.375, 0, 0, std::numbers::pi / 2, 17.375, -5.75,
                              5.375, 12.75, 4.75, 14.375});
  EXPECT_LT(scaled_difference(from_order(Order::urdf, yawed).values, golden_body().values, 3),
            few_hundred_eps);
}

// A roll of 90 degrees and then a yaw of 90 degrees: the inertial axes x', y', z' are link y, z, x.
// So Ix'x' = Iyy, Iy'y' = Izz, Iz'z' = Ixx, Ix'y' = Iyz, Ix'z' = Ixy, Iy'z' = Ixz.
TEST(Orders, UrdfRollComesBeforeYaw) {
  const double quarter = std::numbers::pi / 2;
  const auto turned = numbers(
      {8, 0.25, -0.125, -0.375, quarter, 0, quarter, 17.375, 5.375, 5.75, 14.375, -4.75, 12.75});
  EXPECT_LT(scaled_difference(from_order(Order::urdf, turned).values, golden_body().values, 3),
            few_hundred_eps);
}

// What a user sees who takes one library's numbers for another's. shapeid and idyntree are the same
// order by design.
TEST(Orders, GoldenBodyTellsEachPairOfOrdersApart) {
  const auto as_ours = [](Order o) { return o == Order::idyntree ? Order::shapeid : o; };
  for (const Order written : all_orders) {
    for (const Order read : all_orders) {
      if (number_count(written) != number_count(read)) continue;
      const bool understood = from_order(read, golden(written)).values == golden_body().values;
      EXPECT_EQ(understood, as_ours(written) == as_ours(read))
          << name_of(written) << " read as " << name_of(read);
    }
  }
}

// Seeded slips: any two numbers exchanged must show, in every order, for no two of them agree (save
// URDF's three zero angles).
TEST(Orders, EveryExchangeOfTwoNumbersShows) {
  for (const Order order : all_orders) {
    const Eigen::VectorXd right = golden(order);
    for (Eigen::Index i = 0; i < right.size(); ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        const bool both_angles = order == Order::urdf && j >= 4 && i <= 6;
        if (both_angles) continue;
        Eigen::VectorXd wrong = right;
        std::swap(wrong[i], wrong[j]);
        const bool turns = order == Order::urdf && wrong.segment<3>(4).maxCoeff() > largest_angle;
        if (turns) {  // more than once: no angle
          EXPECT_THROW(static_cast<void>(from_order(order, wrong)), InputError);
          continue;
        }
        EXPECT_NE(from_order(order, wrong).values, golden_body().values)
            << name_of(order) << " numbers " << i << " and " << j;
      }
    }
  }
}

RC_GTEST_PROP(Orders, ThereAndBack, ()) {
  const InertialParameters body = *test::body();
  for (const Order order : all_orders) {
    const InertialParameters back = from_order(order, to_order(order, body));
    RC_ASSERT(scaled_difference(back.values, body.values, 10) < few_hundred_eps);
  }
}

// A body in arbitrary inertial axes: the same body as one turned by hand.
RC_GTEST_PROP(Orders, UrdfFrameAgreesWithMovedBody, ()) {
  const InertialParameters body = *test::body();
  const Eigen::Vector3d rpy = *test::vector3(3.0);
  Eigen::VectorXd written = to_order(Order::urdf, body);
  written.segment<3>(4) = rpy;
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  const Eigen::Vector3d c = body.centre_of_mass();
  // Turn the body about its centre of mass.
  const Eigen::Isometry3d turn =
      Eigen::Translation3d(c) * Eigen::Isometry3d(R) * Eigen::Translation3d(-c);
  RC_ASSERT(scaled_difference(from_order(Order::urdf, written).values, moved(body, turn).values,
                              10) < few_hundred_eps);
}

TEST(Orders, NamesAndCounts) {
  for (const Order order : all_orders) EXPECT_EQ(order_named(name_of(order)), order);
  EXPECT_THROW(static_cast<void>(order_named("Pinocchio")), InputError);
  EXPECT_THROW(static_cast<void>(from_order(Order::drake, Eigen::VectorXd::Ones(9))), InputError);
  EXPECT_THROW(static_cast<void>(from_order(Order::urdf, Eigen::VectorXd::Ones(10))), InputError);
  Eigen::VectorXd nan = Eigen::VectorXd::Ones(10);
  nan[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(from_order(Order::symoro, nan)), InputError);
}

TEST(Orders, MasslessBodies) {
  const InertialParameters nothing;
  const InertialParameters moments = from_origin(0.0, {0, 0, 0}, Eigen::Matrix3d::Identity());
  for (const Order order : all_orders) {
    EXPECT_EQ(from_order(order, to_order(order, nothing)).values, nothing.values);
    const bool divides = order == Order::drake || order == Order::mujoco || order == Order::urdf;
    if (divides) {
      EXPECT_THROW(static_cast<void>(to_order(order, moments)), InputError) << name_of(order);
    } else {
      EXPECT_EQ(from_order(order, to_order(order, moments)).values, moments.values);
    }
  }
}

}  // namespace
}  // namespace shapeid

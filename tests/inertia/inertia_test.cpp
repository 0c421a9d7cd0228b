#include "shapeid/models/inertia.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled_difference;

RC_GTEST_PROP(Inertia, PseudoInertiaAndBack, ()) {
  const InertialParameters b = *test::body();
  RC_ASSERT(scaled_difference(from_pseudo_inertia(pseudo_inertia(b)).values, b.values, 10) <
            few_hundred_eps);
}

RC_GTEST_PROP(Inertia, CentreAndBack, ()) {
  const InertialParameters b = *test::body();
  const auto back = from_centre(b.mass(), b.centre_of_mass(), b.tensor_about_centre());
  RC_ASSERT(scaled_difference(back.values, b.values, 10) < few_hundred_eps);
}

// The same body from another frame, once by Sigma -> T Sigma T^T and once by turning centre and
// central tensor by hand.
RC_GTEST_PROP(Inertia, MovedAgreesWithTextbook, ()) {
  const InertialParameters b = *test::body();
  const Eigen::Isometry3d T = *test::pose(0.7);
  const auto by_hand = from_centre(b.mass(), T * b.centre_of_mass(),
                                   T.linear() * b.tensor_about_centre() * T.linear().transpose());
  RC_ASSERT(scaled_difference(moved(b, T).values, by_hand.values, 10) < few_hundred_eps);
}

RC_GTEST_PROP(Inertia, GeneratedBodiesExistInEveryFrame, ()) {
  const InertialParameters b = *test::body();
  const Eigen::Isometry3d T = *test::pose(0.7);
  RC_ASSERT(!why_impossible(b));
  RC_ASSERT(!why_impossible(moved(b, T)));
}

// Triangle inequality: positive moments are not enough.
TEST(Inertia, PositiveTensorThatBreaksTheTriangleIsImpossible) {
  const auto b = from_centre(2.0, {0.1, -0.2, 0.3}, Eigen::Vector3d(1.0, 2.0, 3.5).asDiagonal());
  const Violation why = why_impossible(b);
  ASSERT_TRUE(why);
  EXPECT_NE(why->find("triangle"), std::string::npos) << *why;
}

TEST(Inertia, NegativeMassIsImpossible) {
  EXPECT_TRUE(why_impossible(from_centre(-1.0, {0, 0, 0}, Eigen::Matrix3d::Identity())));
}

TEST(Inertia, EdgesOfTheConeExist) {
  EXPECT_FALSE(why_impossible({}));                                                    // no body
  EXPECT_FALSE(why_impossible(from_centre(1.0, {0, 0, 0}, Eigen::Matrix3d::Zero())));  // at origin
  EXPECT_FALSE(why_impossible(from_centre(1.0, {3, 1, 2}, Eigen::Matrix3d::Zero())));  // a point
  const Eigen::Matrix3d rod = Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  EXPECT_FALSE(why_impossible(from_centre(1.0, {0, 0, 0}, rod)));
}

TEST(Inertia, MomentsWithoutMassAreImpossible) {
  EXPECT_TRUE(why_impossible(from_origin(0.0, {0.1, 0, 0}, Eigen::Matrix3d::Zero())));
  EXPECT_TRUE(why_impossible(from_origin(0.0, {0, 0, 0}, Eigen::Matrix3d::Identity())));
}

// An asymmetric body whose numbers were worked out by hand: two unit point masses at (1,2,3) and
// (-2,0,1). Ixy = -sum m x y and so on.
TEST(Inertia, TwoPointMassesByHand) {
  const auto a = from_centre(1.0, {1, 2, 3}, Eigen::Matrix3d::Zero());
  const auto b = from_centre(1.0, {-2, 0, 1}, Eigen::Matrix3d::Zero());
  Vector10 expected;
  expected << 2, -1, 2, 4, 13 + 1, -2, -3 + 2, 10 + 5, -6, 5 + 4;
  EXPECT_EQ((a + b).values, expected);
}

}  // namespace
}  // namespace shapeid

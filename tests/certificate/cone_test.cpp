// Parameters that are made of the shapes, and parameters that are not.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "shapeid/proofs/certificate/cone.hpp"
#include "shapeid/proofs/certificate/consistency.hpp"
#include "shapeid/tests/certificate/problems.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/qp_generators.hpp"

namespace shapeid::certificate {
namespace {

RC_GTEST_PROP(Cone, EitherMassesOrAPlane, ()) {
  test::PlantedStyle style;
  style.most_shapes = 30;
  const MassProblem p = (*test::planted_problem(style)).problem;
  const Eigen::VectorXd Phi = *test::vector(p.U.rows(), 1.0);
  const NearestBody nearest = nearest_body(p, Phi);
  for (const Rational& mass : nearest.m) RC_ASSERT(sgn(mass) >= 0);
  RC_ASSERT(separates(nearest.plane, p, Phi) == (sgn(nearest.square_distance) > 0));
  // The plane touches the cone at the nearest body: so it is the nearest.
  for (Eigen::Index j = 0; j < p.shapes(); ++j) {
    const Rational height = dot(nearest.plane, exact(Eigen::VectorXd(p.U.col(j))));
    RC_ASSERT(sgn(height) >= 0);
    if (sgn(nearest.m[static_cast<std::size_t>(j)]) > 0) RC_ASSERT(height == 0);
  }
  RC_ASSERT(nearest.square_distance == -dot(nearest.plane, exact(Phi)));
}

/// Masses and columns of few bits make parameters that are doubles exactly.
TEST(Cone, ExactCombinationsAreFound) {
  MassProblem p;
  p.U = Eigen::MatrixXd::Zero(20, 4);
  p.U.col(0).head<10>() << 1, 1, 0, 0, 0, 0, 0, 1, 0, 1;
  p.U.col(1).head<10>() << 1, 0, 1, 0, 1, 0, 0, 0, 0, 1;
  p.U.col(2).tail<10>() << 1, 0, 0, 1, 1, 0, 0, 1, 0, 0;
  p.U.col(3) = p.U.col(0) + 2.0 * p.U.col(1);  // dependent
  const Eigen::Vector4d m(0.5, 0.0, 3.0, 0.25);
  const Eigen::VectorXd Phi = p.U * m;
  const NearestBody nearest = nearest_body(p, Phi);
  EXPECT_EQ(nearest.square_distance, 0);
  EXPECT_FALSE(separates(nearest.plane, p, Phi));
  Eigen::VectorXd outside = Phi;
  outside[12] = 0.125;  // no shape of the second link has this
  const NearestBody other = nearest_body(p, outside);
  EXPECT_GT(other.square_distance, 0);
  EXPECT_TRUE(separates(other.plane, p, outside));
}

/// Columns that couple links, of which the last brings two groups together.
TEST(Cone, ColumnsMayCoupleLinksOneAfterTheOther) {
  MassProblem p;
  p.U = Eigen::MatrixXd::Zero(30, 4);
  const auto couple = [&](Eigen::Index column, int one, int other) {
    p.U.col(column).segment<10>(Eigen::Index{10} * one) << 1, 1, 0, 0, 0, 0, 0, 1, 0, 1;
    p.U.col(column).segment<10>(Eigen::Index{10} * other) << 1, 0, static_cast<double>(column), 0,
        1, 0, 0, 0, 0, 2;
  };
  couple(0, 1, 2);
  couple(1, 1, 2);
  couple(2, 1, 2);
  couple(3, 0, 1);  // nothing after it: a link that was left behind would stay so
  const Eigen::VectorXd Phi = p.U * Eigen::Vector4d(0.5, 2.0, 1.0, 0.25);
  const NearestBody nearest = nearest_body(p, Phi);
  EXPECT_EQ(nearest.square_distance, 0);
  EXPECT_FALSE(separates(nearest.plane, p, Phi));
  Eigen::VectorXd outside = Phi;
  outside[3] = -1.0;
  const NearestBody other = nearest_body(p, outside);
  EXPECT_GT(other.square_distance, 0);
  EXPECT_TRUE(separates(other.plane, p, outside));
}

Vector ten(const Eigen::VectorXd& v) { return exact(v); }

RC_GTEST_PROP(Existence, BodiesExistAndWithTooSmallATensorDoNot, ()) {
  const InertialParameters body = *test::body();
  RC_ASSERT(existence(ten(body.values)) == Existence::definite);
  InertialParameters broken = body;  // the triangle inequality about the centre, by one part in 8
  const Eigen::Matrix3d about = body.tensor_about_centre();
  const double zz = about(0, 0) + about(1, 1);
  broken.values[9] += 1.125 * zz - about(2, 2);
  RC_ASSERT(existence(ten(broken.values)) == Existence::impossible);
}

TEST(Existence, EdgesOfTheCone) {
  EXPECT_EQ(existence(Vector(10)), Existence::semidefinite);
  const Vector point = ten((Eigen::VectorXd(10) << 2, 2, -4, 0, 8, 4, 0, 2, 0, 10).finished());
  EXPECT_EQ(existence(point), Existence::semidefinite);
  Vector lighter = point;
  lighter[9] -= exact(1e-300);
  EXPECT_EQ(existence(lighter), Existence::impossible);
  Vector massless(10);
  massless[1] = 1;
  EXPECT_EQ(existence(massless), Existence::impossible);
  massless[1] = 0;
  massless[4] = massless[7] = massless[9] = 1;  // semidefinite, but moments are made of mass
  EXPECT_EQ(existence(massless), Existence::impossible);
}

}  // namespace
}  // namespace shapeid::certificate

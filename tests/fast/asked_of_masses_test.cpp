// What the mass solver and the tracker ask of their callers: what they are given by the library
// holds, and each way to break it is told.
#include "shapeid/fast/asked_of_masses.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "shapeid/fast/parameter_tracker.hpp"
#include "shapeid/models/shape.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/shape_generators.hpp"

namespace shapeid::fast {
namespace {

using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Whole {
  Vector10 u;
  double V;
};

Whole whole(const Shape& shape) { return {unit_parameters(shape).values, volume(shape)}; }

RC_GTEST_PROP(AskedOfMasses, ShapesAndTheirHalvesHold, ()) {
  const Shape shape = *test::solid();
  const auto [lower, upper] = divide(shape);
  const Whole all = whole(shape), first = whole(lower), second = whole(upper);
  RC_ASSERT(why_no_shape(0, all.u, all.V, 1) == std::nullopt);
  RC_ASSERT(why_no_parts(all.u, all.V, first.u, first.V, second.u, second.V) == std::nullopt);
}

// One entry, or one volume, of one part off by a thousandth of the part.
RC_GTEST_PROP(AskedOfMasses, PartsThatMakeUpAnotherShapeAreTold, ()) {
  const Shape shape = *test::solid();
  const auto [lower, upper] = divide(shape);
  const Whole all = whole(shape);
  Whole first = whole(lower), second = whole(upper);
  const auto entry = *rc::gen::inRange(0, 11);
  if (entry == 10) {
    first.V *= 1.001;
  } else {
    const double size = entry == 0 ? 1.0
                        : entry < 4
                            ? first.u.segment<3>(1).norm() + std::sqrt(first.u.tail<6>().norm())
                            : first.u.tail<6>().norm();
    first.u[entry] += 1e-3 * size;
  }
  RC_ASSERT(why_no_parts(all.u, all.V, first.u, first.V, second.u, second.V) != std::nullopt);
}

TEST(AskedOfMasses, SaysWhatIsWrong) {
  Vector10 u = Vector10::LinSpaced(1.0, 2.0);
  EXPECT_EQ(why_no_shape(1, u, 0.5, 2), std::nullopt);
  EXPECT_EQ(why_no_shape(2, u, 0.5, 2), "a shape on free link 2 of 2");
  EXPECT_EQ(why_no_shape(-1, u, 0.5, 2), "a shape on free link -1 of 2");
  for (const double V : {0.0, -0.5, infinity, nan}) {
    EXPECT_EQ(why_no_shape(1, u, V, 2), "a shape's volume is " + std::to_string(V));
    EXPECT_EQ(why_no_start(0, V, 3), "a mass to start at is " + std::to_string(V));
  }
  EXPECT_EQ(why_no_start(2, 0.1, 3), std::nullopt);
  EXPECT_EQ(why_no_rows(true), std::nullopt);
  EXPECT_EQ(why_no_rows(false), "no triangle has been solved for");
  EXPECT_EQ(why_no_start(3, 0.1, 3), "a mass for shape 3 of 3");
  EXPECT_EQ(why_no_start(-1, 0.1, 3), "a mass for shape -1 of 3");
  EXPECT_NE(why_no_parts(u, 1.0, u, 1.5, u, -0.5), std::nullopt);
  EXPECT_NE(why_no_parts(u, 1.0, u, 0.5, u, nan), std::nullopt);
  u[7] = nan;
  EXPECT_EQ(why_no_shape(1, u, 0.5, 2), "a shape's unit parameters are not finite");
  EXPECT_NE(why_no_parts(u, 1.0, u, 0.5, u, 0.5), std::nullopt);

  for (const double lambda : {0.0, 1e-300, infinity})
    EXPECT_EQ(why_no_lambda(lambda), std::nullopt);
  for (const double lambda : {-1e-300, nan}) EXPECT_NE(why_no_lambda(lambda), std::nullopt);
  EXPECT_EQ(why_no_triangle(Eigen::MatrixXd(21, 21), 2), std::nullopt);
  for (const auto& [rows, columns] : {std::pair{20, 21}, {21, 20}, {11, 11}}) {
    EXPECT_EQ(why_no_triangle(Eigen::MatrixXd(rows, columns), 2),
              "the triangle of 2 links has " + std::to_string(rows) + " rows and " +
                  std::to_string(columns) + " columns");
  }
}

TEST(AskedOfTheTracker, SaysWhatIsWrong) {
  const VectorXd ones = VectorXd::Ones(2), zeros = VectorXd::Zero(2);
  const VectorXd three = VectorXd::Ones(3);
  const std::string bad_spread = "a spread is not positive and finite, or its square is not";
  EXPECT_EQ(why_no_belief(zeros, ones, zeros), std::nullopt);
  EXPECT_EQ(why_no_belief(three, ones, zeros),
            "a mean of 3 parameters, a spread of 2, a wander of 2");
  EXPECT_EQ(why_no_belief(zeros, ones, three),
            "a mean of 2 parameters, a spread of 2, a wander of 3");
  for (const double wrong : {infinity, -infinity, nan}) {
    const VectorXd bad = Eigen::Vector2d(1.0, wrong);
    EXPECT_EQ(why_no_belief(bad, ones, zeros), "a mean is not finite");
    EXPECT_EQ(why_no_belief(zeros, bad, zeros), bad_spread);
    EXPECT_EQ(why_no_belief(zeros, ones, bad), "a wander is negative or not finite");
    EXPECT_NE(why_no_time(wrong), std::nullopt);
    EXPECT_NE(why_no_variance(wrong), std::nullopt);
  }
  EXPECT_EQ(why_no_belief(1e140 * ones, 1e-10 * ones, zeros),
            "a mean is too many spreads from zero");
  for (const double wrong : {0.0, -1.0, 1e-170, 1e170}) {
    EXPECT_EQ(why_no_belief(zeros, wrong * ones, zeros), bad_spread);
  }
  EXPECT_EQ(why_no_belief(zeros, ones, -ones), "a wander is negative or not finite");
  EXPECT_EQ(why_no_time(0.0), std::nullopt);
  EXPECT_NE(why_no_time(-0.1), std::nullopt);
  EXPECT_EQ(why_no_variance(1e-300), std::nullopt);
  EXPECT_NE(why_no_variance(0.0), std::nullopt);
}

}  // namespace
}  // namespace shapeid::fast

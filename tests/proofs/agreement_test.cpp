// What the theorems speak of is what the code computes: Coq evaluates the definitions of proofs/ on
// the very doubles, in rational numbers, and the code's results agree to rounding.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "coq.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/models/mass_problem.hpp"
#include "shapeid/models/shape.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {
namespace {

/// Numbers of few digits, so that Coq's fractions stay short. No zeros, nothing symmetric.
class Draws {
 public:
  double number() { return (sign_(engine_) ? 1.0 : -1.0) * positive(); }
  double positive() { return digits_(engine_) / 64.0; }
  Eigen::VectorXd vector(Eigen::Index n) {
    return Eigen::VectorXd::NullaryExpr(n, [&] { return number(); });
  }
  Eigen::VectorXd positives(Eigen::Index n) {
    return Eigen::VectorXd::NullaryExpr(n, [&] { return positive(); });
  }
  Eigen::MatrixXd matrix(Eigen::Index n, Eigen::Index k) {
    return Eigen::MatrixXd::NullaryExpr(n, k, [&] { return number(); });
  }
  /// A cell of the canonical cuboid in a frame that turns, shears and stretches.
  Cuboid cuboid() {
    Cuboid shape;
    do {
      shape.frame.matrix() << matrix(3, 4), 0.0, 0.0, 0.0, 1.0;
    } while (shape.frame.linear().determinant() < 0.1);
    shape.cell.lower = -positives(3) / 4.0;
    shape.cell.upper = positives(3) / 4.0;
    return shape;
  }

 private:
  std::mt19937 engine_{20240611};
  std::bernoulli_distribution sign_;
  std::uniform_int_distribution<int> digits_{1, 127};
};

void expect_same(const Eigen::VectorXd& proved, const Eigen::VectorXd& computed) {
  ASSERT_EQ(proved.size(), computed.size());
  EXPECT_LT(scaled_difference(proved, computed, computed.size()), few_hundred_eps)
      << proved.transpose() << "\nis not\n"
      << computed.transpose();
}

std::string coq_problem(const MassProblem& p) {
  return fmt::format(
      "{{| rows := {}; parameters := {}; shapes := {}; Y := mat {}; F := vec {}; W := vec {}; "
      "U := mat {}; V := vec {}; lambda := {} |}}",
      p.Y.rows(), p.U.rows(), p.shapes(), coq_rows(p.Y), coq_list(p.F), coq_list(p.W),
      coq_rows(p.U), coq_list(p.V), coq_number(p.lambda));
}

std::string coq_frame(const Eigen::Affine3d& frame) {
  return fmt::format("{{| linear := mat3 {}; translation := vec3 {} |}}", coq_rows(frame.linear()),
                     coq_list(frame.translation()));
}

std::string coq_cell(const Cell& cell) {
  return fmt::format("{{| lower := vec3 {}; upper := vec3 {} |}}", coq_list(cell.lower),
                     coq_list(cell.upper));
}

/// Volume, centroid, covariance by rows, ten unit parameters.
Eigen::VectorXd all_moments(const Shape& shape) {
  const Moments m = moments(shape);
  Eigen::VectorXd all(23);
  all << m.volume, m.centroid, m.covariance.reshaped(), unit_parameters(shape).values;
  return all;
}
constexpr auto all_moments_of =
    "(volume {0} :: entries3 (centroid {0}) ++ entries33 (covariance {0}) ++ "
    "entries 10 (unit_parameters {0}))";

TEST(DefinitionsOfTheProofs, MassProblemIsTheCodes) {
  Draws draw;
  const MassProblem p{draw.matrix(7, 10), draw.vector(7),    draw.positives(7),
                      draw.matrix(10, 4), draw.positives(4), draw.positive()};
  const Eigen::VectorXd m = draw.positives(4);
  const Objective value = objective(p, m);
  Eigen::VectorXd computed(17);
  computed << value.data, value.density, value.total(), gradient(p, m), p.U * m;
  expect_same(
      evaluated("Definition p := " + coq_problem(p) + ".\nDefinition m := vec " + coq_list(m) + ".",
                "data p m :: density p m :: objective p m :: "
                "entries 4 (gradient p m) ++ entries 10 (Phi p m)"),
      computed);
}

TEST(DefinitionsOfTheProofs, CuboidsAndTheirPartsAreTheCodes) {
  Draws draw;
  const double share = 0.25;
  const std::vector<std::string> axes = {"ax", "ay", "az"};
  for (int axis = 0; axis < 3; ++axis) {
    const Cuboid whole = draw.cuboid();
    const auto [first, second] = divide(whole, axis, share);
    Eigen::VectorXd computed(3 * 23);
    computed << all_moments(whole), all_moments(first), all_moments(second);
    const std::string definitions = fmt::format(
        "Definition T := {}.\nDefinition c := {}.\nDefinition axis := {}.\n"
        "Definition s : rationals := add (lower c axis) (mul {} (sub (upper c axis) (lower c "
        "axis))).\n"
        "Definition whole := moments_of T c.\nDefinition part1 := moments_of T (below c axis s).\n"
        "Definition part2 := moments_of T (above c axis s).",
        coq_frame(whole.frame), coq_cell(whole.cell), axes[static_cast<std::size_t>(axis)],
        coq_number(share));
    expect_same(evaluated(definitions, fmt::format(all_moments_of, "whole") + " ++ " +
                                           fmt::format(all_moments_of, "part1") + " ++ " +
                                           fmt::format(all_moments_of, "part2")),
                computed);
  }
}

TEST(DefinitionsOfTheProofs, MassesAfterACutAreTheCodes) {
  Draws draw;
  BodyModel model;
  model.free_links = {0};
  for (const char* id : {"0", "1", "2"}) model.shapes.push_back({0, draw.cuboid(), id});
  MassProblem p{draw.matrix(5, 10), draw.vector(5), draw.positives(5), {}, {}, draw.positive()};
  p.U = shape_columns(model);
  p.V = shape_volumes(model);
  const Eigen::VectorXd m = draw.positives(3);
  const reference::Split split = reference::split_shape(model, p, m, 1).value();
  const std::string definitions =
      fmt::format("Definition p := {}.\nDefinition p' := {}.\nDefinition m := vec {}.",
                  coq_problem(p), coq_problem(split.problem), coq_list(m));
  expect_same(evaluated(definitions, "entries 4 (equal_density p p' 1 m)"), split.start);
}

TEST(DefinitionsOfTheProofs, PseudoInertiaIsTheCodes) {
  Draws draw;
  const InertialParameters body{draw.vector(10)};
  const Eigen::Vector4d x = draw.vector(4);
  Eigen::Isometry3d turned;  // by a quarter, which doubles hold exactly
  turned.matrix() << 0, -1, 0, draw.number(), 0, 0, -1, draw.number(), 1, 0, 0, draw.number(), 0, 0,
      0, 1;
  Eigen::VectorXd computed(11);
  computed << x.dot(pseudo_inertia(body) * x), moved(body, turned).values;
  const std::string definitions =
      fmt::format("Definition body := vec {}.\nDefinition T := {}.", coq_list(body.values),
                  coq_frame(Eigen::Affine3d(turned)));
  const std::string form =
      fmt::format("pseudo_inertia body (vec3 {}) {} :: entries 10 (moved T body)",
                  coq_list(x.head<3>()), coq_number(x[3]));
  expect_same(evaluated(definitions, form), computed);
}

TEST(DefinitionsOfTheProofs, RegressorOfABodyIsTheCodes) {
  Draws draw;
  Robot robot;
  robot.links.emplace_back();
  Sample sample;
  sample.base_angular_velocity = draw.vector(3);
  sample.base_angular_acceleration = draw.vector(3);
  sample.base_specific_force = draw.vector(3);
  const Eigen::MatrixXd Y = reference::regressor(robot, sample);
  const std::string definitions = fmt::format(
      "Definition body_motion := {{| omega := vec3 {}; alpha := vec3 {}; origin := vec3 {} |}}.",
      coq_list(sample.base_angular_velocity), coq_list(sample.base_angular_acceleration),
      coq_list(sample.base_specific_force));
  expect_same(evaluated(definitions,
                        "flat_map (fun i => entries 10 (force_rows body_motion i)) [ax; ay; az] ++ "
                        "flat_map (fun i => entries 10 (moment_rows body_motion i)) [ax; ay; az]"),
              Y.reshaped<Eigen::RowMajor>());
}

}  // namespace
}  // namespace shapeid::test

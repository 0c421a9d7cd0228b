// Division runs of any shapes and rows: the objective is equal right after a cut and never rises,
// and the fast path divides what the reference divides.
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "shapeid/fuzz/support/bytes.hpp"
#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/declines.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/tests/fast/division_runs.hpp"
#include "shapeid/tests/support/any_model.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

using namespace shapeid;
using test::few_hundred_eps, test::scaled;

namespace {

Eigen::Isometry3d any_pose(fuzz::Bytes& bytes) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (bytes.flag()) pose.linear() = bytes.rotation();
  pose.translation() = bytes.vector(0.3);
  return pose;
}

Shape any_shape(fuzz::Bytes& bytes) {
  const int kind = bytes.count(0, 4);
  const Eigen::Isometry3d pose = any_pose(bytes);
  const Eigen::Vector3d s(bytes.between(0.02, 0.3), bytes.between(0.02, 0.3),
                          bytes.between(0.02, 0.3));
  switch (kind) {
    case 0:
      return make_cuboid(s, pose);
    case 1:
      return make_cylinder(0.5 * s.x(), s.z(), pose);
    case 2:
      return make_ellipsoid(0.5 * s, pose);
    case 3:
      return make_convex_hull(
          {{s.x(), 0.01, 0.0}, {0.0, s.y(), 0.02}, {0.03, 0.0, s.z()}, {-0.02, -0.01, -0.03}},
          pose);
    default:
      return make_point(pose.translation(), s.prod());
  }
}

/// Shapes on one or two links, and rows of any numbers: no body need explain them.
test::ModelWithRows any_case(fuzz::Bytes& bytes) {
  test::ModelWithRows result;
  BodyModel& model = result.model;
  const int links = bytes.count(1, 2);
  const Eigen::Index numbers = Eigen::Index{10} * links;
  for (int i = 0; i < links; ++i) {
    model.free_links.push_back(i);
    for (int shapes = bytes.count(1, 3); shapes > 0; --shapes) {
      model.shapes.push_back({i, any_shape(bytes), std::to_string(model.shapes.size())});
    }
  }
  model.known = Eigen::VectorXd::Zero(numbers);
  MassProblem& p = result.problem;
  const int rows = bytes.count(1, 18);
  p.Y.resize(rows, numbers);
  p.F.resize(rows);
  p.W.resize(rows);
  for (int i = 0; i < rows; ++i) {
    p.W[i] = std::pow(10.0, 2.0 * bytes.unit());
    p.F[i] = 100.0 * bytes.unit();
    for (Eigen::Index k = 0; k < p.Y.cols(); ++k) p.Y(i, k) = 30.0 * bytes.unit();
  }
  result.expected_mass = bytes.between(0.1, 10.0);
  test::use_shapes(p, model, result.expected_mass);
  return result;
}

void check_laws(const test::ModelWithRows& given, const DivisionOptions& options) {
  const auto watch = [&](const reference::DivisionRun& run) {
    if (run.history.empty()) return;
    const DivisionStep& step = run.history.back();
    const double terms =
        test::objective_terms(run.problem, run.solution.m) +
        test::objective_terms(given.problem, Eigen::VectorXd::Zero(given.problem.shapes()));
    const Eigen::Index size = run.problem.F.size() + run.problem.shapes();
    fuzz::check(scaled(std::abs(step.objective_at_split - step.objective_before), terms, size) <
                    few_hundred_eps,
                "the objective is equal right after a cut");
    fuzz::check(
        scaled(step.objective_after - step.objective_at_split, terms, size) < few_hundred_eps,
        "the objective never rises");
  };
  static_cast<void>(reference::divide_and_solve(given.model, given.problem, options, watch));
}

/// Only the density term makes the answer one: it must stand out of the other terms' rounding.
bool determined(const MassProblem& p) {
  const double others = (p.W.cwiseSqrt().asDiagonal() * p.Y * p.U).squaredNorm();
  const double least = p.lambda / p.V.maxCoeff();
  return least > few_hundred_eps * std::numeric_limits<double>::epsilon() * others;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes(data, size);
  const int divisions = bytes.count(1, 8);
  const test::ModelWithRows given = any_case(bytes);
  check_laws(given,
             {.step = 0.0, .most_divisions = divisions, .expected_mass = given.expected_mass});
  if (!determined(given.problem)) return 0;
  const test::RunComparison run = test::compare_runs(given, divisions);
  fuzz::declines.count(run.declined);
  // The bounds of FastDivision.WholeRunsOfAnyModel, with their reasons there. But rows of any
  // numbers leave masses less determined than bodies do, by roundings (which the last check bounds)
  // over lambda: then each run divides by its own v, and what one sees ahead the other sees at most
  // twice their distance behind.
  constexpr double tie = 2e-9;
  fuzz::check(
      !run.tie_at_difference || *run.tie_at_difference <= tie + 2.0 * run.v_apart_at_difference,
      "both divide the same shapes, or there is a tie");
  fuzz::check(run.worst_objective < few_hundred_eps, "both have the same objective");
  fuzz::check(run.worst_scaled_mass < few_hundred_eps, "both have the same masses");
  return 0;
}

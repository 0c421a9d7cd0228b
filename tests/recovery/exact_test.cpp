// Exact accelerations, no noise, the truth inside the cone of the shapes: the true identifiable
// parameters must come back to rounding.
//
// What rounding allows: a row of Y Phi* - F is off by eps times the terms added up in it. With D
// the natural sizes of the parameters, e = D^-1 (Phi - Phi*) then satisfies
//   || e || <= c eps n T / sigma_min(Y D),   T = || terms of all rows ||,  n = rows of a sample,
// the last factor being what cond(Y D) is for a least squares error in units of ours.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <string>

#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/simbody/joint_trajectory.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/reference/identify.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/reference/triangle.hpp"
#include "shapeid/tests/physics/dynamics.hpp"
#include "shapeid/tests/recovery/quadruped.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using reference::natural_sizes;
using reference::Window;
using test::bundled_quadruped;
using test::few_hundred_eps;
using test::Quadruped;
using test::scaled;
using test::Trot;
using test::trot;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double body_mass = 13.0, base_mass = 5.5, legs_mass = 7.5;  // kg, about: for sizes

/// Rows of a motion and what rounding them is measured against.
struct Rows {
  MassProblem problem;      ///< lambda = 0
  Eigen::VectorXd natural;  ///< D
  double terms = 0.0;       ///< T
  Eigen::Index dof = 0;

  /// Y D, a triangle.
  [[nodiscard]] Eigen::MatrixXd scaled_rows() const {
    return reference::triangle(problem.Y) * natural.asDiagonal();
  }
};

std::vector<Sample> samples_of(const std::vector<SimulatedSample>& motion) {
  std::vector<Sample> samples;
  samples.reserve(motion.size());
  for (const SimulatedSample& s : motion) samples.push_back(s.sample);
  return samples;
}

/// `truth`: 10 per link of the robot that moved.
Rows rows_of(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
             const std::vector<Sample>& motion, const Eigen::VectorXd& truth, double mass) {
  Window window(robot, model, contacts, Eigen::VectorXd::Ones(robot.dof()));
  Rows rows;
  double squares = 0.0;
  for (const Sample& sample : motion) {
    window.add(sample);
    const double terms =
        test::size_of_terms(reference::regressor(robot, sample), truth) + sample.tau.norm();
    squares += terms * terms;
  }
  rows.problem = window.problem(model);
  rows.natural = natural_sizes(model, mass);
  rows.terms = std::sqrt(squares);
  rows.dof = robot.dof();
  return rows;
}

Eigen::VectorXd free_part(const BodyModel& model, const Eigen::VectorXd& all) {
  Eigen::VectorXd free(10 * static_cast<Eigen::Index>(model.free_links.size()));
  for (std::size_t i = 0; i < model.free_links.size(); ++i) {
    free.segment<10>(10 * static_cast<Eigen::Index>(i)) =
        all.segment<10>(Eigen::Index{10} * model.free_links[i]);
  }
  return free;
}

/// The singular value decomposition Y D = Q S V^T, cut where rounding begins.
struct Seen {
  Eigen::MatrixXd V;  ///< directions of D^-1 Phi that the motion shows, parameters x rank
  Eigen::VectorXd s;  ///< the diagonal of S, rank
  double gap;         ///< smallest singular value kept over the largest one dropped

  explicit Seen(const Rows& rows) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows.scaled_rows(), Eigen::ComputeFullV);
    const Eigen::VectorXd& all = svd.singularValues();
    const Eigen::Index rank = (all.array() > few_hundred_eps * eps * all[0]).count();
    V = svd.matrixV().leftCols(rank);
    s = all.head(rank);
    gap = rank < all.size() ? s[rank - 1] / all[rank] : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] double smallest() const { return s.tail<1>()[0]; }
};

/// What the motion shows of || e ||, in units of what rounding allows. `sought`: the true
/// parameters of the free links.
double roundings(const char* name, const Rows& rows, const Eigen::VectorXd& Phi,
                 const Eigen::VectorXd& sought) {
  const Seen seen(rows);
  const double error = (seen.V.transpose() * (Phi - sought).cwiseQuotient(rows.natural)).norm();
  const double result = scaled(error, rows.terms / seen.smallest(), rows.dof);
  fmt::print(
      "{}: {} of {} directions seen, gap {:.0e}, cond {:.1e}; error {:.1e} of natural sizes, "
      "{:.1e} "
      "of the unit of rounding\n",
      name, seen.V.cols(), seen.V.rows(), seen.gap, seen.s[0] / seen.smallest(), error, result);
  return result;
}

std::vector<int> links_from(const Robot& robot, int first) {
  std::vector<int> links;
  for (int link = first; link < robot.link_count(); ++link) links.push_back(link);
  return links;
}

TEST(Exact, TheBaseComesBackWithForcesProjectedOrMeasured) {
  const Quadruped quadruped = bundled_quadruped();
  const Robot& robot = quadruped.robot;
  const auto motion = samples_of(trot(robot, {}));
  const Eigen::VectorXd truth = stacked_parameters(robot);
  for (const auto contacts : {ContactTreatment::project, ContactTreatment::measured}) {
    const Rows rows = rows_of(robot, quadruped.base, contacts, motion, truth, base_mass);
    const MassSolution found = reference::solve_masses(rows.problem);
    const bool projected = contacts == ContactTreatment::project;
    EXPECT_EQ(Seen(rows).V.cols(), 10);
    EXPECT_LT(roundings(projected ? "base, forces projected" : "base, forces measured", rows,
                        found.Phi, truth.head<10>()),
              few_hundred_eps);
  }
}

// Thirteen free links: only what the motion shows can be compared, as the forces of another motion.
// Over two hundred shapes and directions seen 1e5 times less well than others, the solver may stop
// as soon as no gradient entry is negative beyond rounding, z >= -tol. For a quadratic whose
// minimum is zero at m*, 2 || Y (Phi - Phi*) ||^2 = -z^T (m* - m) <= tol sum m*, and tol = c eps ||
// a || || b ||: the rows are right to sqrt(c eps) of their size. On other rows this grows by at
// most
// || Y_other D V S^-1 ||, with Y D = Q S V^T.
TEST(Exact, TheWholeBodyPredictsAnotherMotion) {
  const Robot robot = bundled_quadruped().robot;
  const BodyModel model = test::divided_cuboids(robot, links_from(robot, 0), 16);
  const Eigen::VectorXd truth = stacked_parameters(robot);
  Trot other;
  other.seconds = 1.0;
  other.seed = 2;
  constexpr auto project = ContactTreatment::project;
  const Rows rows = rows_of(robot, model, project, samples_of(trot(robot, {})), truth, body_mass);
  const Rows others =
      rows_of(robot, model, project, samples_of(trot(robot, other)), truth, body_mass);
  const Seen seen(rows);
  EXPECT_LT(seen.V.cols(), 130);
  EXPECT_GT(seen.gap, 1.0 / std::sqrt(eps)) << "it is not clear what the motion shows";

  // Directions that this motion does not show mean nothing to the other one either: they are hidden
  // by the robot's structure. V is known to eps times the condition.
  const Eigen::MatrixXd asked = others.scaled_rows();
  const Eigen::MatrixXd inside = asked * seen.V;
  EXPECT_LT(scaled((asked - inside * seen.V.transpose()).norm(),
                   asked.norm() * seen.s[0] / seen.smallest(), rows.dof),
            few_hundred_eps);

  const MassSolution found = reference::solve_masses(rows.problem);
  roundings("whole body", rows, found.Phi, truth);
  const double growth = (inside * seen.s.cwiseInverse().asDiagonal()).norm();
  const double error = (others.problem.Y * (found.Phi - truth)).norm();
  const double allowed =
      growth * rows.terms * std::sqrt(few_hundred_eps * eps * static_cast<double>(rows.dof));
  fmt::print("whole body: forces of another motion off by {:.1e} of their terms, allowed {:.1e}\n",
             error / others.terms, allowed / others.terms);
  EXPECT_LT(error, allowed);
}

// The quadruped's body bolted to a table: four arms of three joints on a fixed base.
TEST(Exact, ArmsOnAFixedBaseComeBack) {
  Robot robot = bundled_quadruped().robot;
  robot.root = Root::fixed;
  robot.contacts.clear();
  JointTrajectoryOptions options;
  options.rate = 50.0;
  std::vector<Sample> motion;
  simulate_joint_trajectory(robot, options, [&](const Sample& s) { motion.push_back(s); });
  const BodyModel model = test::divided_cuboids(robot, links_from(robot, 1), 32);
  const Eigen::VectorXd truth = stacked_parameters(robot);
  const Rows rows = rows_of(robot, model, ContactTreatment::ignore, motion, truth, legs_mass);
  const MassSolution found = reference::solve_masses(rows.problem);
  EXPECT_LT(roundings("arms", rows, found.Phi, free_part(model, truth)), few_hundred_eps);
}

struct LoadCase {
  Load load;
  Rows rows;  ///< of the load alone: the robot's own links are known
};

LoadCase carrying(const Robot& robot, const BodyModel& region) {
  Trot wanted;
  wanted.load = Load{};
  return {*wanted.load,
          rows_of(robot, region, ContactTreatment::project, samples_of(trot(robot, wanted)),
                  stacked_parameters(with_load(robot, *wanted.load)), 1.0)};
}

// A block of 4 cm in the middle of 27 such cells is a corner of their cone: 26 masses are zero.
TEST(Exact, ALoadThatFillsOneCellComesBack) {
  const Robot robot = bundled_quadruped().robot;
  const Load load;
  BodyModel region =
      load_region(robot, load.link, load.centre - 0.5 * load.sides, load.centre + 0.5 * load.sides);
  for (int cell = 0; cell < 27; ++cell) {
    if (cell == 13) continue;  // the middle one, which is there already
    const int layer = cell / 9;
    const Eigen::Vector3d place(layer - 1, cell / 3 % 3 - 1, cell % 3 - 1);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = load.centre + load.sides.cwiseProduct(place);
    region.shapes.push_back({load.link, make_cuboid(load.sides, pose), std::to_string(cell)});
  }
  const LoadCase carried = carrying(robot, region);
  const MassSolution found = reference::solve_masses(carried.rows.problem);
  EXPECT_LT(roundings("load in a cell", carried.rows, found.Phi, inertia_of(carried.load).values),
            few_hundred_eps);
}

// In a region that is cut without knowing where the block is, the truth is at first in no cone:
// what is left of the objective says how far away the answer may be, || Y (Phi - Phi*) ||^2 =
// objective.
TEST(Exact, ALoadInARegionIsAsNearAsItsObjectiveSays) {
  const Robot robot = bundled_quadruped().robot;
  const BodyModel region =
      load_region(robot, 0, Eigen::Vector3d(-0.11, -0.07, 0.05), Eigen::Vector3d(0.09, 0.09, 0.17));
  const LoadCase carried = carrying(robot, region);
  const Eigen::VectorXd truth = inertia_of(carried.load).values;
  const Seen seen(carried.rows);
  ASSERT_EQ(seen.V.cols(), 10);
  DivisionOptions options;
  options.expected_mass = 1.0;
  options.most_divisions = 30;
  options.step = 1e-9;  // all of them
  const double rounding =
      few_hundred_eps * eps * static_cast<double>(carried.rows.dof) * carried.rows.terms;
  double before = std::numeric_limits<double>::infinity();
  const auto check = [&](const reference::DivisionRun& run) {
    const Eigen::VectorXd& Phi = run.solution.Phi;
    const double error = (Phi - truth).cwiseQuotient(carried.rows.natural).norm();
    const double allowed = std::sqrt(run.solution.value.data) / seen.smallest();
    EXPECT_LE(error, allowed + rounding / seen.smallest());
    EXPECT_LE(run.solution.value.data, before + rounding * rounding);
    before = run.solution.value.data;
    const std::size_t divisions = run.history.size();
    if (divisions <= 20 && divisions % 5 == 0) {
      fmt::print(
          "load, {:3} divisions: mass {:.5f} of 1 kg, centre off by {:.2f} mm, error {:.1e} "
          "of natural sizes, allowed {:.1e}\n",
          divisions, Phi[0], 1e3 * (Phi.segment<3>(1) / Phi[0] - carried.load.centre).norm(), error,
          allowed);
    }
  };
  const auto run = reference::divide_and_solve(region, carried.rows.problem, options, check);
  // By now cells smaller than the block surround its centre, and the truth is in their cone.
  EXPECT_LT(roundings("load in a region", carried.rows, run.solution.Phi, truth), few_hundred_eps);
}

}  // namespace
}  // namespace shapeid

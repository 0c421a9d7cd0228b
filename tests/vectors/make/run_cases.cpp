// Cases of the whole method: division runs, and an unknown load on a link of a robot.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/reference/projection.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/vectors/make/cases.hpp"
#include "shapeid/tests/vectors/make/robots.hpp"

namespace shapeid::vectors {
namespace {

using nlohmann::json;
using reference::DivisionRun;

/// The density term relative to the objective of no mass. A million times the method's default:
/// then even normal equations in doubles give every mass to nine digits, and programs that solve
/// otherwise divide the same shapes.
constexpr double density_share = 1e-6;
/// Of masses (in M0), objectives (in b^T b) and parameters: a hundredth of what separates the
/// choices below, a hundred times what normal equations lose.
constexpr double run_forgiven = 1e-7;
/// The first and second of the criterion differ by at least this, relative to the first.
constexpr double clear_choice = 1e-4;

struct RecordedRun {
  std::vector<double> places, masses, objectives;
  DivisionRun last;
  bool clear = true, tied = false;
};

/// Divides `options.most_divisions` times; notes every choice, and whether it was a clear one.
RecordedRun recorded(const BodyModel& model, const MassProblem& problem,
                     const DivisionOptions& options) {
  RecordedRun record{{}, {}, {}, {model, problem, {}, {}, {}}};
  std::optional<Eigen::Index> choice;
  record.last = reference::divide_and_solve(model, problem, options, [&](const DivisionRun& run) {
    if (!run.history.empty()) record.places.push_back(static_cast<double>(choice.value()));
    const Eigen::VectorXd& m = run.solution.m;
    record.masses.insert(record.masses.end(), m.begin(), m.end());
    record.objectives.push_back(run.solution.value.total());
    Eigen::VectorXd v = reference::division_criterion(run.model, m, options);
    choice = reference::next_to_divide(v, options.tie);
    std::sort(v.begin(), v.end(), std::greater<>());
    const double apart = v.size() < 2 ? 1.0 : (v[0] - v[1]) / v[0];
    // Where no shape has mass, some stop, and some divide the first.
    if (!(v[0] > 0.0)) record.clear = false;
    if (apart < options.tie) record.tied = true;
    if (apart >= options.tie && apart < clear_choice) record.clear = false;
  });
  return record;
}

DivisionOptions options_of(double k1, double k2, int divisions, double expected_mass) {
  DivisionOptions options;
  options.k1 = k1;
  options.k2 = k2;
  options.step = 0.0;  // no step is below it: all divisions that are asked for are made
  options.most_divisions = divisions;
  options.expected_mass = expected_mass;
  return options;
}

json options_json(const DivisionOptions& options, double lambda) {
  return {{"k1", options.k1},
          {"k2", options.k2},
          {"tie", options.tie},
          {"divisions", options.most_divisions},
          {"expected_mass", options.expected_mass},
          {"lambda", lambda}};
}

json list_json(const std::vector<double>& list) { return list; }

void set_lambda(MassProblem& problem, double expected_mass) {
  problem.lambda = density_share / 1e-12 * default_lambda(problem, expected_mass);
}

struct StatedCuboid {
  int link;
  Eigen::Vector3d size, xyz, rpy;
};

json cuboid_json(const StatedCuboid& cuboid) {
  return {{"kind", "cuboid"},
          {"link", cuboid.link},
          {"size", vector_json(cuboid.size)},
          {"xyz", vector_json(cuboid.xyz)},
          {"rpy", vector_json(cuboid.rpy)}};
}

/// The case of a run, or nothing if some choice is so close that rounding could turn it.
std::optional<json> run_case(MassProblem rows, const std::vector<StatedCuboid>& cuboids, int links,
                             const DivisionOptions& options, json flags) {
  BodyModel model{Eigen::VectorXd::Zero(Eigen::Index{10} * links), {}, {}};
  json shapes = json::array();
  for (int link = 0; link < links; ++link) model.free_links.push_back(link);
  for (std::size_t i = 0; i < cuboids.size(); ++i) {
    const StatedCuboid& c = cuboids[i];
    model.shapes.push_back(
        {c.link, make_cuboid(c.size, pose_of(c.xyz, c.rpy)), fmt::format("{}", i)});
    shapes.push_back(cuboid_json(c));
  }
  rows.U = shape_columns(model);
  rows.V = shape_volumes(model);
  set_lambda(rows, options.expected_mass);
  const RecordedRun record = recorded(model, rows, options);
  if (!record.clear) return std::nullopt;
  if (record.tied) flags.push_back("TiedCriterion");
  if (record.last.solution.m.minCoeff() == 0.0) flags.push_back("MassAtBound");
  json input = options_json(options, rows.lambda);
  input.update({{"Y", matrix_json(rows.Y)},
                {"F", vector_json(rows.F)},
                {"W", vector_json(rows.W)},
                {"shapes", shapes}});
  const double none = rows.F.dot(rows.W.cwiseProduct(rows.F)), M0 = options.expected_mass;
  return json{{"flags", flags},
              {"input", input},
              {"expected",
               {{"divided", list_json(record.places)},
                {"masses", list_json(record.masses)},
                {"objectives", list_json(record.objectives)},
                {"parameters", vector_json(record.last.solution.Phi)}}},
              {"within",
               {{"divided", 0.0},
                {"masses", run_forgiven * M0},
                {"objectives", run_forgiven * none},
                {"parameters", run_forgiven * M0}}}};
}

StatedCuboid drawn_cuboid(test::Draw& draw, int link) {
  return {link, draw.sides(0.1, 0.4), draw.vector(0.2), draw.vector(3.0)};
}

MassProblem drawn_rows(test::Draw& draw) {
  const Eigen::Vector3d centre = draw.vector(0.15);
  return test::load_window(draw, 4, test::cuboid_body(1.0, centre, {0.05, 0.04, 0.03}), 0.05);
}

/// Rows in which two bodies of a kilogram move, each its own way.
MassProblem rows_of_two(test::Draw& draw) {
  const MassProblem one = drawn_rows(draw), other = drawn_rows(draw);
  MassProblem both = one;
  both.Y.resize(one.Y.rows(), 20);
  both.Y << one.Y, other.Y;
  both.F += other.F;
  return both;
}

/// Calls `make` until it makes a case whose choices are clear.
template <typename Make>
json first_clear(const Make& make) {
  constexpr int most_draws = 100;
  for (int i = 0; i < most_draws; ++i) {
    if (std::optional<json> made = make()) return *std::move(made);
  }
  throw std::logic_error("no draw has clear choices");
}

/// What a load case is about: a robot, where its load may be, and on which link.
struct LoadPlan {
  Plan robot;
  int link;
  int samples;
  std::string flag;
};

std::optional<json> load_case(test::Draw& draw, const LoadPlan& plan) {
  Robot robot = drawn_robot(draw, plan.robot);
  if (plan.flag == "RankDeficientJacobian") robot.contacts.push_back(robot.contacts.front());
  const Eigen::Vector3d lower(-0.2, -0.15, 0.05), upper(0.25, 0.1, 0.15), xyz = draw.vector(0.1),
                                                                          rpy = draw.vector(1.0);
  const Eigen::Isometry3d area = pose_of(xyz, rpy);
  const double mass = draw.between(1.0, 4.0);
  const Eigen::Vector3d place = 0.5 * (lower + upper) + draw.vector(0.05);
  Eigen::VectorXd Phi = stacked_parameters(robot);
  const json known = vector_json(Phi);
  const Eigen::VectorXd given = Phi;
  const Eigen::Index column = Eigen::Index{10} * plan.link;
  Phi.segment<10>(column) += moved(test::cuboid_body(mass, place, {0.05, 0.06, 0.04}), area).values;

  const Eigen::VectorXd weight =
      (2.0 * Eigen::VectorXd::Ones(robot.dof()) + drawn_matrix(draw, robot.dof(), 1)).cwiseAbs();
  MassProblem problem;
  json samples = json::array();
  for (int i = 0; i < plan.samples; ++i) {
    Sample sample = drawn_sample(draw, robot);
    const Eigen::MatrixXd Y = reference::regressor(robot, sample),
                          J = reference::contact_jacobian(robot, sample);
    // Feet carry what the base needs, joints the rest; torques are measured with 1 % of noise.
    Eigen::VectorXd force = Y * Phi;
    if (robot.root == Root::floating) {
      const Eigen::MatrixXd Jb = J.leftCols<6>().transpose();
      force -= J.transpose() * Jb.completeOrthogonalDecomposition().solve(force.head<6>());
    }
    sample.tau = force.tail(robot.joint_count());
    for (double& tau : sample.tau) tau *= 1.0 + 0.01 * draw.normal();
    samples.push_back(sample_json(sample));
    const Eigen::VectorXd applied = reference::applied_force(robot, sample);
    const auto free =
        reference::eliminate_contacts(Y.middleCols<10>(column), applied - Y * given, J, weight);
    const Eigen::Index before = problem.F.size();
    problem.Y.conservativeResize(before + free.Y.rows(), 10);
    problem.F.conservativeResize(before + free.F.size());
    problem.Y.bottomRows(free.Y.rows()) = free.Y;
    problem.F.tail(free.F.size()) = free.F;
  }
  problem.W = Eigen::VectorXd::Ones(problem.F.size());
  const BodyModel model = load_region(robot, plan.link, lower, upper, area);
  problem.U = shape_columns(model);
  problem.V = shape_volumes(model);
  const DivisionOptions options = options_of(1.0, 1e-4, 5, mass);
  set_lambda(problem, mass);
  const RecordedRun record = recorded(model, problem, options);
  if (!record.clear) return std::nullopt;

  const Eigen::VectorXd& found = record.last.solution.Phi;
  Eigen::Vector4d load;
  load << found[0], found.segment<3>(1) / found[0];
  json input = options_json(options, problem.lambda);
  input.update({{"robot", robot_json(robot)},
                {"parameters", known},
                {"samples", samples},
                {"weight", vector_json(weight)},
                {"area",
                 {{"link", plan.link},
                  {"lower", vector_json(lower)},
                  {"upper", vector_json(upper)},
                  {"xyz", vector_json(xyz)},
                  {"rpy", vector_json(rpy)}}}});
  json flags = json::array();
  if (!plan.flag.empty()) flags.push_back(plan.flag);
  return json{{"flags", flags},
              {"input", input},
              {"expected",
               {{"divided", list_json(record.places)},
                {"mass_and_centre", vector_json(load)},
                {"objective", {record.objectives.back()}}}},
              {"within",
               {{"divided", 0.0},
                {"mass_and_centre", run_forgiven * mass},
                {"objective", run_forgiven * problem.F.squaredNorm()}}}};
}

}  // namespace

json run_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 6; ++i) {
    const bool dense = i % 2 == 1;
    cases.push_back(first_clear([&] {
      const MassProblem rows = drawn_rows(draw);
      const std::vector<StatedCuboid> cuboids = {drawn_cuboid(draw, 0), drawn_cuboid(draw, 0)};
      const auto with = [&](double k2) {
        return run_case(rows, cuboids, 1, options_of(1.0, k2, 5, 1.0), json::array());
      };
      if (!dense) return with(1e-4);
      // Where density counts, it decides at least once.
      const std::optional<json> made = with(0.2), without = with(0.0);
      const bool decides =
          made && without &&
          made->at("expected").at("divided") != without->at("expected").at("divided");
      return decides ? made : std::nullopt;
    }));
  }
  for (int i = 0; i < 2; ++i) {
    cases.push_back(first_clear([&] {
      const MassProblem rows = rows_of_two(draw);
      return run_case(rows, {drawn_cuboid(draw, 0), drawn_cuboid(draw, 1)}, 2,
                      options_of(1.0, 1e-4, 5, 2.0), {"TwoLinks"});
    }));
  }
  cases.push_back(first_clear([&] {
    MassProblem few = drawn_rows(draw);
    few.Y.conservativeResize(3, Eigen::NoChange);
    few.F.conservativeResize(3);
    few.W.conservativeResize(3);
    return run_case(few, {drawn_cuboid(draw, 0), drawn_cuboid(draw, 0)}, 1,
                    options_of(1.0, 1e-4, 5, 1.0), {"RankDeficientExcitation"});
  }));
  for (int i = 0; i < 2; ++i) {  // sides of equal length: the rule says which is cut
    cases.push_back(first_clear([&] {
      StatedCuboid square = drawn_cuboid(draw, 0);
      square.size[2] = square.size[1] = square.size[0] + (i == 0 ? 0.1 : 0.0);
      const MassProblem rows = drawn_rows(draw);
      return run_case(rows, {square}, 1, options_of(1.0, 1e-4, 3, 1.0), {"TiedSides"});
    }));
  }
  // Two congruent cuboids and a balance: nothing but the rule for ties says which is divided.
  MassProblem balance;
  balance.Y = test::body_rows({0, 0, 0}, {0, 0, 0}, {0, 0, 9.81}).row(2);
  balance.F = Eigen::VectorXd::Constant(1, 9.81);
  balance.W = Eigen::VectorXd::Ones(1);
  const Eigen::Vector3d size(0.1, 0.2, 0.3), none = Eigen::Vector3d::Zero();
  cases.push_back(first_clear([&] {
    return run_case(balance, {{0, size, {0.2, 0, 0}, none}, {0, size, {-0.2, 0, 0}, none}}, 1,
                    options_of(1.0, 1e-4, 5, 1.0), {"RankDeficientExcitation"});
  }));
  return cases;
}

json load_cases(test::Draw& draw) {
  constexpr auto revolute = JointKind::revolute;
  const Plan arm{Root::fixed, {0, 1, 2}, {revolute, revolute, revolute}, {}},
      legs{Root::floating, {0, 1, 0, 3, 0, 5}, std::vector<JointKind>(6, revolute), {2, 4, 6}};
  json cases = json::array();
  for (const LoadPlan& plan :
       {LoadPlan{arm, 3, 8, ""}, LoadPlan{arm, 2, 8, ""}, LoadPlan{legs, 0, 8, ""},
        LoadPlan{legs, 0, 8, ""}, LoadPlan{legs, 4, 8, ""},
        LoadPlan{legs, 0, 8, "RankDeficientJacobian"}}) {
    cases.push_back(first_clear([&] { return load_case(draw, plan); }));
  }
  return cases;
}

}  // namespace shapeid::vectors

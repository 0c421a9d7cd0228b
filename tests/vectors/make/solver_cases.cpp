// Cases of the method: projection, masses, divisions, and answers to be judged.
#include <string>

#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/shape.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/reference/projection.hpp"
#include "shapeid/tests/vectors/make/cases.hpp"

namespace shapeid::vectors {
namespace {

using nlohmann::json;

Eigen::MatrixXd drawn_matrix(test::Draw& draw, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd M(rows, columns);
  for (double& x : M.reshaped()) x = draw.sign();
  return M;
}

/// A trunk's load of 1 kg in a few cuboids.
StatedProblem drawn_problem(test::Draw& draw, const Eigen::Vector3i& counts, double noise) {
  StatedProblem p{
      test::load_window(
          draw, 4,
          test::cuboid_body(1.0, {draw.between(-0.1, 0.1), 0.03, 0.07}, {0.05, 0.04, 0.03}), noise),
      {},
      {}};
  test::fill_with_cuboids(p.masses, {-0.2, -0.1, 0.05}, {0.2, 0.1, 0.1}, counts);
  p.masses.lambda = default_lambda(p.masses, 1.0);
  return p;
}

json masses_case(const StatedProblem& p, const json& flags) {
  return {{"flags", flags},
          {"input", json::parse(problem_to_json(p))},
          {"expected", {{"certified_gap", 1e-9}}}};
}

Answer answer_of(const StatedProblem& p, const Eigen::VectorXd& m) {
  return {problem_digest(p), m, p.masses.U * m, objective(p.masses, m).total()};
}

json certify_case(const StatedProblem& p, const Answer& answer, bool accepted,
                  const std::string& flag) {
  return {{"flags", json::array({flag})},
          {"input",
           {{"problem", json::parse(problem_to_json(p))},
            {"answer", json::parse(answer_to_json(answer))},
            {"gap", 1e-9}}},
          {"expected", {{"accepted", accepted}}}};
}

}  // namespace

json projection_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 9; ++i) {
    const Eigen::Index rows = 8, contacts = 3;
    const Eigen::MatrixXd Y = drawn_matrix(draw, rows, 10);
    Eigen::MatrixXd J = drawn_matrix(draw, contacts, rows);
    json flags = json::array();
    if (i % 3 == 1) {
      J.row(2) = 2.0 * J.row(0);  // a contact named twice, in other units
      flags.push_back("RankDeficientJacobian");
    }
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(rows);
    if (i >= 3) {
      for (double& w : weight) w = draw.between(0.2, 5.0);
    }
    const Eigen::VectorXd F = drawn_matrix(draw, rows, 1);
    const auto free = reference::eliminate_contacts(Y, F, J, weight);
    Eigen::MatrixXd YF(free.Y.rows(), 11);
    YF << free.Y, free.F;
    const Eigen::MatrixXd gram = YF.transpose() * YF;
    const Eigen::VectorXd expected = gram.reshaped<Eigen::RowMajor>();
    const double size = weight.maxCoeff() * static_cast<double>(rows);
    cases.push_back(
        {{"flags", flags},
         {"input",
          {{"Y", matrix_json(Y)},
           {"F", vector_json(F)},
           {"J", matrix_json(J)},
           {"weight", vector_json(weight)}}},
         {"expected", {{"gram", vector_json(expected)}, {"rank", {free.rank}}}},
         {"within",
          {{"gram", vector_json(Eigen::VectorXd::Constant(121, forgiven * size * 100.0))},
           {"rank", {0.0}}}}});
  }
  return cases;
}

json masses_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 6; ++i)
    cases.push_back(masses_case(drawn_problem(draw, {2, 2, 1}, 0.05), {}));
  for (int i = 0; i < 3; ++i) {
    StatedProblem p = drawn_problem(draw, {3, 2, 1}, 0.0);
    p.masses.lambda = 0.0;
    cases.push_back(masses_case(p, {"WithoutNoise"}));
  }
  StatedProblem many = drawn_problem(draw, {4, 3, 1}, 0.05);  // twelve shapes, ten parameters
  cases.push_back(masses_case(many, {"ManyShapes"}));
  many.masses.lambda = 0.0;
  cases.push_back(masses_case(many, {"NonUniqueMinimiser"}));
  StatedProblem few = drawn_problem(draw, {2, 2, 1}, 0.05);
  few.masses.Y.conservativeResize(2, Eigen::NoChange);
  few.masses.F.conservativeResize(2);
  few.masses.W.conservativeResize(2);
  cases.push_back(masses_case(few, {"RankDeficientExcitation"}));
  StatedProblem away = drawn_problem(draw, {2, 2, 1}, 0.05);
  away.masses.F *= -1.0;  // a force upward: nothing helps but no mass
  cases.push_back(masses_case(away, {"MassAtBound"}));
  return cases;
}

json division_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 9; ++i) {
    const Eigen::Vector3d xyz = draw.vector(0.3), rpy = draw.vector(3.0),
                          size(draw.between(0.1, 0.5), draw.between(0.1, 0.5),
                               draw.between(0.1, 0.5));
    const Eigen::Isometry3d pose = pose_of(xyz, rpy);
    const double mass = draw.between(0.1, 5.0), fraction = i < 3 ? 0.5 : draw.between(0.1, 0.9);
    const int axis = i % 3;
    const auto [first, second] = divide(make_cuboid(size, pose), axis, fraction);
    Eigen::VectorXd expected(24), sizes(24);
    const double reach = xyz.norm() + size.norm();
    for (const auto& [part, share, at] :
         {std::tuple{&first, fraction, 0}, std::tuple{&second, 1.0 - fraction, 12}}) {
      expected.segment<12>(at) << volume(*part), mass * share, unit_parameters(*part).values;
      sizes.segment<12>(at) << size.prod(), mass, 1.0, Eigen::Vector3d::Constant(reach),
          Eigen::VectorXd::Constant(6, reach * reach);
    }
    cases.push_back({{"flags", json::array()},
                     {"input",
                      {{"size", vector_json(size)},
                       {"xyz", vector_json(xyz)},
                       {"rpy", vector_json(rpy)},
                       {"mass", mass},
                       {"axis", axis},
                       {"fraction", fraction}}},
                     {"expected", {{"parts", vector_json(expected)}}},
                     {"within", {{"parts", vector_json(forgiven * sizes)}}}});
  }
  return cases;
}

json certify_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 2; ++i) {
    const StatedProblem p = drawn_problem(draw, {3, 2, 1}, 0.05);
    const Eigen::VectorXd m = reference::solve_masses(p.masses).m;
    Eigen::Index heaviest = 0;
    m.maxCoeff(&heaviest);
    const auto with = [&](double factor) {
      Eigen::VectorXd other = m;
      other[heaviest] *= factor;
      return answer_of(p, other);
    };
    cases.push_back(certify_case(p, with(1.0), true, "Optimum"));
    cases.push_back(certify_case(p, with(1.01), false, "MassPerturbed"));
    cases.push_back(certify_case(p, with(0.0), false, "WrongActiveSet"));
    cases.push_back(
        certify_case(p, answer_of(p, Eigen::VectorXd::Zero(m.size())), false, "NoMass"));
    Answer negative = answer_of(p, m);
    negative.masses[heaviest] *= -1.0;
    cases.push_back(certify_case(p, negative, false, "NegativeMass"));
    Answer slanted = answer_of(p, m);
    slanted.parameters[5] += 1e-3;
    cases.push_back(certify_case(p, slanted, false, "ParametersOfAnotherBody"));
    Answer boastful = answer_of(p, m);
    boastful.objective *= 0.5;
    cases.push_back(certify_case(p, boastful, false, "ObjectiveUnderstated"));
    StatedProblem bounded = p;
    bounded.masses.mass_bound = 0.5 * m.sum();
    cases.push_back(certify_case(bounded, answer_of(bounded, m), false, "BeyondTheMassBound"));
  }
  return cases;
}

json flags() {
  return {
      {"NoRotation", "the body does not turn: terms in the angular velocity are not asked for"},
      {"RankDeficientJacobian",
       "a force acts through two rows of J: the rank is less than their number. What is projected "
       "away is the same; forces are not unique, and none are compared"},
      {"WithoutNoise", "the optimum is zero up to rounding: only the gap counts"},
      {"ManyShapes",
       "more shapes than parameters: the density term alone says where the mass is. "
       "Judged by the gap, so other masses of nearly the same objective pass"},
      {"NonUniqueMinimiser", "lambda = 0 and more shapes than parameters: any minimiser passes"},
      {"RankDeficientExcitation", "two rows: the data alone leave the masses undetermined"},
      {"MassAtBound", "the optimum is no mass at all"},
      {"Optimum", "must be accepted"},
      {"MassPerturbed", "one mass is one percent too large"},
      {"WrongActiveSet", "the heaviest shape is left out"},
      {"NoMass", "m = 0, which certifies itself where the mass bound is taken from the answer"},
      {"NegativeMass", "a mass is negative"},
      {"ParametersOfAnotherBody", "the parameters written beside the masses are not theirs"},
      {"ObjectiveUnderstated", "the objective is said to be half of what it is"},
      {"BeyondTheMassBound", "the masses add up to more than the problem declares"}};
}

}  // namespace shapeid::vectors

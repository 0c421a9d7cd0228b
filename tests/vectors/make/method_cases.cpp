// Cases of the method: projection, masses, and answers to be judged.
#include <Eigen/LU>

#include <cmath>
#include <string>

#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/reference/projection.hpp"
#include "shapeid/tests/vectors/make/cases.hpp"

namespace shapeid::vectors {
namespace {

using nlohmann::json;

/// Above the optimum, relative to the objective of no mass.
constexpr double accepted_gap = 1e-9;

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

/// Forces upward, as of something lighter than nothing: any mass makes it worse.
StatedProblem drawn_without_mass(test::Draw& draw) {
  while (true) {
    StatedProblem p = drawn_problem(draw, {2, 2, 1}, 0.05);
    p.masses.F *= -1.0;
    if (gradient(p.masses, Eigen::VectorXd::Zero(4)).minCoeff() > 0.0) return p;
  }
}

/// Another link whose body moves its own way in the same rows.
void append_link(MassProblem& p, const MassProblem& other) {
  const Eigen::Index rows = p.Y.rows(), shapes = p.shapes(), added = other.shapes();
  p.Y.conservativeResize(rows, p.Y.cols() + 10);
  p.Y.rightCols<10>() = other.Y;
  p.F += other.F;
  p.U.conservativeResizeLike(Eigen::MatrixXd::Zero(p.U.rows() + 10, shapes + added));
  p.U.bottomRightCorner(10, added) = other.U;
  p.V.conservativeResize(shapes + added);
  p.V.tail(added) = other.V;
  p.mass_bound += other.mass_bound;
}

json masses_case(const StatedProblem& p, const json& flags) {
  return {{"flags", flags},
          {"input", json::parse(problem_to_json(p))},
          {"expected", {{"certified_gap", accepted_gap}}}};
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
            {"gap", accepted_gap}}},
          {"expected", {{"accepted", accepted}}}};
}

}  // namespace

json projection_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 11; ++i) {
    const Eigen::Index dof = 8, contacts = 3;
    const Eigen::MatrixXd Y = drawn_matrix(draw, dof, 10);
    Eigen::MatrixXd J = drawn_matrix(draw, contacts, dof);
    json flags = json::array();
    if (i < 9 && i % 3 == 1) {
      J.row(2) = 2.0 * J.row(0);  // a contact named twice, in other units
      flags.push_back("RankDeficientJacobian");
    }
    // Of J, over the smallest singular value: what roundings of the basis grow by.
    double condition = 100.0;
    if (i >= 9) {
      J.row(2) = J.row(0) + 1e-6 * J.row(2);
      condition = 1e8;
      flags.push_back("NearlySingular");
    }
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(dof);
    if (i >= 3) {
      for (double& w : weight) w = draw.between(0.2, 5.0);
    }
    const Eigen::VectorXd F = drawn_matrix(draw, dof, 1);
    const auto free = reference::eliminate_contacts(Y, F, J, weight);
    Eigen::MatrixXd YF(free.Y.rows(), 11);
    YF << free.Y, free.F;
    const Eigen::MatrixXd gram = YF.transpose() * YF;
    const Eigen::VectorXd expected = gram.reshaped<Eigen::RowMajor>();
    const double size = condition * weight.maxCoeff() * static_cast<double>(dof);
    json made = number_case({{"Y", matrix_json(Y)},
                             {"F", vector_json(F)},
                             {"J", matrix_json(J)},
                             {"weight", vector_json(weight)}},
                            "gram", expected, size);
    made["flags"] = flags;
    made["expected"]["rank"] = {free.rank};
    made["within"]["rank"] = 0.0;
    cases.push_back(made);
  }
  return cases;
}

json masses_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 6; ++i)
    cases.push_back(masses_case(drawn_problem(draw, {2, 2, 1}, 0.05), json::array()));
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
  cases.push_back(masses_case(drawn_without_mass(draw), {"MassAtBound"}));
  StatedProblem twins = drawn_problem(draw, {3, 2, 1}, 0.05);
  twins.masses.U.col(1) = twins.masses.U.col(0) + 1e-7 * twins.masses.U.col(1);
  cases.push_back(masses_case(twins, {"NearlySingular"}));
  StatedProblem two = drawn_problem(draw, {2, 2, 1}, 0.05);
  const StatedProblem other = drawn_problem(draw, {2, 1, 1}, 0.05);
  append_link(two.masses, other.masses);
  cases.push_back(masses_case(two, {"TwoLinks"}));
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

    // f rises by curvature * step^2 from the optimum along a mass that is free to move.
    const Eigen::VectorXd column = p.masses.Y * p.masses.U.col(heaviest);
    const double none = p.masses.F.dot(p.masses.W.cwiseProduct(p.masses.F)),
                 curvature = column.dot(p.masses.W.cwiseProduct(column)) +
                             p.masses.lambda / p.masses.V[heaviest];
    for (const double share : {0.5, 2.0}) {
      const double step = std::sqrt(share * accepted_gap * none / curvature);
      cases.push_back(
          certify_case(p, with(1.0 + step / m[heaviest]), share < 1.0, "NearTheAcceptedGap"));
    }
  }
  const StatedProblem away = drawn_without_mass(draw);
  cases.push_back(
      certify_case(away, answer_of(away, Eigen::VectorXd::Zero(4)), true, "MassAtBound"));

  // Twelve shapes that all have mass, and a step that changes no parameter.
  StatedProblem many = drawn_problem(draw, {4, 3, 1}, 0.0);
  many.masses.lambda = 0.0;
  Eigen::VectorXd m(12);
  for (double& mass : m) mass = draw.between(0.05, 0.1);
  many.masses.F = many.masses.Y * (many.masses.U * m);
  const Eigen::VectorXd nothing = many.masses.U.fullPivLu().kernel().col(0);
  m += 0.04 / nothing.cwiseAbs().maxCoeff() * nothing;
  cases.push_back(certify_case(many, answer_of(many, m), true, "NonUniqueMinimiser"));
  return cases;
}

}  // namespace shapeid::vectors

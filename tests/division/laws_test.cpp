// Laws that every division obeys, whatever the shapes and the data.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>

#include "shapeid/models/inertia.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/support/any_model.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::reference {
namespace {

using test::few_hundred_eps;
using test::model_with_rows;
using test::ModelWithRows;
using test::scaled;

DivisionOptions twelve_divisions(const ModelWithRows& given) {
  // eps = 0 never stops a run early.
  return {.step = 0.0, .most_divisions = 12, .expected_mass = given.expected_mass};
}

Eigen::VectorXd any_masses(const ModelWithRows& given) {
  const auto masses = test::vector(given.problem.shapes(), given.expected_mass);
  return (*rc::gen::resize(rc::kNominalSize, masses)).cwiseMax(0.0);
}

/// Mass, first moment and tensor of a body that is cut are the sums of its parts', written out:
/// the contract is the product's own.
void expect_sums_of_halves(const ModelWithRows& given, const Eigen::VectorXd& m, const Split& split,
                           Eigen::Index j) {
  const Eigen::Index last = m.size();
  const double whole = given.problem.V[j];
  const double share = split.problem.V[j] / whole, rest = split.problem.V[last] / whole;
  const Eigen::VectorXd first = share * split.problem.U.col(j);
  const Eigen::VectorXd second = rest * split.problem.U.col(last);
  const auto of_links = [](const Eigen::VectorXd& all) {
    return Eigen::MatrixXd(all.reshaped(10, all.size() / 10));
  };
  const Eigen::MatrixXd error = of_links(first + second - given.problem.U.col(j));
  const Eigen::MatrixXd terms = of_links(first.cwiseAbs() + second.cwiseAbs());
  const auto same = [](const Eigen::MatrixXd& wrong, const Eigen::MatrixXd& size) {
    return scaled(wrong.norm(), size.norm(), 10) < few_hundred_eps;
  };
  RC_ASSERT(same(error.topRows<1>(), terms.topRows<1>()));
  RC_ASSERT(same(error.middleRows<3>(1), terms.middleRows<3>(1)));
  RC_ASSERT(same(error.bottomRows<6>(), terms.bottomRows<6>()));

  Eigen::VectorXd masses(last + 1);
  masses << m, rest * m[j];
  masses[j] = share * m[j];
  RC_ASSERT((split.start - masses).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <=
            few_hundred_eps * std::numeric_limits<double>::epsilon() * m[j]);
}

// Not only at an optimum: any masses survive a split, whichever shape is cut.
RC_GTEST_PROP(Division, SplitChangesNeitherPhiNorObjective, ()) {
  const ModelWithRows given = *model_with_rows();
  const Eigen::VectorXd m = any_masses(given);
  for (Eigen::Index j = 0; j < m.size(); ++j) {
    if (!divisible(given.model.shapes[static_cast<std::size_t>(j)].shape)) continue;
    const Split split = split_shape(given.model, given.problem, m, j).value();
    expect_sums_of_halves(given, m, split, j);
    RC_ASSERT(why_changed(given.problem, m, split) == std::nullopt);
    RC_ASSERT(why_unrelated(split.model, split.problem) == std::nullopt);
    RC_ASSERT(scaled(std::abs(split.problem.V.sum() - given.problem.V.sum()), given.problem.V.sum(),
                     m.size()) < few_hundred_eps);
  }
}

// The contract above can fail: a start that puts a ten-millionth of the mass elsewhere is noticed.
RC_GTEST_PROP(Division, WrongStartIsNoticed, ()) {
  const ModelWithRows given = *model_with_rows();
  RC_PRE(divisible(given.model.shapes.front().shape));
  const Eigen::VectorXd m = Eigen::VectorXd::Constant(given.problem.shapes(), given.expected_mass);
  Split split = split_shape(given.model, given.problem, m, 0).value();
  split.start[0] *= 1.0 + 1e-7;
  split.start[m.size()] *= 1.0 - 1e-7;
  RC_ASSERT(why_changed(given.problem, m, split) != std::nullopt);
}

RC_GTEST_PROP(Division, ObjectiveNeverRises, ()) {
  const ModelWithRows given = *model_with_rows();
  const DivisionRun run = divide_and_solve(given.model, given.problem, twelve_divisions(given));
  const double terms = test::objective_terms(run.problem, run.solution.m);
  const Eigen::Index size = run.problem.F.size() + run.problem.shapes();
  double last = solve_masses(given.problem).value.total();
  for (const DivisionStep& step : run.history) {
    RC_ASSERT(scaled(std::abs(step.objective_before - last), terms, size) < few_hundred_eps);
    RC_ASSERT(scaled(std::abs(step.objective_at_split - step.objective_before), terms, size) <
              few_hundred_eps);
    RC_ASSERT(scaled(std::max(step.objective_after - step.objective_at_split, 0.0), terms, size) <
              few_hundred_eps);
    last = step.objective_after;
  }
  RC_ASSERT(run.solution.value.total() == last);
}

RC_GTEST_PROP(Division, EveryAnswerIsOptimalAndCanExist, ()) {
  const ModelWithRows given = *model_with_rows();
  const auto good = [](const DivisionRun& run) {
    const MassProblem& p = run.problem;
    RC_ASSERT((run.solution.m.array() >= 0.0).all());
    RC_ASSERT(scaled(kkt_residual(p, run.solution.m).worst(), 1.0, p.F.size() + p.shapes()) <
              few_hundred_eps);
    for (Eigen::Index link = 0; link < run.solution.Phi.size(); link += 10) {
      const InertialParameters body{Vector10(run.solution.Phi.segment<10>(link))};
      RC_ASSERT(why_impossible(body) == std::nullopt);
    }
  };
  good(divide_and_solve(given.model, given.problem, twelve_divisions(given), good));
}

// What a division does not touch, and what it records.
RC_GTEST_PROP(Division, KeepsRowsAndNamesItsSteps, ()) {
  const ModelWithRows given = *model_with_rows();
  const DivisionRun run = divide_and_solve(given.model, given.problem, twelve_divisions(given));
  RC_ASSERT(run.problem.Y == given.problem.Y);
  RC_ASSERT(run.problem.F == given.problem.F);
  RC_ASSERT(run.problem.lambda == given.problem.lambda);
  RC_ASSERT(run.problem.mass_bound == given.problem.mass_bound);
  RC_ASSERT(run.model.free_links == given.model.free_links);

  std::set<std::string> ids;
  for (const SoughtShape& s : given.model.shapes) ids.insert(s.id);
  auto shapes = given.model.shapes.size();
  for (const DivisionStep& step : run.history) {
    RC_ASSERT(ids.erase(step.divided) == 1U);
    ids.insert({step.divided + ".0", step.divided + ".1"});
    RC_ASSERT(step.shapes == static_cast<int>(++shapes));
    RC_ASSERT(step.criterion > 0.0);
    RC_ASSERT(step.step.allFinite());
  }
  std::set<std::string> left;
  for (const SoughtShape& s : run.model.shapes) left.insert(s.id);
  RC_ASSERT(left == ids);
}

RC_GTEST_PROP(Division, SameInputSameBits, ()) {
  const ModelWithRows given = *model_with_rows();
  const DivisionOptions options = twelve_divisions(given);
  const DivisionRun a = divide_and_solve(given.model, given.problem, options);
  const DivisionRun b = divide_and_solve(given.model, given.problem, options);
  RC_ASSERT(a.solution.m == b.solution.m);
  RC_ASSERT(a.solution.Phi == b.solution.Phi);
  RC_ASSERT(a.history.size() == b.history.size());
  for (std::size_t k = 0; k < a.history.size(); ++k) {
    RC_ASSERT(a.history[k].divided == b.history[k].divided);
    RC_ASSERT(a.history[k].objective_after == b.history[k].objective_after);
  }
}

// Newtons or kilonewtons, kilograms or grams: the same shapes are divided. The factor is a power of
// two, so that not even rounding differs.
RC_GTEST_PROP(Division, ChoicesAreFreeOfUnits, ()) {
  const ModelWithRows given = *model_with_rows();
  ModelWithRows other = given;
  other.problem.F *= 1024.0;
  other.expected_mass *= 1024.0;
  const DivisionRun a = divide_and_solve(given.model, given.problem, twelve_divisions(given));
  const DivisionRun b = divide_and_solve(other.model, other.problem, twelve_divisions(other));
  RC_ASSERT(a.history.size() == b.history.size());
  for (std::size_t k = 0; k < a.history.size(); ++k) {
    RC_ASSERT(a.history[k].divided == b.history[k].divided);
    RC_ASSERT(a.history[k].step == b.history[k].step);
  }
  RC_ASSERT(1024.0 * a.solution.m == b.solution.m);
}

}  // namespace
}  // namespace shapeid::reference

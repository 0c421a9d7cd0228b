// The fast mass solver asks for no memory after construction, whatever it is asked for.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "shapeid/tests/fast/allocations.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"

namespace shapeid {
namespace {

using test::TriangleCase;

RC_GTEST_PROP(Allocations, MassSolverMakesNoneAfterConstruction, ()) {
  const bool density_term = *rc::gen::arbitrary<bool>();
  const int links = *rc::gen::inRange(1, 6);
  const TriangleCase first = test::body_case(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.links = links, .shapes_a_link = *rc::gen::inRange(1, 40), .density_term = density_term});
  Eigen::MatrixXd second = first.R, broken = first.R;
  second.rightCols<1>() += 0.3 * first.R.leftCols<5>().rowwise().sum();
  broken(0, 3) = std::numeric_limits<double>::quiet_NaN();

  // The same divisions, made beforehand.
  constexpr int divisions = 10;
  TriangleCase divided = first;
  test::Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  struct Cut {
    fast::MassSolver::Column first, second;
    double V1, V2;
  };
  std::vector<Cut> cuts;
  for (int j = 0; j < divisions; ++j) {
    divide(divided, j % first.shapes(), draw);
    const int last = divided.shapes() - 1;
    cuts.push_back({divided.column(j % first.shapes()), divided.column(last),
                    divided.problem.V[j % first.shapes()], divided.problem.V[last]});
  }
  std::vector<fast::MassSolver::Column> columns;
  columns.reserve(static_cast<std::size_t>(first.shapes()));
  for (int j = 0; j < first.shapes(); ++j) columns.push_back(first.column(j));
  const Eigen::VectorXd start = test::any_start(1, first);

  fast::MassSolver solver(links, first.shapes() + divisions);
  solver.set_lambda(first.problem.lambda);
  int solved = 0;
  const std::size_t asked = test::allocations_during([&] {
    solver.clear();
    for (int j = 0; j < first.shapes(); ++j) {
      const auto at = static_cast<std::size_t>(j);
      static_cast<void>(solver.append(first.links[at], columns[at], first.problem.V[j]));
    }
    const auto count = [&](fast::Outcome outcome) { solved += outcome == fast::Outcome::solved; };
    test::start_at(start, solver);
    count(solver.solve(first.R));
    solver.forget_masses();
    count(solver.solve(first.R));
    count(solver.solve(second));
    count(solver.solve(broken));
    for (int j = 0; j < divisions; ++j) {
      const Cut& cut = cuts[static_cast<std::size_t>(j)];
      static_cast<void>(solver.divide(j % first.shapes(), cut.first, cut.V1, cut.second, cut.V2));
      count(solver.solve_again());
    }
    static_cast<void>(solver.gap(10.0));
  });
  RC_ASSERT(asked == 0U);
  RC_ASSERT(solved == 3 + divisions);
}

}  // namespace
}  // namespace shapeid

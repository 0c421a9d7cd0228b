#include "shapeid/tests/fast/judged_guess.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/QR>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>

#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

JudgedGuess::JudgedGuess(GuessBy by, const TriangleCase& given)
    : V_(VectorXd::Ones(given.shapes() + most_divisions)),
      by_(by),
      columns_(1, given.shapes() + most_divisions),
      few_(V_),
      table_(columns_, V_),
      vertex_(columns_),
      method_(columns_, V_) {
  for (int j = 0; j < given.shapes(); ++j) {
    static_cast<void>(columns_.append(0, given.column(j)));
    few_.put(j, given.column(j));
  }
  V_.head(given.shapes()) = given.problem.V;
  method_.use(vertex_, given.problem.lambda);
  static_cast<void>(method_.take(given.R));
  method_.scale_prices();
}

bool JudgedGuess::start(const MatrixXd& R, double lambda, const std::vector<int>& passive) {
  rows_.take(R);
  return guess().start(rows_, lambda, passive);
}

bool JudgedGuess::settles() {
  for (int round = 0; round < fast::Guess::most_rounds && guess().settle(); ++round) {
    if (method_.settles_at(guess())) return true;
    if (!guess().can_go_on()) return false;
  }
  return false;
}

bool JudgedGuess::divide(const TriangleCase& divided, int j) {
  const int other = divided.shapes() - 1;
  static_cast<void>(columns_.append(0, divided.column(other)));
  columns_.replace(j, divided.column(j));
  for (const int part : {j, other}) few_.put(part, divided.column(part));
  V_.head(divided.shapes()) = divided.problem.V;
  return guess().divide(j, other, divided.problem.V[j], divided.problem.V[other]);
}

VectorXd JudgedGuess::masses() const {
  VectorXd m = VectorXd::Zero(columns_.size());
  for (std::size_t i = 0; i < method_.passive().size(); ++i) {
    m[method_.passive()[i]] = method_.masses()[i];
  }
  return m;
}

TriangleCase link_case(std::uint64_t seed, int shapes, bool density_term, double noise) {
  return body_case(seed, {.shapes_a_link = shapes, .noise = noise, .density_term = density_term});
}

int settled_guesses(GuessBy by, int most_shapes, bool density_term, bool warm, double noise) {
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const int shapes = 1 + static_cast<int>(seed % static_cast<std::uint64_t>(most_shapes));
    const TriangleCase given = link_case(seed, shapes, density_term, noise);
    std::vector<int> start;
    for (int j = 0; warm && j < given.shapes() && start.size() < 8; ++j) {
      if ((seed >> (j % 8)) % 2 == 1) start.push_back(j);
    }
    JudgedGuess judged(by, given);
    if (!judged.start(given.R, given.problem.lambda, start) || !judged.settles()) continue;
    ++count;
    const VectorXd m = reference::solve_masses(given.problem).m;
    EXPECT_LT(scaled_objective_difference(given.problem, judged.masses(), m), few_hundred_eps);
    EXPECT_LT(reference::kkt_residual(given.problem, judged.masses()).worst(), 1e-13);
    if (density_term) {
      EXPECT_LT(scaled_mass_difference(given.problem, judged.masses(), m), few_hundred_eps);
    }
  }
  return count;
}

int refused_guesses(GuessBy by, int shapes) {
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const TriangleCase given = link_case(seed, shapes, false),
                       other = link_case(seed + 1000, shapes, false);
    MatrixXd R = given.R;
    R.rightCols<1>() = other.R.rightCols<1>();
    JudgedGuess judged(by, given);
    if (judged.start(R, 0.0) && !judged.settles()) ++refused;
  }
  return refused;
}

void check_guess_of_other_forces(GuessBy by, int most_shapes) {
  const TriangleCase given =
      link_case(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange(2, most_shapes + 1),
                *rc::gen::arbitrary<bool>());
  JudgedGuess judged(by, given);
  MatrixXd R = given.R;
  R(*rc::gen::inRange(0, 10), 10) += *rc::gen::element(1e-9, 1e-3, 1.0) * R.col(10).norm();
  RC_PRE(judged.start(R, given.problem.lambda));
  if (!judged.settles()) return;
  const VectorXd wanted = reference::solve_masses(given.problem).m;
  RC_ASSERT(scaled_objective_difference(given.problem, judged.masses(), wanted) < few_hundred_eps);
}

namespace {

/// Columns of A = Y U over those of the square root of lambda V^-1: their condition is not squared.
struct Columns {
  MatrixXd A;
  VectorXd lengths;

  explicit Columns(const MassProblem& problem)
      : A(problem.Y.rows() + problem.U.cols(), problem.U.cols()) {
    A << problem.Y * problem.U,
        (problem.lambda * problem.V.cwiseInverse()).cwiseSqrt().asDiagonal().toDenseMatrix();
    lengths = A.colwise().norm().transpose();
  }
  [[nodiscard]] MatrixXd scaled() const { return A * lengths.cwiseInverse().asDiagonal(); }
  [[nodiscard]] double condition() const {
    const VectorXd sizes = singular_values(scaled());
    return sizes[0] / sizes[sizes.size() - 1];
  }
};

/// Of what a division goes through: its new part beside the whole.
double condition_beside_whole(const MassProblem& before, const MassProblem& divided, int j) {
  MassProblem between = divided;
  between.U.col(j) = before.U.col(j);
  between.V[j] = before.V[j];
  return Columns(between).condition();
}

/// What the column of a part is made of, the whole's and the other part's, over what it is.
double left_of_whole(const MassProblem& divided, int j) {
  const MatrixXd A = divided.Y * divided.U;
  const Index other = divided.U.cols() - 1;
  const double share = divided.V[other] / divided.V[j];
  return 1.0 + 2.0 * share * A.col(other).norm() / A.col(j).norm();
}

/// Those of a guess, by their places.
std::vector<int> passive_shapes(const fast::AtPlaces& at) {
  std::vector<int> shapes;
  for (unsigned left = at.used; left != 0; left &= left - 1) {
    shapes.push_back(at.shape[std::countr_zero(left)]);
  }
  return shapes;
}

MassProblem of_shapes(const MassProblem& problem, const std::vector<int>& shapes) {
  MassProblem some = problem;
  some.U = problem.U(Eigen::all, shapes);
  some.V = problem.V(shapes);
  return some;
}

/// Of the passive shapes. `condition`: of the worst columns on the way.
void check_inverse_and_minimum(JudgedGuess& judged, const MassProblem& problem, double condition,
                               double growth) {
  const fast::AtPlaces at = judged.guess().answer();
  std::vector<std::size_t> places;
  for (unsigned left = at.used; left != 0; left &= left - 1) {
    places.push_back(static_cast<std::size_t>(std::countr_zero(left)));
  }
  const Columns columns(of_shapes(problem, passive_shapes(at)));
  condition = std::max(condition, columns.condition());
  RC_PRE(condition < 1e4);
  const Index n = std::ssize(places);
  VectorXd b = VectorXd::Zero(columns.A.rows());
  b.head(problem.F.size()) = problem.F;
  const VectorXd m = Eigen::ColPivHouseholderQR<MatrixXd>(columns.A).solve(b);
  VectorXd found(n);
  for (Index i = 0; i < n; ++i) found[i] = (*at.m)[places[static_cast<std::size_t>(i)]];
  // Masses in units of their columns. The condition is squared.
  const double size = growth * condition * condition;
  RC_ASSERT(scaled(((found - m).cwiseProduct(columns.lengths)).norm(), b.norm() * size, n) <
            few_hundred_eps);
  const MatrixXd scaled_columns = columns.scaled();
  const MatrixXd inverse = (scaled_columns.transpose() * scaled_columns).inverse();
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < n; ++k) {
      const double entry =
          at.inverse[places[static_cast<std::size_t>(i)]][places[static_cast<std::size_t>(k)]];
      RC_ASSERT(scaled(entry * columns.lengths[i] * columns.lengths[k] - inverse(i, k),
                       inverse.norm() * size, n) < few_hundred_eps);
    }
  }
}

}  // namespace

void check_divided_guess(GuessBy by, int most_shapes, double growth) {
  const bool density_term = *rc::gen::arbitrary<bool>();
  TriangleCase given = link_case(*rc::gen::arbitrary<std::uint64_t>(),
                                 *rc::gen::inRange(1, most_shapes + 1), density_term, 1e-3);
  // As strong as the rows, so that a term that is missing cannot hide.
  if (density_term) {
    const MatrixXd A = given.problem.Y * given.problem.U;
    given.problem.lambda = 0.3 * A.squaredNorm() * given.problem.V.mean();
  }
  JudgedGuess judged(by, given);
  std::vector<int> all(static_cast<std::size_t>(given.shapes()));
  std::iota(all.begin(), all.end(), 0);
  RC_PRE(judged.start(given.R, given.problem.lambda, all));
  Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  const int divisions = *rc::gen::inRange(0, 4);
  double condition = 1.0;
  for (int k = 0; k < divisions; ++k) {
    const MassProblem before = given.problem;
    const int j = *rc::gen::inRange(0, given.shapes());
    divide(given, j, draw);
    condition = std::max(condition, condition_beside_whole(before, given.problem, j));
    RC_PRE(judged.divide(given, j));
  }
  RC_PRE(std::popcount(judged.guess().answer().used) == given.shapes());
  check_inverse_and_minimum(judged, given.problem, condition, growth);
}

void check_guess_divided_within_span() {
  const int rank = *rc::gen::inRange(1, 9);
  TriangleCase given = link_case(*rc::gen::arbitrary<std::uint64_t>(), rank, false);
  given.R.block(rank, rank, 10 - rank, 10 - rank).setZero();
  given.problem.Y = given.R.topLeftCorner(10, 10);
  Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  VectorXd m(rank);
  for (double& mass : m) mass = draw.between(0.1, 1.0);
  given.problem.F = given.R.topRightCorner(10, 1);
  given.problem.F.head(rank) = (given.problem.Y * given.problem.U * m).head(rank);
  given.problem.W = VectorXd::Ones(10);
  given.R.topRightCorner(10, 1) = given.problem.F;
  JudgedGuess judged(GuessBy::link_table, given);
  std::vector<int> all(static_cast<std::size_t>(rank));
  std::iota(all.begin(), all.end(), 0);
  RC_PRE(judged.start(given.R, 0.0, all));
  RC_PRE(std::popcount(judged.guess().answer().used) == rank);
  double condition = Columns(given.problem).condition(), cancelled = 0.0;
  const int divisions = *rc::gen::inRange(1, JudgedGuess::most_divisions);
  for (int k = 0; k < divisions; ++k) {
    const std::vector<int> passive = passive_shapes(judged.guess().answer());
    const int j = *rc::gen::elementOf(passive);
    divide(given, j, draw);
    cancelled += left_of_whole(given.problem, j);
    RC_PRE(judged.divide(given, j));
    const fast::AtPlaces at = judged.guess().answer();
    RC_ASSERT(std::popcount(at.used) == rank);
    condition =
        std::max(condition, Columns(of_shapes(given.problem, passive_shapes(at))).condition());
    RC_PRE(condition < 1e3);
  }
  const fast::AtPlaces at = judged.guess().answer();
  check_inverse_and_minimum(judged, given.problem, condition, condition * cancelled);
  for (unsigned left = at.used; left != 0; left &= left - 1) {
    RC_ASSERT((*at.m)[static_cast<std::size_t>(std::countr_zero(left))] > -1e-9);
  }
}

}  // namespace shapeid::test

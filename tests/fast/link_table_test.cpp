// The first answer for any number of shapes of a link: how often it is right, that a wrong one is
// refused, and what it keeps as shapes are divided.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/QR>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "shapeid/fast/active_set.hpp"
#include "shapeid/fast/link_table.hpp"
#include "shapeid/fast/one_link.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::few_hundred_eps;
using test::TriangleCase;

constexpr int most_divisions = 8;

/// A table, and the method that judges it, on one problem.
class Judged {
 public:
  explicit Judged(const TriangleCase& given)
      : table_(columns_, V_),
        V_(VectorXd::Ones(given.shapes() + most_divisions)),
        columns_(1, given.shapes() + most_divisions),
        vertex_(columns_),
        method_(columns_, V_) {
    for (int j = 0; j < given.shapes(); ++j) {
      static_cast<void>(columns_.append(0, given.column(j)));
    }
    V_.head(given.shapes()) = given.problem.V;
    method_.use(vertex_, given.problem.lambda);
    static_cast<void>(method_.take(given.R));
    method_.scale_prices();
  }

  bool start(const MatrixXd& R, double lambda, const std::vector<int>& passive = {}) {
    rows_.take(R);
    return table_.start(rows_, lambda, passive);
  }
  LinkTable& table() { return table_; }
  bool settles() {
    while (table_.settle()) {
      if (method_.settles_at(table_)) return true;
      if (!table_.can_go_on()) return false;
    }
    return false;
  }
  /// The last shape came out of shape j.
  bool divide(const TriangleCase& divided, int j) {
    const int other = divided.shapes() - 1;
    static_cast<void>(columns_.append(0, divided.column(other)));
    columns_.replace(j, divided.column(j));
    V_.head(divided.shapes()) = divided.problem.V;
    return table_.divide(j, other, divided.problem.V[j], divided.problem.V[other]);
  }
  [[nodiscard]] VectorXd masses() const {
    VectorXd m = VectorXd::Zero(columns_.size());
    for (std::size_t i = 0; i < method_.passive().size(); ++i) {
      m[method_.passive()[i]] = method_.masses()[i];
    }
    return m;
  }

 private:
  LinkRows rows_;  // first: their members are the most strictly aligned
  LinkTable table_;
  VectorXd V_;
  ShapeColumns columns_;
  OneLink vertex_;
  ActiveSet method_;
};

TriangleCase some_case(std::uint64_t seed, int shapes, bool density_term, double noise = 1e-2) {
  return test::body_case(seed,
                         {.shapes_a_link = shapes, .noise = noise, .density_term = density_term});
}

/// Of 300 problems with up to sixty shapes, how many the table settles; each of these is right.
int settled(bool density_term, bool warm) {
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const TriangleCase given = some_case(seed, 1 + static_cast<int>(seed % 60), density_term);
    std::vector<int> start;
    for (int j = 0; warm && j < given.shapes() && start.size() < 8; ++j) {
      if ((seed >> (j % 8)) % 2 == 1) start.push_back(j);
    }
    Judged judged(given);
    if (!judged.start(given.R, given.problem.lambda, start) || !judged.settles()) continue;
    ++count;
    const VectorXd m = reference::solve_masses(given.problem).m;
    EXPECT_LT(test::scaled_objective_difference(given.problem, judged.masses(), m),
              few_hundred_eps);
    if (density_term) {
      EXPECT_LT(test::scaled_mass_difference(given.problem, judged.masses(), m), few_hundred_eps);
    }
  }
  return count;
}

TEST(LinkTable, IsSettledAlmostAlwaysWithoutLambda) {
  for (const bool warm : {false, true}) EXPECT_GE(settled(false, warm), 295);
}

// With lambda only where the rows alone decide which shapes have mass.
TEST(LinkTable, IsSettledOftenWithLambda) {
  // 143 where this was written: up to ten shapes or so.
  for (const bool warm : {false, true}) EXPECT_GE(settled(true, warm), 120);
}

// A table of other forces has other masses: either they can be corrected to the minimum, or they
// are refused.
RC_GTEST_PROP(LinkTable, OfOtherForcesIsCorrectedOrRefused, ()) {
  const TriangleCase given = some_case(*rc::gen::arbitrary<std::uint64_t>(),
                                       *rc::gen::inRange(2, 40), *rc::gen::arbitrary<bool>());
  Judged judged(given);
  MatrixXd R = given.R;
  R(*rc::gen::inRange(0, 10), 10) += *rc::gen::element(1e-9, 1e-3, 1.0) * R.col(10).norm();
  RC_PRE(judged.start(R, given.problem.lambda));
  if (!judged.settles()) return;
  const VectorXd wanted = reference::solve_masses(given.problem).m;
  RC_ASSERT(test::scaled_objective_difference(given.problem, judged.masses(), wanted) <
            few_hundred_eps);
}

TEST(LinkTable, OfAnotherWindowIsRefused) {
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const TriangleCase given = some_case(seed, 25, false),
                       other = some_case(seed + 1000, 25, false);
    MatrixXd R = given.R;
    R.rightCols<1>() = other.R.rightCols<1>();
    Judged judged(given);
    if (judged.start(R, 0.0) && !judged.settles()) ++refused;
  }
  EXPECT_GE(refused, 80);
}

// What stands in the table when some shapes have been divided, and none was allowed to leave: the
// inverse and the minimum of its passive shapes. With lambda the parts of a whole feel each other.
RC_GTEST_PROP(LinkTable, KeepsInverseAndMinimumAsShapesAreDivided, ()) {
  const bool density_term = *rc::gen::arbitrary<bool>();
  TriangleCase given =
      some_case(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange(1, 5), density_term, 1e-3);
  // As strong as the rows, so that a term that is missing cannot hide.
  if (density_term) {
    const MatrixXd A = given.problem.Y * given.problem.U;
    given.problem.lambda = 0.3 * A.squaredNorm() * given.problem.V.mean();
  }
  Judged judged(given);
  std::vector<int> all(static_cast<std::size_t>(given.shapes()));
  std::iota(all.begin(), all.end(), 0);
  RC_PRE(judged.start(given.R, given.problem.lambda, all));
  test::Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  const int divisions = *rc::gen::inRange(0, 4);
  for (int k = 0; k < divisions; ++k) {
    const int j = *rc::gen::inRange(0, given.shapes());
    test::divide(given, j, draw);
    RC_PRE(judged.divide(given, j));
  }
  const AtPlaces at = judged.table().answer();
  std::vector<int> passive;
  std::vector<std::size_t> places;
  for (unsigned left = at.used; left != 0; left &= left - 1) {
    places.push_back(static_cast<std::size_t>(std::countr_zero(left)));
    passive.push_back(at.shape[places.back()]);
  }
  const auto n = static_cast<Index>(passive.size());
  RC_PRE(n == given.shapes());
  // The augmented rows, whose condition is not squared.
  const Index rows = given.problem.Y.rows();
  MatrixXd A(rows + n, n);
  A.topRows(rows) = (given.problem.Y * given.problem.U)(Eigen::all, passive);
  A.bottomRows(n) = (given.problem.lambda * given.problem.V(passive).cwiseInverse())
                        .cwiseSqrt()
                        .asDiagonal()
                        .toDenseMatrix();
  VectorXd b = VectorXd::Zero(rows + n);
  b.head(rows) = given.problem.F;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  const VectorXd lengths = A.colwise().norm().transpose();
  const MatrixXd scaled = A * lengths.cwiseInverse().asDiagonal();
  const VectorXd sizes = scaled.jacobiSvd().singularValues();
  const double condition = sizes[0] / sizes[n - 1];
  RC_PRE(condition < 1e5);
  const VectorXd m = qr.solve(b);
  VectorXd found(n);
  for (Index i = 0; i < n; ++i) found[i] = (*at.m)[places[static_cast<std::size_t>(i)]];
  // Masses in units of their columns; the condition is squared, and once more as shapes enter.
  RC_ASSERT(test::scaled(((found - m).cwiseProduct(lengths)).norm(),
                         b.norm() * condition * condition, n) < few_hundred_eps);
  const MatrixXd inverse = (scaled.transpose() * scaled).inverse();
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < n; ++k) {
      const double entry =
          at.inverse[places[static_cast<std::size_t>(i)]][places[static_cast<std::size_t>(k)]];
      RC_ASSERT(test::scaled(entry * lengths[i] * lengths[k] - inverse(i, k),
                             inverse.norm() * condition * condition, n) < few_hundred_eps);
    }
  }
}

TEST(LinkTable, HasRoomForADozenPassiveShapes) {
  const TriangleCase given = some_case(1, 20, true);
  std::vector<int> passive(LinkTable::most_passive);
  std::iota(passive.begin(), passive.end(), 0);
  Judged judged(given);
  EXPECT_TRUE(judged.start(given.R, given.problem.lambda, passive));
  passive.push_back(12);
  EXPECT_FALSE(judged.start(given.R, given.problem.lambda, passive));
}

// Without forces there is no mass, whatever was passive.
TEST(LinkTable, WithoutForcesIsEmpty) {
  TriangleCase given = some_case(3, 15, false);
  given.R.rightCols<1>().setZero();
  given.problem.F.setZero();
  Judged judged(given);
  ASSERT_TRUE(judged.start(given.R, 0.0, {1, 4, 7}));
  ASSERT_TRUE(judged.settles());
  EXPECT_EQ(judged.table().answer().used, 0U);
}

}  // namespace
}  // namespace shapeid::fast

// The rows of even density and the damped ten unknowns, against dense decompositions of the shapes
// that are there.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/QR>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shapeid/fast/damped_ten.hpp"
#include "shapeid/fast/link_density.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::few_hundred_eps;
using test::scaled;
using Ten = LinkDensity::Ten;

MatrixXd matrix(const TenRows& rows) {
  MatrixXd E(10, 10);
  for (Index i = 0; i < 10; ++i) {
    for (Index j = 0; j < 10; ++j) {
      E(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  return E;
}

/// Rows of shapes that come and go, kept beside what is tested. They lie in a space of `rank`
/// dimensions; lengths differ by a factor of a hundred.
class ShadowedDensity {
 public:
  ShadowedDensity(int rank, std::uint64_t seed) : draw_(seed) {
    basis_ = MatrixXd::NullaryExpr(rank, 10, [&] { return draw_.sign(); });
    density_.clear();
  }

  void step() {
    if (rows_.empty() || draw_.between(0.0, 1.0) < 0.6) {
      VectorXd share = VectorXd::NullaryExpr(basis_.rows(), [&] { return draw_.sign(); });
      share *= std::pow(10.0, draw_.between(-1.0, 1.0));
      rows_.emplace_back(basis_.transpose() * share);
      density_.enter(rows_.back());
    } else {
      const auto at =
          static_cast<std::size_t>(draw_.between(0.0, static_cast<double>(rows_.size())));
      density_.leave(rows_[at]);
      rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    if (!density_.outdated()) return;
    ++made_anew_;
    density_.begin_anew();
    for (const Ten& row : rows_) density_.again(row);
  }

  /// E has the squares of all rows, as many rows as there are dimensions, and nothing below them;
  /// and weights satisfy the rows that they are asked to.
  void check() {
    density_.reveal();
    const auto n = static_cast<Index>(rows_.size());
    MatrixXd X = MatrixXd::Zero(std::max<Index>(n, 1), 10);
    for (Index i = 0; i < n; ++i) X.row(i) = rows_[static_cast<std::size_t>(i)];
    const MatrixXd E = matrix(density_.E());
    RC_ASSERT(scaled((E.transpose() * E - X.transpose() * X).norm(), X.squaredNorm(), 10 + n) <
              few_hundred_eps);
    const int rank = density_.rank();
    RC_ASSERT(rank == std::min<Index>(n, basis_.rows()));
    RC_ASSERT(density_.certain() <= rank);
    RC_ASSERT(E.bottomRows(10 - rank).isZero(0.0));

    const Ten wanted = Ten::NullaryExpr([&] { return draw_.sign(); });
    const Ten rest = Ten::NullaryExpr([&] { return draw_.sign(); });
    const Ten y = density_.share_of(wanted);
    const Ten expected = E * wanted;
    RC_ASSERT(scaled((y - expected).norm(), E.norm() * wanted.norm(), 10) < few_hundred_eps);
    const Ten w = density_.weights(density_.certain(), y, rest);
    const VectorXd left = (E * w - y).head(density_.certain());
    RC_ASSERT(scaled(left.norm(), E.norm() * w.norm() + y.norm(), 10) < few_hundred_eps);
    RC_ASSERT((w.array() == rest.array()).count() == 10 - density_.certain());
  }

  [[nodiscard]] int made_anew() const { return made_anew_; }

 private:
  LinkDensity density_;
  MatrixXd basis_;
  std::vector<Ten> rows_;
  test::Draw draw_;
  int made_anew_ = 0;
};

RC_GTEST_PROP(LinkDensity, RowsOfTheShapesThatAreThere, ()) {
  const int rank = *rc::gen::inRange(1, 11);
  ShadowedDensity shadowed(rank, *rc::gen::arbitrary<std::uint64_t>());
  for (int step = 0; step < 60; ++step) {
    shadowed.step();
    shadowed.check();
  }
  RC_CLASSIFY(shadowed.made_anew() > 0, "made anew");
}

/// Both ways in which a triangle is outdated: the last row of a direction leaves, and a direction
/// that never was is asked for.
TEST(LinkDensity, OutdatedWhereARowWasAllOfADirection) {
  LinkDensity density;
  density.clear();
  for (int i = 0; i < 10; ++i) density.enter(Ten::Unit(i) + 0.25 * Ten::Ones());
  density.leave(Ten::Unit(3) + 0.25 * Ten::Ones());
  EXPECT_TRUE(density.outdated());

  density.clear();
  EXPECT_FALSE(density.outdated());
  density.enter(Ten::Unit(0));
  density.leave(Ten::Unit(0));
  EXPECT_TRUE(density.outdated());
  density.begin_anew();
  density.reveal();
  EXPECT_EQ(density.rank(), 0);
}

RC_GTEST_PROP(DampedTen, AsDenseLeastSquares, ()) {
  using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const int rank = *rc::gen::inRange(0, 11);
  const double lambda = std::pow(10.0, *rc::gen::inRange(-12, 3));
  test::Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  // A triangle of more rows than the one link has, which are not to be read.
  MatrixXd R = MatrixXd::NullaryExpr(14, 14, [&] { return draw.sign(); });
  TenRows E{};
  for (int i = 0; i < rank; ++i) {
    for (std::size_t j = 0; j < 10; ++j) E[static_cast<std::size_t>(i)][j] = draw.sign();
  }
  DampedTen damped;
  damped.factorise(R, E, rank, lambda);
  VectorXd y(10);
  damped.solve(y);

  const MatrixXd upper = R.topLeftCorner(10, 10).triangularView<Eigen::Upper>();
  const MatrixXd K = upper * matrix(E).transpose();
  Long A(20, 10);
  A << K.cast<long double>(), std::sqrt(static_cast<long double>(lambda)) * Long::Identity(10, 10);
  Long b = Long::Zero(20, 1);
  b.topRows(10) = R.col(10).head(10).cast<long double>();
  const Eigen::HouseholderQR<Long> qr(A);
  const VectorXd expected = Long(qr.solve(b)).cast<double>();
  // The minimum is flat: judged by what it leaves, as backward stable least squares are.
  const double size = A.cast<double>().norm();
  const auto left = [&](const VectorXd& z) {
    return VectorXd(A.cast<double>().transpose() * (b.cast<double>() - A.cast<double>() * z));
  };
  RC_ASSERT(scaled((left(y) - left(expected)).norm(),
                   size * (b.cast<double>().norm() + size * y.norm()), 30) < few_hundred_eps);
  RC_ASSERT(y.tail(10 - rank).isZero(0.0));

  const VectorXd x = VectorXd::NullaryExpr(10, [&] { return draw.sign(); });
  VectorXd z = x;
  damped.solve_normal(z);
  const VectorXd back = (A.transpose() * (A * z.cast<long double>())).cast<double>();
  RC_ASSERT(scaled((back - x).norm(), size * size * z.norm() + x.norm(), 30) < few_hundred_eps);
}

}  // namespace
}  // namespace shapeid::fast

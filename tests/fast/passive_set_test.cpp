// The three kinds of passive shapes against dense least squares in long double, as shapes enter and
// leave.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/QR>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "shapeid/fast/even_density.hpp"
#include "shapeid/fast/many_links.hpp"
#include "shapeid/fast/one_link.hpp"
#include "shapeid/tests/fast/agreement.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::damped_rounding;
using test::few_hundred_eps;
using test::scaled;
using test::TriangleCase;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

enum class Kind { one_link, many_links, even_density };

/// A set of one of the three kinds, and beside it the places of the shapes that it should hold.
class Watched {
 public:
  /// `room`: for parts of shapes that are divided.
  Watched(const TriangleCase& given, Kind kind, int room = 0)
      : given_(given), columns_(given.link_count(), given.shapes() + room) {
    V_.setOnes(columns_.capacity());
    V_.head(given.shapes()) = given.problem.V;
    for (int j = 0; j < given.shapes(); ++j) {
      static_cast<void>(columns_.append(given.links[static_cast<std::size_t>(j)], given.column(j)));
    }
    if (kind == Kind::one_link) {
      set_ = std::make_unique<OneLink>(columns_);
    } else if (kind == Kind::many_links) {
      set_ = std::make_unique<ManyLinks>(columns_);
    } else {
      auto set = std::make_unique<EvenDensity>(columns_, V_);
      even_ = set.get();
      even_->set_lambda(given.problem.lambda);
      set_ = std::move(set);
    }
    columns_.set_scale(given_.problem.Y.cwiseAbs().colwise().sum().transpose(),
                       given_.problem.F.norm());
    set_->start(given_.R);
  }

  [[nodiscard]] const std::vector<int>& passive() const { return passive_; }
  [[nodiscard]] VectorXd slopes() {
    const MassProblem& p = given_.problem;
    return set_->slopes(p.Y.transpose() * (p.F - p.Y * parameters()));
  }

  /// False if the set refused the shape; then the reason that it gave has been checked.
  bool enter(int j) {
    if (set_->enter(j)) {
      passive_.push_back(j);
      return true;
    }
    const auto n = static_cast<Index>(passive_.size());
    VectorXd x = VectorXd::Zero(std::max<Index>(n, Index{10} * given_.link_count()));
    set_->dependence(x);
    const MatrixXd A = given_.problem.Y * given_.problem.U;
    VectorXd sum = VectorXd::Zero(A.rows());
    double size = A.col(j).norm();
    for (Index i = 0; i < n; ++i) {
      const VectorXd a = A.col(passive_[static_cast<std::size_t>(i)]);
      sum += x[i] * a;
      size += std::abs(x[i]) * a.norm();
    }
    RC_ASSERT(scaled((sum - A.col(j)).norm(), size, A.rows()) < few_hundred_eps);
    return false;
  }

  /// How many became passive; that the next one is refused has been checked.
  std::size_t enter_first(std::span<const int> shapes) {
    const std::size_t entered = set_->enter_first(shapes);
    for (const int j : shapes.first(entered)) passive_.push_back(j);
    if (entered < shapes.size()) RC_ASSERT(!enter(shapes[entered]));
    return entered;
  }

  void leave(Index place) {
    set_->leave(static_cast<int>(place));
    passive_.erase(passive_.begin() + place);
  }

  /// The cuboid at this place is cut somewhere.
  void divide(Index place, test::Draw& draw) {
    const int j = passive_[static_cast<std::size_t>(place)], other = given_.shapes();
    test::divide(given_, j, draw);
    V_.head(other + 1) = given_.problem.V;
    columns_.replace(j, given_.column(j));
    RC_ASSERT(columns_.append(given_.links[static_cast<std::size_t>(j)], given_.column(other)));
    set_->divide(static_cast<int>(place), other, true);
    passive_.push_back(other);
  }
  [[nodiscard]] bool has_room() const { return columns_.size() < columns_.capacity(); }

  /// Of even density, in the midst of everything.
  void set_lambda(double lambda) {
    given_.problem.lambda = lambda;
    even_->set_lambda(lambda);
  }

  /// Where the passive shapes alone minimise f, whatever the signs of their masses.
  [[nodiscard]] LongVector minimum() const {
    const MassProblem& p = given_.problem;
    const auto n = static_cast<Index>(passive_.size());
    if (n == 0) return LongVector::Zero(0);
    const Index damping_rows = p.lambda > 0.0 ? n : 0;
    LongMatrix A = LongMatrix::Zero(p.Y.rows() + damping_rows, n);
    LongVector b = LongVector::Zero(A.rows());
    b.head(p.F.size()) = p.F.cast<long double>();
    for (Index i = 0; i < n; ++i) {
      const Index j = passive_[static_cast<std::size_t>(i)];
      A.col(i).head(p.Y.rows()) = p.Y.cast<long double>() * p.U.col(j).cast<long double>();
      if (damping_rows > 0) {
        A(p.Y.rows() + i, i) = std::sqrt(static_cast<long double>(p.lambda) / p.V[j]);
      }
    }
    // Columns of one length: masses of large and small shapes alike to all digits.
    const LongVector lengths = A.colwise().norm();
    for (Index i = 0; i < n; ++i) A.col(i) /= lengths[i];
    return Eigen::HouseholderQR<LongMatrix>(A).solve(b).cwiseQuotient(lengths);
  }

  /// Target and slopes after refinement, as the solver uses them. (Before, rounding of shapes that
  /// left is in the triangle: of 3000 cases one had slopes off by twice `few_hundred_eps`.)
  void check(double& worst_move) {
    const MassProblem& p = given_.problem;
    const LongVector expected = minimum();
    for (int round = 0; round < 3; ++round) {
      const VectorXd Phi = parameters();
      set_->refine(p.Y.transpose() * (p.F - p.Y * Phi));
    }
    RC_ASSERT(set_->sound());
    const VectorXd g = slopes();
    LongVector Phi = LongVector::Zero(p.U.rows());
    VectorXd sizes = VectorXd::Zero(p.U.rows());
    const VectorXd& target = set_->target();
    double total = 0.0, apart = 0.0;
    for (std::size_t i = 0; i < passive_.size(); ++i) {
      const auto at = static_cast<Index>(i);
      Phi += expected[at] * p.U.col(passive_[i]).cast<long double>();
      sizes += std::abs(target[at]) * p.U.col(passive_[i]).cwiseAbs();
      total += std::abs(target[at]);
      apart = std::max(apart, static_cast<double>(std::abs(target[at] - expected[at])));
    }
    const LongVector r = p.F.cast<long double>() - p.Y.cast<long double>() * Phi;
    const VectorXd slopes = (p.Y.cast<long double>().transpose() * r).cast<double>();
    const double length = p.F.norm() + (p.Y.cwiseAbs() * sizes).norm();
    const Index sums = p.Y.rows() + static_cast<Index>(passive_.size());
    const VectorXd lengths = p.Y.colwise().norm();
    for (Index i = 0; i < g.size(); ++i) {
      RC_ASSERT(scaled(std::abs(g[i] - slopes[i]), lengths[i] * length, sums) < few_hundred_eps);
    }
    const VectorXd moved = p.Y * (parameters() - Phi.cast<double>());
    RC_ASSERT(scaled(moved.norm(), length, sums) < few_hundred_eps);
    if (total > 0.0) worst_move = std::max(worst_move, apart / total);
  }

 private:
  [[nodiscard]] VectorXd parameters() {
    VectorXd Phi = VectorXd::Zero(given_.problem.U.rows());
    const VectorXd& target = set_->target();
    for (std::size_t i = 0; i < passive_.size(); ++i) {
      Phi += target[static_cast<Index>(i)] * given_.problem.U.col(passive_[i]);
    }
    return Phi;
  }

  TriangleCase given_;
  VectorXd V_;
  ShapeColumns columns_;
  std::unique_ptr<PassiveSet> set_;
  EvenDensity* even_ = nullptr;  ///< set_, if it is one
  std::vector<int> passive_;
};

/// Enters, one or several, and leaves at random, and checks after every few steps. `fill`: how
/// likely a step enters.
double run(const TriangleCase& given, Kind kind, std::uint64_t seed, int steps, int check_every,
           double fill) {
  Watched set(given, kind);
  test::Draw draw(seed);
  std::vector<int> held(static_cast<std::size_t>(given.shapes()));
  for (int j = 0; j < given.shapes(); ++j) held[static_cast<std::size_t>(j)] = j;
  double worst_move = 0.0;
  for (int step = 0; step < steps; ++step) {
    const bool enters = draw.between(0.0, 1.0) < fill;
    if (enters && !held.empty()) {
      const auto at = static_cast<std::size_t>(draw.between(0.0, static_cast<double>(held.size())));
      const auto from = held.begin() + static_cast<std::ptrdiff_t>(at);
      if (draw.between(0.0, 1.0) < 0.3) {
        const std::size_t count =
            std::min(held.size() - at, static_cast<std::size_t>(1 + step % 7));
        held.erase(from, from + static_cast<std::ptrdiff_t>(set.enter_first({&held[at], count})));
      } else if (set.enter(held[at])) {
        held.erase(from);
      }
    } else if (!enters && !set.passive().empty()) {
      const auto at =
          static_cast<Index>(draw.between(0.0, static_cast<double>(set.passive().size())));
      held.push_back(set.passive()[static_cast<std::size_t>(at)]);
      set.leave(at);
    }
    if (step % check_every == 0) set.check(worst_move);
  }
  return worst_move;
}

RC_GTEST_PROP(OneLink, AsDenseLeastSquares, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const TriangleCase given =
      test::body_case(seed, {.shapes_a_link = *rc::gen::inRange(1, 30), .density_term = false});
  run(given, Kind::one_link, seed, 80, 1, 0.6);
}

RC_GTEST_PROP(ManyLinks, AsDenseLeastSquares, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const TriangleCase given = test::body_case(seed, {.links = *rc::gen::inRange(1, 5),
                                                    .shapes_a_link = *rc::gen::inRange(1, 15),
                                                    .density_term = false});
  run(given, Kind::many_links, seed, 120, 4, 0.6);
}

// In the midst of those that enter together, too.
TEST(ManyLinks, TheirShapesEnterWhereRoomForReflectionsEnds) {
  const TriangleCase given =
      test::body_case(4, {.links = 2, .shapes_a_link = 6, .noise = 1e-2, .density_term = false});
  Watched set(given, Kind::many_links);
  std::vector<int> all(static_cast<std::size_t>(given.shapes()));
  std::iota(all.begin(), all.end(), 0);
  ASSERT_EQ(set.enter_first(all), all.size());
  double worst_move = 0.0;
  for (std::size_t turn = 0; turn < 100; ++turn) {
    // The last ones leave no reflections behind, so that it is those who enter that need room.
    const std::size_t stay = all.size() - 2 - turn % 3;
    const std::vector<int> last(set.passive().begin() + static_cast<std::ptrdiff_t>(stay),
                                set.passive().end());
    while (set.passive().size() > stay) set.leave(static_cast<Index>(set.passive().size()) - 1);
    ASSERT_EQ(set.enter_first(last), last.size());
    set.check(worst_move);
  }
}

RC_GTEST_PROP(EvenDensity, DividedShapesAsDenseLeastSquares, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const TriangleCase given = test::body_case(
      seed, {.links = *rc::gen::inRange(1, 4), .shapes_a_link = *rc::gen::inRange(1, 12)});
  RC_PRE(given.problem.lambda > 0.0);
  test::Draw draw(seed);
  Watched set(given, Kind::even_density, 30);
  for (int j = 0; j < given.shapes(); ++j) RC_ASSERT(set.enter(j));
  double worst_move = 0.0;
  while (set.has_room()) {
    const auto place = [&] {
      return static_cast<Index>(draw.between(0.0, static_cast<double>(set.passive().size())));
    };
    if (set.passive().size() > 1 && draw.between(0.0, 1.0) < 0.2) set.leave(place());
    set.divide(place(), draw);
    if (set.passive().size() % 7 == 0) {
      set.set_lambda(given.problem.lambda * draw.between(0.5, 2.0));
    }
    if (set.passive().size() % 3 == 0) set.check(worst_move);
  }
  RC_ASSERT(worst_move < damped_rounding);
}

RC_GTEST_PROP(EvenDensity, AsDenseLeastSquares, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const TriangleCase given = test::body_case(
      seed, {.links = *rc::gen::inRange(1, 4), .shapes_a_link = *rc::gen::inRange(1, 30)});
  RC_PRE(given.problem.lambda > 0.0);  // zero where there is no force
  RC_ASSERT(run(given, Kind::even_density, seed, 80, 4, 0.6) < damped_rounding);
}

// A few rows only: many directions that no row feels.
RC_GTEST_PROP(EvenDensity, AsDenseLeastSquaresWithFewRows, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const TriangleCase given = test::body_case(seed, {.links = 2, .shapes_a_link = 12, .samples = 1});
  RC_ASSERT(run(given, Kind::even_density, seed, 60, 4, 0.6) < damped_rounding);
}

TEST(EvenDensity, HundredsOfShapesOnALinkAsDenseLeastSquares) {
  const TriangleCase given = test::body_case(3, {.links = 2, .shapes_a_link = 200});
  const double filling = run(given, Kind::even_density, 1, 400, 80, 0.9);
  const double coming_and_going = run(given, Kind::even_density, 2, 800, 160, 0.6);
  fmt::print("masses off by {:.1e} of their sum filling up, {:.1e} coming and going\n", filling,
             coming_and_going);
  EXPECT_LT(std::max(filling, coming_and_going), damped_rounding);
}

/// What no row feels stays nothing to the last digit, also where the columns of its link are kept.
TEST(EvenDensity, WhatNoRowFeelsIsNothingWhileOtherLinksChange) {
  TriangleCase given = test::body_case(5, {.links = 3, .shapes_a_link = 6});
  given.R.topLeftCorner(10, 10).setZero();
  given.R.block(0, 10, 10, 20).setZero();
  given.problem.Y = given.R.leftCols(30);
  ShapeColumns columns(3, given.shapes());
  EvenDensity set(columns, given.problem.V);
  set.set_lambda(given.problem.lambda);
  for (int j = 0; j < given.shapes(); ++j) {
    ASSERT_TRUE(columns.append(given.links[static_cast<std::size_t>(j)], given.column(j)));
  }
  set.start(given.R);
  std::vector<int> passive;
  for (const int link : {0, 1, 2, 1, 2}) {  // of which the first is not felt
    int entered = 0;
    for (int j = 0; j < given.shapes() && entered < 3; ++j) {
      const bool is_there = std::ranges::find(passive, j) != passive.end();
      if (given.links[static_cast<std::size_t>(j)] != link || is_there) continue;
      ASSERT_TRUE(set.enter(j));
      passive.push_back(j);
      ++entered;
    }
    const VectorXd& target = set.target();
    double others = 0.0;
    for (std::size_t i = 0; i < passive.size(); ++i) {
      const double mass = target[static_cast<Index>(i)];
      if (given.links[static_cast<std::size_t>(passive[i])] == 0) {
        EXPECT_EQ(mass, 0.0) << "after link " << link;
      } else {
        others += std::abs(mass);
      }
    }
    EXPECT_EQ(others > 0.0, passive.size() > 3);
  }
}

/// A column that rounding makes dependent when the set is made anew, here by another one in its
/// place: from then on shapes are counted, and no place of the factorisation is one of theirs.
TEST(ManyLinks, CountsItsShapesWhereItIsNotSound) {
  constexpr int most = 10;
  ShapeColumns columns(1, most + 1);
  for (int j = 0; j < most; ++j) {
    ASSERT_TRUE(columns.append(0, ShapeColumns::Column::Unit(j)));
  }
  ASSERT_TRUE(columns.append(0, ShapeColumns::Column::Unit(most - 1)));
  MatrixXd R = MatrixXd::Identity(11, 11);
  R.col(10).setOnes();
  ManyLinks set(columns);
  set.start(R);
  for (int j = 0; j < most; ++j) ASSERT_TRUE(set.enter(j));
  columns.replace(most - 1, ShapeColumns::Column::Unit(most - 2));
  int passive = most, turns = 0;
  for (; turns < most - 2 && set.sound(); ++turns) {
    set.leave(0);
    --passive;
    if (!set.sound()) continue;
    ASSERT_TRUE(set.enter(turns));
    ++passive;
  }
  ASSERT_FALSE(set.sound());  // there was no room left for reflections
  if (passive < most) {
    const int shapes[] = {turns - 1};
    EXPECT_EQ(set.enter_first(shapes), 1U);
    ++passive;
  }
  EXPECT_FALSE(set.enter(most));  // one more than there are unknowns
  while (passive > 0) {
    set.leave(--passive);
    EXPECT_TRUE(set.target().allFinite());
  }
  EXPECT_TRUE(set.enter(0));
  EXPECT_FALSE(set.sound());
  set.start(R);
  ASSERT_TRUE(set.sound());
  ASSERT_TRUE(set.enter(0));
  EXPECT_NEAR(set.target()[0], 1.0, 1e-15);
}

/// Rounding of a force over the root of lambda would be a mass.
TEST(EvenDensity, WhatNoRowFeelsIsZero) {
  for (const int unfelt : {0, 1}) {
    TriangleCase given = test::body_case(5, {.links = 2, .shapes_a_link = 8});
    given.R.middleCols<10>(Index{10} * unfelt).setZero();
    ShapeColumns columns(given.link_count(), given.shapes());
    EvenDensity set(columns, given.problem.V);
    set.set_lambda(1e-9 * given.problem.lambda);
    set.start(given.R);
    for (int j = 0; j < given.shapes(); ++j) {
      ASSERT_TRUE(columns.append(given.links[static_cast<std::size_t>(j)], given.column(j)));
      ASSERT_TRUE(set.enter(j));
    }
    const VectorXd& target = set.target();
    for (int j = 0; j < given.shapes(); ++j) {
      const bool is_felt = given.links[static_cast<std::size_t>(j)] != unfelt;
      EXPECT_EQ(target[j] != 0.0, is_felt) << j << " of a body whose link " << unfelt << " is not";
    }
  }
}

/// Slopes of passive shapes are lambda m / V, so small that they are noise in R^T r; they must come
/// to digits of their own, because shapes are weighed against each other by them.
TEST(EvenDensity, SlopesOfTheSizeOfLambdaHaveDigits) {
  const TriangleCase given = test::body_case(9, {.shapes_a_link = 60, .noise = 0.1});
  Watched set(given, Kind::even_density);
  for (int j = 0; j < given.shapes(); ++j) ASSERT_TRUE(set.enter(j));
  const LongVector m = set.minimum();
  const VectorXd g = set.slopes();
  for (int j = 0; j < given.shapes(); ++j) {
    const double expected = given.problem.lambda * static_cast<double>(m[j]) / given.problem.V[j];
    const double terms = given.column(j).cwiseAbs().dot(g.cwiseAbs());
    // 1e-6 of them is what the condition leaves of w; R^T r in double would leave nothing.
    EXPECT_LT(std::abs(given.column(j).dot(g) - expected), 1e-6 * terms) << j;
  }
}

}  // namespace
}  // namespace shapeid::fast

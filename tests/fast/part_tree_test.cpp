// Parts are made once, kept, and forgotten when there may be no room.
#include "shapeid/fast/part_tree.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "shapeid/fast/division.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/thin_mesh.hpp"

namespace shapeid::fast {
namespace {

BodyModel two_shapes() {
  BodyModel model;
  model.known = Eigen::VectorXd::Zero(10);
  model.free_links = {0};
  const Eigen::Isometry3d pose(Eigen::Translation3d(0.1, -0.2, 0.3));
  model.shapes.push_back({0, make_cuboid({0.3, 0.2, 0.1}, pose), "0"});
  model.shapes.push_back({0, make_point({0.5, 0.0, 0.1}, 1e-3), "1"});
  return model;
}

TEST(PartTree, PartsAreThoseOfDivide) {
  const BodyModel model = two_shapes();
  PartTree tree(model, 3);
  EXPECT_TRUE(tree.is_divisible(0));
  EXPECT_FALSE(tree.is_divisible(1));
  EXPECT_EQ(tree.parts_of(1), -1);
  const int first = tree.parts_of(0);
  ASSERT_EQ(first, 2);
  EXPECT_EQ(tree.parts_of(0), first);  // kept
  const auto [lower, upper] = divide(model.shapes[0].shape);
  for (const auto& [part, shape] : {std::pair(first, lower), std::pair(first + 1, upper)}) {
    EXPECT_EQ(tree[part].u, unit_parameters(shape).values);
    EXPECT_EQ(tree[part].V, volume(shape));
    EXPECT_EQ(tree[part].parent, 0);
    EXPECT_EQ(tree[part].generation, 1);
    EXPECT_EQ(tree[part].first, -1);
  }
}

// Two runs of so many divisions have room; the next one is refused, and what is there stays.
TEST(PartTree, HasRoomForTwoRuns) {
  constexpr int most = 3;
  const BodyModel model = two_shapes();
  PartTree tree(model, most);
  int part = 0;
  for (int k = 0; k < 2 * most; ++k) {
    const int first = tree.parts_of(part);
    ASSERT_EQ(first, 2 + 2 * k);
    EXPECT_EQ(tree[first].generation, k + 1);
    part = first + k % 2;
  }
  EXPECT_TRUE(tree.is_divisible(part));
  EXPECT_EQ(tree.parts_of(part), -1);
  EXPECT_EQ(tree.parts_of(0), 2);
}

// Before a run parts are kept as long as another whole run has room.
TEST(PartTree, ForgetsWhereARunMayHaveNoRoom) {
  constexpr int most = 3;
  const BodyModel model = two_shapes();
  PartTree tree(model, most);
  int part = 0;
  for (int k = 0; k < most; ++k) part = tree.parts_of(part);
  tree.make_room();
  EXPECT_EQ(tree[0].first, 2);
  const int fourth = tree.parts_of(part);
  EXPECT_EQ(fourth, 2 + 2 * most);
  tree.make_room();
  EXPECT_EQ(tree[0].first, -1);
  EXPECT_EQ(tree.parts_of(0), 2);
  EXPECT_EQ(tree[2].first, -1);  // made anew
  EXPECT_EQ(tree[2].generation, 1);
}

/// A run on rows that the shape itself makes, to its end.
struct RunOn {
  explicit RunOn(const Shape& shape);
  std::unique_ptr<Division> run;
  Division::Stop stop;
};

RunOn::RunOn(const Shape& shape) {
  BodyModel model;
  model.known = Eigen::VectorXd::Zero(10);
  model.free_links = {0};
  model.shapes.push_back({0, shape, "0"});
  DivisionOptions options;
  options.expected_mass = 1.0;
  options.most_divisions = 100;
  options.step = 0.0;
  options.patience = 1000;
  run = std::make_unique<Division>(model, options);
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(11, 11);
  for (int i = 0; i < 10; ++i) {
    for (int j = i; j < 10; ++j) R(i, j) = std::sin(3.0 * i + 1.7 * j + 1.0);
  }
  R.col(10).head(10) = R.topLeftCorner(10, 10) * unit_parameters(shape).values;
  run->set_lambda(1e-12 * R.col(10).squaredNorm() * volume(shape));
  EXPECT_EQ(run->start(R), Outcome::solved);
  stop = run->run();
}

/// Parts of thin meshes make up the whole to half the digits. (What a division promises was asked
/// of them to all, in checked builds: half of these runs ended the program.)
TEST(PartTree, ThinMeshesAreDivided) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const RunOn flat(test::flat_tetrahedron(1e-4, seed));
    EXPECT_EQ(flat.stop, Division::Stop::limit) << seed;
    EXPECT_EQ(flat.run->history().size(), 100U) << seed;
    EXPECT_NEAR(flat.run->masses().m().sum(), 1.0, 1e-4) << seed;
  }
}

/// That a mesh is too thin to be cut in double precision only the cut tells: then it is not
/// divisible from there on. (An exception left a function that has none.)
TEST(PartTree, MeshesThatAreTooThinAreNotDivided) {
  int found = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    BodyModel model = two_shapes();
    model.shapes[0].shape = test::flat_tetrahedron(1e-13, seed);
    PartTree tree(model, 100);
    int part = 0, first = 0;
    while (tree.is_divisible(part) && (first = tree.parts_of(part)) >= 0) part = first;
    EXPECT_FALSE(tree.is_divisible(part)) << "there is room for a hundred cuts";
    EXPECT_EQ(tree.parts_of(part), -1);
    if (first < 0) ++found;
  }
  EXPECT_GT(found, 0) << "of the shapes above some are too thin";
}

}  // namespace
}  // namespace shapeid::fast

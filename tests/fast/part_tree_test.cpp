// Parts are made once, kept, and forgotten when there may be no room.
#include "shapeid/fast/part_tree.hpp"

#include <gtest/gtest.h>

#include "shapeid/tests/support/scaled.hpp"

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

}  // namespace
}  // namespace shapeid::fast

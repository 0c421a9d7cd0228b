// fast::SlidingTriangle against the rows of the blocks that are in.
#include "shapeid/fast/sliding_triangle.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "shapeid/reference/triangle.hpp"
#include "shapeid/tests/fast/allocations.hpp"
#include "shapeid/tests/fast/triangles.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using fast::SlidingTriangle;
using fast::Triangle;
using test::few_hundred_eps;
using test::gram_error;

static_assert(noexcept(std::declval<SlidingTriangle&>().push(std::declval<const Triangle&>())));

/// All rows of the last `most` blocks.
MatrixXd last_rows(const std::vector<MatrixXd>& blocks, std::size_t most, Index columns) {
  MatrixXd rows(0, columns);
  const std::size_t in = std::min(most, blocks.size());
  for (std::size_t i = blocks.size() - in; i < blocks.size(); ++i) {
    rows = reference::stacked(rows, blocks[i]);
  }
  return rows;
}

RC_GTEST_PROP(SlidingTriangle, HoldsTheLastBlocksAtEveryMoment, ()) {
  const Index columns = *rc::gen::inRange<Index>(1, 6);
  const auto most = *rc::gen::inRange<std::size_t>(1, 12);
  SlidingTriangle sliding(columns - 1, most);
  for (int round = 0; round < 2; ++round) {
    std::vector<MatrixXd> blocks;
    for (std::size_t k = 0; k < 4 * most + 1; ++k) {
      blocks.push_back(test::arbitrary_rows(columns, 6));
      sliding.push(test::triangle_of(blocks.back()));
      RC_ASSERT(sliding.blocks() == std::min(most, blocks.size()));
      RC_ASSERT(gram_error(sliding.triangle().R(), last_rows(blocks, most, columns)) <
                few_hundred_eps);
      RC_ASSERT(sliding.last_merges() <= 4);
    }
    sliding.clear();
    RC_ASSERT(sliding.blocks() == 0U);
    RC_ASSERT(sliding.last_merges() == 0);
    RC_ASSERT(sliding.triangle().R().isZero(0.0));
  }
}

// What downdating cannot: a block a billion times as large passes through and leaves no trace.
TEST(SlidingTriangle, ALargeBlockLeavesNoTrace) {
  constexpr std::size_t most = 7;
  SlidingTriangle sliding(4, most);
  std::vector<MatrixXd> blocks;
  for (int k = 0; k < 40; ++k) {
    blocks.push_back((k % 10 == 3 ? 1e9 : 1.0) * MatrixXd::Random(8, 5));
    sliding.push(test::triangle_of(blocks.back()));
    EXPECT_LT(gram_error(sliding.triangle().R(), last_rows(blocks, most, 5)), few_hundred_eps);
  }
}

// The work of every push is bounded, whatever the window's length; and it asks for no memory.
TEST(SlidingTriangle, NoPushIsABurst) {
  const Triangle block = test::triangle_of(MatrixXd::Random(6, 4));
  for (const std::size_t most : {1U, 2U, 3U, 10U, 999U, 1000U}) {
    SlidingTriangle sliding(3, most);
    int largest = 0;
    EXPECT_EQ(test::allocations_during([&] {
                for (std::size_t k = 0; k < 3 * most + 2; ++k) {
                  sliding.push(block);
                  largest = std::max(largest, sliding.last_merges());
                }
              }),
              0U);
    EXPECT_LE(largest, 4);
    MatrixXd all(0, 4);
    for (std::size_t k = 0; k < most; ++k) all = reference::stacked(all, block.R());
    EXPECT_LT(gram_error(sliding.triangle().R(), all), few_hundred_eps);
  }
}

}  // namespace
}  // namespace shapeid

// Who does which job, and in which order neighbours merge.
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapeid/app/merge_order.hpp"
#include "shapeid/diagnosis/in_parallel.hpp"

namespace shapeid::test {
namespace {

TEST(InParallel, EveryNumberOnceAndTheFirstExceptionByNumber) {
  for (const std::size_t threads : {1U, 2U, 5U}) {
    std::vector<std::atomic<int>> calls(100);
    diagnosis::in_parallel(calls.size(), threads, [&](std::size_t k) { ++calls[k]; });
    for (const auto& count : calls) EXPECT_EQ(count, 1);
    try {
      diagnosis::in_parallel(calls.size(), threads, [&](std::size_t k) {
        ++calls[k];
        if (k % 30 == 17) throw std::runtime_error(std::to_string(k));
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& e) {
      EXPECT_STREQ(e.what(), "17");
    }
    for (const auto& count : calls) EXPECT_EQ(count, 2);
  }
}

TEST(MergeOrder, CoversEveryLogOnceInOrder) {
  for (std::size_t count = 1; count <= 40; ++count) {
    for (const std::size_t most : {1U, 2U, 3U, 64U}) {
      std::vector<std::vector<std::size_t>> held(count);
      for (std::size_t k = 0; k < count; ++k) held[k] = {k};
      const std::size_t stride =
          app::merge_neighbours(count, most, [&](std::size_t left, std::size_t right) {
            ASSERT_LT(left, right);
            held[left].insert(held[left].end(), held[right].begin(), held[right].end());
            held[right].clear();
          });
      std::vector<std::size_t> all;
      std::size_t blocks = 0;
      for (std::size_t k = 0; k < count; k += stride, ++blocks) {
        all.insert(all.end(), held[k].begin(), held[k].end());
      }
      EXPECT_LE(blocks, most);
      ASSERT_EQ(all.size(), count);
      for (std::size_t k = 0; k < count; ++k) EXPECT_EQ(all[k], k);
    }
  }
}

}  // namespace
}  // namespace shapeid::test

// The last blocks of a stream as one triangle: the oldest block leaves exactly, nothing is
// subtracted.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/fast/triangle.hpp"

namespace shapeid::fast {

/// The triangle of the last `most` blocks pushed. To take rows out of a triangle (downdating) loses
/// digits where they carried much; here the triangle is always made of blocks that are still in:
///
/// Blocks come in chunks of half the window. The window is an end of the chunk before last, the
/// last chunk, and the chunk that is being filled. For the first, the triangles of all ends are
/// made one a push while it is still the last chunk, from its newest block backward. So no push
/// merges more than four triangles, whatever the window's length, where two stacks would now and
/// then merge all. Memory: 3/2 most + 3 triangles. After construction nothing allocates or throws.
class SlidingTriangle {
 public:
  /// Memory, in triangles a block of the window.
  static constexpr double triangles_a_block = 1.5;

  /// `unknowns` as in Triangle; `most` blocks, at least one.
  SlidingTriangle(Eigen::Index unknowns, std::size_t most);

  /// The newest block, of as many unknowns. If there are `most` already, the oldest leaves.
  void push(const Triangle& block) noexcept;

  /// As constructed: no blocks.
  void clear() noexcept;

  /// Of all blocks that are in.
  [[nodiscard]] const Triangle& triangle() const noexcept { return total_; }
  [[nodiscard]] std::size_t blocks() const noexcept { return blocks_; }
  /// Triangles merged by the last push: four at most.
  [[nodiscard]] int last_merges() const noexcept { return last_merges_; }

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("oldest_ends", oldest_ends_);
    archive("last", last_);
    archive("filling", filling_);
    archive("last_total", last_total_);
    archive("filling_total", filling_total_);
    archive("total", total_);
    archive("filled", filled_);
    archive("ends_made", ends_made_);
    archive("whole_chunks", whole_chunks_);
    archive("blocks", blocks_);
  }

 private:
  void merge(Triangle& into, const Triangle& from) noexcept;

  std::size_t most_, chunk_;  ///< blocks
  /// Of the chunk before last: number i holds blocks i to the last. Empty before there is one.
  std::vector<Triangle> oldest_ends_;
  /// Of the last chunk: block i as it came, or the end from i on if that is made already.
  std::vector<Triangle> last_;
  std::vector<Triangle> filling_;  ///< blocks as they come
  Triangle last_total_, filling_total_, total_;
  std::size_t filled_ = 0;        ///< blocks in filling_
  std::size_t ends_made_ = 0;     ///< of last_, from its newest on
  std::size_t whole_chunks_ = 0;  ///< before filling_, as far as they are kept: 0, 1 or 2
  std::size_t blocks_ = 0;
  int last_merges_ = 0;
};

}  // namespace shapeid::fast

#include "shapeid/fast/sliding_triangle.hpp"

#include <algorithm>
#include <utility>

#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

[[maybe_unused]] Violation why_no_window(std::size_t most) {
  if (most > 0) return std::nullopt;
  return "a window of no blocks";
}

}  // namespace

SlidingTriangle::SlidingTriangle(Eigen::Index unknowns, std::size_t most)
    : most_(most),
      chunk_((most + 1) / 2),
      oldest_ends_(chunk_, Triangle(unknowns)),
      last_(oldest_ends_),
      filling_(oldest_ends_),
      last_total_(unknowns),
      filling_total_(unknowns),
      total_(unknowns) {
  SHAPEID_CONTRACT(why_no_window(most));
}

void SlidingTriangle::push(const Triangle& block) noexcept {
  last_merges_ = 0;
  if (filled_ == chunk_) {  // chunks move up; the vectors are only exchanged
    std::swap(oldest_ends_, last_);
    std::swap(last_, filling_);
    std::swap(last_total_, filling_total_);
    filled_ = 0;
    ends_made_ = 1;  // of the newest block alone
    whole_chunks_ = std::min<std::size_t>(whole_chunks_ + 1, 2);
  }
  filling_[filled_].assign(block);
  if (filled_ == 0) {
    filling_total_.assign(block);
  } else {
    merge(filling_total_, block);
  }
  ++filled_;
  if (whole_chunks_ > 0 && ends_made_ < chunk_) {
    ++ends_made_;
    merge(last_[chunk_ - ends_made_], last_[chunk_ - ends_made_ + 1]);
  }

  blocks_ = std::min(most_, blocks_ + 1);
  total_.assign(filling_total_);
  const std::size_t before = blocks_ - filled_;  // blocks of the whole chunks that are still in
  if (before == 0) return;
  if (before < chunk_) {
    merge(total_, last_[chunk_ - before]);
    return;
  }
  merge(total_, last_total_);
  if (before > chunk_) merge(total_, oldest_ends_[2 * chunk_ - before]);
}

void SlidingTriangle::clear() noexcept {
  filled_ = ends_made_ = whole_chunks_ = blocks_ = 0;
  last_merges_ = 0;
  total_.clear();
}

void SlidingTriangle::merge(Triangle& into, const Triangle& from) noexcept {
  into.merge(from);
  ++last_merges_;
}

}  // namespace shapeid::fast

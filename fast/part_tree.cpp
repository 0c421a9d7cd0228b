#include "shapeid/fast/part_tree.hpp"

#include <cstddef>
#include <utility>

namespace shapeid::fast {
namespace {

PartTree::Part part_of(Shape shape, int parent, int generation) {
  PartTree::Part part;
  part.u = unit_parameters(shape).values;
  part.V = volume(shape);
  part.shape = std::move(shape);
  part.parent = parent;
  part.generation = generation;
  return part;
}

}  // namespace

PartTree::PartTree(const BodyModel& model, int most_divisions)
    : most_divisions_(most_divisions),
      whole_(static_cast<int>(model.shapes.size())),
      used_(whole_) {
  for (const SoughtShape& sought : model.shapes) parts_.push_back(part_of(sought.shape, -1, 0));
  parts_.resize(parts_.size() + 4 * static_cast<std::size_t>(most_divisions));
}

void PartTree::make_room() noexcept {
  if (static_cast<std::size_t>(used_) + 2 * static_cast<std::size_t>(most_divisions_) <=
      parts_.size())
    return;
  used_ = whole_;
  for (int i = 0; i < whole_; ++i) parts_[static_cast<std::size_t>(i)].first = -1;
}

bool PartTree::is_divisible(int part) const noexcept {
  const Part& whole = (*this)[part];
  return whole.generation < most_cuts && divisible(whole.shape);
}

int PartTree::parts_of(int part) noexcept {
  const int kept = (*this)[part].first;
  if (kept >= 0) return kept;
  const int first = used_;
  if (!is_divisible(part) || static_cast<std::size_t>(first) + 2 > parts_.size()) return -1;
  const int generation = (*this)[part].generation + 1;
  auto [lower, upper] = divide((*this)[part].shape);
  parts_[static_cast<std::size_t>(first)] = part_of(std::move(lower), part, generation);
  parts_[static_cast<std::size_t>(first) + 1] = part_of(std::move(upper), part, generation);
  parts_[static_cast<std::size_t>(part)].first = first;
  used_ += 2;
  return first;
}

}  // namespace shapeid::fast

#include "shapeid/fast/part_tree.hpp"

#include <cstddef>
#include <optional>
#include <stdexcept>
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
  Part& whole = parts_[static_cast<std::size_t>(part)];
  if (whole.first >= 0) return whole.first;
  const int first = used_;
  if (!is_divisible(part) || static_cast<std::size_t>(first) + 2 > parts_.size()) return -1;
  const int generation = whole.generation + 1;
  std::optional<std::pair<Shape, Shape>> cut = parts_if_any(whole.shape);
  if (!cut) {
    whole.generation = most_cuts;  // so that it is not asked again
    return -1;
  }
  parts_[static_cast<std::size_t>(first)] = part_of(std::move(cut->first), part, generation);
  parts_[static_cast<std::size_t>(first) + 1] = part_of(std::move(cut->second), part, generation);
  whole.first = first;
  used_ += 2;
  return first;
}

}  // namespace shapeid::fast

#include "shapeid/diagnosis/regions.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "shapeid/models/shapes_yaml.hpp"

namespace shapeid::diagnosis {

Box box_around(const Robot& robot, const std::vector<SoughtShape>& given, int link) {
  Box box;
  const auto include = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    box.lower = box.lower.cwiseMin(a);
    box.upper = box.upper.cwiseMax(b);
  };
  for (const SoughtShape& s : given) {
    if (s.link != link) continue;
    const auto [a, b] = bounds(s.shape);
    include(a, b);
  }
  for (const Link& child : robot.links) {
    const Eigen::Vector3d place = child.joint.placement.translation();
    if (child.parent == link) include(place, place);
  }
  return box;
}

BodyModel generous_regions(const Robot& robot, const std::vector<int>& free_links) {
  constexpr double wider = 0.25;  // of the longest side, on every side
  // Along each side of the inner part. One box cannot shift its centre of mass, and the criterion
  // that picks what to divide looks for mass, not for what the data lack: it may leave a light link
  // whole for ever; and cells as large as the margin cannot be as slender as a trunk is.
  constexpr int inner = 4;
  BodyModel model = default_shapes(robot, free_links);
  const std::vector<SoughtShape> given = std::move(model.shapes);
  model.shapes.clear();
  for (const int link : model.free_links) {
    const Box box = box_around(robot, given, link);
    const Eigen::Vector3d &lower = box.lower, &upper = box.upper;
    const double margin = wider * (upper - lower).maxCoeff();
    const Eigen::Vector3d outermost = Eigen::Vector3d::Constant(margin);
    const Eigen::Vector3d cell = (upper - lower) / inner;
    // Borders of the cells along an axis: the margin, the inner part, the margin.
    const auto border = [&](int i) -> Eigen::Vector3d {
      if (i == 0) return lower - outermost;
      return i > inner + 1 ? Eigen::Vector3d(upper + outermost)
                           : Eigen::Vector3d(lower + (i - 1) * cell);
    };
    constexpr int cells = inner + 2;
    for (int k = 0; k < cells * cells * cells; ++k) {
      const std::array<int, 3> place = {k % cells, k / cells % cells, k / (cells * cells)};
      Eigen::Vector3d from, to;
      for (int axis = 0; axis < 3; ++axis) {
        const int i = place[static_cast<std::size_t>(axis)];
        from[axis] = border(i)[axis];
        to[axis] = border(i + 1)[axis];
      }
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = 0.5 * (from + to);
      model.shapes.push_back(
          {link, make_cuboid(to - from, pose), std::to_string(model.shapes.size())});
    }
  }
  return model;
}

}  // namespace shapeid::diagnosis

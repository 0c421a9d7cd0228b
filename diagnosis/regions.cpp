#include "shapeid/diagnosis/regions.hpp"

#include <algorithm>
#include <string>

#include "shapeid/models/shapes_yaml.hpp"

namespace shapeid::diagnosis {

BodyModel generous_regions(const Robot& robot, const std::vector<int>& free_links) {
  constexpr double wider = 0.25;  // of the longest side, on every side
  // Along each side. One box cannot shift its centre of mass, and the criterion that picks what to
  // divide looks for mass, not for what the data lack: it may leave a light link whole for ever.
  constexpr int cells = 4;
  BodyModel model = default_shapes(robot, free_links);
  const std::vector<SoughtShape> given = std::move(model.shapes);
  model.shapes.clear();
  for (const int link : model.free_links) {
    Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = Eigen::Vector3d::Zero();
    const auto include = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      lower = lower.cwiseMin(a);
      upper = upper.cwiseMax(b);
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
    const double margin = wider * (upper - lower).maxCoeff();
    const Eigen::Vector3d cell = ((upper - lower).array() + 2.0 * margin) / cells;
    const Eigen::Vector3d corner = lower.array() - margin;
    for (int k = 0; k < cells * cells * cells; ++k) {
      const Eigen::Vector3d place(k % cells, k / cells % cells, k / (cells * cells));
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = corner + cell.cwiseProduct((place.array() + 0.5).matrix());
      model.shapes.push_back({link, make_cuboid(cell, pose), std::to_string(model.shapes.size())});
    }
  }
  return model;
}

}  // namespace shapeid::diagnosis

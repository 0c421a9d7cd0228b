// Where the mass of a link may be: boxes to begin the divisions with.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/body_model.hpp"

namespace shapeid::diagnosis {

struct Box {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = Eigen::Vector3d::Zero();
};

/// Around the link's shapes (among `given`), its origin and the origins of its children.
[[nodiscard]] Box box_around(const Robot& robot, const std::vector<SoughtShape>& given, int link);

/// A grid of cuboids for each free link, around its given shapes, its origin and the origins of its
/// children, a quarter larger on every side. Given inertias may be far off, and the diagnosis must
/// not blame an effect for mass that a tight box shuts out.
[[nodiscard]] BodyModel generous_regions(const Robot& robot, const std::vector<int>& free_links);

}  // namespace shapeid::diagnosis

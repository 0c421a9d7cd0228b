// shapes.yaml: which links are known, which are made of which shapes; and the default without it.
#pragma once

#include <string>
#include <vector>

#include "shapeid/models/body_model.hpp"

namespace shapeid {

/// Reads shapes.yaml: for each link `known` or a list of {kind, size, pose: {xyz, rpy}} in the
/// frame of the URDF link that it names. Links that the file does not name are known. Mesh files
/// are looked up beside the yaml. A shape's id is its place among all shapes. Throws InputError.
[[nodiscard]] BodyModel read_shapes_yaml(const std::string& path, const Robot& robot);

/// Without a file: the given links are free, with shapes from their collision bodies (primitives;
/// meshes become one cuboid of the given inertia), else the cuboid of the given inertia. Throws
/// InputError if a link has neither.
[[nodiscard]] BodyModel default_shapes(const Robot& robot, const std::vector<int>& free_links);

/// Every link known, with one cuboid of unknown mass on `link`: the start of the search for a load.
/// Corners in m, in the frame `pose` of the lumped link (a LinkSite's pose for a URDF link's
/// frame). Throws InputError for an area without volume.
[[nodiscard]] BodyModel load_region(const Robot& robot, int link, const Eigen::Vector3d& lower,
                                    const Eigen::Vector3d& upper,
                                    const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity());

}  // namespace shapeid

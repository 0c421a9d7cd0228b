#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shapeid/models/error.hpp"
#include "shapeid/models/shape_size.hpp"
#include "shapeid/models/shapes_yaml.hpp"

namespace shapeid {
namespace {

/// The solid that a collision body stands for; empty for a mesh, and for one without volume.
std::optional<Shape> solid(const CollisionBody& body) {
  if (const auto* box = std::get_if<Box>(&body.geometry)) {
    if (box->size.minCoeff() > 0.0) return make_cuboid(box->size, body.pose);
  } else if (const auto* cylinder = std::get_if<CylinderGeometry>(&body.geometry)) {
    if (cylinder->radius > 0.0 && cylinder->length > 0.0) {
      return make_cylinder(cylinder->radius, cylinder->length, body.pose);
    }
  } else if (const auto* sphere = std::get_if<SphereGeometry>(&body.geometry)) {
    if (sphere->radius > 0.0) {
      return make_ellipsoid(Eigen::Vector3d::Constant(sphere->radius), body.pose);
    }
  }
  return std::nullopt;
}

/// The uniform cuboid that has the link's given inertia: its second moment along a principal axis
/// is mass times side^2 / 12. Empty if the link has no extent, or an inertia that no body can have.
std::optional<Shape> cuboid_of_inertia(const Link& link) {
  if (link.inertia.mass() <= 0.0 || why_impossible(link.inertia)) return std::nullopt;
  const Eigen::Matrix3d I = link.inertia.tensor_about_centre();
  const Eigen::Matrix3d second =
      (0.5 * I.trace() * Eigen::Matrix3d::Identity() - I) / link.inertia.mass();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(second);
  const Eigen::Vector3d sides = (12.0 * principal.eigenvalues().cwiseMax(0.0)).cwiseSqrt();
  // Less than a tenth of a millimetre is no link; a rod or plate gets a hundredth of its length.
  constexpr double smallest_link = 1e-4;
  constexpr double thinnest = 0.01;
  if (sides.maxCoeff() < smallest_link) return std::nullopt;
  Eigen::Matrix3d R = principal.eigenvectors();
  if (R.determinant() < 0.0) R.col(0) *= -1.0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = R;
  pose.translation() = link.inertia.centre_of_mass();
  return make_cuboid(sides.cwiseMax(thinnest * sides.maxCoeff()), pose);
}

std::vector<Shape> shapes_of(const Link& link) {
  std::vector<Shape> shapes;
  bool mesh = false;
  for (const CollisionBody& body : link.collision) {
    if (auto shape = solid(body)) shapes.push_back(std::move(*shape));
    mesh = mesh || std::holds_alternative<MeshGeometry>(body.geometry);
  }
  if (!mesh && !shapes.empty()) return shapes;
  if (auto cuboid = cuboid_of_inertia(link)) {
    shapes.push_back(std::move(*cuboid));
    return shapes;
  }
  throw InputError(
      fmt::format("link {} has {}, and no inertia of a solid to make a cuboid of", link.name,
                  mesh ? "a mesh for collision geometry" : "no collision geometry with a volume"),
      "describe it in shapes.yaml");
}

/// The shapes that `make` returns. Throws InputError, which names `what`, for those that are too
/// small or too large to be computed with.
template <typename Make>
std::vector<Shape> of_size(const std::string& what, const Make& make) {
  try {
    std::vector<Shape> shapes = make();
    for (const Shape& shape : shapes) {
      if (const Violation why = why_no_size(shape)) throw std::invalid_argument("it " + *why);
    }
    return shapes;
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", what, error.what()), "give lengths in metres");
  }
}

BodyModel all_known(const Robot& robot) {
  BodyModel model;
  model.known = stacked_parameters(robot);
  return model;
}

}  // namespace

BodyModel default_shapes(const Robot& robot, const std::vector<int>& free_links) {
  BodyModel model = all_known(robot);
  model.free_links = free_links;
  std::sort(model.free_links.begin(), model.free_links.end());
  const auto last = std::unique(model.free_links.begin(), model.free_links.end());
  model.free_links.erase(last, model.free_links.end());
  for (const int i : model.free_links) {
    model.known.segment<10>(Eigen::Index{10} * i).setZero();
    const Link& link = robot.links.at(static_cast<std::size_t>(i));
    for (Shape& shape : of_size("a shape of link " + link.name, [&] { return shapes_of(link); })) {
      model.shapes.push_back({i, std::move(shape), std::to_string(model.shapes.size())});
    }
  }
  SHAPEID_CONTRACT(why_malformed(model, robot));
  return model;
}

BodyModel load_region(const Robot& robot, int link, const Eigen::Vector3d& lower,
                      const Eigen::Vector3d& upper, const Eigen::Isometry3d& pose) {
  if (!lower.allFinite() || !upper.allFinite() || !(lower.array() < upper.array()).all()) {
    throw InputError(
        fmt::format("the area from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) has no volume",
                    lower.x(), lower.y(), lower.z(), upper.x(), upper.y(), upper.z()),
        "give x0 < x1, y0 < y1, z0 < z1 in metres");
  }
  BodyModel model = all_known(robot);
  model.free_links = {link};
  const Eigen::Isometry3d middle = pose * Eigen::Translation3d(0.5 * (lower + upper));
  const std::vector<Shape> area =
      of_size("the area", [&] { return std::vector<Shape>{make_cuboid(upper - lower, middle)}; });
  model.shapes.push_back({link, area.front(), "0"});
  SHAPEID_CONTRACT(why_malformed(model, robot));
  return model;
}

}  // namespace shapeid

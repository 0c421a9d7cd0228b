#include "shapeid/models/shapes_yaml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <variant>

#include "shapeid/models/mesh_file.hpp"
#include "shapeid/models/shape_size.hpp"
#include "shapeid/models/yaml_input.hpp"

namespace shapeid {
namespace {

/// Vertices come in the frame in which shapes are written; the pose is applied by the maker.
Shape read_polyhedron(const YamlInput& in, const YAML::Node& node, const Eigen::Isometry3d& pose) {
  if (const YAML::Node list = node["vertices"]) {
    if (node["mesh"]) {
      in.refuse(node, "a polyhedron has both vertices and a mesh", "give one of them");
    }
    if (node["scale"] || node["hull"]) {
      in.refuse(node, "a polyhedron of vertices has a scale or a hull", "these are of a mesh");
    }
    if (!list.IsSequence()) in.refuse(list, "vertices is not a list", "write [[x, y, z], ...]");
    std::vector<Eigen::Vector3d> vertices;
    for (const YAML::Node& vertex : list) vertices.push_back(in.three(vertex, "a vertex"));
    return make_convex_hull(vertices, pose);
  }
  if (!node["mesh"])
    in.refuse(node, "a polyhedron has no vertices and no mesh", "give one of them");
  const auto folder = std::filesystem::path(in.path()).parent_path();
  MeshFile mesh = read_stl((folder / in.text(node["mesh"], "mesh")).string());
  const double scale = node["scale"] ? in.positive(node["scale"], "scale") : 1.0;
  for (Eigen::Vector3d& v : mesh.vertices) v *= scale;
  const std::string hull = node["hull"] ? in.text(node["hull"], "hull") : "false";
  if (hull != "true" && hull != "false")
    in.refuse(node["hull"], "hull is " + hull, "true or false");
  if (hull == "true") return make_convex_hull(mesh.vertices, pose);
  return make_mesh(std::move(mesh.vertices), std::move(mesh.faces), pose);
}

/// Whether its volume is what is left of terms so much larger that the rounding of its vertices,
/// where they lie, shows in it: no certificate could hold.
bool is_too_thin(const Shape& shape) {
  const auto* const solid = std::get_if<Polyhedron>(&shape);
  if (solid == nullptr) return false;
  double farthest = 0.0;
  for (const Eigen::Vector3d& v : solid->vertices) farthest = std::max(farthest, v.norm());
  constexpr double least_share = 1e-8;
  return !(volume(shape) > least_share * farthest * farthest * farthest);
}

Shape read_kind(const YamlInput& in, const YAML::Node& node, const std::string& kind,
                const Eigen::Isometry3d& pose) {
  const std::string what = "a " + kind;
  if (kind == "cuboid") {
    in.check_keys(node, what, {"kind", "size"}, {"pose"});
    return make_cuboid(in.three(node["size"], "size"), pose);
  }
  if (kind == "cylinder") {
    in.check_keys(node, what, {"kind", "size"}, {"pose"});
    const Eigen::VectorXd size = in.numbers(node["size"], "size (radius, length)", 2);
    return make_cylinder(size[0], size[1], pose);
  }
  if (kind == "ellipsoid") {
    in.check_keys(node, "an ellipsoid", {"kind", "size"}, {"pose"});
    return make_ellipsoid(in.three(node["size"], "size"), pose);
  }
  if (kind == "polyhedron") {
    in.check_keys(node, what, {"kind"}, {"pose", "vertices", "mesh", "scale", "hull"});
    return read_polyhedron(in, node, pose);
  }
  if (kind == "point") {
    in.check_keys(node, what, {"kind", "volume"}, {"pose"});
    return make_point(pose.translation(), in.positive(node["volume"], "volume"));
  }
  in.refuse(node["kind"], fmt::format("there is no shape of kind {}", kind),
            "cuboid, cylinder, ellipsoid, polyhedron or point");
}

Shape read_shape(const YamlInput& in, const YAML::Node& node, const Eigen::Isometry3d& link_pose) {
  if (!node.IsMap() || !node["kind"]) {
    in.refuse(node, "a shape has no kind", "write {kind: cuboid, size: [x, y, z]}");
  }
  Eigen::Isometry3d pose = link_pose;
  if (node["pose"]) pose = link_pose * in.pose(node["pose"], "pose");
  try {
    Shape shape = read_kind(in, node, in.text(node["kind"], "kind"), pose);
    if (const Violation why = why_no_size(shape)) {
      in.refuse(node, "the shape " + *why, "lengths are in metres");
    }
    if (is_too_thin(shape)) {
      in.refuse(node, "the solid is too thin for its place: rounding would change its volume",
                "a thicker solid, or one that is nearer to its link's origin");
    }
    return shape;
  } catch (const std::invalid_argument& error) {
    in.refuse(node, error.what(), "give a solid with a positive volume");
  }
}

/// What the file says about one lumped link, from all of its members that it names.
struct Said {
  bool known = false;
  std::vector<Shape> shapes;
};

void read_link(const YamlInput& in, const YAML::Node& key, const YAML::Node& node,
               const Robot& robot, std::vector<Said>& said) {
  const std::string& name = key.Scalar();
  const std::optional<LinkSite> site = robot.find_site(name);
  if (!site) in.refuse(key, fmt::format("{} has no link {}", robot.name, name), "name a link");
  Said& here = said[static_cast<std::size_t>(site->link)];
  const bool known = node.IsScalar() && node.Scalar() == "known";
  if (!known && (!node.IsSequence() || node.size() == 0)) {
    in.refuse(node, fmt::format("{} is neither known nor a list of shapes", name),
              "write known, or - {kind: cuboid, size: [x, y, z]}");
  }
  if (here.known ? !known : known && !here.shapes.empty()) {
    in.refuse(node,
              fmt::format("{} is one rigid body with a link named before, which says "
                          "otherwise",
                          name),
              "make both known, or give both shapes");
  }
  here.known = known;
  if (known) return;
  for (const YAML::Node& shape : node) here.shapes.push_back(read_shape(in, shape, site->pose));
}

}  // namespace

BodyModel read_shapes_yaml(const std::string& path, const Robot& robot) {
  const YamlInput in(path);
  static_cast<void>(in.keys(in.root(), "shapes.yaml"));
  std::vector<Said> said(robot.links.size());
  for (const auto& entry : in.root()) read_link(in, entry.first, entry.second, robot, said);

  BodyModel model;
  model.known = stacked_parameters(robot);
  for (int i = 0; i < robot.link_count(); ++i) {
    std::vector<Shape>& shapes = said[static_cast<std::size_t>(i)].shapes;
    if (shapes.empty()) continue;
    model.free_links.push_back(i);
    model.known.segment<10>(Eigen::Index{10} * i).setZero();
    for (Shape& shape : shapes) {
      model.shapes.push_back({i, std::move(shape), std::to_string(model.shapes.size())});
    }
  }
  if (model.free_links.empty()) {
    throw InputError(Place{path, 1, {}}, "every link is known, so nothing is sought",
                     "give one link a list of shapes");
  }
  SHAPEID_CONTRACT(why_malformed(model, robot));
  return model;
}

}  // namespace shapeid

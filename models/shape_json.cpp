#include "shapeid/models/shape_json.hpp"

#include <fmt/format.h>

#include "shapeid/models/error.hpp"

namespace shapeid {
namespace {

using nlohmann::json;

struct Writer {
  template <class Celled>
  json operator()(const Celled& s) const {
    return {{"frame", matrix_json(s.frame.affine())},
            {"lower", vector_json(s.cell.lower)},
            {"upper", vector_json(s.cell.upper)}};
  }
  json operator()(const Polyhedron& s) const {
    json vertices = json::array();
    for (const Eigen::Vector3d& v : s.vertices) vertices.push_back(vector_json(v));
    return {{"vertices", vertices}, {"faces", triangles(s)}, {"convex", s.convex}};
  }
  json operator()(const Point& s) const {
    return {{"position", vector_json(s.position)}, {"nominal_volume", s.nominal_volume}};
  }
};

Eigen::Vector3d triple(const json& object, const std::string& key, const JsonSource& source) {
  const Eigen::VectorXd v = numbers(member(object, key, source), key, source);
  if (v.size() != 3) throw InputError(place_of_key(source, key), "not three numbers", "x, y, z");
  return v;
}

template <class Celled>
Shape celled(const json& object, const std::string& key, const JsonSource& source) {
  check_keys(object, key, source, {"kind", "link", "frame", "lower", "upper"});
  const Eigen::MatrixXd frame = matrix(member(object, "frame", source), 4, "frame", source);
  if (frame.rows() != 3)
    throw InputError(place_of_key(source, "frame"), "not 3 x 4", "[L t], 3 x 4");
  Celled shape{Eigen::Affine3d::Identity(),
               {triple(object, "lower", source), triple(object, "upper", source)}};
  shape.frame.affine() = frame;
  return shape;
}

Shape polyhedron(const json& object, const std::string& key, const JsonSource& source) {
  check_keys(object, key, source, {"kind", "link", "vertices", "faces", "convex"});
  Polyhedron shape;
  const Eigen::MatrixXd V = matrix(member(object, "vertices", source), 3, "vertices", source);
  for (Eigen::Index i = 0; i < V.rows(); ++i) shape.vertices.emplace_back(V.row(i).transpose());
  const json& faces = member(object, "faces", source);
  if (!faces.is_array()) throw InputError(place_of_key(source, "faces"), "not a list", "triangles");
  for (const json& face : faces) {
    if (!face.is_array() || face.size() != 3) {
      throw InputError(place_of_key(source, "faces"), "not three numbers",
                       "indices of three vertices");
    }
    std::vector<int> corners(3);
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = static_cast<int>(count(face[i], V.rows() - 1, "faces", source));
    }
    shape.sides.push_back(std::move(corners));
  }
  const json& convex = member(object, "convex", source);
  if (!convex.is_boolean()) throw InputError(place_of_key(source, "convex"), "no", "true or false");
  shape.convex = convex.get<bool>();
  return shape;
}

Shape read(const json& object, const std::string& key, const JsonSource& source) {
  const std::string kind = text(member(object, "kind", source), "kind", source);
  if (kind == "cuboid") return celled<Cuboid>(object, key, source);
  if (kind == "cylinder") return celled<Cylinder>(object, key, source);
  if (kind == "ellipsoid") return celled<Ellipsoid>(object, key, source);
  if (kind == "polyhedron") return polyhedron(object, key, source);
  if (kind == "point") {
    check_keys(object, key, source, {"kind", "link", "position", "nominal_volume"});
    return Point{triple(object, "position", source),
                 number(member(object, "nominal_volume", source), "nominal_volume", source)};
  }
  throw InputError(place_of_key(source, "kind"), "unknown kind of shape '" + kind + "'",
                   "cuboid, cylinder, ellipsoid, polyhedron or point");
}

}  // namespace

json shape_json(const Shape& shape) {
  json object = std::visit(Writer{}, shape);
  object["kind"] = kind_name(shape);
  return object;
}

Shape shape_from_json(const json& value, const std::string& key, const JsonSource& source) {
  if (!value.is_object()) throw InputError(place_of_key(source, key), "not an object", "a shape");
  Shape shape = read(value, key, source);
  if (const Violation why = why_malformed(shape)) {
    throw InputError(place_of_key(source, key), *why, "see " + source.manual);
  }
  return shape;
}

}  // namespace shapeid

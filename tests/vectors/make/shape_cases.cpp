// Cases of shapes: their moments, and what a cut makes of them.
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "shapeid/models/shape.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/tests/vectors/make/cases.hpp"

namespace shapeid::vectors {
namespace {

using nlohmann::json;

/// The same shape twice: as a question says it, and as we have it.
struct AskedShape {
  json text;
  Shape shape;
};

/// "cuboid", "cylinder" or "ellipsoid", whole or a cell of it. Cells are not narrower than a fifth
/// of the body, where plain formulas keep their digits.
AskedShape drawn_cell(test::Draw& draw, const std::string& kind, bool whole) {
  const Eigen::Vector3d xyz = draw.vector(0.5), rpy = draw.vector(3.0),
                        size = draw.sides(0.05, 0.5);
  const Eigen::Isometry3d pose = pose_of(xyz, rpy);
  AskedShape asked{{{"kind", kind}, {"xyz", vector_json(xyz)}, {"rpy", vector_json(rpy)}},
                   make_point(xyz, 1.0)};  // until it is known
  const auto part = [&](double least, double most) {
    const double width = (most - least) * draw.between(0.2, 0.9);
    const double lower = draw.between(least, most - width);
    return std::pair(lower, lower + width);
  };
  const auto narrowed = [&](Cell& cell) {
    if (whole) return;
    for (int axis = 0; axis < 3; ++axis) {
      std::tie(cell.lower[axis], cell.upper[axis]) = part(cell.lower[axis], cell.upper[axis]);
    }
    asked.text["lower"] = vector_json(cell.lower);
    asked.text["upper"] = vector_json(cell.upper);
  };
  if (kind == "cuboid") {
    asked.text["size"] = vector_json(size);
    asked.shape = make_cuboid(size, pose);
    narrowed(std::get<Cuboid>(asked.shape).cell);
  } else if (kind == "cylinder") {
    asked.text["radius"] = size.x();
    asked.text["length"] = size.y();
    asked.shape = make_cylinder(size.x(), size.y(), pose);
    narrowed(std::get<Cylinder>(asked.shape).cell);
  } else {
    asked.text["semi_axes"] = vector_json(size);
    asked.shape = make_ellipsoid(size, pose);
    narrowed(std::get<Ellipsoid>(asked.shape).cell);
  }
  return asked;
}

AskedShape drawn_tetrahedron(test::Draw& draw) {
  const Eigen::Vector3d xyz = draw.vector(0.5), rpy = draw.vector(3.0);
  std::vector<Eigen::Vector3d> corners = {draw.vector(0.1), draw.vector(0.1), draw.vector(0.1)};
  corners.emplace_back(0.4 + draw.between(0.0, 0.2), 0.3, -0.3);
  AskedShape asked{{{"kind", "tetrahedron"}, {"xyz", vector_json(xyz)}, {"rpy", vector_json(rpy)}},
                   make_convex_hull(corners, pose_of(xyz, rpy))};
  for (const Eigen::Vector3d& corner : corners) {
    asked.text["vertices"].push_back(vector_json(corner));
  }
  return asked;
}

/// A pyramid of four sides; with its top inside out it is not convex: the base is then a roof with
/// four flat sides and a hollow.
AskedShape drawn_mesh(test::Draw& draw, bool convex) {
  const Eigen::Vector3d xyz = draw.vector(0.5), rpy = draw.vector(3.0);
  std::vector<Eigen::Vector3d> p = {{0.2, 0.0, 0.0},  {0.0, 0.25, 0.0},  {-0.15, 0.0, 0.0},
                                    {0.0, -0.1, 0.0}, {0.02, 0.01, 0.3}, {0.01, 0.02, -0.1}};
  if (!convex) p[5].z() = 0.1;
  for (Eigen::Vector3d& corner : p) corner += draw.vector(0.01);
  const std::vector<std::array<int, 3>> faces = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4},
                                                 {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  AskedShape asked{{{"kind", "mesh"}, {"xyz", vector_json(xyz)}, {"rpy", vector_json(rpy)}},
                   make_mesh(p, faces, pose_of(xyz, rpy))};
  for (const Eigen::Vector3d& corner : p) asked.text["vertices"].push_back(vector_json(corner));
  for (const auto& face : faces) asked.text["faces"].push_back(face);
  return asked;
}

double reach(const Shape& shape) {
  const auto [lower, upper] = bounds(shape);
  return lower.cwiseAbs().cwiseMax(upper.cwiseAbs()).norm();
}

json moments_case(const AskedShape& asked) {
  Eigen::VectorXd expected(11), sizes(11);
  expected << volume(asked.shape), unit_parameters(asked.shape).values;
  sizes << volume(asked.shape), sizes_of(1.0, reach(asked.shape));
  return number_case(asked.text, "volume_and_parameters", expected, sizes);
}

}  // namespace

json moments_cases(test::Draw& draw) {
  json cases = json::array();
  const auto add = [&](const AskedShape& asked, const json& flags) {
    cases.push_back(moments_case(asked));
    cases.back()["flags"] = flags;
  };
  for (int i = 0; i < 6; ++i) {
    for (const char* kind : {"cuboid", "cylinder", "ellipsoid"}) {
      add(drawn_cell(draw, kind, true), json::array());
      add(drawn_cell(draw, kind, false), {"PartOfAShape"});
    }
    add(drawn_tetrahedron(draw), json::array());
    add(drawn_mesh(draw, true), json::array());
    add(drawn_mesh(draw, false), {"NotConvex"});
  }
  return cases;
}

json division_cases(test::Draw& draw) {
  json cases = json::array();
  for (int i = 0; i < 36; ++i) {
    const char* kind = i % 3 == 0 ? "cuboid" : i % 3 == 1 ? "cylinder" : "ellipsoid";
    const bool whole = i < 18, halves = i % 6 < 3;
    const AskedShape asked = drawn_cell(draw, kind, whole);
    const double mass = draw.between(0.1, 5.0), fraction = halves ? 0.5 : draw.between(0.1, 0.9);
    const int axis = i / 3 % 3;
    const auto [first, second] = divide(asked.shape, axis, fraction);
    Eigen::VectorXd expected(24), sizes(24);
    for (const auto& [part, share, at] :
         {std::tuple{&first, fraction, 0}, std::tuple{&second, 1.0 - fraction, 12}}) {
      expected.segment<12>(at) << volume(*part), mass * share, unit_parameters(*part).values;
      sizes.segment<12>(at) << volume(asked.shape), mass, sizes_of(1.0, reach(asked.shape));
    }
    cases.push_back(
        number_case({{"shape", asked.text}, {"mass", mass}, {"axis", axis}, {"fraction", fraction}},
                    "parts", expected, sizes));
    if (!whole) cases.back()["flags"].push_back("PartOfAShape");
  }
  return cases;
}

}  // namespace shapeid::vectors

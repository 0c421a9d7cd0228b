#include "shapeid/models/polyhedron.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace shapeid {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Six times the volume of the tetrahedron between a triangle and the origin.
double six_volumes(const Triangle& t) { return t[0].dot(t[1].cross(t[2])); }

}  // namespace

std::array<Eigen::Vector3d, 3> corners(const Polyhedron& p, const std::array<int, 3>& face,
                                       const Eigen::Vector3d& origin) {
  const auto at = [&](int i) -> Eigen::Vector3d {
    return p.vertices[static_cast<std::size_t>(i)] - origin;
  };
  return {at(face[0]), at(face[1]), at(face[2])};
}

std::vector<std::array<int, 3>> triangles(const Polyhedron& p) {
  std::vector<std::array<int, 3>> faces;
  for (const std::vector<int>& side : p.sides) {
    for (std::size_t i = 2; i < side.size(); ++i) faces.push_back({side[0], side[i - 1], side[i]});
  }
  return faces;
}

Polyhedron without_unused_vertices(const Polyhedron& p) {
  Polyhedron result{{}, p.sides, p.convex};
  std::vector<int> index(p.vertices.size(), -1);
  for (std::vector<int>& side : result.sides) {
    for (int& v : side) {
      int& known = index[static_cast<std::size_t>(v)];
      if (known < 0) {
        known = static_cast<int>(result.vertices.size());
        result.vertices.push_back(p.vertices[static_cast<std::size_t>(v)]);
      }
      v = known;
    }
  }
  return result;
}

Eigen::Vector3d vertex_mean(const std::vector<Eigen::Vector3d>& vertices) {
  // As seen from the first one, so that a small solid far away keeps its digits.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& v : vertices) sum += v - vertices.front();
  return vertices.front() + sum / static_cast<double>(vertices.size());
}

double extent(const std::vector<Eigen::Vector3d>& vertices) {
  const Eigen::Vector3d mean = vertex_mean(vertices);
  double largest = 0.0;
  for (const Eigen::Vector3d& v : vertices) largest = std::max(largest, (v - mean).norm());
  return largest;
}

std::vector<std::pair<int, int>> open_edges(const std::vector<std::array<int, 3>>& faces) {
  std::map<std::pair<int, int>, int> balance;  // of an edge from its lower to its higher vertex
  for (const auto& face : faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = face[i];
      const int b = face[(i + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  std::vector<std::pair<int, int>> open;
  for (const auto& [edge, count] : balance) {
    const std::pair<int, int> directed =
        count > 0 ? edge : std::pair<int, int>(edge.second, edge.first);
    open.insert(open.end(), static_cast<std::size_t>(std::abs(count)), directed);
  }
  return open;
}

Violation why_malformed(const Polyhedron& p) {
  if (p.sides.size() < 4) return "a closed surface has at least four faces";
  for (const Eigen::Vector3d& v : p.vertices) {
    if (!v.allFinite()) return "a vertex is not finite";
  }
  for (const std::vector<int>& side : p.sides) {
    if (side.size() < 3) return "a face has fewer than three vertices";
  }
  const int count = static_cast<int>(p.vertices.size());
  const auto faces = triangles(p);
  for (const auto& [a, b, c] : faces) {
    if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= count) {
      return fmt::format("a face names a vertex that is none of the {}", count);
    }
    if (a == b || b == c || c == a)
      return fmt::format("a face names vertex {} twice", a == b ? a : c);
  }
  if (const auto open = open_edges(faces); !open.empty()) {
    return fmt::format(
        "the surface is open or inconsistently oriented at {} edges, first between vertices {} and "
        "{}",
        open.size(), open.front().first, open.front().second);
  }

  // Volume counts as such if it exceeds what rounding makes of flat triangles.
  const Eigen::Vector3d o = vertex_mean(p.vertices);
  double sum = 0.0;
  double size = 0.0;
  for (const auto& face : faces) {
    const Triangle t = corners(p, face, o);
    sum += six_volumes(t);
    size += t[0].norm() * t[1].norm() * t[2].norm();
  }
  constexpr double roundings = 16.0 * std::numeric_limits<double>::epsilon();
  if (sum < -roundings * size) {
    return fmt::format(
        "the surface is inside out (volume {:g} m^3): faces must be counter-clockwise seen from "
        "outside",
        sum / 6.0);
  }
  if (!(sum > roundings * size)) return "the surface encloses no volume";
  return std::nullopt;
}

Moments moments(const Polyhedron& p) {
  const auto faces = triangles(p);
  Eigen::Vector3d o = vertex_mean(p.vertices);
  double six = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  for (const auto& face : faces) {
    const Triangle t = corners(p, face, o);
    const double w = six_volumes(t);
    six += w;
    first += w * (t[0] + t[1] + t[2]) / 4.0;
  }
  o += first / six;

  // A second round about the centroid itself: nothing has to be shifted, so nothing cancels.
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& face : faces) {
    const Triangle t = corners(p, face, o);
    const Eigen::Vector3d s = t[0] + t[1] + t[2];
    second += six_volumes(t) / 20.0 *
              (s * s.transpose() + t[0] * t[0].transpose() + t[1] * t[1].transpose() +
               t[2] * t[2].transpose());
  }
  return {six / 6.0, o, second / six};
}

bool is_convex(const Polyhedron& p) {
  // Mesh files carry single precision: facets that were drawn plane are bent by so much.
  const double slack = 1e-6 * extent(p.vertices);

  const auto faces = triangles(p);
  std::map<std::pair<int, int>, std::size_t> face_of;  // directed edge -> the face left of it
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!face_of.emplace(std::pair(faces[f][i], faces[f][(i + 1) % 3]), f).second) {
        return false;  // more than two faces meet in an edge
      }
    }
  }

  // No neighbour's far corner may rise above a face, and neighbours must lead to every face; to the
  // first one as well, which starts.
  std::vector<bool> reached(faces.size(), false);
  std::vector<std::size_t> waiting = {0};
  while (!waiting.empty()) {
    const std::size_t f = waiting.back();
    waiting.pop_back();
    const Eigen::Vector3d& a = p.vertices[static_cast<std::size_t>(faces[f][0])];
    const Triangle t = corners(p, faces[f], a);
    const Eigen::Vector3d normal = t[1].cross(t[2]).normalized();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t g = face_of.at({faces[f][(i + 1) % 3], faces[f][i]});
      for (const Eigen::Vector3d& v : corners(p, faces[g], a)) {
        if (normal.dot(v) > slack) return false;
      }
      if (!reached[g]) waiting.push_back(g);
      reached[g] = true;
    }
  }
  if (!std::all_of(reached.begin(), reached.end(), [](bool r) { return r; })) return false;

  // Such a surface may still wind about its middle twice, as one over a star does.
  constexpr double more_than_once = 1.5;
  return winding(p, moments(p).centroid) < more_than_once;
}

Eigen::Vector3d longest_direction(const Polyhedron& p) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(moments(p).covariance);
  const double most = spread.eigenvalues()[2];
  Eigen::Matrix3d onto_longest = Eigen::Matrix3d::Zero();  // projector on the directions that tie
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d e = spread.eigenvectors().col(i);
    if (spread.eigenvalues()[i] >= (1.0 - tie_of_sides) * most) onto_longest += e * e.transpose();
  }
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (onto_longest(i, i) > (1.0 + tie_of_sides) * onto_longest(axis, axis)) axis = i;
  }
  return onto_longest.col(axis).normalized();
}

}  // namespace shapeid

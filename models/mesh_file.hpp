// Triangles from an STL file. Internal to models.
//
// STL is what robot descriptions keep their collision meshes in, and it is simple enough to be read
// in full and strictly here; Debian's Assimp would bring forty formats, a hundred times the code,
// and repairs that nobody asked for.
#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <vector>

namespace shapeid {

struct MeshFile {
  std::vector<Eigen::Vector3d> vertices;  ///< as in the file; equal ones are one
  std::vector<std::array<int, 3>> faces;  ///< corners in the file's order
};

/// Reads a binary or ASCII STL of at most 64 MiB. Throws InputError for anything else. Whether the
/// surface is closed is not asked here.
[[nodiscard]] MeshFile read_stl(const std::string& path);

}  // namespace shapeid

// STL meshes: finite corners, indices in range.
#include <cstdint>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/memory_file.hpp"
#include "shapeid/models/mesh_file.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  fuzz::taken([&] {
    const MeshFile mesh = read_stl(file.path());
    for (const Eigen::Vector3d& v : mesh.vertices) fuzz::check(v.allFinite(), "corners are finite");
    for (const auto& face : mesh.faces) {
      for (const int corner : face) {
        fuzz::check(corner >= 0 && static_cast<std::size_t>(corner) < mesh.vertices.size(),
                    "faces have corners that are there");
      }
    }
  });
  return 0;
}

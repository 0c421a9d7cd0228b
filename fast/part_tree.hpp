// Shapes and the parts that divisions make of them, computed once and kept from window to window.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/fast/shape_columns.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/models/division.hpp"

namespace shapeid::fast {

/// How a shape is cut does not depend on the data, so that windows which divide the same shapes
/// share the work. Room for the parts of two runs; what does not fit is forgotten and made again.
///
/// Nothing throws after construction, and nothing allocates, but for one thing: a polyhedron is
/// made of vectors, so that cutting it allocates: the first time, and again each time its parts
/// were forgotten meanwhile, as where windows go on to divide different shapes. Cuboids, cylinders
/// and ellipsoids do not.
class PartTree {
 public:
  struct Part {
    Shape shape;
    ShapeColumns::Column u;  ///< unit parameters
    double V = 0.0;          ///< m^3
    int parent = -1;         ///< -1 for the model's shapes
    int first = -1;          ///< its first part; the second follows. -1 if it is not cut
    int generation = 0;
  };

  /// Parts 0, 1, ... are the model's shapes. `most_divisions`: of one run.
  PartTree(const BodyModel& model, int most_divisions);

  /// Before a run: forgets cached parts if there may be no room for those of another run.
  void make_room() noexcept;

  /// The first of the two parts of `part`, cut by divide(). -1 if there is no room, or if it is not
  /// divisible, as a mesh may turn out to be: then is_divisible() says so from now on.
  [[nodiscard]] int parts_of(int part) noexcept;
  [[nodiscard]] bool is_divisible(int part) const noexcept;

  [[nodiscard]] const Part& operator[](int part) const noexcept {
    return parts_[static_cast<std::size_t>(part)];
  }

 private:
  int most_divisions_;
  int whole_ = 0;  ///< the model's shapes, which are never forgotten
  int used_ = 0;
  std::vector<Part> parts_;
};

}  // namespace shapeid::fast

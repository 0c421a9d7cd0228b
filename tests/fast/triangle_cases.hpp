// Mass problems on a triangle [R c]: as a fast solver sees them and, with the same numbers, as the
// reference does.
#pragma once

#include <cstdint>
#include <vector>

#include "shapeid/fast/mass_solver.hpp"
#include "shapeid/models/mass_problem.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::test {

/// Shapes on the links of a triangle.
struct TriangleCase {
  Eigen::MatrixXd R;       ///< 10 n + 1 square, n links
  std::vector<int> links;  ///< of each shape
  MassProblem problem;     ///< Y and F are the columns of R, the weights are one

  [[nodiscard]] int link_count() const { return static_cast<int>(problem.U.rows() / 10); }
  [[nodiscard]] int shapes() const { return static_cast<int>(problem.U.cols()); }
  [[nodiscard]] fast::MassSolver::Column column(int j) const {
    return problem.U.col(j).segment<10>(Eigen::Index{10} * links[static_cast<std::size_t>(j)]);
  }
};

struct BodyStyle {
  int links = 1;
  int shapes_a_link = 10;
  int samples = 0;  ///< 0: enough to determine all parameters
  double noise = 1e-3;
  bool density_term = true;
};

/// Links that move together like those of a robot, each pulled at by six rows a sample; each filled
/// with cuboids anywhere in a region, of which about a third have mass. With the default lambda, or
/// none.
[[nodiscard]] TriangleCase body_case(std::uint64_t seed, const BodyStyle& style);

/// A problem whose shapes belong to a link each, compressed.
[[nodiscard]] TriangleCase compressed(const MassProblem& problem);

/// The same shapes in another order: the first becomes order[0]-th of the given ones, and so on.
[[nodiscard]] TriangleCase permuted(const TriangleCase& given, const std::vector<int>& order);

/// Cuts cuboid j across its longest side, at a place that `draw` chooses: one part takes its place,
/// the other becomes the last shape.
void divide(TriangleCase& given, int j, Draw& draw);

/// Gives a fresh solver, with room for them, the shapes and lambda.
void load(const TriangleCase& given, fast::MassSolver& solver);

/// A start with about half the shapes at a mass of the case's own size.
[[nodiscard]] Eigen::VectorXd any_start(std::uint64_t seed, const TriangleCase& given);
void start_at(const Eigen::VectorXd& m, fast::MassSolver& solver);

/// True if the columns of R, each made one long, are independent by a good margin: then Phi is
/// unique also at lambda = 0.
[[nodiscard]] bool determines_parameters(const TriangleCase& given);

}  // namespace shapeid::test

#include "shapeid/diagnosis/shape_masses.hpp"

#include <cstddef>
#include <optional>
#include <utility>

#include "shapeid/fast/division.hpp"
#include "shapeid/fast/solve_masses.hpp"
#include "shapeid/fast/triangle.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::diagnosis {
namespace {

[[noreturn]] void decline() {
  throw Refusal("declined",
                "the fast path cannot solve these masses to the accuracy that it promises; "
                "--path reference computes them");
}

/// The shapes after the cuts of a run.
BodyModel divided(BodyModel shapes, const fast::Division& run) {
  for (const fast::Division::Cut& cut : run.history()) {
    SoughtShape& whole = shapes.shapes[static_cast<std::size_t>(cut.place)];
    auto [first, second] = divide(whole.shape);
    const SoughtShape last = {whole.link, std::move(second), whole.id + ".1"};
    whole = {whole.link, std::move(first), whole.id + ".0"};
    shapes.shapes.push_back(last);
  }
  return shapes;
}

}  // namespace

ShapeMasses::ShapeMasses(const BodyModel& shapes, MassProblem problem,
                         const DivisionOptions& options, Path path)
    : path_(path), problem_(std::move(problem)) {
  if (path_ == Path::fast) {
    divide_fast(shapes, options);
    return;
  }
  const reference::DivisionRun run = reference::divide_and_solve(shapes, problem_, options);
  problem_ = run.problem;
  m_ = run.solution.m;
  Phi_ = run.solution.Phi;
}

void ShapeMasses::divide_fast(const BodyModel& shapes, const DivisionOptions& options) {
  fast::Triangle triangle(problem_.Y.cols());
  triangle.add(problem_.Y, problem_.F);
  fast::Division run(shapes, options);
  run.set_lambda(problem_.lambda);
  if (run.start(triangle.R()) != fast::Outcome::solved) decline();
  if (run.run() == fast::Division::Stop::declined) decline();
  const BodyModel parts = divided(shapes, run);
  problem_.U = shape_columns(parts);
  problem_.V = shape_volumes(parts);
  m_ = run.masses().m();
  Phi_ = run.masses().Phi();
}

Eigen::VectorXd ShapeMasses::Phi_of(const Eigen::MatrixXd& Y, const Eigen::VectorXd& F) const {
  MassProblem problem = problem_;
  problem.Y = Y;
  problem.F = F;
  problem.W = Eigen::VectorXd::Ones(F.size());
  if (path_ == Path::fast) {
    const std::optional<MassSolution> solution = fast::solve_masses(problem, m_);
    if (!solution) decline();
    return solution->Phi;
  }
  return reference::solve_masses(problem, m_).Phi;
}

}  // namespace shapeid::diagnosis

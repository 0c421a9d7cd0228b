#include "shapeid/reference/division.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::reference {
namespace {

/// Norms over all links of the masses, first moments and tensors in Phi.
Eigen::Vector3d group_norms(const Eigen::VectorXd& Phi) {
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (Eigen::Index link = 0; link < Phi.size(); link += 10) {
    squares += Eigen::Vector3d(Phi[link] * Phi[link], Phi.segment<3>(link + 1).squaredNorm(),
                               Phi.segment<6>(link + 4).squaredNorm());
  }
  return squares.cwiseSqrt();
}

/// || difference || of each group over the group's size in `Phi`; zero where nothing differs.
Eigen::Vector3d relative_groups(const Eigen::VectorXd& difference, const Eigen::VectorXd& Phi) {
  const Eigen::Vector3d change = group_norms(difference);
  Eigen::Vector3d size = group_norms(Phi);
  size[1] = std::sqrt(size[0] * size[2]);  // a first moment may vanish by the choice of the origin
  Eigen::Vector3d relative = Eigen::Vector3d::Zero();
  for (int g = 0; g < 3; ++g) {
    if (change[g] > 0.0) relative[g] = change[g] / size[g];
  }
  return relative;
}

/// "3.0.1" has had two.
int cuts_of(const std::string& id) {
  return static_cast<int>(std::count(id.begin(), id.end(), '.'));
}

}  // namespace

Eigen::VectorXd division_criterion(const BodyModel& model, const Eigen::VectorXd& m,
                                   const DivisionOptions& options) {
  const Eigen::VectorXd V = shape_volumes(model);
  const double V0 = V.sum();
  Eigen::VectorXd v = Eigen::VectorXd::Zero(V.size());
  for (Eigen::Index j = 0; j < v.size(); ++j) {
    const SoughtShape& sought = model.shapes[static_cast<std::size_t>(j)];
    if (cuts_of(sought.id) >= most_cuts || !divisible(sought.shape)) continue;
    const double mass = m[j] / options.expected_mass, size = V[j] / V0;
    v[j] = options.k1 * mass * size + options.k2 * mass / size;  // (16)
  }
  return v;
}

Eigen::Index next_to_divide(const Eigen::VectorXd& v, double tie) {
  const double largest = v.size() > 0 ? v.maxCoeff() : 0.0;
  if (!(largest > 0.0)) return -1;
  const auto first = std::find_if(v.begin(), v.end(),
                                  [&](double value) { return value >= (1.0 - tie) * largest; });
  return first - v.begin();
}

std::optional<Split> split_shape(const BodyModel& model, const MassProblem& problem,
                                 const Eigen::VectorXd& m, Eigen::Index place) {
  const SoughtShape& whole = model.shapes[static_cast<std::size_t>(place)];
  auto parts = parts_if_any(whole.shape);
  if (!parts) return std::nullopt;
  Split split{model, problem, Eigen::VectorXd(m.size() + 1)};
  std::vector<SoughtShape>& shapes = split.model.shapes;
  shapes[static_cast<std::size_t>(place)] = {whole.link, std::move(parts->first), whole.id + ".0"};
  shapes.push_back({whole.link, std::move(parts->second), whole.id + ".1"});
  split.problem.U = shape_columns(split.model);
  split.problem.V = shape_volumes(split.model);

  const double V1 = split.problem.V[place], V2 = split.problem.V[m.size()];
  split.start << m, m[place] * V2 / (V1 + V2);
  split.start[place] = m[place] * V1 / (V1 + V2);
  SHAPEID_CONTRACT(why_changed(problem, m, split));
  return split;
}

Violation why_unrelated(const BodyModel& model, const MassProblem& problem) {
  if (problem.shapes() != static_cast<Eigen::Index>(model.shapes.size())) {
    return fmt::format("{} columns for {} shapes", problem.shapes(), model.shapes.size());
  }
  if (problem.U != shape_columns(model) || problem.V != shape_volumes(model)) {
    return "the problem's columns or volumes are not those of the model's shapes";
  }
  return std::nullopt;
}

Violation why_changed(const MassProblem& before, const Eigen::VectorXd& m, const Split& after) {
  // A few hundred roundings of the terms' own size, as in every backward stable chain of a dozen
  // steps (moments, columns, products); a wrong fraction is off by 1e10 of them.
  const double allowed = 300.0 * std::numeric_limits<double>::epsilon() *
                         static_cast<double>(before.F.size() + after.problem.shapes());
  const Eigen::VectorXd Phi = before.U * m, terms = after.problem.U.cwiseAbs() * after.start;
  const double change = relative_groups(after.problem.U * after.start - Phi, terms).maxCoeff();
  if (!(change <= allowed)) return fmt::format("the split changes Phi by {:g}", change);

  const Objective f0 = objective(before, m), f1 = objective(after.problem, after.start);
  const Eigen::VectorXd rows = before.Y.cwiseAbs() * terms + before.F.cwiseAbs();
  const double data = std::abs(f1.data - f0.data);
  if (!(data <= allowed * rows.dot(before.W.cwiseProduct(rows)))) {
    return fmt::format("the split changes the data term from {:g} to {:g}", f0.data, f1.data);
  }
  if (!(std::abs(f1.density - f0.density) <= allowed * f0.density)) {
    return fmt::format("the split changes the density term from {:g} to {:g}", f0.density,
                       f1.density);
  }
  return std::nullopt;
}

namespace {

struct NextSplit {
  Eigen::Index place;
  double criterion;  ///< v
  Split split;
};

/// Of the shape with the largest v; of the next one where a mesh is too thin.
std::optional<NextSplit> largest_that_splits(const DivisionRun& run,
                                             const DivisionOptions& options) {
  Eigen::VectorXd v = division_criterion(run.model, run.solution.m, options);
  while (true) {
    const Eigen::Index place = next_to_divide(v, options.tie);
    if (place < 0) return std::nullopt;
    if (auto split = split_shape(run.model, run.problem, run.solution.m, place)) {
      return NextSplit{place, v[place], std::move(*split)};
    }
    v[place] = 0.0;
  }
}

}  // namespace

DivisionRun divide_and_solve(const BodyModel& model, const MassProblem& problem,
                             const DivisionOptions& options,
                             const std::function<void(const DivisionRun&)>& watch,
                             const std::function<double(const DivisionRun&)>& floor) {
  if (const Violation reason = why_senseless(options)) throw std::invalid_argument(*reason);
  SHAPEID_CONTRACT(why_unrelated(model, problem));
  DivisionRun run{model, problem, solve_masses(problem), {}, {}};
  if (watch) watch(run);
  const double undivided = run.solution.value.total();
  std::optional<double> known_floor;
  const auto is_near = [&] {
    if (!floor) return true;
    if (!known_floor) known_floor = floor(run);
    return is_near_floor(undivided, run.solution.value, *known_floor);
  };
  int small_steps = 0, settled_steps = 0;
  while (true) {
    if (static_cast<int>(run.history.size()) >= options.most_divisions) {
      run.stopped_by = "limit";
      return run;
    }
    std::optional<NextSplit> next_split = largest_that_splits(run, options);
    if (!next_split) {
      run.stopped_by = "nothing divisible";
      return run;
    }
    Split& split = next_split->split;
    DivisionStep step;
    step.divided = run.model.shapes[static_cast<std::size_t>(next_split->place)].id;
    step.criterion = next_split->criterion;
    step.objective_before = run.solution.value.total();

    step.objective_at_split = objective(split.problem, split.start).total();
    MassSolution next = solve_masses(split.problem, split.start);
    step.objective_after = next.value.total();
    step.step = relative_groups(next.Phi - run.solution.Phi, next.Phi);
    step.iterations = next.iterations;
    step.shapes = static_cast<int>(split.model.shapes.size());

    run.model = std::move(split.model);
    run.problem = std::move(split.problem);
    run.solution = std::move(next);
    run.history.push_back(std::move(step));
    if (watch) watch(run);

    const DivisionStep& last = run.history.back();
    small_steps = last.step.maxCoeff() < options.step ? small_steps + 1 : 0;
    settled_steps = cuts_of(last.divided) >= settled_cuts ? settled_steps + 1 : 0;
    if (small_steps >= options.patience && (settled_steps >= options.patience || is_near())) {
      run.stopped_by = "step";
      return run;
    }
  }
}

}  // namespace shapeid::reference

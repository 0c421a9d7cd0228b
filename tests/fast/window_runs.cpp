#include "shapeid/tests/fast/window_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "shapeid/reference/division.hpp"
#include "shapeid/reference/window.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {
namespace {

using Fed = fast::Identifier::Fed;

Eigen::VectorXd weight_of(const Robot& robot, const fast::IdentifierSettings& settings) {
  return settings.weight.size() > 0 ? settings.weight
                                    : Eigen::VectorXd(Eigen::VectorXd::Ones(robot.dof()));
}

/// The windows of a stream, by the definition of window and stride.
class ReferenceWindows {
 public:
  ReferenceWindows(const Robot& robot, const BodyModel& model,
                   const fast::IdentifierSettings& settings, const std::vector<Sample>& samples)
      : model_(model),
        settings_(settings),
        samples_(samples),
        rows_(robot, model, settings.contacts, weight_of(robot, settings)),
        lambda_(settings.lambda) {}

  /// How many samples were fed when window k is complete.
  [[nodiscard]] std::size_t end(std::size_t k) const {
    const std::size_t first = std::max(settings_.window, settings_.stride);
    return first + k * settings_.stride;
  }

  reference::DivisionRun solve(std::size_t k) { return solve(k, options().most_divisions); }

  /// The same with fewer divisions, and the v that decide the next.
  reference::DivisionRun solve(std::size_t k, int most_divisions) {
    rows_.clear();
    for (std::size_t i = end(k) - settings_.window; i < end(k); ++i) rows_.add(samples_[i]);
    MassProblem problem = rows_.problem(model_);
    if (!lambda_) lambda_ = default_lambda(problem, settings_.expected_mass);
    problem.lambda = *lambda_;
    DivisionOptions fewer = options();
    fewer.most_divisions = most_divisions;
    return reference::divide_and_solve(model_, problem, fewer);
  }

  [[nodiscard]] DivisionOptions options() const {
    DivisionOptions options = settings_.division;
    options.expected_mass = settings_.expected_mass;
    return options;
  }

 private:
  const BodyModel& model_;
  const fast::IdentifierSettings& settings_;
  const std::vector<Sample>& samples_;
  reference::Window rows_;
  std::optional<double> lambda_;
};

/// Ids of the shapes that a fast run divided, as a DivisionStep has them.
std::vector<std::string> divided(const fast::Division& division, const BodyModel& model) {
  std::vector<std::string> ids, all;
  for (const SoughtShape& shape : model.shapes) ids.push_back(shape.id);
  for (const fast::Division::Cut& cut : division.history()) {
    std::string& id = ids[static_cast<std::size_t>(cut.place)];
    all.push_back(id);
    const std::string second = id + ".1";
    id += ".0";
    ids.push_back(second);
  }
  return all;
}

/// How far the v of two shapes are apart after as many divisions of window k, over the larger.
double tie_of(ReferenceWindows& windows, std::size_t k, std::size_t divisions, const std::string& a,
              const std::string& b) {
  const reference::DivisionRun run = windows.solve(k, static_cast<int>(divisions));
  const Eigen::VectorXd v =
      reference::division_criterion(run.model, run.solution.m, windows.options());
  const auto v_of = [&](const std::string& id) {
    const auto place = std::find_if(run.model.shapes.begin(), run.model.shapes.end(),
                                    [&](const SoughtShape& shape) { return shape.id == id; });
    return v[place - run.model.shapes.begin()];
  };
  return std::abs(v_of(a) - v_of(b)) / v.maxCoeff();
}

/// Compares the objectives of all divisions up to the first that is not of the same shape.
void compare(const fast::Identifier& identifier, const BodyModel& model,
             const reference::DivisionRun& expected, ReferenceWindows& windows, std::size_t k,
             WindowRuns& runs) {
  const double terms = objective_terms(expected.problem, expected.solution.m);
  const auto note = [&](double value, double right) {
    keep_worst(runs.worst_objective, scaled(std::abs(value - right), terms, 1));
  };
  const std::vector<std::string> ids = divided(identifier.division(), model);
  const auto& history = identifier.division().history();
  std::size_t same = 0;
  while (same < std::min(ids.size(), expected.history.size()) &&
         ids[same] == expected.history[same].divided) {
    note(history[same].objective_before, expected.history[same].objective_before);
    if (same + 1 == ids.size() && ids.size() < expected.history.size()) {
      ++runs.stopped;
      return;
    }
    note(history[same].objective_after, expected.history[same].objective_after);
    ++same;
    ++runs.divisions;
  }
  if (same < std::min(ids.size(), expected.history.size())) {
    ++runs.parted;
    keep_worst(runs.worst_tie, tie_of(windows, k, same, ids[same], expected.history[same].divided));
    return;
  }
  if (same < ids.size()) {
    runs.first_wrong = fmt::format("window {}: fast divides on after {} divisions", k, same);
    return;
  }
  note(identifier.answer().value.total(), expected.solution.value.total());
  keep_worst(runs.worst_gap, identifier.answer().gap / terms);
}

}  // namespace

WindowRuns run_windows(const Robot& robot, const BodyModel& model,
                       const fast::IdentifierSettings& settings,
                       const std::vector<Sample>& samples) {
  fast::Identifier identifier(robot, model, settings);
  ReferenceWindows windows(robot, model, settings, samples);
  WindowRuns runs;
  Eigen::VectorXd filtered;
  for (std::size_t fed = 1; fed <= samples.size(); ++fed) {
    const Fed result = identifier.feed(samples[fed - 1]);
    const bool complete = fed == windows.end(static_cast<std::size_t>(runs.windows));
    if (complete != (result == Fed::answered || result == Fed::window_declined)) {
      runs.first_wrong = fmt::format("sample {}: a window is complete, or is not", fed);
      return runs;
    }
    if (!complete) continue;
    const auto k = static_cast<std::size_t>(runs.windows++);
    const reference::DivisionRun expected = windows.solve(k);
    if (result == Fed::window_declined) {
      ++runs.declined;
      continue;
    }
    compare(identifier, model, expected, windows, k, runs);
    runs.iterations = std::max(runs.iterations, identifier.answer().iterations);
    if (identifier.answer().time != samples[fed - 1].time) {
      runs.first_wrong = fmt::format("sample {}: answered for another time", fed);
    }
    filtered = filtered.size() == 0 ? identifier.Phi()
                                    : Eigen::VectorXd(settings.alpha * identifier.Phi() +
                                                      (1.0 - settings.alpha) * filtered);
    keep_worst(runs.worst_filter, scaled_difference(identifier.filtered(), filtered, 1));
  }
  runs.six_rows = identifier.samples_by_six_rows();
  return runs;
}

int most_iterations(const BodyModel& model, int divisions) {
  int sum = 0;
  for (int k = 0; k <= divisions; ++k) {
    const auto links = static_cast<int>(model.free_links.size());
    sum += 101 + 4 * (10 * links + static_cast<int>(model.shapes.size()) + k);
  }
  return sum;
}

std::string describe(const WindowRuns& runs) {
  return fmt::format(
      "{} windows, {} declined, {} equal divisions, {} windows part at a division (v {:.1e} apart) "
      "and {} stop early, "
      "at most {} iterations, {} samples by six rows; objective {:.1e} roundings apart, gap {:.1e} "
      "of its terms",
      runs.windows, runs.declined, runs.divisions, runs.parted, runs.worst_tie, runs.stopped,
      runs.iterations, runs.six_rows, runs.worst_objective, runs.worst_gap);
}

}  // namespace shapeid::test

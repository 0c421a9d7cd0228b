#include "shapeid/app/division_history.hpp"

#include <fmt/format.h>

#include <cmath>

namespace shapeid::app {
namespace {

using nlohmann::json;

json relative_step(const Eigen::Vector3d& step) {
  json list = json::array();
  for (const double x : step) list.push_back(std::isfinite(x) ? json(x) : json());
  return list;
}

json above(double objective, const std::optional<double>& floor) {
  return floor ? json(objective - *floor) : json();
}

std::string line(std::size_t division, const std::string& divided, std::size_t shapes,
                 double objective, const std::optional<double>& floor) {
  return fmt::format("  {:>8}{:>8}{:>16.8g}{:>16}  {}\n", division, shapes, objective,
                     floor ? fmt::format("{:.3g}", objective - *floor) : "-", divided);
}

}  // namespace

json history_json(const reference::DivisionRun& run, const std::optional<double>& floor) {
  json steps = json::array();
  for (const DivisionStep& step : run.history) {
    steps.push_back({{"divided", step.divided},
                     {"criterion", step.criterion},
                     {"objective_before", step.objective_before},
                     {"objective_at_split", step.objective_at_split},
                     {"objective_after", step.objective_after},
                     {"above_floor", above(step.objective_after, floor)},
                     {"step", relative_step(step.step)},
                     {"iterations", step.iterations},
                     {"shapes", step.shapes}});
  }
  return steps;
}

std::string history_text(const reference::Identification& found,
                         const std::optional<double>& floor) {
  const std::vector<DivisionStep>& history = found.run.history;
  if (history.empty() && !floor) return "";
  std::string text =
      floor ? fmt::format("\nno division, however fine, goes below {:.17g} (proved)\n", *floor)
            : "\nno floor of infinitely many divisions was proved\n";
  text += fmt::format("  {:>8}{:>8}{:>16}{:>16}  {}\n", "division", "shapes", "objective",
                      "above floor", "of shape");
  text += line(0, "(as given)", found.run.model.shapes.size() - history.size(),
               found.undivided_objective, floor);
  for (std::size_t k = 0; k < history.size(); ++k) {
    text += line(k + 1, history[k].divided, static_cast<std::size_t>(history[k].shapes),
                 history[k].objective_after, floor);
  }
  return text;
}

}  // namespace shapeid::app

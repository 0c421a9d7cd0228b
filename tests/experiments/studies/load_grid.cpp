#include "shapeid/tests/experiments/studies/load_grid.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "shapeid/tests/experiments/page/plot.hpp"
#include "shapeid/tests/experiments/page/spread_table.hpp"
#include "shapeid/tests/experiments/studies/load_trace.hpp"

namespace shapeid::experiments {
namespace {

constexpr double grid_seconds = 2.0;
constexpr int grid_divisions = 60;
const std::vector<int> looked_at = {0, 5, 10, 20, 40, grid_divisions};

struct Model {
  std::string key, words;
  BodyModel area;
};

std::vector<Model> models(const test::Quadruped& quadruped, Form form) {
  const double fitted = form == Form::full ? 8.0 : 1.0;  // s
  return {{"true", "true robot", load_area(quadruped.robot)},
          {"identified", "identified robot", load_area(with_identified_base(quadruped, fitted))}};
}

/// Traces of one load with every model; none if the robot falls under it.
std::optional<std::vector<LoadTrace>> trace_case(const test::Quadruped& quadruped,
                                                 const std::vector<Model>& all, const Load& load,
                                                 std::uint64_t seed) {
  std::vector<SimulatedSample> motion;
  try {
    motion = simulated(quadruped.robot, {gaits().front(), grid_seconds, seed, load});
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
  std::vector<LoadTrace> traces;
  for (const Model& model : all) {
    const DataTerm f = prepared(quadruped, model.area, motion, grid_seconds, {.seed = seed});
    traces.push_back(
        trace_load(model.area, f, inertia_of(load), default_division(), grid_divisions));
  }
  return traces;
}

using Numbers = std::map<std::string, std::vector<double>>;

void collect(const LoadTrace& trace, const std::string& start, Numbers& numbers) {
  const auto add = [&](const std::string& when, const LoadError& e) {
    numbers[start + when + ".mass"].push_back(e.mass);
    numbers[start + when + ".place_mm"].push_back(1e3 * e.place);
    numbers[start + when + ".tensor"].push_back(e.tensor);
  };
  for (const int k : looked_at) {
    add(fmt::format("d{}", k), trace.errors[static_cast<std::size_t>(k)]);
  }
  add("stop", trace.errors[static_cast<std::size_t>(trace.published_stop)]);
  numbers[start + "divisions"].push_back(trace.published_stop);
}

/// Error against the number of divisions, one panel a quantity.
std::string errors_plot(const std::vector<std::pair<std::string, LoadTrace>>& traces) {
  std::vector<Panel> panels = {{"divisions", "mass error (kg)", {}, "set logscale y\n"},
                               {"divisions", "place error (mm)", {}, ""},
                               {"divisions", "inertia error (relative)", {}, ""}};
  for (const auto& [title, trace] : traces) {
    std::vector<Curve> curves(3, {title, {}});
    for (std::size_t k = 0; k < trace.errors.size(); ++k) {
      const LoadError& e = trace.errors[k];
      const auto x = static_cast<double>(k);
      curves[0].points.emplace_back(x, e.mass);
      curves[1].points.emplace_back(x, 1e3 * e.place);
      curves[2].points.emplace_back(x, e.tensor);
    }
    for (std::size_t i = 0; i < panels.size(); ++i) panels[i].curves.push_back(curves[i]);
  }
  return plot(panels);
}

}  // namespace

Findings load_grid(Form form) {
  const test::Quadruped quadruped = test::bundled_quadruped();
  const std::vector<Model> all = models(quadruped, form);
  std::vector<double> masses = {1.0}, along = {0.1}, across = {-0.04};
  if (form == Form::full) {
    masses = {0.25, 0.5, 1.0, 2.0, 4.0};
    along = {-0.16, 0.0, 0.16};
    across = {-0.07, 0.0, 0.07};
  }
  Findings findings;
  Numbers numbers;
  int fell = 0, cases = 0;
  std::uint64_t seed = 0;
  std::vector<std::pair<std::string, LoadTrace>> shown;
  for (const double mass : masses) {
    for (const double x : along) {
      for (const double y : across) {
        Load load;
        load.mass = mass;
        load.centre.head<2>() << x, y;
        ++cases;
        const auto traces = trace_case(quadruped, all, load, ++seed);
        if (!traces) {
          ++fell;
          continue;
        }
        for (std::size_t i = 0; i < all.size(); ++i) {
          collect((*traces)[i], fmt::format("load.grid.{}.{}kg.", all[i].key, mass), numbers);
          if (mass == 1.0 && (form != Form::full || x * y > 0.0)) {
            shown.emplace_back(fmt::format("{} at ({}, {})", all[i].words, x, y), (*traces)[i]);
          }
        }
      }
    }
  }
  for (const auto& [name, list] : numbers) set_spread(findings, name, list);
  findings.set("load.grid.inertia_of_1kg", inertia_of(Load{}).tensor_about_centre()(0, 0));
  findings.set("load.grid.base_mass", quadruped.robot.links[0].inertia.mass());
  findings.set("load.grid.cases", cases);
  findings.set("load.grid.fell", fell);
  findings.plots["load_errors"] = errors_plot(shown);
  Table table = {{"robot model", "load, kg", "divisions", "mass error, kg", "place error, mm",
                  "inertia error, relative"}};
  for (const Model& model : all) {
    for (const double mass : masses) {
      const std::string start = fmt::format("load.grid.{}.{}kg.", model.key, mass);
      if (!findings.values.contains(start + "divisions.median")) continue;  // all fell
      for (const char* when : {"d0", "d10", "d40", "stop"}) {
        const std::string name = start + when;
        const std::string divisions = when == std::string("stop")
                                          ? with_spread(findings, start + "divisions")
                                          : std::string(when).substr(1);
        table.push_back(
            {model.words, fmt::format("{}", mass), divisions, with_spread(findings, name + ".mass"),
             with_spread(findings, name + ".place_mm"), with_spread(findings, name + ".tensor")});
      }
    }
  }
  findings.tables["load_grid"] = table;
  return findings;
}

Findings load_shapes(Form form) {
  const test::Quadruped quadruped = test::bundled_quadruped();
  const std::vector<Model> all = models(quadruped, form);
  struct Block {
    std::string words;
    Eigen::Vector3d sides;
    double height;  ///< m, of its centre
  };
  std::vector<Block> blocks = {{"cube of 2 cm on the plate", {0.02, 0.02, 0.02}, 0.068}};
  if (form == Form::full) {
    blocks.push_back({"cube of 2 cm, 3 cm above", {0.02, 0.02, 0.02}, 0.098});
    blocks.push_back({"cube of 4 cm on the plate", {0.04, 0.04, 0.04}, 0.078});
    blocks.push_back({"cube of 4 cm, 2 cm above", {0.04, 0.04, 0.04}, 0.098});
    blocks.push_back({"plate of 16 x 10 x 2 cm", {0.16, 0.10, 0.02}, 0.068});
    blocks.push_back({"bar of 24 x 4 x 4 cm", {0.24, 0.04, 0.04}, 0.078});
    blocks.push_back({"cube of 4 cm, half above the area", {0.04, 0.04, 0.04}, 0.118});
  }
  Findings findings;
  Table table = {{"block of 1 kg", "robot model", "divisions to the stop", "mass error, kg",
                  "place error, mm", "inertia error, relative", "place error after 60, mm"}};
  std::uint64_t seed = 200;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    Load load;
    load.sides = blocks[b].sides;
    load.centre << 0.06, -0.03, blocks[b].height;
    const auto traces = trace_case(quadruped, all, load, ++seed);
    if (!traces) continue;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const LoadTrace& trace = (*traces)[i];
      const LoadError& e = trace.errors[static_cast<std::size_t>(trace.published_stop)];
      const std::string start = fmt::format("load.shape.{}.{}.", b, all[i].key);
      findings.set(start + "mass", e.mass);
      findings.set(start + "place_mm", 1e3 * e.place);
      findings.set(start + "tensor", e.tensor);
      findings.set(start + "divisions", trace.published_stop);
      findings.set(start + "later_mm", 1e3 * trace.errors.back().place);
      table.push_back({blocks[b].words, all[i].words, fmt::format("{}", trace.published_stop),
                       fmt::format("{:.3g}", e.mass), fmt::format("{:.3g}", 1e3 * e.place),
                       fmt::format("{:.3g}", e.tensor),
                       fmt::format("{:.3g}", 1e3 * trace.errors.back().place)});
    }
  }
  findings.tables["load_shapes"] = table;
  return findings;
}

}  // namespace shapeid::experiments

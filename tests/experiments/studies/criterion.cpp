#include "shapeid/tests/experiments/studies/criterion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "shapeid/tests/experiments/page/plot.hpp"
#include "shapeid/tests/experiments/page/spread_table.hpp"
#include "shapeid/tests/experiments/studies/load_trace.hpp"

namespace shapeid::experiments {
namespace {

constexpr double seconds = 2.0;
constexpr int most_divisions = 100;

struct Choice {
  std::string key, words;
  double k1, k2;
};

std::vector<Choice> choices(const BodyModel& area) {
  const double V0 = shape_volumes(area).sum();
  // (16) with k1 = k2 = 1 in SI units: m V + m / V. In our relative terms k2 / k1 = 1 / V0^2.
  return {{"volume", "heavy and large: k2 = 0", 1.0, 0.0},
          {"default", "default: k1 = 1, k2 = 1e-4", 1.0, 1e-4},
          {"middle", "k1 = 1, k2 = 1e-2", 1.0, 1e-2},
          {"si", "k1 = k2 = 1 in SI units", 1.0, 1.0 / (V0 * V0)},
          {"density", "dense alone: k1 = 0", 0.0, 1.0}};
}

struct Judgement {
  double left, useless, smallest, place, reached;
};

Judgement judge(const LoadTrace& trace) {
  constexpr double hundredth = 0.01, enough = 1e-4;
  const auto above = [&](std::size_t k) { return std::max(trace.f[k] - trace.floor, 0.0); };
  const std::size_t n = trace.f.size() - 1;
  double useless = 0.0, reached = static_cast<double>(n) + 1.0;
  for (std::size_t k = 0; k < n; ++k) {
    if (above(k) - above(k + 1) < hundredth * above(k)) ++useless;
  }
  for (std::size_t k = n + 1; k-- > 0;) {
    if (above(k) <= enough * above(0)) reached = static_cast<double>(k);
  }
  double smallest = 1.0;
  for (const double share : trace.smallest) {
    if (share > 0.0) smallest = std::min(smallest, share);
  }
  return {above(n) / above(0), useless / static_cast<double>(n), std::log10(smallest),
          1e3 * trace.errors.back().place, reached};
}

}  // namespace

Findings criterion(Form form) {
  const test::Quadruped quadruped = test::bundled_quadruped();
  const BodyModel area = load_area(quadruped.robot);
  std::vector<Eigen::Vector2d> places = {{0.11, -0.045}};
  if (form == Form::full) {
    places.insert(places.end(), {{0.0, 0.0}, {-0.15, 0.05}, {0.05, 0.07}, {-0.07, -0.02}});
  }
  std::vector<std::vector<SimulatedSample>> motions;
  std::vector<Load> loads;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Load load;
    load.centre.head<2>() = places[i];
    loads.push_back(load);
    motions.push_back(simulated(quadruped.robot, {gaits().front(), seconds, 400 + i, load}));
  }
  Findings findings;
  findings.set("criterion.si_ratio", std::pow(shape_volumes(area).sum(), -2));
  Table table = {{"data", "criterion", "left above the floor, of what was", "divisions to 1e-4",
                  "useless divisions", "smallest divided, of the area", "place error, mm"}};
  for (const std::string data : {"exact", "robot"}) {
    Panel panel{"divisions", "f above the floor", {}, "set logscale y\n"};
    std::vector<DataTerm> terms;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      terms.push_back(data == "exact"
                          ? whole(quadruped.robot, area, exact(motions[i], seconds))
                          : prepared(quadruped, area, motions[i], seconds, {.seed = i + 1}));
    }
    for (const Choice& choice : choices(area)) {
      DivisionOptions options = default_division();
      options.k1 = choice.k1;
      options.k2 = choice.k2;
      std::vector<double> left, useless, smallest, place, reached;
      for (std::size_t i = 0; i < terms.size(); ++i) {
        const LoadTrace trace =
            trace_load(area, terms[i], inertia_of(loads[i]), options, most_divisions);
        const Judgement j = judge(trace);
        left.push_back(j.left);
        useless.push_back(j.useless);
        smallest.push_back(j.smallest);
        place.push_back(j.place);
        reached.push_back(j.reached);
        if (i > 0) continue;
        Curve curve{choice.words, {}};
        for (std::size_t k = 0; k < trace.f.size(); ++k) {
          curve.points.emplace_back(k, std::max(trace.f[k] - trace.floor, 1e-12 * terms[i].size()));
        }
        panel.curves.push_back(curve);
      }
      const std::string start = fmt::format("criterion.{}.{}.", data, choice.key);
      set_spread(findings, start + "left", left);
      set_spread(findings, start + "useless", useless);
      set_spread(findings, start + "smallest", smallest);
      set_spread(findings, start + "place_mm", place);
      set_spread(findings, start + "reached", reached);
      const double median_reached = findings.values.at(start + "reached.median");
      table.push_back(
          {data, choice.words, with_spread(findings, start + "left"),
           median_reached > most_divisions ? fmt::format("not in {}", most_divisions)
                                           : fmt::format("{:.3g}", median_reached),
           fmt::format("{:.0f} %", 100.0 * findings.values.at(start + "useless.median")),
           fmt::format("{:.1g}", std::pow(10.0, findings.values.at(start + "smallest.median"))),
           with_spread(findings, start + "place_mm")});
    }
    findings.plots["criterion_" + data] = plot({panel});
  }
  findings.tables["criterion"] = table;
  return findings;
}

}  // namespace shapeid::experiments

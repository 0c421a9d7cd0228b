#include "shapeid/tests/experiments/studies/load_influence.hpp"

#include <fmt/format.h>

#include <functional>
#include <map>

#include "shapeid/models/simbody/random.hpp"
#include "shapeid/tests/experiments/page/spread_table.hpp"
#include "shapeid/tests/experiments/studies/load_trace.hpp"

namespace shapeid::experiments {
namespace {

using Motion = std::vector<SimulatedSample>;

/// All that can be changed.
struct Setup {
  Gait gait = gaits().front();
  double seconds = 2.0;
  Preparation preparation;
  std::function<void(Motion&)> labels = [](Motion&) {};  ///< spoils contact flags
  DivisionOptions division = default_division();
  double lambda_share = 1e-12;
};

struct Variant {
  std::string group, value;
  std::function<void(Setup&)> change;
};

/// Flags of `delay` samples before (negative: after).
std::function<void(Motion&)> late_by(long delay) {
  return [delay](Motion& motion) {
    const Motion before = motion;
    const long n = std::ssize(motion);
    for (long i = 0; i < n; ++i) {
      const auto from = static_cast<std::size_t>(std::clamp(i - delay, 0L, n - 1));
      motion[static_cast<std::size_t>(i)].sample.in_contact = before[from].sample.in_contact;
    }
  };
}

void always_standing(Motion& motion) {
  for (SimulatedSample& s : motion) s.sample.in_contact.assign(s.sample.in_contact.size(), true);
}

/// Now and then a standing foot is said to swing, for a tenth of a second.
void lost_stances(Motion& motion) {
  constexpr std::size_t length = 50, spacing = 250;  // samples
  Random random(1);
  for (std::size_t i = 0; i + length < motion.size(); i += spacing) {
    const auto foot = static_cast<std::size_t>(random.uniform(0.0, 4.0));
    for (std::size_t k = i; k < i + length; ++k) motion[k].sample.in_contact[foot] = false;
  }
}

std::vector<Variant> variants() {
  std::vector<Variant> all = {{"default", "-", [](Setup&) {}}};
  const auto add = [&](const std::string& group, double value, auto change) {
    all.push_back(
        {group, fmt::format("{:g}", value), [value, change](Setup& s) { change(s, value); }});
  };
  for (const Gait& gait : gaits()) {
    if (gait.name == gaits().front().name) continue;  // the default
    all.push_back({"motion", gait.name, [gait](Setup& s) { s.gait = gait; }});
  }
  for (const double k2 : {0.0, 1e-6, 1e-2, 1.0}) {
    add("k2 over k1", k2, [](Setup& s, double x) { s.division.k2 = x; });
  }
  for (const double eps : {1e-1, 1e-2, 1e-4}) {
    add("eps", eps, [](Setup& s, double x) { s.division.step = x; });
  }
  for (const double seconds : {0.02, 0.1, 0.5, 5.0}) {
    add("window, s", seconds, [](Setup& s, double x) {
      s.seconds = x;
      // Too short to filter rows: the published way, signals alone.
      if (x < 0.5) s.preparation.rows = 0.0;
    });
  }
  for (const double noise : {0.0, 3.0, 10.0}) {
    add("noise, times", noise, [](Setup& s, double x) { s.preparation.noise = x; });
  }
  for (const double cutoff : {10.0, 20.0, 40.0, 80.0}) {
    add("signals alone filtered at, Hz", cutoff, [](Setup& s, double x) {
      s.preparation.signals = x;
      s.preparation.rows = 0.0;
    });
  }
  for (const double share : {0.0, 1e-10, 1e-8, 1e-6, 1e-4}) {
    add("lambda, of its scale", share, [](Setup& s, double x) { s.lambda_share = x; });
  }
  all.push_back({"contacts", "10 ms late", [](Setup& s) { s.labels = late_by(5); }});
  all.push_back({"contacts", "10 ms early", [](Setup& s) { s.labels = late_by(-5); }});
  all.push_back({"contacts", "30 ms late", [](Setup& s) { s.labels = late_by(15); }});
  all.push_back({"contacts", "always standing", [](Setup& s) { s.labels = always_standing; }});
  all.push_back({"contacts", "some stances lost", [](Setup& s) { s.labels = lost_stances; }});
  return all;
}

Load the_load() {
  Load load;
  load.centre.head<2>() << 0.11, -0.045;
  return load;
}

}  // namespace

Findings load_influence(Form form) {
  const std::size_t seeds = form == Form::full ? 6 : 1;
  const double longest = form == Form::full ? 5.0 : 2.0;
  constexpr int most_divisions = 100;
  const test::Quadruped quadruped = test::bundled_quadruped();
  const BodyModel area = load_area(quadruped.robot);
  const Load load = the_load();
  std::map<std::string, std::vector<Motion>> motions;
  for (const Gait& gait : gaits()) {
    for (std::size_t seed = 1; seed <= seeds; ++seed) {
      motions[gait.name].push_back(simulated(quadruped.robot, {gait, longest, 300 + seed, load}));
    }
  }
  Findings findings;
  Table table = {{"changed", "to", "divisions", "mass error, kg", "place error, mm",
                  "inertia error, relative"}};
  for (const Variant& variant : variants()) {
    Setup setup;
    variant.change(setup);
    if (setup.seconds > longest) continue;
    std::vector<double> divisions, mass, place, tensor;
    for (std::size_t i = 0; i < seeds; ++i) {
      setup.preparation.seed = i + 1;
      Motion motion = motions.at(setup.gait.name)[i];
      setup.labels(motion);
      const DataTerm f = prepared(quadruped, area, motion, setup.seconds, setup.preparation);
      const LoadTrace trace =
          trace_load(area, f, inertia_of(load), setup.division, most_divisions, setup.lambda_share);
      const LoadError& e = trace.errors[static_cast<std::size_t>(trace.published_stop)];
      divisions.push_back(trace.published_stop);
      mass.push_back(e.mass);
      place.push_back(1e3 * e.place);
      tensor.push_back(e.tensor);
    }
    std::string name = fmt::format("load.influence.{}.{}.", variant.group, variant.value);
    for (char& c : name) {
      if (c == ' ') c = '_';
    }
    set_spread(findings, name + "divisions", divisions);
    set_spread(findings, name + "mass", mass);
    set_spread(findings, name + "place_mm", place);
    set_spread(findings, name + "tensor", tensor);
    table.push_back({variant.group, variant.value, median(findings, name + "divisions"),
                     with_spread(findings, name + "mass"), with_spread(findings, name + "place_mm"),
                     with_spread(findings, name + "tensor")});
  }
  findings.tables["load_influence"] = table;
  return findings;
}

}  // namespace shapeid::experiments

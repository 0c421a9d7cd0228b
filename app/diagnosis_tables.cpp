#include "shapeid/app/diagnosis_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "shapeid/app/diagnosis_result.hpp"
#include "shapeid/app/result.hpp"
#include "shapeid/diagnosis/body_sums.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/motion_noise.hpp"
#include "shapeid/models/student.hpp"
#include "shapeid/models/version.hpp"

namespace shapeid::app {
namespace {

/// One after the other, what is said of an effect besides its numbers.
std::vector<std::string> remarks_on(const DiagnosisRun& run, const Robot& robot, std::size_t k,
                                    const diagnosis::Found* f) {
  const diagnosis::AppliedEffect& a = run.consistent.model.effects[k];
  std::vector<std::string> remarks;
  const bool stands = f == nullptr || f->name_stands();
  if (!stands) remarks.push_back(doubt(run, *f, robot));
  if (a.effect->is_payload) {
    remarks.push_back(centre_text(robot, a, run.consistent.effect_error[k]));
  }
  if (f == nullptr) return remarks;
  if (!f->ambiguous_with.empty()) {
    remarks.push_back(fmt::format("cannot be told from: {}; to separate: {}",
                                  fmt::join(f->ambiguous_with, ", "), a.effect->separate_by));
  }
  if (f->hangs_on_given) remarks.emplace_back(hangs_on_given);
  if (f->rival) {
    remarks.push_back("or something without a name: " + law_text(*f->rival, robot));
  }
  if (const std::string since = since_text(*f); !since.empty()) remarks.push_back(since);
  return remarks;
}

bool hangs_on_descriptions(const DiagnosisRun& run, int link) {
  return run.causes_alone &&
         diagnosis::hangs_on_descriptions(run.consistent, *run.causes_alone, link).has_value();
}

}  // namespace

std::string short_number(double x) { return number_or_dash(x, 3); }

namespace {

std::string contacts_words(const DiagnosisRun& run) {
  switch (run.settings.rows.contacts) {
    case ContactTreatment::project:
      return run.motion.contacts_derived ? "forces eliminated, flags derived from torques"
                                         : "forces eliminated, flags as logged";
    case ContactTreatment::measured:
      return "measured forces";
    case ContactTreatment::ignore:
      break;
  }
  return "none";
}

}  // namespace

Table how_made_table(const DiagnosisRun& run, const Robot& robot, const DiagnoseOptions& options) {
  const MotionInputs& inputs = options.inputs;
  std::vector<std::string> sought, logs = {inputs.log};
  for (const int link : run.settings.shapes.free_links) {
    sought.push_back(robot.links[static_cast<std::size_t>(link)].name);
  }
  logs.insert(logs.end(), options.also.begin(), options.also.end());
  Table table = {
      {"what", "which"}, {"software", fmt::format("shapeid {}", version)}, {"robot", inputs.robot}};
  const auto add_if_any = [&](const char* what, const std::string& which) {
    if (!which.empty()) table.push_back({what, which});
  };
  add_if_any("robot.yaml", run.robot_yaml);
  add_if_any("mapping", inputs.mapping);
  add_if_any("shapes", options.shapes);
  table.push_back({"fitted", fmt::format("{}: {} samples in {} blocks", fmt::join(logs, ", "),
                                         run.loop.samples, run.loop.blocks)});
  add_if_any("reference log", options.reference);
  table.push_back({"tested", fmt::format("{}: {} samples", run.errors.where, run.errors.samples)});
  const bool filtered = !inputs.exact && inputs.cutoff > 0.0;
  table.push_back(
      {"filter", filtered ? fmt::format("{:g} Hz, zero phase", inputs.cutoff) : "none"});
  table.push_back({"grid", fmt::format("{:.5g} Hz", run.motion.rate)});
  table.push_back({"contacts", contacts_words(run)});
  table.push_back({"sought links", sought.empty() ? "none: the given inertias are trusted"
                                                  : fmt::format("{}", fmt::join(sought, ", "))});
  if (!sought.empty()) {
    table.push_back({"their expected mass", fmt::format("{:.4g} kg", run.settings.expected_mass)});
  }
  return table;
}

Table errors_table(const DiagnosisRun& run, const Robot& robot) {
  const TestErrors& e = run.errors;
  Table table = {
      {"row", "predicting zero", "given model", "usual fit", "found", "noise floor", "unfiltered"}};
  const auto names = row_names(robot);
  const int base = robot.base_dof();
  for (Eigen::Index row = 0; row < e.zero.size(); ++row) {
    const bool joint = row >= base;
    table.push_back({names[static_cast<std::size_t>(row)], short_number(e.zero[row]),
                     short_number(e.given[row]), short_number(e.usual[row]),
                     short_number(e.found[row]),
                     joint ? short_number(e.noise_floor[row - base]) : "",
                     joint ? short_number(e.unfiltered_found[row - base]) : ""});
  }
  table.push_back({"all joints", short_number(overall(e.zero, robot)),
                   short_number(overall(e.given, robot)), short_number(overall(e.usual, robot)),
                   short_number(overall(e.found, robot)),
                   short_number(overall(e.noise_floor, robot)),
                   short_number(overall(e.unfiltered_found, robot))});
  return table;
}

Table findings_table(const DiagnosisRun& run, const Robot& robot, bool names_stand) {
  Table table = {{"effect", "value", "s.e.", "unit", "gain (%)", "gain / s.e.",
                  names_stand ? "remarks" : "why it is not the cause"}};
  const auto& effects = run.consistent.model.effects;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const auto& a = effects[k];
    const diagnosis::Found* f = found_for(run, a);
    if ((f == nullptr || f->name_stands()) != names_stand) continue;
    std::string gain = "-", t = "-", remarks;
    if (f != nullptr && !f->is_for_bodies_alone()) {
      gain = short_number(100.0 * f->gain);
      t = short_number(f->t);
    }
    for (const std::string& remark : remarks_on(run, robot, k, f)) {
      remarks += (remarks.empty() ? "" : "; ") + remark;
    }
    for (std::size_t p = 0; p < a.effect->parameters.size(); ++p) {
      const auto at = static_cast<Eigen::Index>(p);
      table.push_back({p == 0 ? hypothesis_id(robot, a) : "",
                       a.effect->parameters[p].name + " = " + short_number(a.value[at]),
                       short_number(run.consistent.effect_error[k][at]),
                       unit_of(robot, a, a.effect->parameters[p].unit), p == 0 ? gain : "",
                       p == 0 ? t : "", p == 0 ? remarks : ""});
    }
    for (std::size_t s = 0; s < a.effect->shape.size(); ++s) {
      const diagnosis::ShapeNumber& number = a.effect->shape[s];
      table.push_back({"",
                       number.name + " = " + short_number(a.shape[static_cast<Eigen::Index>(s)]),
                       "-", unit_of(robot, a, number.unit), "", "", ""});
    }
  }
  return table;
}

Table parameters_table(const DiagnosisRun& run, const Robot& robot, std::size_t sought) {
  constexpr std::array<const char*, 10> names = {
      "m (kg)",       "m rx (kg m)",  "m ry (kg m)",  "m rz (kg m)",  "Ixx (kg m^2)",
      "Ixy (kg m^2)", "Ixz (kg m^2)", "Iyy (kg m^2)", "Iyz (kg m^2)", "Izz (kg m^2)"};
  const double of_95_percent = limit_for(1.96, diagnosis::tenths);
  const int link = run.settings.shapes.free_links[sought];
  Table table = {{"parameter", "given", "found", "95 % interval", "with what was not noticed",
                  "determined by"}};
  const bool behind_slower = run.moves_behind_filter.size() > 0;
  if (behind_slower) {
    table[0].push_back(fmt::format("behind {:.3g} Hz", diagnosis::slower_by * run.settings.cutoff));
  }
  if (run.causes_alone) table[0].push_back("beside causes alone");
  const Link& given = robot.links[static_cast<std::size_t>(link)];
  const bool is_given = given.inertia.mass() > 0.0;
  const bool hangs = hangs_on_descriptions(run, link);
  constexpr double rounding = 1e-12;  // of a link's own size
  for (Eigen::Index p = 0; p < 10; ++p) {
    const Eigen::Index at = Eigen::Index{10} * link + p;
    const auto known = [&](double x) {
      return std::abs(x) < rounding * run.settings.size[at] ? 0.0 : x;
    };
    const double value = known(run.consistent.model.Phi[at]);
    const bool determined =
        run.consistent.data.determined[10 * sought + static_cast<std::size_t>(p)] && !hangs;
    const auto interval = [&](double error) -> std::string {
      if (!determined) return "-";
      // To a hundredth of its width, so that its ends differ.
      const double half = of_95_percent * error;
      const int digits = half > 0.0 ? static_cast<int>(std::ceil(2.0 - std::log10(half))) : 3;
      return fmt::format("{0:.{2}f} to {1:.{2}f}", value - half, value + half,
                         std::clamp(digits, 0, 12));
    };
    const std::string& effect = run.unnoticed.effect[static_cast<std::size_t>(at)];
    std::string wider = interval(run.unnoticed.error[at]);
    if (determined && !effect.empty()) wider += " (" + effect + ")";
    if (determined && effect.empty() && !behind_slower) wider = "the same";
    table.push_back({names[static_cast<std::size_t>(p)],
                     is_given ? short_number(known(given.inertia.values[p])) : "-",
                     short_number(value), interval(run.consistent.Phi_error[at]), wider,
                     determined ? "data"
                     : hangs    ? "not: hangs on descriptions"
                     : is_given ? "given inertia and bodies"
                                : "bodies and expected mass"});
    if (behind_slower) {
      table.back().push_back(determined ? short_number(known(value + run.moves_behind_filter[at]))
                                        : "-");
    }
    if (run.causes_alone) {
      table.back().push_back(short_number(known(run.causes_alone->model.Phi[at])));
    }
  }
  return table;
}

std::size_t determined_of_link(const DiagnosisRun& run, std::size_t sought) {
  const auto first =
      run.consistent.data.determined.begin() + 10 * static_cast<std::ptrdiff_t>(sought);
  return static_cast<std::size_t>(std::count(first, first + 10, true));
}

std::string link_verdict(const DiagnosisRun& run, const Robot& robot, std::size_t sought) {
  const std::vector<int>& free_links = run.settings.shapes.free_links;
  if (hangs_on_descriptions(run, free_links[sought])) {
    return "Not identified: without the effects that are no causes its inertia is another one.";
  }
  if (diagnosis::is_surely_far_from_given(robot, free_links, run.consistent, run.unnoticed.error,
                                          sought)) {
    return "Its mass is far from the given one, which no error covers: weigh it before believing "
           "either.";
  }
  return "";
}

}  // namespace shapeid::app

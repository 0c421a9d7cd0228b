#include "shapeid/app/diagnosis_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "shapeid/app/diagnosis_plots.hpp"
#include "shapeid/app/diagnosis_result.hpp"
#include "shapeid/app/found_plots.hpp"
#include "shapeid/app/html.hpp"
#include "shapeid/app/result.hpp"
#include "shapeid/diagnosis/body_sums.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/slowness.hpp"
#include "shapeid/models/student.hpp"

namespace shapeid::app {
namespace {

using Table = std::vector<std::vector<std::string>>;

std::string short_number(double x) { return number_or_dash(x, 3); }

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

/// What the column and the mark of that name are. Contact forces explain a part of the residual,
/// but not of the floor: TestErrors::noise_floor.
std::string noise_floor_words(bool filtered) {
  if (!filtered) {
    return "Noise floor: what noise of the logged torque leaves behind the filter is judged by "
           "what it takes away; without a filter nothing is known of it.";
  }
  return "Noise floor: what noise of the logged torque leaves behind the filter, so that a perfect "
         "model would have about this error. It is judged by what the filter took away from the "
         "torque, as though that were white noise. It is too high, and the error found may be "
         "lower, where the filter took away more than such noise (motion, ripple or impacts "
         "faster than its cutoff, noise that is stronger at high frequencies than at low ones), "
         "and on legs that stand, where contact forces explain a part of the noise, too.";
}

Table findings_table(const DiagnosisRun& run, const Robot& robot) {
  Table table = {{"effect", "value", "s.e.", "unit", "gain (%)", "gain / s.e.",
                  "cannot be told from, or doubt"}};
  const auto& effects = run.consistent.model.effects;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const auto& a = effects[k];
    std::string gain, t, others;
    for (const diagnosis::Found& f : run.loop.found) {
      if (!same_place(f.effect, a)) continue;
      gain = short_number(100.0 * f.gain);
      t = short_number(f.t);
      for (const std::string& id : f.ambiguous_with) others += (others.empty() ? "" : ", ") + id;
      if (f.hangs_on_given) others += (others.empty() ? "" : "; ") + std::string(hangs_on_given);
      if (f.rival) {
        others += (others.empty() ? "" : "; ") + ("no name: " + law_text(*f.rival, robot));
      }
      if (const std::string since = since_text(f); !since.empty()) {
        others += (others.empty() ? "" : "; ") + since;
      }
      if (!f.name_stands()) {
        others = "a description, not the cause: " + doubt(run, f, robot) +
                 (others.empty() ? "" : "; ") + others;
      }
    }
    for (std::size_t p = 0; p < a.effect->parameters.size(); ++p) {
      const auto at = static_cast<Eigen::Index>(p);
      table.push_back({p == 0 ? hypothesis_id(robot, a) : "",
                       a.effect->parameters[p].name + " = " + short_number(a.value[at]),
                       short_number(run.consistent.effect_error[k][at]),
                       unit_of(robot, a, a.effect->parameters[p].unit), p == 0 ? gain : "",
                       p == 0 ? t : "", p == 0 ? others : ""});
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
  if (run.causes_alone) table[0].push_back("beside causes alone");
  const Link& given = robot.links[static_cast<std::size_t>(link)];
  for (Eigen::Index p = 0; p < 10; ++p) {
    const Eigen::Index at = Eigen::Index{10} * link + p;
    const double value = run.consistent.model.Phi[at];
    const bool determined =
        run.consistent.data.determined[10 * sought + static_cast<std::size_t>(p)];
    const auto interval = [&](double error) -> std::string {
      if (!determined) return "-";
      // To a hundredth of its width, so that its ends differ.
      const double half = of_95_percent * error;
      const int digits = half > 0.0 ? static_cast<int>(std::ceil(2.0 - std::log10(half))) : 3;
      return fmt::format("{0:.{2}f} to {1:.{2}f}", value - half, value + half,
                         std::clamp(digits, 0, 12));
    };
    const std::string& effect = run.unnoticed.effect[static_cast<std::size_t>(at)];
    table.push_back(
        {names[static_cast<std::size_t>(p)], short_number(given.inertia.values[p]),
         short_number(value), interval(run.consistent.Phi_error[at]),
         effect.empty() ? "the same" : interval(run.unnoticed.error[at]) + " (" + effect + ")",
         determined ? "data" : "given inertia and bodies"});
    if (run.causes_alone) {
      table.back().push_back(short_number(run.causes_alone->model.Phi[at]));
    }
  }
  return table;
}

void add_undetermined(Page& page, const DiagnosisRun& run, const Robot& robot) {
  page.heading("What could not be determined");
  if (!run.loop.hidden.empty()) {
    std::string list;
    for (const std::string& id : run.loop.hidden) list += (list.empty() ? "" : ", ") + id;
    page.paragraph(
        "Hardly to be told from inertias and from what was found, in this data: " + list + ".");
  }
  for (const auto& [id, z] : run.loop.wrong_signs) {
    page.paragraph(
        fmt::format("{} would be negative by {:.0f} standard errors, which it cannot be: "
                    "evidence of something else.",
                    id, -z));
  }
  for (const auto& a : run.consistent.dropped) {
    page.paragraph(fmt::format("{} was left out: {}.", hypothesis_id(robot, a), why_left_out(a)));
  }
  if (!run.curves.empty()) {
    page.paragraph(fmt::format(
        "With curves in the place of what no name explains the error of all joints on the test "
        "motion is {} {} instead of {}. diagnose --curves writes them with the model.",
        short_number(overall(run.errors.with_curves, robot)), joints_unit(robot),
        short_number(overall(run.errors.found, robot))));
  }
  if (run.structures.empty())
    page.paragraph("Of what was fitted, the residual follows no signal that was tested.");
  constexpr std::size_t shown = 6;
  for (std::size_t i = 0; i < std::min(shown, run.structures.size()); ++i) {
    const diagnosis::Structure& s = run.structures[i];
    page.picture(structure_picture(s, robot),
                 s.variable == diagnosis::slow
                     ? fmt::format("Unexplained: the residual of {} is no noise: {:.1f} % of its "
                                   "variance is slow and beyond it",
                                   s.joint, 100.0 * s.share)
                 : !s.law.empty()
                     ? fmt::format("Unexplained: as {}, but its number follows {}; {:.1f} % of the "
                                   "held-out error, {:.1f} standard errors",
                                   s.law, s.variable, 100.0 * s.share, s.t)
                 : s.under_name.empty()
                     ? fmt::format("Unexplained: {} over {}, {:.1f} % of its residual variance on "
                                   "blocks left out, {:.1f} standard errors",
                                   s.joint, s.variable, 100.0 * s.share, s.t)
                     : fmt::format("Unexplained: {} over {}, which {} describes in part", s.joint,
                                   s.variable, s.under_name));
  }
}

}  // namespace

std::string diagnosis_report(const DiagnosisRun& run, const Robot& robot,
                             const DiagnoseOptions& options) {
  Page page("What the model of " + robot.name + " lacks");
  std::vector<std::string> logs = {options.inputs.log};
  logs.insert(logs.end(), options.also.begin(), options.also.end());
  const bool filtered = !options.inputs.exact && options.inputs.cutoff > 0.0;
  const std::string filter =
      filtered ? fmt::format("Every channel went through the same zero-phase filter of {:g} Hz.",
                             options.inputs.cutoff)
               : "No channel was filtered.";
  page.paragraph(fmt::format(
      "Log {}, tested on {} ({} samples used for nothing else). {} {} hypotheses in {} "
      "blocks; screening {:.1f} s, refits {:.1f} s.",
      fmt::join(logs, ", "), run.errors.where, run.errors.samples, filter, run.loop.hypotheses,
      run.loop.blocks, run.loop.screening_seconds, run.loop.refit_seconds));
  page.heading("Error before and after");
  page.paragraph(fmt::format(
      "Predicted minus logged torque, root mean square, {}{}. "
      "Usual fit: least squares of masses and, at every joint, viscous and Coulomb friction, an "
      "offset and a rotor, nothing selected. Unfiltered: the found model against the torque as "
      "logged. {}",
      joints_unit(robot), robot.base_dof() > 0 ? " (base rows: N and N m)" : "",
      beyond_contacts(run, robot)));
  page.table(errors_table(run, robot));
  page.paragraph(noise_floor_words(filtered));
  if (const std::string picture = errors_picture(run, robot); !picture.empty()) {
    page.picture(picture,
                 "Joints: the same errors as in the table, on a logarithmic axis: the further left "
                 "the better.");
  }
  page.heading("What was found");
  if (run.consistent.model.effects.empty()) {
    page.paragraph("No effect lowers the error on held-out blocks by more than chance.");
  } else {
    page.table(findings_table(run, robot));
  }
  if (!run.loop.first_ranking.empty()) {
    page.picture(ranking_picture(run),
                 "Hypotheses beside rigid links alone, with standard errors. "
                 "The best was accepted, and the search went on. *: chance may make as "
                 "much of it, or its size is not believed.");
  }
  for (int j = 0; j < robot.joint_count(); ++j) {
    page.heading("Joint " + robot.joint(j).name);
    page.picture(torque_picture(run, robot, j),
                 "Test motion: logged and predicted torque, and "
                 "their difference");
    page.picture(scatter_picture(run, robot, j), "Residual before (orange) and after (blue)");
  }
  page.heading("Autocorrelation of the residual");
  page.picture(
      autocorrelation_picture(run, robot),
      "Over the lag in s, before (orange) and after (blue); the band is that of white noise");
  page.heading("Inertial parameters");
  page.paragraph(
      "The 95 % interval takes for granted that nothing acts but what was found. With what was not "
      "noticed: if the effect that is named acts, as large as this log allows without its being "
      "found.");
  if (run.causes_alone) {
    page.paragraph(
        "Beside causes alone: fitted again without the effects whose name does not stand. What "
        "differs there by more than its error is not determined by this log.");
  }
  for (std::size_t i = 0; i < run.settings.shapes.free_links.size(); ++i) {
    const int link = run.settings.shapes.free_links[i];
    page.paragraph("Link " + robot.links[static_cast<std::size_t>(link)].name);
    page.table(parameters_table(run, robot, i));
    const std::string picture = inertia_picture(run, robot, link);
    if (!picture.empty()) page.picture(picture, "Ellipsoids of the same mass and moments");
  }
  add_undetermined(page, run, robot);
  if (!run.notes.empty()) page.heading("Notes");
  for (const std::string& note : run.notes) page.paragraph(note);
  return page.html();
}

}  // namespace shapeid::app

#include "shapeid/app/diagnosis_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "shapeid/app/diagnosis_plots.hpp"
#include "shapeid/app/diagnosis_result.hpp"
#include "shapeid/app/diagnosis_tables.hpp"
#include "shapeid/app/found_plots.hpp"
#include "shapeid/app/html.hpp"
#include "shapeid/app/result.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/slowness.hpp"

namespace shapeid::app {
namespace {

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
         "and on legs that stand, where contact forces explain a part of the noise, too. It is too "
         "low, and says nothing, where the torque was smoothed before it was logged.";
}

/// What the residual still follows, half a sentence.
std::string structure_words(const diagnosis::Structure& s) {
  if (s.variable == diagnosis::slow) {
    return fmt::format(
        "the residual of {} is no noise: {:.1f} % of its variance is slow and beyond it", s.joint,
        100.0 * s.share);
  }
  if (!s.law.empty()) {
    return fmt::format(
        "as {}, but its number follows {}; {:.1f} % of the held-out error, {:.1f} standard errors",
        s.law, s.variable, 100.0 * s.share, s.t);
  }
  if (!s.under_name.empty()) {
    return fmt::format("{} over {}, which {} describes in part", s.joint, s.variable, s.under_name);
  }
  return fmt::format(
      "{} over {}, {:.1f} % of its residual variance on blocks left out, {:.1f} standard errors",
      s.joint, s.variable, 100.0 * s.share, s.t);
}

void add_undetermined(Page& page, const DiagnosisRun& run, const Robot& robot,
                      bool curves_written) {
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
        "With curves in the place of what no name explains ({}) the error of all joints on the "
        "test "
        "motion is {} {} instead of {}. {}",
        curves_words(run, robot), short_number(overall(run.errors.with_curves, robot)),
        joints_unit(robot), short_number(overall(run.errors.found, robot)),
        curves_written ? "effects.yaml and predict_torque.hpp have them; tables and pictures here "
                         "are without."
                       : "diagnose --curves writes them with the model."));
  }
  if (run.structures.empty())
    page.paragraph("Of what was fitted, the residual follows no signal that was tested.");
  constexpr std::size_t shown = 6;
  for (std::size_t i = 0; i < std::min(shown, run.structures.size()); ++i) {
    const diagnosis::Structure& s = run.structures[i];
    page.picture(structure_picture(s, robot), "Unexplained: " + structure_words(s));
  }
  if (run.structures.size() <= shown) return;
  std::string more;
  for (std::size_t i = shown; i < run.structures.size(); ++i) {
    more += (more.empty() ? "" : "; ") + structure_words(run.structures[i]);
  }
  page.paragraph("Likewise unexplained, without a picture: " + more + ".");
}

void add_findings(Page& page, const DiagnosisRun& run, const Robot& robot) {
  const Table found = findings_table(run, robot, true);
  if (found.size() > 1) {
    page.table(found);
  } else {
    page.paragraph("No effect whose name stands.");
  }
  const Table descriptions = findings_table(run, robot, false);
  if (descriptions.size() == 1) return;
  page.heading("What predicts, and is not the cause");
  page.paragraph(
      "Descriptions: with them the model predicts better, and each is there for something else, or "
      "for more than it says.");
  page.table(descriptions);
}

}  // namespace

std::string diagnosis_report(const DiagnosisRun& run, const Robot& robot,
                             const DiagnoseOptions& options) {
  Page page("What the model of " + robot.name + " lacks");
  const bool filtered = !options.inputs.exact && options.inputs.cutoff > 0.0;
  page.paragraph(fmt::format(
      "Tested on {} samples that were used for nothing else. {} {} hypotheses in {} blocks; "
      "screening {:.1f} s, refits {:.1f} s.",
      run.errors.samples,
      filtered ? fmt::format("Every channel went through the same zero-phase filter of {:g} Hz.",
                             options.inputs.cutoff)
               : "No channel was filtered.",
      run.loop.hypotheses, run.loop.blocks, run.loop.screening_seconds, run.loop.refit_seconds));
  page.table(how_made_table(run, robot, options));
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
    add_findings(page, run, robot);
  }
  if (!run.loop.first_ranking.empty()) {
    page.picture(ranking_picture(run),
                 "Hypotheses beside rigid links alone, with standard errors. "
                 "The best was accepted, and the search went on. *: chance may make as "
                 "much of it, or its size is not believed.");
  }
  for (int j = 0; j < robot.joint_count(); ++j) {
    page.heading("Joint " + robot.joint(j).name);
    const std::string& name = robot.joint(j).name;
    const std::string torques = torque_picture(run, robot, j);
    const std::string scatter = scatter_picture(run, robot, j);
    if (torques.empty() || scatter.empty()) {
      page.paragraph(
          "It stands still in the test, and friction at rest holds any torque: it has no "
          "residual to be shown.");
      continue;
    }
    page.picture(
        torques,
        fmt::format("{}, test motion: logged{} and predicted torque, and their difference. "
                    "Time since the first sample of the test, several logs one after the "
                    "other. {}",
                    name, filtered ? " (filtered)" : "", beyond_contacts(run, robot)));
    page.picture(scatter,
                 name + ": residual before (orange) and after (blue); rest does not count");
  }
  page.heading("Autocorrelation of the residual");
  page.picture(
      autocorrelation_picture(run, robot),
      "Over the lag in s, before (orange) and after (blue); the band is that of white noise");
  page.heading("Inertial parameters");
  page.paragraph(
      "The 95 % interval takes for granted that nothing acts but what was found. With what was not "
      "noticed: if the effect that is named acts, as large as this log allows without its being "
      "found, and with what the number changes by behind a slower filter (noise of motion, and the "
      "filter itself).");
  if (run.causes_alone) {
    page.paragraph(
        "Beside causes alone: fitted again without the effects whose name does not stand. A link "
        "of "
        "which a number differs there by more than three standard errors of both is not "
        "identified.");
  }
  if (run.settings.shapes.free_links.empty()) page.paragraph("No link was sought.");
  for (std::size_t i = 0; i < run.settings.shapes.free_links.size(); ++i) {
    const int link = run.settings.shapes.free_links[i];
    const std::string& name = robot.links[static_cast<std::size_t>(link)].name;
    page.subheading("Link " + name);
    if (const std::string verdict = link_verdict(run, robot, i); !verdict.empty()) {
      page.paragraph(verdict);
    }
    page.table(parameters_table(run, robot, i));
    const std::string picture = inertia_picture(run, robot, link);
    if (!picture.empty()) {
      page.picture(picture, fmt::format("{}: ellipsoids of the same mass and moments; {} of its 10 "
                                        "numbers are determined by the data",
                                        name, determined_of_link(run, i)));
    }
  }
  add_undetermined(page, run, robot, options.curves);
  if (!run.notes.empty()) page.heading("Notes");
  for (const std::string& note : run.notes) page.paragraph(note);
  return page.html();
}

}  // namespace shapeid::app

#include "shapeid/app/diagnosis_result.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "shapeid/app/result.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/slowness.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/models/version.hpp"

namespace shapeid::app {
namespace {

using diagnosis::AppliedEffect;
using diagnosis::When;
using nlohmann::json;

json number_or_null(double x) { return std::isfinite(x) ? json(x) : json(); }

json numbers(const Eigen::VectorXd& v) {
  json list = json::array();
  for (const double x : v) list.push_back(number_or_null(x));
  return list;
}

bool name_stands(const DiagnosisRun& run, const AppliedEffect& effect) {
  const diagnosis::Found* f = found_for(run, effect);
  return f == nullptr || f->name_stands();
}

const char* contacts_json(ContactTreatment contacts) {
  switch (contacts) {
    case ContactTreatment::project:
      return "project";
    case ContactTreatment::measured:
      return "measured";
    case ContactTreatment::ignore:
      break;
  }
  return "none";
}

json finding(const DiagnosisRun& run, const Robot& robot, std::size_t k) {
  const AppliedEffect& a = run.consistent.model.effects[k];
  const Eigen::VectorXd& error = run.consistent.effect_error[k];
  json values = json::object();
  for (std::size_t p = 0; p < a.effect->parameters.size(); ++p) {
    const auto at = static_cast<Eigen::Index>(p);
    values[a.effect->parameters[p].name] = {
        {"value", a.value[at]},
        {"unit", unit_of(robot, a, a.effect->parameters[p].unit)},
        {"standard_error", number_or_null(error[at])}};
  }
  for (std::size_t s = 0; s < a.effect->shape.size(); ++s) {
    values[a.effect->shape[s].name] = {{"value", a.shape[static_cast<Eigen::Index>(s)]},
                                       {"unit", unit_of(robot, a, a.effect->shape[s].unit)}};
  }
  json entry = {{"effect", a.effect->id},
                {"site", site_name(robot, a.effect->site, a.site)},
                {"value", a.value[0]},
                {"unit", unit_of(robot, a, a.effect->parameters[0].unit)},
                {"standard_error", number_or_null(error[0])},
                {"values", values}};
  if (const diagnosis::Found* f = found_for(run, a)) {
    entry["heldout_gain"] = f->gain;
    entry["gain_over_its_error"] = f->t;
    const auto may_be = [&](When when) {
      return std::ranges::find(f->other_times, when) != f->other_times.end();
    };
    entry["since_reference"] = a.when == When::since_reference;
    entry["gone_since_reference"] = a.when == When::gone;
    entry["may_act_in_both"] = may_be(When::always);
    entry["may_have_come_since"] = may_be(When::since_reference);
    entry["may_have_gone_since"] = may_be(When::gone);
    entry["ambiguous_with"] = f->ambiguous_with;
    entry["hangs_on_given_inertias"] = f->hangs_on_given;
    if (f->rival) entry["or_without_name"] = law_text(*f->rival, robot);
    if (!f->ambiguous_with.empty()) entry["separate_by"] = a.effect->separate_by;
    entry["under_contact"] = a.effect->under_contact;
    if (!f->name_stands()) entry["doubt"] = doubt(run, *f, robot);
  }
  return entry;
}

json ranking_json(const std::vector<diagnosis::Ranked>& ranking) {
  json list = json::array();
  for (const diagnosis::Ranked& r : ranking) {
    list.push_back({{"hypothesis", r.id},
                    {"heldout_gain", r.gain},
                    {"gain_over_its_error", r.t},
                    {"credible", r.credible}});
  }
  return list;
}

/// Ten errors; null where the data do not determine the number: how little the given inertias let
/// it scatter is no error of it.
json errors_of_determined(const Eigen::VectorXd& errors, const std::vector<bool>& determined) {
  json list = json::array();
  for (std::size_t p = 0; p < determined.size(); ++p) {
    list.push_back(determined[p] ? number_or_null(errors[static_cast<Eigen::Index>(p)]) : json());
  }
  return list;
}

json links_json(const DiagnosisRun& run, const Robot& robot) {
  json links = json::array();
  const auto& free_links = run.settings.shapes.free_links;
  for (std::size_t i = 0; i < free_links.size(); ++i) {
    const Eigen::Index at = Eigen::Index{10} * free_links[i];
    const Link& given = robot.links[static_cast<std::size_t>(free_links[i])];
    const auto own = 10 * static_cast<std::ptrdiff_t>(i);
    const reference::Determination& data = run.consistent.data;
    const std::vector<bool> determined(data.determined.begin() + own,
                                       data.determined.begin() + own + 10);
    json entry = {
        {"name", given.name},
        {"parameters", numbers(run.consistent.model.Phi.segment<10>(at))},
        {"given", numbers(given.inertia.values)},
        {"standard_error",
         errors_of_determined(run.consistent.Phi_error.segment<10>(at), determined)},
        {"error_if_unnoticed",
         errors_of_determined(run.unnoticed.error.segment<10>(at), determined)},
        {"unnoticed", std::vector<std::string>(run.unnoticed.effect.begin() + at,
                                               run.unnoticed.effect.begin() + at + 10)},
        {"move_behind_slower_filter",
         run.moves_behind_filter.size() > 0
             ? errors_of_determined(run.moves_behind_filter.segment<10>(at), determined)
             : json()},
        {"far_from_given", diagnosis::is_surely_far_from_given(robot, free_links, run.consistent,
                                                               run.unnoticed.error, i)},
        {"data_standard_error", numbers(data.standard_error.segment<10>(own))},
        {"determined", determined}};
    if (run.causes_alone) {
      entry["beside_causes_alone"] = numbers(run.causes_alone->model.Phi.segment<10>(at));
      entry["hangs_on_descriptions"] =
          diagnosis::hangs_on_descriptions(run.consistent, *run.causes_alone, free_links[i])
              .has_value();
    }
    links.push_back(entry);
  }
  return links;
}

std::string values_text(const Robot& robot, const AppliedEffect& a, const Eigen::VectorXd& error) {
  std::string text;
  for (std::size_t p = 0; p < a.effect->parameters.size(); ++p) {
    const auto at = static_cast<Eigen::Index>(p);
    const diagnosis::Parameter& parameter = a.effect->parameters[p];
    const std::string own_error =
        std::isfinite(error[at]) ? fmt::format("+- {:.2g}", error[at]) : "(not determined)";
    text += fmt::format("{}{} = {:.4g} {} {}", p == 0 ? "" : ", ", parameter.name, a.value[at],
                        own_error, unit_of(robot, a, parameter.unit));
  }
  for (std::size_t s = 0; s < a.effect->shape.size(); ++s) {
    text += fmt::format(", {} = {:.3g} {}", a.effect->shape[s].name,
                        a.shape[static_cast<Eigen::Index>(s)],
                        unit_of(robot, a, a.effect->shape[s].unit));
  }
  return text;
}

std::string findings_text(const DiagnosisRun& run, const Robot& robot) {
  const auto& effects = run.consistent.model.effects;
  if (effects.empty())
    return "\nno effect lowers the error on held-out blocks by more than chance\n";
  std::string text =
      "\nfound (gain: share of the held-out squared error that would come back "
      "without it, and over its standard error)\n";
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const diagnosis::Found* f = found_for(run, effects[k]);
    text += fmt::format("  {:<38}{}\n", hypothesis_id(robot, effects[k]),
                        values_text(robot, effects[k], run.consistent.effect_error[k]));
    if (effects[k].effect->is_payload) {
      text += fmt::format("  {:<38}{}\n", "",
                          centre_text(robot, effects[k], run.consistent.effect_error[k]));
    }
    if (f != nullptr && !f->name_stands()) {
      text += fmt::format("  {:<38}a description, not the cause: {}\n", "", doubt(run, *f, robot));
    }
    if (f == nullptr) continue;
    if (!f->is_for_bodies_alone()) {
      text +=
          fmt::format("  {:<38}gain {:.1f} %, {:.1f} standard errors\n", "", 100.0 * f->gain, f->t);
    }
    if (const std::string since = since_text(*f); !since.empty()) {
      text += fmt::format("  {:<38}{}\n", "", since);
    }
    if (f->hangs_on_given) text += fmt::format("  {:<38}{}\n", "", hangs_on_given);
    if (f->rival) {
      text +=
          fmt::format("  {:<38}or something without a name: {}\n", "", law_text(*f->rival, robot));
    }
    if (f->ambiguous_with.empty()) continue;
    std::string others;
    for (const std::string& id : f->ambiguous_with) others += (others.empty() ? "" : ", ") + id;
    text += fmt::format("  {:<38}cannot be told from: {}\n  {:<38}to separate: {}\n", "", others,
                        "", effects[k].effect->separate_by);
  }
  return text;
}

std::string errors_text(const DiagnosisRun& run, const Robot& robot) {
  const TestErrors& e = run.errors;
  std::string text = fmt::format(
      "\nresidual on {} samples that were used for nothing else ({}), rms\n  {:<20}{:>10}{:>10}"
      "{:>10}{:>10}{:>14}{:>12}\n",
      e.samples, e.where, "", "zero", "given", "usual", "found", "noise floor", "unfiltered");
  const auto names = row_names(robot);
  const int base = robot.base_dof();
  for (Eigen::Index row = 0; row < e.zero.size(); ++row) {
    text += fmt::format("  {:<20}{:>10}{:>10}{:>10}{:>10}", names[static_cast<std::size_t>(row)],
                        number_or_dash(e.zero[row], 4), number_or_dash(e.given[row], 4),
                        number_or_dash(e.usual[row], 4), number_or_dash(e.found[row], 4));
    if (row >= base) {
      text += fmt::format("{:>14}{:>12}", number_or_dash(e.noise_floor[row - base], 3),
                          number_or_dash(e.unfiltered_found[row - base], 4));
    }
    text += "\n";
  }
  const auto all = [&](const Eigen::VectorXd& rms, int digits) {
    return number_or_dash(overall(rms, robot), digits);
  };
  text += fmt::format("  {:<20}{:>10}{:>10}{:>10}{:>10}{:>14}{:>12}  {}\n", "all joints",
                      all(e.zero, 4), all(e.given, 4), all(e.usual, 4), all(e.found, 4),
                      all(e.noise_floor, 3), all(e.unfiltered_found, 4), joints_unit(robot));
  const std::string contacts = beyond_contacts(run, robot);
  return contacts.empty() ? text : text + fmt::format("  {}\n", contacts);
}

std::string curves_text(const DiagnosisRun& run, const Robot& robot) {
  if (run.curves.empty()) return "";
  return fmt::format("with curves for what is unexplained ({}): {:.4g} {}\n",
                     curves_words(run, robot), overall(run.errors.with_curves, robot),
                     joints_unit(robot));
}

std::string structures_text(const DiagnosisRun& run) {
  if (run.structures.empty())
    return "\nof what was fitted, the residual follows no signal that was tested\n";
  std::string text =
      "\nunexplained: the residual still follows (share of its variance on blocks left out)\n";
  constexpr std::size_t shown = 12;
  for (std::size_t i = 0; i < std::min(shown, run.structures.size()); ++i) {
    const diagnosis::Structure& s = run.structures[i];
    if (!s.under_name.empty()) {
      text += fmt::format("  {:<23} over {:<27} what {} describes in part\n", s.joint, s.variable,
                          s.under_name);
      continue;
    }
    if (s.variable == diagnosis::slow) {
      text += fmt::format("  {:<24}none of them, and is no noise: {:.1f} % is slow and beyond it\n",
                          s.joint, 100.0 * s.share);
      continue;
    }
    const std::string what = s.law.empty() ? s.joint : "as " + s.law;
    text += fmt::format("  {:<23} over {:<27} {:>5.1f} %  ({:.1f} standard errors)\n", what,
                        s.variable, 100.0 * s.share, s.t);
  }
  if (run.structures.size() > shown) {
    text +=
        fmt::format("  and {} more, in the report and in --json\n", run.structures.size() - shown);
  }
  return text;
}

/// Friction of joints for <dynamics>: b and c of what was found.
std::map<std::string, JointFriction> joint_friction(const DiagnosisRun& run, const Robot& robot) {
  std::map<std::string, JointFriction> friction;
  for (const AppliedEffect& a : run.consistent.model.acting()) {
    const bool viscous = a.effect->id == "viscous_friction";
    if (!viscous && a.effect->id != "coulomb_friction") continue;
    JointFriction& of_joint = friction[robot.joint(a.site).name];
    (viscous ? of_joint.damping : of_joint.friction) += a.value[0];
  }
  return friction;
}

}  // namespace

const diagnosis::Found* found_for(const DiagnosisRun& run, const AppliedEffect& effect) {
  for (const diagnosis::Found& f : run.loop.found) {
    if (same_place(f.effect, effect)) return &f;
  }
  return nullptr;
}

std::string centre_text(const Robot& robot, const AppliedEffect& a, const Eigen::VectorXd& error) {
  if (!std::isfinite(error[0])) return "where it is cannot be told: no data show its mass";
  constexpr double known = 2.0;  // standard errors
  if (!(a.value[0] > known * error[0])) {
    return "where it is cannot be told: its mass is zero within two standard errors";
  }
  const Eigen::Array3d centre = a.value.segment<3>(1) / a.value[0];
  const Eigen::Array3d e =
      (error.segment<3>(1).array().square() + (centre * error[0]).square()).sqrt() / a.value[0];
  std::string text;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    text += axis > 0 ? ", " : "";
    text += std::isfinite(e[axis]) ? fmt::format("{:.2g} +- {:.1g}", centre[axis], e[axis]) : "?";
  }
  return fmt::format("its centre at ({}) m of {}", text, site_name(robot, a.effect->site, a.site));
}

std::string curves_words(const DiagnosisRun& run, const Robot& robot) {
  std::string over;
  for (const diagnosis::Curve& c : run.curves) {
    over += fmt::format("{}{} over {}", over.empty() ? "" : ", ", hypothesis_id(robot, c.law),
                        variable_name(c.over, robot));
  }
  return over;
}

std::string beyond_contacts(const DiagnosisRun& run, const Robot& robot) {
  if (run.settings.rows.contacts != ContactTreatment::project || robot.contacts.empty()) return "";
  return "What contact forces could explain is taken out of all torques and errors.";
}

std::string since_text(const diagnosis::Found& found) {
  const auto words = [](When when) -> std::string {
    switch (when) {
      case When::since_reference:
        return "came since the reference log";
      case When::gone:
        return "was in the reference log and is gone";
      case When::always:
        break;
    }
    return "acts in both logs";
  };
  const bool is_sure = found.other_times.empty();
  if (is_sure && found.effect.when == When::always) return "";
  std::string text = words(found.effect.when);
  for (const When other : found.other_times) text += ", or " + words(other);
  return is_sure ? text : text + ": these two logs do not tell";
}

std::string doubt(const DiagnosisRun& run, const diagnosis::Found& f, const Robot& robot) {
  if (f.varies) {
    return fmt::format(
        "its number follows {} by {:.1f} standard errors, worth {:.0f} % of what it "
        "is itself: something else",
        variable_of(*f.varies, robot), f.varies->z, 100.0 * f.varies->share);
  }
  if (f.needed) {
    return "without it the links beyond this joint would have to be larger, or far heavier: a "
           "rotor, or links of "
           "another size";
  }
  if (f.pulls) return "the ground would have to pull the foot";
  if (f.displaced) return "a law without a name explains it better: something else";
  if (f.is_lost_when_slower) {
    return "behind a slower filter it explains hardly any of what it does here";
  }
  if (f.faded) return "once the links are bodies it does not differ from zero by more than chance";
  if (f.only_with_others) {
    return "it came with the same at other joints, and by itself is no more than chance";
  }
  if (f.beside_unknown) return "what has no name on the joints where it acts is worth more";
  if (f.any_period) return "a ripple over another joint's position, sought likewise, does as well";
  return fmt::format("a law that no robot has explains {:.1f} % here, this one less",
                     100.0 * run.loop.placebo);
}

std::string why_left_out(const AppliedEffect& dropped) {
  return dropped.effect->is_payload ? "no mass is left for it once the links are bodies"
                                    : "its sign is impossible once the links are bodies";
}

json diagnosis_json(const DiagnosisRun& run, const Robot& robot, const DiagnoseOptions& options) {
  json findings = json::array(), descriptions = json::array();
  for (std::size_t k = 0; k < run.consistent.model.effects.size(); ++k) {
    const bool named = name_stands(run, run.consistent.model.effects[k]);
    (named ? findings : descriptions).push_back(finding(run, robot, k));
  }
  json structures = json::array();
  for (const diagnosis::Structure& s : run.structures) {
    structures.push_back({{"joint", s.joint},
                          {"variable", s.variable},
                          {"share", s.share},
                          {"share_over_its_error", s.t},
                          {"under_name", s.under_name},
                          {"law", s.law},
                          {"curve", {{"at", s.at}, {"value", s.value}}}});
  }
  json curves = json::array();
  for (const diagnosis::Curve& c : run.curves) {
    curves.push_back({{"law", hypothesis_id(robot, c.law)},
                      {"over", variable_name(c.over, robot)},
                      {"at", numbers(c.at)},
                      {"number", numbers(c.number)}});
  }
  json wrong_signs = json::array();
  for (const auto& [id, z] : run.loop.wrong_signs) {
    wrong_signs.push_back({{"hypothesis", id}, {"value_over_its_error", z}});
  }
  const TestErrors& e = run.errors;
  return {{"format", "shapeid-diagnosis-1"},
          {"software", fmt::format("shapeid {}", version)},
          {"robot", options.inputs.robot},
          {"robot_yaml", run.robot_yaml.empty() ? json() : json(run.robot_yaml)},
          {"log", options.inputs.log},
          {"also", options.also},
          {"test", e.where},
          {"reference", options.reference},
          {"mapping", options.inputs.mapping.empty() ? json() : json(options.inputs.mapping)},
          {"cutoff", options.inputs.cutoff},
          {"rate", run.motion.rate},
          {"contacts", contacts_json(run.settings.rows.contacts)},
          {"expected_mass", run.settings.expected_mass},
          {"path", options.path == diagnosis::Path::fast ? "fast" : "reference"},
          {"samples", run.loop.samples},
          {"blocks", run.loop.blocks},
          {"hypotheses", run.loop.hypotheses},
          {"screening_seconds", run.loop.screening_seconds},
          {"refit_seconds", run.loop.refit_seconds},
          {"findings", findings},
          {"descriptions", descriptions},
          {"placebo_gain", run.loop.placebo},
          {"unexplained", structures},
          {"curves", curves},
          {"hidden", run.loop.hidden},
          {"wrong_signs", wrong_signs},
          {"first_ranking", ranking_json(run.loop.first_ranking)},
          {"last_ranking", ranking_json(run.loop.last_ranking)},
          {"links", links_json(run, robot)},
          {"heldout",
           {{"samples", e.samples},
            {"where", e.where},
            {"rows", row_names(robot)},
            {"at_rest", numbers(e.at_rest)},
            {"rms_zero", numbers(e.zero)},
            {"rms_before", numbers(e.given)},
            {"rms_usual", numbers(e.usual)},
            {"rms_after", numbers(e.found)},
            {"rms_with_curves", numbers(e.with_curves)},
            {"noise_floor", numbers(e.noise_floor)},
            {"unfiltered_zero", numbers(e.unfiltered_zero)},
            {"unfiltered_before", numbers(e.unfiltered_given)},
            {"unfiltered_after", numbers(e.unfiltered_found)}}},
          {"heldout_rms_before", numbers(e.given.tail(robot.joint_count()))},
          {"heldout_rms_after", numbers(e.found.tail(robot.joint_count()))},
          {"notes", run.notes}};
}

std::string diagnosis_text(const DiagnosisRun& run, const Robot& robot) {
  std::string text = fmt::format(
      "robot {}: {} links, {} joints, {} base, {} of unknown inertia\n"
      "{} samples in {} blocks, {} hypotheses; screening {:.1f} s, refits {:.1f} s\n"
      "weighted held-out error a row: given {:.4g}, rigid links refitted {:.4g}, with effects "
      "{:.4g}\n",
      robot.name, robot.link_count(), robot.joint_count(),
      robot.root == Root::floating ? "floating" : "fixed", run.settings.shapes.free_links.size(),
      run.loop.samples, run.loop.blocks, run.loop.hypotheses, run.loop.screening_seconds,
      run.loop.refit_seconds, run.loop.error_given, run.loop.error_rigid, run.loop.error_end);
  text += findings_text(run, robot);
  for (const AppliedEffect& a : run.consistent.dropped) {
    text += fmt::format("  {:<38}left out: {}\n", hypothesis_id(robot, a), why_left_out(a));
  }
  for (const auto& [id, z] : run.loop.wrong_signs) {
    text += fmt::format(
        "  {:<38}would be negative by {:.0f} standard errors: evidence of something "
        "else\n",
        id, -z);
  }
  text += errors_text(run, robot) + structures_text(run) + curves_text(run, robot);
  if (!run.loop.hidden.empty()) {
    text += "\nhardly to be told from inertias and what was found, in this data:\n ";
    for (const std::string& id : run.loop.hidden) text += " " + id;
    text += "\n";
  }
  for (const std::string& note : run.notes) text += fmt::format("note: {}\n", note);
  return text;
}

std::string diagnosed_urdf(DiagnosisRun& run, const Robot& robot, const std::string& original) {
  std::vector<IdentifiedLink> written;
  for (const int link : run.settings.shapes.free_links) {
    const InertialParameters inertia{run.consistent.model.Phi.segment<10>(Eigen::Index{10} * link)};
    const std::string& name = robot.links[static_cast<std::size_t>(link)].name;
    if (!(inertia.mass() > 0.0)) {
      const auto lightest =
          lightest_written(robot.links[static_cast<std::size_t>(link)].inertia, 0.0);
      if (lightest) written.push_back({link, *lightest});
      run.notes.push_back(fmt::format(
          "link {} was left without mass: in identified.urdf it {}", name,
          lightest ? fmt::format("has {:g} kg, because readers want some", lightest->mass())
                   : "keeps the given inertia"));
    } else if (const Violation why = why_impossible(inertia)) {
      run.notes.push_back(fmt::format("link {} keeps the given inertia: {}", name, *why));
    } else {
      written.push_back({link, inertia});
    }
  }
  return with_friction(write_urdf(original, robot, written), original, joint_friction(run, robot));
}

}  // namespace shapeid::app

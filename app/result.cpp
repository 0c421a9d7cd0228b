#include "shapeid/app/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "shapeid/app/division_history.hpp"
#include "shapeid/app/no_mass.hpp"
#include "shapeid/app/number_source.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/student.hpp"
#include "shapeid/models/version.hpp"

namespace shapeid::app {
namespace {

using nlohmann::json;

/// JSON has no infinity: a number that is not known is null.
json numbers(const Eigen::VectorXd& v) {
  json list = json::array();
  for (const double x : v) list.push_back(std::isfinite(x) ? json(x) : json());
  return list;
}

const Link& link_at(const Robot& robot, int index) {
  return robot.links[static_cast<std::size_t>(index)];
}

/// Ten parameters of a free link: all of it, and the part that was sought. They differ where a load
/// is sought on a link that is known.
struct FreeLink {
  FreeLink(const Result& result, std::size_t place)
      : link(result.found.run.model.free_links[place]),
        at(Eigen::Index{10} * static_cast<Eigen::Index>(place)),
        known(result.sought.known.segment<10>(Eigen::Index{10} * link)),
        whole(result.found.Phi.segment<10>(Eigen::Index{10} * link)),
        sought(result.found.run.solution.Phi.segment<10>(at)) {}

  int link;
  Eigen::Index at;  ///< among the sought parameters
  Vector10 known, whole, sought;
};

/// What is said of a link's ten parameters; not finite where these data say nothing of them.
Eigen::VectorXd where_told(const reference::Determination& data, const FreeLink& link,
                           const Vector10& values) {
  const auto told = data.standard_error.segment<10>(link.at).array().isFinite();
  return told.select(values, std::numeric_limits<double>::infinity());
}

/// By how much the data's ten values are others behind the slower filter; null: not asked.
json moves_json(const reference::Identification& found, const FreeLink& link) {
  if (!found.slower) return {};
  const Vector10 move = (found.slower->value - found.data.value).segment<10>(link.at);
  return numbers(where_told(*found.slower, link, where_told(found.data, link, move)));
}

json links_json(const Result& result, const Robot& robot) {
  json links = json::array();
  const auto& free_links = result.found.run.model.free_links;
  for (std::size_t i = 0; i < free_links.size(); ++i) {
    const FreeLink free(result, i);
    const Link& link = link_at(robot, free.link);
    const Eigen::Index at = free.at;
    json determined = json::array(), against_data = json::array(), determined_by = json::array(),
         hangs = json::array();
    for (Eigen::Index p = 0; p < 10; ++p) {
      determined.push_back(
          static_cast<bool>(result.found.data.determined[static_cast<std::size_t>(at + p)]));
      against_data.push_back(!result.found.data.agrees(at + p, free.sought[p]));
      determined_by.push_back(number_source(result.found, at + p));
      hangs.push_back(hangs_on_filter(result.found, at + p));
    }
    const Vector10 data_value = free.known + result.found.data.value.segment<10>(at);
    links.push_back(
        {{"name", link.name},
         {"parameters", numbers(free.whole)},
         {"given", numbers(link.inertia.values)},
         {"standard_error", numbers(result.found.standard_error.segment<10>(at))},
         {"data_value", numbers(where_told(result.found.data, free, data_value))},
         {"data_standard_error", numbers(result.found.data.standard_error.segment<10>(at))},
         {"move_behind_slower_filter", moves_json(result.found, free)},
         {"hangs_on_filter", hangs},
         {"determined", determined},
         {"against_data", against_data},
         {"determined_by", determined_by}});
  }
  return links;
}

json masses_json(const reference::DivisionRun& run, const Robot& robot) {
  json masses = json::array();
  for (std::size_t j = 0; j < run.model.shapes.size(); ++j) {
    const SoughtShape& s = run.model.shapes[j];
    masses.push_back({{"id", s.id},
                      {"link", link_at(robot, s.link).name},
                      {"kind", kind_name(s.shape)},
                      {"volume", volume(s.shape)},
                      {"mass", run.solution.m[static_cast<Eigen::Index>(j)]}});
  }
  return masses;
}

/// A link that weighs this many times what it should is not believed without a word.
constexpr double far_from_given = 3.0;

/// s of motion that was fitted: a sample stands for one step of the regular grid.
double fitted_seconds(const Result& result) {
  return static_cast<double>(result.found.samples) / result.motion.rate;
}

std::string shown(double x) { return std::isfinite(x) ? fmt::format("{:.3g}", x) : "none"; }

std::string links_text(const Result& result, const Robot& robot) {
  std::string text;
  const auto& free_links = result.found.run.model.free_links;
  for (std::size_t i = 0; i < free_links.size(); ++i) {
    const FreeLink free(result, i);
    const Link& link = link_at(robot, free.link);
    text += fmt::format("\nlink {}\n  {:<6}{:>12}{:>12}{:>12}{:>14}  {:<7} {}\n", link.name, "",
                        "given", "found", "s.e.", "data's s.e.", "unit", "determined by");
    for (Eigen::Index p = 0; p < 10; ++p) {
      const Eigen::Index at = free.at + p;
      const auto k = static_cast<std::size_t>(p);
      text +=
          fmt::format("  {:<6}{:>12.5g}{:>12.5g}{:>12}{:>14}  {:<7} {}\n", parameter_names[k],
                      link.inertia.values[p], free.whole[p], shown(result.found.standard_error[at]),
                      shown(result.found.data.standard_error[at]), parameter_units[k],
                      number_source_text(result, at, free.known[p]));
    }
  }
  return text;
}

std::string comparison_text(const Comparison& c, const Robot& robot) {
  if (c.where.empty()) return "\nall samples were fitted, none held out\n";
  if (c.samples == 0) return "\nno samples were held out: the log is too short\n";
  std::string text = fmt::format(
      "\nresidual on {} samples that were not fitted ({}), rms\n  {:<20}{:>12}{:>12}{:>12}  unit\n",
      c.samples, c.where, "", "zero", "given", "found");
  const auto names = row_names(robot), units = row_units(robot);
  for (Eigen::Index row = 0; row < c.zero.size(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    text +=
        fmt::format("  {:<20}{:>12}{:>12}{:>12}  {}\n", names[at], number_or_dash(c.zero[row], 4),
                    number_or_dash(c.given[row], 4), number_or_dash(c.found[row], 4), units[at]);
  }
  text += fmt::format("  {:<20}{:>12}{:>12}{:>12}  {}\n", "all joints",
                      number_or_dash(overall(c.zero, robot), 4),
                      number_or_dash(overall(c.given, robot), 4),
                      number_or_dash(overall(c.found, robot), 4), joints_unit(robot));
  return text;
}

}  // namespace

std::vector<std::string> row_names(const Robot& robot) {
  std::vector<std::string> names;
  if (robot.base_dof() > 0) {
    names = {"base force x",  "base force y",  "base force z",
             "base moment x", "base moment y", "base moment z"};
  }
  for (int j = 0; j < robot.joint_count(); ++j) names.push_back(robot.joint(j).name);
  return names;
}

std::vector<std::string> row_units(const Robot& robot) {
  std::vector<std::string> units;
  if (robot.base_dof() > 0) units = {"N", "N", "N", "N m", "N m", "N m"};
  for (int j = 0; j < robot.joint_count(); ++j) units.push_back(unit_at(robot.joint(j), "N m"));
  return units;
}

std::string joints_unit(const Robot& robot) {
  bool turns = false, slides = false;
  for (int j = 0; j < robot.joint_count(); ++j) {
    (robot.joint(j).kind == JointKind::prismatic ? slides : turns) = true;
  }
  return !slides ? "N m" : turns ? "N m and N" : "N";
}

std::string number_or_dash(double x, int digits) {
  return std::isfinite(x) ? fmt::format("{:.{}g}", x, digits) : "-";
}

double overall(const Eigen::VectorXd& rms, const Robot& robot) {
  const Eigen::ArrayXd joints = rms.tail(robot.joint_count());
  if (joints.isNaN().all()) return std::numeric_limits<double>::quiet_NaN();
  return joints.isNaN().select(0.0, joints).matrix().norm();
}

StatedProblem stated_problem(const Result& result) {
  const reference::DivisionRun& run = result.found.run;
  return {run.problem, {}, regions_of(result.sought), regions_of(run.model)};
}

void check_some_mass(const Result& result, double expected_mass) {
  if (!is_no_mass(result.found.Phi, result.sought.free_links, expected_mass)) return;
  throw Refusal("no-mass", fmt::format("the log asks for no mass at all where some is sought: {}",
                                       causes_of_no_mass));
}

std::optional<InertialParameters> lightest_written(const InertialParameters& given,
                                                   double least_mass) {
  constexpr double share = 1e-3;  // of the given mass: no residual shows it
  const double mass = std::max(least_mass, share * given.mass());
  if (!(given.mass() > mass)) return {};
  return InertialParameters{(mass / given.mass()) * given.values};
}

void choose_written_links(Result& result, const Robot& robot, double least_mass) {
  for (std::size_t i = 0; i < result.found.run.model.free_links.size(); ++i) {
    const int index = result.found.run.model.free_links[i];
    const InertialParameters inertia{result.found.Phi.segment<10>(Eigen::Index{10} * index)};
    const std::string& name = link_at(robot, index).name;
    const double given = link_at(robot, index).inertia.mass();
    const bool carries_a_load = result.sought.known[Eigen::Index{10} * index] > 0.0;
    // (What the data do not determine is the shapes' or a neighbour's.)
    const bool is_known = result.found.data.determined.at(10 * i);
    if (is_known && !carries_a_load && given > 0.0 && inertia.mass() > far_from_given * given) {
      result.notes.push_back(
          fmt::format("link {} was found with {:.3g} kg, given {:.3g}: either that is wrong, or "
                      "some effect that is not a rigid body hides in it (friction, for a link that "
                      "turns about a vertical axis)",
                      name, inertia.mass(), given));
    }
    if (!(inertia.mass() > least_mass)) {
      const std::string left =
          fmt::format("it was left with {:g} kg (limit {:g})", inertia.mass(), least_mass);
      const auto lightest = lightest_written(link_at(robot, index).inertia, least_mass);
      if (lightest) {
        result.notes.push_back(
            fmt::format("link {} is written with {:g} kg, its given inertia scaled: {}", name,
                        lightest->mass(), left));
        result.written.push_back({index, *lightest});
      } else {
        result.notes.push_back(fmt::format("link {} keeps the given inertia: {}", name, left));
      }
    } else if (const Violation why = why_impossible(inertia)) {
      result.notes.push_back(fmt::format(
          "link {} keeps the given inertia: what was found cannot be written ({})", name, *why));
    } else {
      result.written.push_back({index, inertia});
    }
  }
}

json result_json(const Result& result, const std::optional<double>& floor, const Robot& robot) {
  const reference::DivisionRun& run = result.found.run;
  const auto of_any = [&](const Eigen::VectorXd& rms) {
    return result.heldout.samples > 0 ? numbers(rms) : json::array();
  };
  return {{"format", "shapeid-result-1"},
          {"software", fmt::format("shapeid {}", version)},
          {"robot", result.robot_file},
          {"robot_yaml", result.robot_yaml_file.empty() ? json() : json(result.robot_yaml_file)},
          {"log", result.log_file},
          {"samples", result.found.samples},
          {"blocks", result.found.blocks},
          {"seconds", fitted_seconds(result)},
          {"rate", result.motion.rate},
          {"gaps", result.motion.gaps},
          {"contacts_derived", result.motion.contacts_derived},
          {"slower_cutoff", result.found.slower ? json(result.slower_cutoff) : json()},
          {"problem_digest", problem_digest(stated_problem(result))},
          {"lambda", run.problem.lambda},
          {"mass_bound", run.problem.mass_bound},
          {"objective",
           {{"undivided", result.found.undivided_objective},
            {"data", run.solution.value.data},
            {"density", run.solution.value.density},
            {"floor", floor ? json(*floor) : json()}}},
          {"masses", masses_json(run, robot)},
          {"links", links_json(result, robot)},
          {"divisions", history_json(run, floor)},
          {"stopped_by", run.stopped_by},
          {"heldout",
           {{"samples", result.heldout.samples},
            {"where", result.heldout.where},
            {"rows", row_names(robot)},
            {"rms_zero", of_any(result.heldout.zero)},
            {"rms_before", of_any(result.heldout.given)},
            {"rms_after", of_any(result.heldout.found)}}},
          {"notes", result.notes}};
}

std::string result_text(const Result& result, const std::optional<double>& floor,
                        const Robot& robot) {
  const reference::DivisionRun& run = result.found.run;
  std::string text = fmt::format(
      "robot {}: {} links, {} joints, {} base\n"
      "log {}: {} samples ({:.1f} s fitted) at {:.0f} Hz, {} gaps\n"
      "{} shapes after {} divisions (stopped by: {}); objective {:.6g} -> {:.6g}, density term's "
      "share {:.2g}\n",
      robot.name, robot.link_count(), robot.joint_count(),
      robot.root == Root::floating ? "floating" : "fixed", result.log_file, result.found.samples,
      fitted_seconds(result), result.motion.rate, result.motion.gaps, run.model.shapes.size(),
      run.history.size(), run.stopped_by, result.found.undivided_objective,
      run.solution.value.total(), run.solution.value.density / run.solution.value.total());
  text += history_text(result.found, floor);
  text += links_text(result, robot);
  text += comparison_text(result.heldout, robot);
  for (const std::string& note : result.notes) text += fmt::format("note: {}\n", note);
  constexpr double of_95_percent = 1.96;
  text += fmt::format(
      "note: standard errors are by leaving out each of {0} blocks; 95 % lie within "
      "{1:.3g} of them\n",
      result.found.blocks,
      limit_for(of_95_percent, static_cast<Eigen::Index>(result.found.blocks)));
  text += "note: standard errors do not contain the shrinkage that noise in the motion causes\n";
  text += number_source_legend(result.found);
  return text;
}

}  // namespace shapeid::app

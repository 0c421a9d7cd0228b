#include "shapeid/app/inputs.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <set>
#include <utility>

#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/tell.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/reference/contact_detection.hpp"

namespace shapeid::app {
namespace {

// A foot that is wrongly taken to touch costs rows; the force of one that is missed ends in the
// residual. (At 0.15 four trots without flags had a delay of the torque that was none.)
constexpr double usual_contact_threshold = 0.05;

/// Whether a log, as seen through its mapping, has an IMU.
bool has_imu(const LogTable& log, const std::optional<Mapping>& mapping) {
  const auto is_of_base = [](const std::string& name) {
    return std::ranges::any_of(
        std::array{"base.gyro.", "base.accel.", "base.quat.", "base.gyrodot."},
        [&](const char* quantity) { return name.starts_with(quantity); });
  };
  if (mapping && std::any_of(mapping->columns.begin(), mapping->columns.end(),
                             [&](const auto& rule) { return is_of_base(rule.first); })) {
    return true;
  }
  return std::any_of(log.columns().begin(), log.columns().end(), is_of_base);
}

void check_measured(const Robot& robot) {
  std::set<std::string> names;
  for (const Contact& contact : robot.contacts) {
    if (!names.insert(contact.name).second) {
      throw InputError(
          fmt::format("--contacts measured, but {} has several contacts", contact.name),
          "one contact for a measured force, at the place where it acts");
    }
    if (contact.kind == ContactKind::point) continue;
    throw InputError(
        fmt::format("--contacts measured, but {} is the contact of a {}, whose moment "
                    "no column of a log has",
                    contact.name, contact.kind == ContactKind::line ? "line" : "plane"),
        "a contact that is a point, at the place where the force acts");
  }
}

}  // namespace

std::string robot_yaml_beside(const std::string& urdf) {
  const std::filesystem::path path(urdf);
  for (const auto& name : {path.stem().string() + ".robot.yaml", std::string("robot.yaml")}) {
    const auto candidate = path.parent_path() / name;
    // A link to nowhere is there, and is refused when it is read; a name that is too long is not.
    std::error_code unknown;
    if (std::filesystem::exists(std::filesystem::symlink_status(candidate, unknown))) {
      return candidate.string();
    }
  }
  return {};
}

std::string remark_beside(const std::string& robot_yaml) {
  return fmt::format("{} stands beside the URDF and is used (--robot-yaml names another one)",
                     robot_yaml);
}

void MotionInputs::add_robot_to(CLI::App& verb) {
  verb.add_option("--robot", robot, "URDF file")->required();
  verb.add_option("--mapping", mapping, "mapping.yaml, for a log with foreign names or units");
  verb.add_option("--robot-yaml", robot_yaml,
                  "contacts, IMU pose, noise (default: beside the URDF, if there)");
  verb.add_flag("--accept-impossible", accept_impossible,
                "take given inertias that no body can have as they are, for links that are known");
  verb.add_option("--contacts", contacts,
                  "auto: flags as logged, else derived; measured: forces are logged; none")
      ->check(CLI::IsMember({"auto", "measured", "none"}))
      ->capture_default_str();
  verb.add_option("--contact-threshold", contact_threshold,
                  "derived contacts: share of the robot's weight that a foot must carry")
      ->check(share_above_zero())
      ->default_str(fmt::format("{}", usual_contact_threshold));
}

void MotionInputs::add_to(CLI::App& verb) {
  add_robot_to(verb);
  verb.add_option("--log", log, "log, CSV or CSV.gz")->required();
  add_smoothing_to(verb);
}

void MotionInputs::add_smoothing_to(CLI::App& verb) {
  auto* smoothing =
      verb.add_option("--cutoff", cutoff,
                      "Hz, of the zero-phase filter over every channel; 0 does not smooth")
          ->check(zero_or_above())
          ->capture_default_str();
  auto* grid = verb.add_option("--rate", rate, "Hz, of the regular grid (default: the log's)")
                   ->check(rate_of_a_log());
  verb.add_flag("--exact", exact, "take dq, ddq and base.gyrodot from the log (simulations)")
      ->excludes(grid)
      ->excludes(smoothing);
}

void MotionInputs::add_row_cutoff_to(CLI::App& verb) {
  verb.add_option("--row-cutoff", row_cutoff,
                  "Hz: filter the rows of the equations as well; then --cutoff can be high, which "
                  "distorts less (docs/recovery.md)")
      ->check(above_zero());
}

ContactTreatment contact_treatment(const MotionInputs& inputs, const Robot& robot) {
  const bool none =
      inputs.contacts == "none" || robot.root == Root::fixed || robot.contacts.empty();
  const auto treatment = inputs.contacts == "measured" ? ContactTreatment::measured
                         : none                        ? ContactTreatment::ignore
                                                       : ContactTreatment::project;
  if (inputs.contact_threshold && treatment != ContactTreatment::project) {
    throw InputError("--contact-threshold is given, and no contacts are derived here",
                     "a floating base with contacts in robot.yaml and --contacts auto, or no "
                     "threshold");
  }
  return treatment;
}

double contact_threshold(const MotionInputs& inputs) {
  return inputs.contact_threshold.value_or(usual_contact_threshold);
}

ContactRule contact_rule(const MotionInputs& inputs, const Robot& robot) {
  return [&robot, Phi = stacked_parameters(robot),
          share = contact_threshold(inputs)](const Sample& sample) {
    return std::optional(reference::detect_contacts(robot, sample, Phi, share));
  };
}

MotionOptionNames names_of_options() { return {"--cutoff", "--rate", "--contact-threshold"}; }

void check_no_stream(const std::string& log) {
  std::error_code unknown;  // a log that is not there is said when it is opened
  const auto kind = std::filesystem::status(log, unknown).type();
  if (log != "-" && kind != std::filesystem::file_type::fifo &&
      kind != std::filesystem::file_type::character) {
    return;
  }
  throw InputError({log}, "is a stream, and a log is read more than once",
                   "a file; `shapeid track -` follows a stream");
}

void say_warnings(const RobotInputs& inputs) {
  for (const std::string& remark : inputs.remarks) tell(fmt::format("note: {}\n", remark));
  for (const std::string& warning : inputs.warnings) tell(fmt::format("warning: {}\n", warning));
}

std::string RobotInputs::of_floating_base() const {
  if (notes.imu_given) return "an IMU";
  return notes.contacts_given && !robot.contacts.empty() ? "contacts" : "";
}

std::vector<std::string> RobotInputs::all_notes() const {
  std::vector<std::string> all = robot.notes;
  all.insert(all.end(), remarks.begin(), remarks.end());
  all.insert(all.end(), warnings.begin(), warnings.end());
  return all;
}

std::vector<std::string> RobotInputs::notes_with(const MotionReport& log) const {
  std::vector<std::string> all = all_notes();
  all.insert(all.end(), log.notes.begin(), log.notes.end());
  return all;
}

RobotInputs read_robot(const MotionInputs& inputs) {
  check_no_stream(inputs.log);
  return read_robot(inputs, LogReader(inputs.log).table());
}

RobotInputs read_robot(const MotionInputs& inputs, const LogTable& log) {
  RobotInputs result;
  if (!inputs.mapping.empty()) result.mapping = read_mapping_yaml(inputs.mapping);
  UrdfOptions options;
  options.root = has_imu(log, result.mapping) ? Root::floating : Root::fixed;
  options.reject_impossible = !inputs.accept_impossible;
  options.accepted_by = "--accept-impossible";
  UrdfFile file = read_urdf(inputs.robot, options);
  for (const InertiaFinding& finding : file.findings) {
    if (!finding.fatal) continue;
    result.warnings.push_back(
        fmt::format("{}: the given inertia of link {} is taken as it is, though {}",
                    describe(finding.place), finding.link, finding.wrong));
  }
  result.robot = std::move(file.robot);
  result.robot_yaml =
      inputs.robot_yaml.empty() ? robot_yaml_beside(inputs.robot) : inputs.robot_yaml;
  if (!result.robot_yaml.empty()) {
    result.notes = read_robot_yaml(result.robot_yaml, result.robot);
    if (inputs.robot_yaml.empty()) {
      result.remarks.push_back(remark_beside(result.robot_yaml));
    }
    const std::string unused = result.of_floating_base();
    if (options.root == Root::fixed && !unused.empty()) {
      result.warnings.push_back(
          fmt::format("the log has no base.* columns: the base is taken as fixed, though {} has {}",
                      result.robot_yaml, unused));
    }
  } else if (options.root == Root::floating) {
    result.warnings.push_back(fmt::format(
        "no robot.yaml beside {}: the IMU is taken to be at the base's origin, unturned",
        inputs.robot));
  }
  if (!result.notes.contacts_given) add_default_contacts(result.robot, log, result.mapping);
  if (inputs.contacts == "measured") check_measured(result.robot);
  if (options.root == Root::floating && inputs.contacts == "auto" &&
      result.robot.contacts.empty()) {
    result.warnings.push_back(
        "no contacts in robot.yaml and no contact.* in the log: the robot is taken to touch "
        "nothing (--contacts none says so)");
  }
  return result;
}

Eigen::VectorXd weight(const RobotInputs& inputs) {
  const auto sigma = [&](const std::string& name, const std::string& group) {
    const auto& known = inputs.notes.noise_sigma;
    if (const auto found = known.find(name); found != known.end()) return found->second;
    if (const auto found = known.find(group); found != known.end()) return found->second;
    return 1.0;
  };
  Eigen::VectorXd W(inputs.robot.dof());
  const int base = inputs.robot.base_dof();
  if (base > 0) {
    W.head<3>().setConstant(std::pow(sigma("base.force", "base.force"), -2));
    W.segment<3>(3).setConstant(std::pow(sigma("base.moment", "base.moment"), -2));
  }
  for (int j = 0; j < inputs.robot.joint_count(); ++j) {
    W[base + j] = std::pow(sigma("tau." + inputs.robot.joint(j).name, "tau"), -2);
  }
  return W;
}

namespace {

MotionOptions motion_options(const MotionInputs& inputs, const Robot& robot) {
  MotionOptions options;
  options.names = names_of_options();
  options.rate = inputs.rate;
  options.exact_derivatives = inputs.exact;
  options.smoothing = inputs.causal ? Smoothing::causal : Smoothing::zero_phase;
  if (inputs.exact || inputs.cutoff == 0.0) options.smoothing = Smoothing::none;
  if (inputs.cutoff != 0.0) options.cutoff = inputs.cutoff;
  options.contacts_needed = contact_treatment(inputs, robot) == ContactTreatment::project;
  if (options.contacts_needed) options.derive_contacts = contact_rule(inputs, robot);
  return options;
}

}  // namespace

std::vector<int> named_links(const std::vector<std::string>& names, const Robot& robot) {
  std::vector<int> links;
  for (const std::string& name : names) {
    const auto link = robot.find_link(name);
    if (!link) throw InputError("--free " + name + ": no such link", "a link of the URDF");
    links.push_back(*link);
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

std::vector<int> moving_links(const Robot& robot) {
  std::vector<int> links(robot.links.size());
  std::iota(links.begin(), links.end(), 0);
  if (robot.root == Root::fixed) links.erase(links.begin());
  return links;
}

void check_forces(const std::string& log, ContactTreatment contacts, bool are_logged) {
  if (contacts != ContactTreatment::measured || are_logged) return;
  throw InputError({log}, "--contacts measured, but there are no force.* columns",
                   "log force.<link>.x, .y, .z for every contact, or choose another treatment");
}

LogSamples::LogSamples(const std::string& path, const RobotInputs& robot,
                       const MotionInputs& inputs)
    : reader_(path, robot.robot, robot.notes, robot.mapping, motion_options(inputs, robot.robot)),
      contacts_(contact_treatment(inputs, robot.robot)),
      quiet_(inputs.quiet || ::isatty(STDERR_FILENO) == 0) {
  check_forces(path, contacts_, reader_.report().forces_logged);
}

std::optional<Sample> LogSamples::next() {
  std::optional<Sample> sample = reader_.next();
  if (quiet_) return sample;
  constexpr std::size_t samples_between_reports = 2000;
  if (!sample) {
    if (count_ >= samples_between_reports) tell("\r\033[K");
    return sample;
  }
  if (++count_ % samples_between_reports == 0) {
    tell(fmt::format("\rreading: {:.1f} s of motion", sample->time));
  }
  return sample;
}

Part part_of(double time_since_start, const MotionInputs& inputs) {
  constexpr double stretch = 2.0;  // s: several strides
  // s: two periods of the cutoff, after which the filter's response has fallen below a thousandth;
  // not less than at the default one of 20 Hz, and not so much that nothing is left.
  constexpr double periods = 2.0, shortest = 0.1, longest = 0.8;
  double margin = shortest;
  for (const double cutoff : {inputs.cutoff, inputs.row_cutoff}) {
    if (cutoff > 0.0) margin = std::clamp(periods / cutoff, margin, longest);
  }
  constexpr double period = stretches * stretch;
  const double held_out_from = (inputs.held_out_stretch - 1) * stretch;
  const double place = std::fmod(time_since_start - held_out_from + period, period);
  if (place >= margin && place < stretch - margin) return Part::held_out;
  if (place >= stretch + margin && place < period - margin) return Part::fitted;
  return Part::neither;
}

void refuse_without_samples(const MotionReport& log) {
  if (log.samples > 0) return;
  std::string why = "the log has no usable sample";
  if (log.dropped_at_contacts > log.dropped_at_ends) {
    why += fmt::format(
        ": {} samples left out near changes of contact, or because no flag says whether a contact "
        "touches",
        log.dropped_at_contacts);
  } else if (log.dropped_at_ends > 0) {
    why += fmt::format(": {} samples lost to the filter at the ends of {} stretches without gaps",
                       log.dropped_at_ends, log.gaps + 1);
  } else if (log.dropped_rows > 0) {
    why += fmt::format(": the mapping's keep_rows leaves out {} of {} rows", log.dropped_rows,
                       log.rows);
  }
  throw Refusal("no-data", why);
}

void refuse_all_held_out(std::size_t samples) {
  if (samples == 0) return;
  throw Refusal("no-data",
                fmt::format("all {} samples of the log are held out for the test, or too "
                            "near to what is; give --test, or a longer log",
                            samples));
}

std::string held_out_words(const MotionInputs& inputs) {
  return inputs.held_out_stretch == stretches
             ? "every fifth two seconds of the log"
             : fmt::format("two seconds of every ten of the log, from {} s on",
                           2 * (inputs.held_out_stretch - 1));
}

std::size_t stride_of(const MotionInputs& inputs, double rate) {
  // A log's rate is one over a difference of rounded times: a floor of a whole number would be
  // decided by when the log was begun.
  constexpr double samples_a_period = 5.0, below_whole = 0.999;
  const double cutoff = inputs.cutoff > 0.0 ? inputs.cutoff : rate;
  return static_cast<std::size_t>(std::max(1.0, below_whole * rate / (samples_a_period * cutoff)));
}

void add_hold_out_option(CLI::App& verb, MotionInputs& inputs) {
  verb.add_option("--hold-out", inputs.held_out_stretch,
                  "which of every five stretches of two seconds to test on, if no --test is given")
      ->check(count_from(1, stretches))
      ->capture_default_str()
      ->excludes(verb.get_option("--test"));
}

}  // namespace shapeid::app

// What the verbs share: reading a robot, a log and the choices about them.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/reference/identify.hpp"

namespace shapeid::app {

/// Of so many stretches of a log one is held out.
constexpr int stretches = 5;

/// Options that name the robot, the log and how to read them.
struct MotionInputs {
  std::string robot, robot_yaml, log, mapping;
  double cutoff = 20.0, row_cutoff = 0.0, rate = 0.0;
  std::optional<double> contact_threshold;  ///< as given
  std::string contacts = "auto";
  bool exact = false, accept_impossible = false;
  int held_out_stretch = stretches;  ///< which one of them
  bool causal = false;               ///< smooth as a robot would, forward in time only
  bool quiet = false;                ///< no progress on a terminal: several logs are read at once

  void add_to(CLI::App& verb);
  /// All but the log and how it is smoothed.
  void add_robot_to(CLI::App& verb);
  void add_smoothing_to(CLI::App& verb);
  /// For verbs that identify by rows of the equations.
  void add_row_cutoff_to(CLI::App& verb);
};

/// A robot with what its files say, ready for logs.
struct RobotInputs {
  Robot robot;
  RobotNotes notes;
  std::optional<Mapping> mapping;
  std::string robot_yaml;             ///< that was read, given or found; may be empty
  std::vector<std::string> warnings;  ///< what is taken for granted
  std::vector<std::string> remarks;   ///< what was read without being named

  /// What robot.yaml has that a fixed base has no use for ("an IMU"); empty if there is nothing.
  [[nodiscard]] std::string of_floating_base() const;
  /// What a result notes of its inputs: of the robot, remarks, warnings.
  [[nodiscard]] std::vector<std::string> all_notes() const;
  /// These, and what was noted of a log.
  [[nodiscard]] std::vector<std::string> notes_with(const MotionReport& log) const;
};

/// On standard error, where no notes of a result say them.
void say_warnings(const RobotInputs& inputs);

/// What complaints and notes about a log call options of the command.
[[nodiscard]] MotionOptionNames names_of_options();

/// Every how many samples of a log of this rate (Hz) count: five a period of the filter's cutoff
/// say all that is left in the signals.
[[nodiscard]] std::size_t stride_of(const MotionInputs& inputs, double rate);

/// Throws InputError for a log that flows by, which can be read once only.
void check_no_stream(const std::string& log);

/// Reads URDF, robot.yaml and mapping.yaml. The root is floating if the log has an IMU. Throws
/// InputError also for contacts that cannot be treated as asked for.
[[nodiscard]] RobotInputs read_robot(const MotionInputs& inputs);
/// The same for a log whose header is read already, as a stream's must be.
[[nodiscard]] RobotInputs read_robot(const MotionInputs& inputs, const LogTable& log);

/// What becomes of contact forces: as asked for, or nothing where nothing touches. Throws
/// InputError for a threshold of derived contacts where none are derived.
[[nodiscard]] ContactTreatment contact_treatment(const MotionInputs& inputs, const Robot& robot);

/// Share of the robot's weight that a foot must carry: as given, or the usual one.
[[nodiscard]] double contact_threshold(const MotionInputs& inputs);

/// Derives contacts for logs without flags, from the model that is given. The robot must outlive
/// it.
[[nodiscard]] ContactRule contact_rule(const MotionInputs& inputs, const Robot& robot);

/// Diagonal of W: 1 / sigma^2 of "tau.<joint>" (or "tau" for all joints) and of "base.force" (N)
/// and "base.moment" (N m); ones where robot.yaml says nothing.
[[nodiscard]] Eigen::VectorXd weight(const RobotInputs& inputs);

/// robot.yaml beside the URDF, under the URDF's name or plainly; empty if there is none.
[[nodiscard]] std::string robot_yaml_beside(const std::string& urdf);
/// That such a file is used, for people to read.
[[nodiscard]] std::string remark_beside(const std::string& robot_yaml);

/// Throws InputError where contact forces are to be used that the log does not have.
void check_forces(const std::string& log, ContactTreatment contacts, bool are_logged);

/// Indices of the links that `--free` names, in the robot's order, each once. Throws InputError for
/// a name that is not there.
[[nodiscard]] std::vector<int> named_links(const std::vector<std::string>& names,
                                           const Robot& robot);
/// All links but a fixed root, which never moves.
[[nodiscard]] std::vector<int> moving_links(const Robot& robot);

/// A log as samples, with progress on a terminal. Keeps its report for the result.
class LogSamples {
 public:
  LogSamples(const std::string& path, const RobotInputs& robot, const MotionInputs& inputs);

  std::optional<Sample> next();
  [[nodiscard]] const MotionReport& report() const { return reader_.report(); }
  [[nodiscard]] ContactTreatment contacts() const { return contacts_; }

 private:
  MotionReader reader_;
  ContactTreatment contacts_;
  bool quiet_;
  std::size_t count_ = 0;
};

/// Of every five stretches of two seconds one is held out, the last unless another one is chosen;
/// samples close to its ends are used for neither side, because the smoothing filter reaches
/// across.
enum class Part { fitted, held_out, neither };
/// Of the time (s) since the log began, for the stretch and the filter of these inputs.
[[nodiscard]] Part part_of(double time_since_start, const MotionInputs& inputs);

/// Throws Refusal, which says where they went, if a log that was read has no sample.
void refuse_without_samples(const MotionReport& log);

/// Throws Refusal if a log has samples, none of which is in a stretch to be fitted.
void refuse_all_held_out(std::size_t samples);

/// What is held out, for people to read.
[[nodiscard]] std::string held_out_words(const MotionInputs& inputs);

/// Adds --hold-out to a verb that has --test.
void add_hold_out_option(CLI::App& verb, MotionInputs& inputs);

}  // namespace shapeid::app

// From a log to samples: the same filter over every channel, derivatives, gaps, contacts.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/butterworth.hpp"
#include "shapeid/models/log.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/models/segment_filter.hpp"

namespace shapeid {

/// Which contacts touch in a sample whose flags are not logged, one entry a contact of the robot;
/// empty if it cannot be told, and the sample is dropped.
using ContactRule = std::function<std::optional<std::vector<bool>>(const Sample&)>;

/// The filter mixes what was before a change of contact with what came after.
enum class ContactChange {
  widen,  ///< near a touch the contact counts as touching: this costs rows, and is never wrong
  drop    ///< samples near any change are left out
};

/// What complaints and notes call these options: a command has names of its own for them.
struct MotionOptionNames {
  std::string cutoff = "cutoff", rate = "rate", derive_contacts = "derive_contacts";
};

struct MotionOptions {
  MotionOptionNames names;
  Smoothing smoothing = Smoothing::zero_phase;
  double cutoff = 20.0;  ///< Hz, -3 dB of one pass; the same for joints, IMU, torque and force
  int order = log_filter_order;  ///< of one pass, 1 to 8
  double rate = 0.0;  ///< Hz of the regular grid; 0: the log's median rate. Not below that.
  /// Joint velocities from the logged dq instead of the differentiated q, and accelerations from
  /// its first derivative instead of q's second. Drives often log a velocity that is a sample late
  /// or filtered on its own, so this is not the default.
  bool use_logged_velocity = false;
  /// Logged dq, ddq and base.gyrodot are used as they are (simulation). Nothing is resampled,
  /// filtered or differentiated, and `smoothing` does not count.
  bool exact_derivatives = false;
  /// Decides contacts when the log has no contact columns, e.g. from -J^-T (tau - given model).
  ContactRule derive_contacts;
  /// Refuse the log of a robot with contacts if it has no contact columns and nothing decides them.
  /// Otherwise its samples have no flags.
  bool contacts_needed = true;
  /// What becomes of samples near a change of contact.
  ContactChange at_contact_change = ContactChange::widen;
  /// s before and after a change that count as near. Empty: 1 / (2 cutoff), and 0.8 / cutoff after
  /// a change where `smoothing` is causal (docs/derivations/filtering.md); 0: every sample keeps
  /// its flags.
  std::optional<double> contact_margin;
  /// Refuse a floating log whose accelerometer does not read about 9.81 m/s^2 on average while
  /// something carries the robot. Turn off for free fall without contact flags.
  bool expect_gravity = true;
  /// Refuse logs in which an IMU channel, or a torque other than zero, never changes while joints
  /// move.
  bool refuse_frozen = true;
};

/// What preparing a log did, for the report of a run.
struct MotionReport {
  std::size_t rows = 0;          ///< in the log
  std::size_t samples = 0;       ///< handed out
  std::size_t gaps = 0;          ///< between segments
  std::size_t dropped_rows = 0;  ///< by the mapping's row filter
  /// Grid rows lost at the ends of segments, and in segments too short to filter.
  std::size_t dropped_at_ends = 0;
  /// Samples lost because a contact is not known, or (with drop) changes within the margin.
  std::size_t dropped_at_contacts = 0;
  double rate = 0.0;         ///< Hz; 0 for a single row with exact derivatives
  double group_delay = 0.0;  ///< s, at low frequency, of all channels alike; 0 for zero_phase
  bool floating = false;     ///< the log has base.* columns
  bool contacts_logged = false, contacts_derived = false, forces_logged = false;
  std::vector<std::string> extra;  ///< columns that are neither ours nor mapped
  std::vector<std::string> notes;
};

/// Streams the samples of a log in fixed memory. Throws InputError for bad input: a clock that runs
/// backwards, units that cannot be (degrees), torque that is a current, missing columns.
class MotionReader {
 public:
  /// `path` "-" reads standard input. `robot` must outlive the reader; its order of joints and
  /// contacts is the samples' order. IMU channels are turned and moved from notes.imu to the base.
  MotionReader(const std::string& path, const Robot& robot, const RobotNotes& notes,
               const std::optional<Mapping>& mapping, const MotionOptions& options);
  ~MotionReader();
  MotionReader(MotionReader&&) noexcept;
  MotionReader& operator=(MotionReader&&) noexcept;
  MotionReader(const MotionReader&) = delete;
  MotionReader& operator=(const MotionReader&) = delete;

  [[nodiscard]] std::optional<Sample> next();
  /// Complete once next() has returned empty.
  [[nodiscard]] const MotionReport& report() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Gives the robot a point contact at the origin of every link that the log has a contact.<link>
/// column for, unless it has contacts already (robot.yaml). Throws InputError for unknown links.
void add_default_contacts(Robot& robot, const LogTable& log, const std::optional<Mapping>& mapping);
void add_default_contacts(Robot& robot, const std::string& log_path,
                          const std::optional<Mapping>& mapping);

}  // namespace shapeid

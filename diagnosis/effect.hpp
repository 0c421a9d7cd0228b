// What a model may lack: an equation with a few parameters, at a place of the robot.
//
// With effects the dynamics read   Y Phi + E theta = S^T tau + J^T f   in generalised order: a
// column of E is the force that the joints must provide besides what the rigid links ask for, per
// unit of its parameter. Friction b dq of joint j is the column dq_j in row j.
#pragma once

#include <Eigen/Core>

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/reference/kinematics.hpp"

namespace shapeid::diagnosis {

/// Where an effect can sit. The site's number is the index of the joint, link or contact; 0 for the
/// accelerometer and for the whole robot.
enum class SiteKind { joint, link, accelerometer, contact, whole };

/// A number that an effect has at its site.
struct Parameter {
  std::string name;
  std::string unit;
  bool nonnegative = false;
  /// A usual size in the unit. Derivatives are taken over a small part of it.
  double size = 1.0;
  /// Values beyond this are not believed; what is linearised has a range.
  double limit = std::numeric_limits<double>::infinity();
};

/// A number that the columns do not depend on linearly, found by an outer search.
struct ShapeNumber {
  std::string name;
  std::string unit;
  double lower = 0.0, upper = 0.0, start = 0.0;  ///< positive; searched in the logarithm
  /// Relative range of the search about where screening found it; 0: from lower to upper.
  double nearby = 0.0;
  /// A time, s: screening finds it to a block of the log, so it is sought evenly within one.
  bool is_moment = false;
};

/// What a sample's neighbours in the log tell of it.
struct Surroundings {
  double elapsed = 0.0;                            ///< s since the log began (Recording)
  Eigen::Vector3d down = Eigen::Vector3d::Zero();  ///< Recording::down()
  /// s since each contact was declared to touch for the last time, and until it will be: 0 while it
  /// is, infinity if the segment does not say.
  Eigen::VectorXd since_touch = {}, until_touch = {};
};

/// One instant as the present model sees it.
struct Instant {
  const Robot& robot;
  const Sample& sample;
  const std::vector<reference::LinkMotion>& motions;  ///< of all links, at this sample
  /// Predicted joint torques of the rigid links, n, with contact forces from the base's balance.
  /// Measured torque is only in what that leaves open (predicted_load()).
  const Eigen::VectorXd& load;
  /// Its change a second, n (Effect::filters_load): about the time constant ago of the filter that
  /// the model has at the joint, now where it has none (load_rates()).
  const Eigen::VectorXd& load_rate;
  const Surroundings& surroundings;
};

/// An instant with its neighbours: `at(dt)` is the sample dt seconds later, interpolated. dt stays
/// within largest_shift.
struct Moment {
  const Sample& now;
  std::function<Sample(double)> at;
  Surroundings surroundings = {};
};

/// s: how far one effect may look to either side, and how far several together.
inline constexpr double largest_delay = 0.018;
inline constexpr double largest_shift = 2.0 * largest_delay + 0.004;

/// The matrices of one sample, in generalised order, before weights and projection.
struct Rows {
  Eigen::MatrixXd E;  ///< everything that predicts: [Y, columns of effects], dof x any
  Eigen::MatrixXd J;  ///< contact Jacobian, contact rows x dof
};

/// An effect that is not a column but changes what the others are computed from. Its values are the
/// parameters themselves; any of the three functions may be absent. The logged torque, which is
/// what all models are scored against, is never changed.
struct Transformation {
  void (*robot)(Robot&, int site, const Eigen::VectorXd& value) = nullptr;
  Sample (*sample)(const Moment&, int site, const Eigen::VectorXd& value) = nullptr;
  /// `down`: where gravity pulls, in base axes, of unit length (floating bases).
  void (*rows)(const Robot&, const Sample&, const Eigen::Vector3d& down, int site,
               const Eigen::VectorXd& value, Rows&) = nullptr;

  /// `rows` multiplies: it comes last, whatever stands behind it in a list.
  bool scales = false;

  [[nodiscard]] bool any() const {
    return robot != nullptr || sample != nullptr || rows != nullptr;
  }
};

/// Statements of C++ with which the identified effect predicts joint torque. They see `j` (the
/// site's number), the parameters and shape numbers by name, and arrays over the joints.
struct TorqueCode {
  std::string motion;  ///< before the rigid links: changes q, dq, ddq
  std::string link;    ///< between: `at` (torque_header.cpp) has the links' motion and wrenches
  /// After them: changes tau; load[j] holds what the rigid links ask for, load_rate[j] its change a
  /// second (Effect::filters_load).
  std::string torque;
};

struct Effect {
  std::string id;        ///< stable: results and files name it
  std::string title;     ///< in a few words
  std::string equation;  ///< what it adds to tau, or what it changes
  SiteKind site = SiteKind::joint;
  std::vector<Parameter> parameters;
  std::vector<ShapeNumber> shape;
  std::vector<std::string> confused_with;  ///< ids, or what else looks like it
  std::string separate_by;                 ///< the experiment that tells it from those
  std::string under_contact;               ///< what the contact projection hides of it
  std::string source;                      ///< where the equation comes from

  /// Whether the site exists on this robot.
  bool (*applies)(const Robot&, int site) = nullptr;
  /// What it adds per unit of each parameter: dof x parameters.
  Eigen::MatrixXd (*columns)(const Instant&, int site, const Eigen::VectorXd& shape) = nullptr;
  /// It is sought before all others, and by itself (contact_flags.hpp).
  bool sought_first = false;
  /// What the robot is built of: it is not among what may have come since a reference log.
  bool built_in = false;
  /// Fitted as a rule, whatever the drive: what the found model is compared with (usual.hpp), and
  /// where a second search for causes begins.
  bool is_usual = false;
  /// Its one value is the time constant of a filter of the load, s, and its column uses
  /// Instant::load_rate, which costs two more instants.
  bool filters_load = false;
  /// Instead of columns.
  Transformation transform;
  /// The columns are the link's own ten of Y, at all times or from the onset (its shape number) on.
  bool is_payload = false;
  TorqueCode code;
};

/// When an effect acts, where there is a reference log. What came is on top of what was at its
/// place already; what went was in the reference log on top of what is there still.
enum class When { always, since_reference, gone };
inline constexpr std::array every_when = {When::always, When::since_reference, When::gone};

/// An effect at a place with its numbers.
struct AppliedEffect {
  const Effect* effect = nullptr;
  int site = 0;
  Eigen::VectorXd shape;  ///< one for each of Effect::shape
  Eigen::VectorXd value;  ///< one for each of Effect::parameters
  When when = When::always;
  /// Of what filters the load (Effect::filters_load): as far as it is linear in its time constant.
  bool to_first_order = false;
  /// Whether it is there from some moment of the log on.
  [[nodiscard]] bool begins() const { return effect->is_payload && !effect->shape.empty(); }
  [[nodiscard]] bool acts_in_reference() const {
    return when != When::since_reference && !begins();
  }
  [[nodiscard]] bool acts_in_log() const { return when != When::gone; }
};

/// The same effect at the same place and time. What changes samples is at its place once, whenever:
/// how far all together may look in time has a limit (largest_shift).
[[nodiscard]] bool same_place(const AppliedEffect& a, const AppliedEffect& b);
/// The same effect at the same site, at whatever time and with whatever shape.
[[nodiscard]] bool same_law(const AppliedEffect& a, const AppliedEffect& b);
/// Whether one of them is the same effect at the same place.
[[nodiscard]] bool has_place_of(const std::vector<AppliedEffect>& effects, const AppliedEffect& a);

/// The largest of an effect's numbers over the limit up to which it is believed; of forces that is
/// `most_force` (N).
[[nodiscard]] double over_limit(const Effect& effect, const Eigen::VectorXd& value,
                                double most_force);

/// Names of places: a joint, a link, a contact, "base.accel" or "all". Of several contacts on one
/// link the second is "LINK #2".
[[nodiscard]] std::string site_name(const Robot& robot, SiteKind kind, int site);
/// How many sites of a kind the robot has.
[[nodiscard]] int site_count(const Robot& robot, SiteKind kind);

/// Contact forces of least norm that carry a floating base, J_base^T f = (Y Phi)_base: no measured
/// torque is in them. `YPhi` is without what measured contact forces carry.
[[nodiscard]] Eigen::VectorXd carrying_forces(const Robot& robot, const Eigen::VectorXd& YPhi,
                                              const Eigen::MatrixXd& J);

/// Of contact forces that push against each other those are taken for zero of which joints feel
/// less than this part of the norm of J's joint columns: a torque's noise would make a hundred
/// times itself of them.
inline constexpr double least_lever = 0.01;

/// Predicted joint torques Y Phi - J^T f. Of all contact forces f that carry the base (any, on a
/// fixed one) these come closest to the logged torque: nothing else tells what feet push against
/// each other. `applied` is S^T tau, dof; `YPhi` is without what measured contact forces carry.
struct PredictedLoad {
  Eigen::VectorXd force;  ///< contact rows of J
  Eigen::VectorXd joint;  ///< n
  Eigen::VectorXd rate;   ///< Instant::load_rate, N m/s, n; zero where nobody asks for it
};
[[nodiscard]] PredictedLoad predicted_load(const Robot& robot, const Eigen::VectorXd& applied,
                                           const Eigen::VectorXd& YPhi, const Eigen::MatrixXd& J);

}  // namespace shapeid::diagnosis

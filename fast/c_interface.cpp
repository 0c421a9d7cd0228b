#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "shapeid/fast/identifier.hpp"
#include "shapeid/fast/shapeid.h"
#include "shapeid/models/error.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/sample_builder.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/models/version.hpp"

using shapeid::BodyModel;
using shapeid::ContactTreatment;
using shapeid::InputError;
using shapeid::Robot;
using shapeid::Sample;
using shapeid::fast::Division;
using shapeid::fast::Identifier;
using shapeid::fast::IdentifierSettings;
using shapeid::fast::Outcome;

struct shapeid_identifier {
  shapeid_identifier(const Robot& robot, const Eigen::Isometry3d& imu_pose, const BodyModel& model,
                     const IdentifierSettings& settings);

  Identifier identifier;
  Sample sample;  ///< with room for all that a feed copies
  Eigen::VectorXd rotor_inertias;
  Eigen::Isometry3d imu;
  std::size_t shapes;
  std::vector<std::string> joints, contacts, free_links;
  bool answered = false;
  bool completed = false;  ///< a window, answered or not
};

shapeid_identifier::shapeid_identifier(const Robot& robot, const Eigen::Isometry3d& imu_pose,
                                       const BodyModel& model, const IdentifierSettings& settings)
    : identifier(robot, model, settings),
      rotor_inertias(shapeid::rotor_inertias(robot)),
      imu(imu_pose),
      shapes(model.shapes.size()) {
  sample.q = sample.dq = sample.ddq = sample.tau = Eigen::VectorXd::Zero(robot.joint_count());
  sample.in_contact.resize(robot.contacts.size());
  sample.contact_force.reserve(robot.contacts.size());
  for (int j = 0; j < robot.joint_count(); ++j) joints.push_back(robot.joint(j).name);
  for (const shapeid::Contact& contact : robot.contacts) contacts.push_back(contact.name);
  for (const int link : model.free_links) {
    free_links.push_back(robot.links[static_cast<std::size_t>(link)].name);
  }
}

namespace {

ContactTreatment treatment_of(shapeid_contacts contacts) {
  switch (contacts) {
    case SHAPEID_PROJECT_CONTACTS:
      return ContactTreatment::project;
    case SHAPEID_MEASURED_CONTACTS:
      return ContactTreatment::measured;
    case SHAPEID_IGNORE_CONTACTS:
      return ContactTreatment::ignore;
  }
  throw InputError("no such treatment of contacts", "a value of shapeid_contacts");
}

shapeid::Root root_of(shapeid_root root) {
  switch (root) {
    case SHAPEID_FLOATING_ROOT:
      return shapeid::Root::floating;
    case SHAPEID_FIXED_ROOT:
      return shapeid::Root::fixed;
  }
  throw InputError("no such root", "a value of shapeid_root");
}

BodyModel model_of(const char* shapes_yaml, const Robot& robot) {
  if (shapes_yaml != nullptr) return shapeid::read_shapes_yaml(shapes_yaml, robot);
  if (robot.root == shapeid::Root::fixed) {
    throw InputError("which links are sought is not said",
                     "give a shapes.yaml (a fixed base has no dynamics)");
  }
  return shapeid::default_shapes(robot, {0});
}

/// Counted before anything is read: a negative count in C comes as more than there is.
Eigen::VectorXd weight_of(const shapeid_settings& given, const Robot& robot) {
  if (given.weight == nullptr && given.weight_count == 0) return {};
  const auto equations = static_cast<std::size_t>(robot.dof());
  if (given.weight == nullptr || given.weight_count != equations) {
    throw InputError("weight and weight_count are not those of the robot's equations",
                     "NULL and 0, or " + std::to_string(equations) + " numbers");
  }
  return Eigen::Map<const Eigen::VectorXd>(given.weight, robot.dof());
}

IdentifierSettings settings_of(const shapeid_settings& given, const Robot& robot,
                               double usual_mass) {
  IdentifierSettings settings;
  settings.contacts = treatment_of(given.contacts);
  settings.weight = weight_of(given, robot);
  settings.window = given.window;
  settings.stride = given.stride;
  settings.alpha = given.alpha;
  settings.expected_mass = given.expected_mass == 0.0 ? usual_mass : given.expected_mass;
  if (!(given.lambda < 0.0)) settings.lambda = given.lambda;
  if (given.mass_bound != 0.0) settings.mass_bound = given.mass_bound;
  settings.division.most_divisions = given.most_divisions;
  settings.division.step = given.division_step;
  settings.division.patience = given.division_patience;
  return settings;
}

std::unique_ptr<shapeid_identifier> create(const char* urdf, const char* robot_yaml,
                                           const char* shapes_yaml, const shapeid_settings& given) {
  if (urdf == nullptr) throw InputError("no URDF is named", "the path of a file");
  shapeid::UrdfOptions options;
  options.root = root_of(given.root);
  options.accepted_by.clear();  // in C there is no way
  Robot robot = shapeid::read_urdf(urdf, options).robot;
  shapeid::RobotNotes notes;
  if (robot_yaml != nullptr) notes = shapeid::read_robot_yaml(robot_yaml, robot);
  const BodyModel model = model_of(shapes_yaml, robot);
  const double usual_mass = shapeid::expected_mass(robot, notes, model.free_links);
  return std::make_unique<shapeid_identifier>(robot, notes.imu, model,
                                              settings_of(given, robot, usual_mass));
}

shapeid_stop stop_of(Division::Stop stop) noexcept {
  switch (stop) {
    case Division::Stop::limit:
      return SHAPEID_STOP_LIMIT;
    case Division::Stop::step:
      return SHAPEID_STOP_STEP;
    case Division::Stop::nothing_divisible:
      return SHAPEID_STOP_NOTHING_DIVISIBLE;
    case Division::Stop::declined:
      break;
  }
  return SHAPEID_STOP_DECLINED;
}

shapeid_outcome outcome_of(Outcome outcome) noexcept {
  switch (outcome) {
    case Outcome::solved:
      return SHAPEID_OUTCOME_SOLVED;
    case Outcome::not_finite:
      return SHAPEID_OUTCOME_NOT_FINITE;
    case Outcome::ill_conditioned:
      return SHAPEID_OUTCOME_ILL_CONDITIONED;
    case Outcome::too_many_steps:
      return SHAPEID_OUTCOME_TOO_MANY_STEPS;
    case Outcome::out_of_scale:
      break;
  }
  return SHAPEID_OUTCOME_OUT_OF_SCALE;
}

void say(const char* message, char* error, size_t error_size) noexcept {
  if (error == nullptr || error_size == 0) return;
  const std::size_t length = std::min(std::strlen(message), error_size - 1);
  std::memcpy(error, message, length);
  error[length] = '\0';
}

const char* name_at(const std::vector<std::string>& names, size_t place) noexcept {
  return place < names.size() ? names[place].c_str() : nullptr;
}

/// Empty arrays may be anything, also NULL.
bool is_there(const double* numbers, size_t count) noexcept {
  return numbers != nullptr || count == 0;
}

bool fits(const shapeid_identifier& of, const shapeid_sample& sample) noexcept {
  const size_t joints = sample.joint_count;
  return joints == of.joints.size() && sample.contact_count == of.contacts.size() &&
         is_there(sample.q, joints) && is_there(sample.dq, joints) &&
         is_there(sample.ddq, joints) && is_there(sample.tau, joints);
}

void copy(const shapeid_sample& from, const Eigen::VectorXd& rotor_inertias, Sample& to) noexcept {
  to.time = from.time;
  std::copy_n(from.base_angular_velocity, 3, to.base_angular_velocity.data());
  std::copy_n(from.base_angular_acceleration, 3, to.base_angular_acceleration.data());
  std::copy_n(from.base_specific_force, 3, to.base_specific_force.data());
  std::copy_n(from.q, from.joint_count, to.q.data());
  std::copy_n(from.dq, from.joint_count, to.dq.data());
  std::copy_n(from.ddq, from.joint_count, to.ddq.data());
  std::copy_n(from.tau, from.joint_count, to.tau.data());
  to.tau -= rotor_inertias.cwiseProduct(to.ddq);
  to.contact_force.clear();
  for (size_t c = 0; c < from.contact_count; ++c) {
    to.in_contact[c] = from.in_contact != nullptr && from.in_contact[c] != 0;
    if (from.contact_force != nullptr) to.contact_force.emplace_back(from.contact_force + 3 * c);
  }
}

const double* ten_of(const Eigen::VectorXd& all, size_t link) noexcept {
  // No product of a number that may be any.
  const auto links = static_cast<size_t>(all.size()) / 10;
  return link < links ? all.data() + 10 * link : nullptr;
}

}  // namespace

const char* shapeid_version(void) { return shapeid::version; }

void shapeid_default_settings(shapeid_settings* settings) {
  if (settings == nullptr) return;
  const IdentifierSettings usual;
  *settings = shapeid_settings{.root = SHAPEID_FLOATING_ROOT,
                               .contacts = SHAPEID_PROJECT_CONTACTS,
                               .weight = nullptr,
                               .weight_count = 0,
                               .window = usual.window,
                               .stride = usual.stride,
                               .alpha = usual.alpha,
                               .expected_mass = 0.0,
                               .lambda = -1.0,
                               .mass_bound = 0.0,
                               .most_divisions = usual.division.most_divisions,
                               .division_step = usual.division.step,
                               .division_patience = usual.division.patience};
}

shapeid_identifier* shapeid_create(const char* urdf, const char* robot_yaml,
                                   const char* shapes_yaml, const shapeid_settings* settings,
                                   char* error, size_t error_size) {
  shapeid_settings usual;
  shapeid_default_settings(&usual);
  try {
    return create(urdf, robot_yaml, shapes_yaml, settings != nullptr ? *settings : usual).release();
  } catch (const std::bad_alloc&) {
    say("memory is used up; a shorter window, fewer divisions or shapes", error, error_size);
  } catch (const std::exception& e) {
    say(e.what(), error, error_size);
  } catch (...) {
    say("an exception that is no std::exception", error, error_size);
  }
  return nullptr;
}

void shapeid_destroy(shapeid_identifier* identifier) {
  const std::unique_ptr<shapeid_identifier> last(identifier);
}

size_t shapeid_joint_count(const shapeid_identifier* identifier) {
  return identifier != nullptr ? identifier->joints.size() : 0;
}
size_t shapeid_contact_count(const shapeid_identifier* identifier) {
  return identifier != nullptr ? identifier->contacts.size() : 0;
}
size_t shapeid_free_link_count(const shapeid_identifier* identifier) {
  return identifier != nullptr ? identifier->free_links.size() : 0;
}
size_t shapeid_shape_count(const shapeid_identifier* identifier) {
  return identifier != nullptr ? identifier->shapes : 0;
}

const char* shapeid_joint_name(const shapeid_identifier* identifier, size_t place) {
  return identifier != nullptr ? name_at(identifier->joints, place) : nullptr;
}
const char* shapeid_contact_name(const shapeid_identifier* identifier, size_t place) {
  return identifier != nullptr ? name_at(identifier->contacts, place) : nullptr;
}
const char* shapeid_free_link_name(const shapeid_identifier* identifier, size_t place) {
  return identifier != nullptr ? name_at(identifier->free_links, place) : nullptr;
}

void shapeid_set_base(const shapeid_identifier* identifier, const double gyro[3],
                      const double gyro_derivative[3], const double accelerometer[3],
                      shapeid_sample* sample) {
  if (identifier == nullptr || gyro == nullptr || gyro_derivative == nullptr ||
      accelerometer == nullptr || sample == nullptr) {
    return;
  }
  Sample base;
  shapeid::set_base(identifier->imu, Eigen::Vector3d(gyro), Eigen::Vector3d(gyro_derivative),
                    Eigen::Vector3d(accelerometer), base);
  std::copy_n(base.base_angular_velocity.data(), 3, sample->base_angular_velocity);
  std::copy_n(base.base_angular_acceleration.data(), 3, sample->base_angular_acceleration);
  std::copy_n(base.base_specific_force.data(), 3, sample->base_specific_force);
}

void shapeid_forget_samples(shapeid_identifier* identifier) {
  if (identifier != nullptr) identifier->identifier.forget_samples();
}

shapeid_status shapeid_feed(shapeid_identifier* identifier, const shapeid_sample* sample) {
  if (identifier == nullptr || sample == nullptr || !fits(*identifier, *sample)) {
    return SHAPEID_WRONG_ARGUMENT;
  }
  copy(*sample, identifier->rotor_inertias, identifier->sample);
  switch (identifier->identifier.feed(identifier->sample)) {
    case Identifier::Fed::kept:
      return SHAPEID_KEPT;
    case Identifier::Fed::answered:
      identifier->answered = identifier->completed = true;
      return SHAPEID_ANSWERED;
    case Identifier::Fed::sample_declined:
      return SHAPEID_SAMPLE_DECLINED;
    case Identifier::Fed::window_declined:
      break;
  }
  identifier->completed = true;
  return SHAPEID_WINDOW_DECLINED;
}

shapeid_outcome shapeid_last_outcome(const shapeid_identifier* identifier) {
  if (identifier == nullptr || !identifier->completed) return SHAPEID_OUTCOME_NONE;
  return outcome_of(identifier->identifier.outcome());
}

shapeid_status shapeid_get_answer(const shapeid_identifier* identifier, shapeid_answer* answer) {
  if (identifier == nullptr || answer == nullptr) return SHAPEID_WRONG_ARGUMENT;
  const shapeid::fast::WindowAnswer& last = identifier->identifier.answer();
  *answer = shapeid_answer{.time = last.time,
                           .objective = last.value.total(),
                           .gap = last.gap,
                           .iterations = last.iterations,
                           .divisions = last.divisions,
                           .stopped_by = stop_of(last.stopped_by),
                           .window_seconds = last.seconds,
                           .slowest_sample_seconds = last.slowest_sample,
                           .last_call_seconds = last.last_call};
  return identifier->answered ? SHAPEID_ANSWERED : SHAPEID_KEPT;
}

const double* shapeid_parameters(const shapeid_identifier* identifier, size_t free_link) {
  return identifier != nullptr ? ten_of(identifier->identifier.Phi(), free_link) : nullptr;
}

const double* shapeid_filtered_parameters(const shapeid_identifier* identifier, size_t free_link) {
  return identifier != nullptr ? ten_of(identifier->identifier.filtered(), free_link) : nullptr;
}

const double* shapeid_masses(const shapeid_identifier* identifier) {
  return identifier != nullptr ? identifier->identifier.undivided_masses().data() : nullptr;
}

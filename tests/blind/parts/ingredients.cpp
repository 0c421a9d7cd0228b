#include "shapeid/tests/blind/parts/ingredients.hpp"

#include <cmath>
#include <stdexcept>

#include "shapeid/tests/blind/parts/foreign.hpp"
#include "shapeid/tests/blind/parts/rotor.hpp"

namespace shapeid::blind {
namespace {

constexpr double width = 0.02;          // rad/s: where dry friction turns round
constexpr double stribeck_speed = 0.2;  // rad/s
constexpr double ripple = 14.0;         // 1/rad

using Forces = DisturbingForces;
using State = DisturbedState;

/// A torque that the drive has to overcome at one joint.
template <typename Law>
void resist(Ingredients& in, int joint, Law law) {
  in.forces.emplace_back([joint, law](const State& s, Forces& f) {
    f.joint[joint] -= law(s.q[joint], s.dq[joint], s.drive[joint]);
  });
}

/// Something that every reading goes through.
template <typename Change>
void change_each(Ingredients& in, Change change) {
  in.signals.emplace_back([change](Readings& readings) {
    for (Reading& r : readings) change(r);
  });
}

void viscous(Ingredients& in, const Machine&, const Amount& a) {
  resist(in, a.site, [b = a.size](double, double dq, double) { return b * dq; });
}
void coulomb(Ingredients& in, const Machine&, const Amount& a) {
  resist(in, a.site, [c = a.size](double, double dq, double) { return c * std::tanh(dq / width); });
}
void stribeck(Ingredients& in, const Machine&, const Amount& a) {
  resist(in, a.site, [s = a.size](double, double dq, double) {
    return s * std::exp(-dq * dq / (stribeck_speed * stribeck_speed)) * std::tanh(dq / width);
  });
}
void load_friction(Ingredients& in, const Machine&, const Amount& a) {
  // drive = load + mu |load| step, solved for the load.
  resist(in, a.site, [mu = a.size](double, double dq, double drive) {
    const double step = mu * std::tanh(dq / width);
    return drive - drive / (1.0 + (drive > 0.0 ? step : -step));
  });
}
void spring(Ingredients& in, const Machine&, const Amount& a) {
  resist(in, a.site, [k = a.size](double q, double, double) { return k * q; });
}
void cogging(Ingredients& in, const Machine&, const Amount& a) {
  resist(in, a.site, [s = a.size](double q, double, double) {
    return s * (0.8 * std::cos(ripple * q) + 0.6 * std::sin(ripple * q));
  });
}
// The motor turns its rotor besides: of the same motion it asks for I ddq more. The controller
// then is one that knows of the rotor.
void rotor(Ingredients& in, const Machine&, const Amount& a) {
  change_each(in, [a](Reading& r) { r.sample.tau[a.site] += a.size * r.sample.ddq[a.site]; });
}
void rotor_reaction(Ingredients& in, const Machine& m, const Amount& a) {
  change_each(in, [a, robot = m.robot](Reading& r) {
    r.sample.tau += a.size * rotor_torque(robot, r.sample, a.site);
  });
}
void torque_offset(Ingredients& in, const Machine&, const Amount& a) {
  change_each(in, [a](Reading& r) { r.sample.tau[a.site] += a.size; });
}
void torque_gain(Ingredients& in, const Machine&, const Amount& a) {
  change_each(in, [a](Reading& r) { r.sample.tau[a.site] *= 1.0 + a.size; });
}
/// The drive reports its torque through a filter of first order; size is its time constant, s.
/// Between readings the torque goes straight: a constant one would be half an interval late or
/// early, which is as much as the smallest lags.
void torque_lag(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    double before = readings.front().sample.tau[a.site], behind = 0.0;
    for (std::size_t i = 1; i < readings.size(); ++i) {
      const double dt = readings[i].sample.time - readings[i - 1].sample.time;
      double& tau = readings[i].sample.tau[a.site];
      const double late = a.size * (tau - before) / dt;
      before = tau;
      behind = late + (behind - late) * std::exp(-dt / a.size);
      tau -= behind;
    }
  });
}
void encoder_offset(Ingredients& in, const Machine&, const Amount& a) {
  change_each(in, [a](Reading& r) { r.sample.q[a.site] -= a.size; });
}
void accel_bias(Ingredients& in, const Machine&, const Amount& a) {
  change_each(in, [a](Reading& r) { r.sample.base_specific_force += a.size * a.direction; });
}
void accel_misalignment(Ingredients& in, const Machine&, const Amount& a) {
  change_each(in, [a](Reading& r) {
    r.sample.base_specific_force =
        Eigen::AngleAxisd(-a.size, a.direction) * r.sample.base_specific_force;
  });
}
/// An accelerometer on a soft mount moves more than the base does.
void accel_noise(Ingredients& in, const Machine&, const Amount& a) {
  change_each(in, [a](Reading& r) {
    const Eigen::Vector3d at_rest = r.attitude.conjugate() * Eigen::Vector3d(0.0, 0.0, 9.81);
    Eigen::Vector3d& force = r.sample.base_specific_force;
    force = at_rest + (force - at_rest) / (1.0 - a.size);
  });
}

void torque_delay(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    delay(
        readings, a.size, [](Sample& to, const Sample& from, double w) { to.tau += w * from.tau; },
        [](Sample& s) { s.tau.setZero(); });
  });
}
void imu_delay(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    delay(
        readings, a.size,
        [](Sample& to, const Sample& from, double w) {
          to.base_specific_force += w * from.base_specific_force;
          to.base_angular_velocity += w * from.base_angular_velocity;
          to.base_angular_acceleration += w * from.base_angular_acceleration;
        },
        [](Sample& s) {
          s.base_specific_force.setZero();
          s.base_angular_velocity.setZero();
          s.base_angular_acceleration.setZero();
        });
  });
}

void gravity_tilt(Ingredients& in, const Machine&, const Amount& a) {
  const Eigen::Vector3d axis = Eigen::Vector3d(a.direction.x(), a.direction.y(), 0.0).normalized();
  // Turned by the tilt in the base's axes gravity is where it is: the base itself turns back.
  Eigen::Isometry3d& first = in.robot.links[1].joint.placement;
  first = Eigen::AngleAxisd(-a.size, axis) * first;
}
void link_length(Ingredients& in, const Machine&, const Amount& a) {
  auto place = in.robot.links[static_cast<std::size_t>(a.site) + 1].joint.placement.translation();
  place += a.size * place.normalized();
}
void contact_point(Ingredients& in, const Machine&, const Amount& a) {
  in.robot.contacts[static_cast<std::size_t>(a.site)].frame.translation() += a.size * a.direction;
}
void foot_radius(Ingredients& in, const Machine&, const Amount& a) {
  in.ground.foot_radius.assign(in.robot.contacts.size(), 0.0);
  in.ground.foot_radius[static_cast<std::size_t>(a.site)] = a.size;
}
/// The flag of a foot follows its touch only so much later; size in s.
void contact_late(Ingredients& in, const Machine&, const Amount& a) {
  change_flags(in, a.site,
               [a](bool touches, double since, double) { return touches && since >= a.size; });
}
/// The flag is gone so much before the foot is.
void contact_short(Ingredients& in, const Machine&, const Amount& a) {
  change_flags(in, a.site,
               [a](bool touches, double, double until) { return touches && until > a.size; });
}
/// The flag stays so much longer than the foot.
void contact_absent(Ingredients& in, const Machine&, const Amount& a) {
  change_flags(in, a.site,
               [a](bool touches, double since, double) { return touches || since < a.size; });
}

void payload(Ingredients& in, const Machine&, const Amount& a) {
  // A second load would take the first one's place, and the seal would tell of what is not there.
  if (in.load) throw std::logic_error("two loads in one trial");
  in.load = Load{a.site, a.size, Eigen::Vector3d::Constant(0.05), {0.01, 0.0, 0.06}};
}
void payload_from(Ingredients& in, const Machine& m, const Amount& a) {
  payload(in, m, a);
  in.load_from = load_moment;
}
void external_force(Ingredients& in, const Machine&, const Amount& a) {
  in.forces.emplace_back([a](const State& s, Forces& f) {
    f.link[static_cast<std::size_t>(a.site)] += s.attitude[0] * (a.size * a.direction);
  });
}
void drag(Ingredients& in, const Machine&, const Amount& a) {
  in.forces.emplace_back([a](const State& s, Forces& f) {
    const auto link = static_cast<std::size_t>(a.site);
    f.link[link] -= a.size * s.velocity[link];
  });
}

std::vector<double> one(const Machine&, const Amount& a) { return {a.size}; }
std::vector<double> three(const Machine&, const Amount& a) {
  const Eigen::Vector3d v = a.size * a.direction;
  return {v.x(), v.y(), v.z()};
}
std::vector<double> spring_values(const Machine&, const Amount& a) { return {a.size, 0.0}; }
std::vector<double> ripple_values(const Machine&, const Amount& a) {
  return {0.8 * a.size, 0.6 * a.size};
}
std::vector<double> tilt_values(const Machine&, const Amount& a) {
  const Eigen::Vector2d v = a.size * a.direction.head<2>().normalized();
  return {v.x(), v.y()};
}
std::vector<double> load_values(const Machine& m, const Amount& a) {
  Ingredients in;
  payload(in, m, a);
  const Vector10 values = inertia_of(*in.load).values;
  return {values.data(), values.data() + values.size()};
}

Kind make(const std::string& id, Place place, bool dynamic, double nominal,
          void (*put)(Ingredients&, const Machine&, const Amount&),
          std::vector<double> (*values)(const Machine&, const Amount&),
          std::vector<double> shape = {}) {
  Kind k;
  k.id = id;
  k.place = place;
  k.dynamic = dynamic;
  k.nominal = nominal;
  k.put = put;
  k.values = values;
  k.shape = std::move(shape);
  return k;
}

std::vector<Kind> list() {
  std::vector<Kind> all = {
      make("viscous_friction", Place::joint, true, 0.3, viscous, one),
      make("coulomb_friction", Place::joint, true, 0.5, coulomb, one, {width}),
      make("stribeck_friction", Place::joint, true, 0.8, stribeck, one, {stribeck_speed, width}),
      make("load_friction", Place::joint, true, 0.1, load_friction, one, {width}),
      make("joint_spring", Place::joint, true, 1.0, spring, spring_values),
      make("cogging", Place::joint, true, 0.5, cogging, ripple_values, {ripple}),
      make("rotor_inertia", Place::joint, false, 0.02, rotor, one),
      make("rotor_reaction", Place::joint, false, 0.002, rotor_reaction, one),
      make("torque_offset", Place::joint, false, 0.3, torque_offset, one),
      make("torque_gain", Place::joint, false, 0.1, torque_gain, one),
      make("torque_lag", Place::joint, false, 0.008, torque_lag, one),
      make("encoder_offset", Place::joint, false, 0.02, encoder_offset, one),
      make("torque_delay", Place::whole, false, 0.004, torque_delay, one),
      make("imu_delay", Place::whole, false, 0.004, imu_delay, one),
      make("accel_bias", Place::accelerometer, false, 0.3, accel_bias, three),
      make("accel_misalignment", Place::accelerometer, false, 0.03, accel_misalignment, three),
      make("accel_noise", Place::accelerometer, false, 0.1, accel_noise, one),
      make("gravity_tilt", Place::whole, true, 0.03, gravity_tilt, tilt_values),
      make("link_length", Place::joint, true, 0.01, link_length, one),
      make("contact_point", Place::contact, true, 0.01, contact_point, three),
      make("foot_radius", Place::contact, true, 0.01, foot_radius, one),
      make("contact_late", Place::contact, false, 0.02, contact_late, nullptr),
      make("contact_short", Place::contact, false, 0.02, contact_short, nullptr),
      make("contact_absent", Place::contact, false, 0.02, contact_absent, nullptr),
      make("payload", Place::link, true, 0.5, payload, load_values),
      make("payload_from", Place::link, true, 0.5, payload_from, load_values, {load_moment}),
      make("external_force", Place::link, true, 8.0, external_force, three),
      make("drag", Place::link, true, 5.0, drag, one),
  };
  for (Kind& k : all) {
    k.largest = 12.0 * k.nominal;
    if (k.id == "torque_delay" || k.id == "imu_delay") k.largest = 0.015;  // s
    if (k.id == "torque_lag") k.largest = 0.03;                            // s
    if (k.id == "torque_gain") k.largest = 0.6;
    if (k.id == "accel_noise") k.largest = 0.7;
    if (k.id == "link_length" || k.id == "contact_point" || k.id == "foot_radius") {
      k.largest = 0.05;  // m
    }
    k.load = k.id == "payload" || k.id == "payload_from";
    if (k.load) k.largest = 3.0;  // kg
    if (k.id == "gravity_tilt" || k.id == "rotor_reaction") k.quadruped = false;
    if (k.id == "imu_delay" || k.place == Place::accelerometer || k.place == Place::contact) {
      k.arm = false;
    }
    k.flags = k.place == Place::contact && k.values == nullptr;
  }
  for (const Kind& k : foreign_kinds()) all.push_back(k);
  return all;
}

}  // namespace

Disturbance Ingredients::disturbance() const {
  if (forces.empty()) return {};
  return [all = forces](const State& state, Forces& sum) {
    for (const auto& force : all) force(state, sum);
  };
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = list();
  return all;
}

const Kind& kind(const std::string& id) {
  for (const Kind& k : kinds()) {
    if (k.id == id) return k;
  }
  throw std::out_of_range("no kind " + id);
}

bool fit_together(const Kind& one, const Kind& other) {
  return one.id != other.id && !(one.load && other.load);
}

std::string place_name(const Machine& machine, Place place, int site) {
  const auto at = static_cast<std::size_t>(site);
  switch (place) {
    case Place::joint:
      return machine.robot.joint(site).name;
    case Place::link:
      return machine.robot.links[at].name;
    case Place::contact:
      return machine.robot.contacts[at].name;
    case Place::accelerometer:
      return "base.accel";
    case Place::whole:
      break;
  }
  return "all";
}

std::vector<int> sites(const Machine& machine, const Kind& kind) {
  std::vector<int> list;
  const Robot& robot = machine.robot;
  if (robot.root == Root::fixed ? !kind.arm : !kind.quadruped) return list;
  const int first_link = robot.root == Root::fixed ? 1 : 0;
  switch (kind.place) {
    case Place::joint:
      for (int j = 0; j < robot.joint_count(); ++j) {
        const Link& link = robot.links[static_cast<std::size_t>(j) + 1];
        constexpr double shortest = 0.02;  // m: what is shorter has no length to be wrong
        const bool long_enough =
            link.parent > 0 && link.joint.placement.translation().norm() > shortest;
        if (kind.id == "link_length" && !long_enough) continue;
        // The drive of a slider is no rotor on its parent.
        if (kind.id == "rotor_reaction" && link.joint.kind == JointKind::prismatic) continue;
        list.push_back(j);
      }
      break;
    case Place::link:
      for (int link = first_link; link < robot.link_count(); ++link) list.push_back(link);
      break;
    case Place::contact:
      for (int c = 0; c < static_cast<int>(robot.contacts.size()); ++c) list.push_back(c);
      break;
    case Place::accelerometer:
    case Place::whole:
      list.push_back(0);
  }
  return list;
}

}  // namespace shapeid::blind

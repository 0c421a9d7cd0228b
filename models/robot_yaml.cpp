#include "shapeid/models/robot_yaml.hpp"

#include <fmt/format.h>

#include <string_view>

#include "shapeid/models/robot_size.hpp"
#include "shapeid/models/yaml_input.hpp"

namespace shapeid {
namespace {

LinkSite site_of(const YamlInput& in, const YAML::Node& node, const std::string& name,
                 const Robot& robot) {
  const std::optional<LinkSite> site = robot.find_site(name);
  if (!site) in.refuse(node, fmt::format("{} has no link {}", robot.name, name), "name a link");
  return *site;
}

ContactKind kind_of(const YamlInput& in, const YAML::Node& node) {
  const std::string kind = in.text(node, "kind");
  if (kind == "point") return ContactKind::point;
  if (kind == "line") return ContactKind::line;
  if (kind == "plane") return ContactKind::plane;
  in.refuse(node, fmt::format("there is no contact of kind {}", kind), "point, line or plane");
}

/// A rotation whose x axis is `axis`.
Eigen::Matrix3d frame_along(const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), axis).toRotationMatrix();
}

void check_on_robot(const YamlInput& in, const YAML::Node& node, const std::string& what,
                    const Eigen::Vector3d& place, const Robot& robot) {
  if (const auto why = why_too_far(place.norm(), robot)) {
    in.refuse(node, fmt::format("{} is {}", what, *why), "metres, on the robot");
  }
}

Contact read_contact(const YamlInput& in, const YAML::Node& node, const Robot& robot) {
  in.check_keys(node, "a contact", {"link"}, {"point", "kind", "axis"});
  Contact contact;
  contact.name = in.text(node["link"], "link");
  const LinkSite site = site_of(in, node["link"], contact.name, robot);
  contact.link = site.link;
  if (node["kind"]) contact.kind = kind_of(in, node["kind"]);
  if (node["point"]) {
    contact.frame.translation() = in.place(node["point"], "point");
    check_on_robot(in, node["point"], "point", contact.frame.translation(), robot);
  }
  const bool line = contact.kind == ContactKind::line;
  if (line && !node["axis"]) {
    in.refuse(node, fmt::format("the line contact of {} does not say which line", contact.name),
              "write axis: [x, y, z], the direction about which no moment acts");
  }
  if (!line && node["axis"]) {
    in.refuse(node["axis"], fmt::format("the contact of {} is no line", contact.name),
              "an axis belongs to kind: line");
  }
  if (line) {
    const Eigen::Vector3d axis = in.three(node["axis"], "axis");
    const double size = axis.cwiseAbs().maxCoeff();
    constexpr double least = 1e-6, most = 1e6;
    if (size == 0.0) in.refuse(node["axis"], "the axis is zero", "write a direction");
    if (!(size >= least && size <= most)) {
      in.refuse(node["axis"], fmt::format("the axis is {:g} long", size), "write a unit vector");
    }
    contact.frame.linear() = frame_along(axis.normalized());
  }
  contact.frame = site.pose * contact.frame;
  return contact;
}

/// Two at one place would be one force named twice.
void check_new(const YamlInput& in, const YAML::Node& node, const Contact& contact,
               const std::vector<Contact>& contacts) {
  constexpr double same = 1e-6;  // m
  for (const Contact& other : contacts) {
    const double apart = (contact.frame.translation() - other.frame.translation()).norm();
    if (contact.link != other.link || apart > same) continue;
    in.refuse(node, fmt::format("{} has a contact at this place already", other.name),
              "name a contact once, or its other points");
  }
}

/// A channel of the log, or a quantity that stands for all of its channels.
bool is_channel(const std::string& name, const Robot& robot) {
  const auto begins = [&](std::string_view prefix) { return name.starts_with(prefix); };
  for (const std::string_view quantity : {"q", "dq", "ddq", "tau"}) {
    if (name == quantity) return true;
    if (begins(fmt::format("{}.", quantity))) {
      return robot.find_joint(name.substr(quantity.size() + 1)).has_value();
    }
  }
  for (const std::string_view quantity :
       {"base.gyro", "base.accel", "base.quat", "base.force", "base.moment"}) {
    if (name == quantity) return true;
  }
  // What remains is one component of a vector.
  if (name.size() < 3 || name[name.size() - 2] != '.') return false;
  const std::string vector = name.substr(0, name.size() - 2);
  const char component = name.back();
  if (vector == "base.quat") return component >= 'w' && component <= 'z';
  if (component < 'x' || component > 'z') return false;
  if (vector == "base.gyro" || vector == "base.accel") return true;
  return vector.starts_with("force.") && robot.find_link(vector.substr(6)).has_value();
}

void read_noise(const YamlInput& in, const YAML::Node& node, const Robot& robot,
                RobotNotes& notes) {
  for (const std::string& channel : in.keys(node, "noise")) {
    if (!is_channel(channel, robot)) {
      in.refuse(node[channel], fmt::format("{} is no channel of a log of {}", channel, robot.name),
                "write q, dq, ddq or tau, alone or with .<joint>, base.gyro, base.accel or "
                "base.quat, alone or with .x, force.<link>.x, base.force or base.moment");
    }
    const double sigma = in.positive(node[channel], "the sigma of " + channel);
    constexpr double least = 1e-12, most = 1e12;
    if (sigma < least || sigma > most) {
      in.refuse(node[channel], fmt::format("the sigma of {} is {:g}", channel, sigma),
                "the standard deviation of its noise, in its own unit");
    }
    notes.noise_sigma[channel] = sigma;
  }
}

/// Inertias behind the gear, one a joint: what turns g times as fast counts g^2 times.
std::vector<double> read_rotors(const YamlInput& in, const YAML::Node& node, const Robot& robot) {
  std::vector<double> inertias(static_cast<std::size_t>(robot.joint_count()), 0.0);
  for (const std::string& name : in.keys(node, "rotors")) {
    const YAML::Node rotor = node[name];
    const std::optional<int> joint = robot.find_joint(name);
    if (!joint) {
      in.refuse(rotor, fmt::format("{} has no moving joint {}", robot.name, name), "name a joint");
    }
    in.check_keys(rotor, "the rotor of " + name, {"inertia", "gear"}, {});
    const double gear = in.positive(rotor["gear"], "gear");
    const double inertia = in.positive(rotor["inertia"], "inertia") * gear * gear;
    constexpr double largest = 1e6;  // kg m^2: more than any robot's link
    if (!(inertia <= largest)) {
      in.refuse(rotor, fmt::format("the rotor of {} counts as {:g} kg m^2", name, inertia),
                "its inertia before the gear, kg m^2, and the gear's ratio");
    }
    inertias[static_cast<std::size_t>(*joint)] = inertia;
  }
  return inertias;
}

void read_masses(const YamlInput& in, const YAML::Node& node, const Robot& robot,
                 RobotNotes& notes) {
  for (const std::string& name : in.keys(node, "expected_mass")) {
    const YAML::Node range = node[name];
    std::string key = name;
    if (name != "load") {
      const int link = site_of(in, range, name, robot).link;
      key = robot.links[static_cast<std::size_t>(link)].name;
    }
    const Eigen::VectorXd bounds = in.numbers(range, "the mass of " + name, 2);
    constexpr double lightest = 1e-6, heaviest = 1e6;  // kg
    if (bounds[0] < 0.0 || bounds[1] <= bounds[0] || bounds[1] > heaviest || bounds[1] < lightest) {
      in.refuse(range,
                fmt::format("the mass of {} lies from {:g} to {:g}", name, bounds[0], bounds[1]),
                "write [lower, upper] in kg, 0 <= lower < upper, upper from 1e-6 to 1e6");
    }
    if (!notes.expected_mass.emplace(key, RobotNotes::MassRange{bounds[0], bounds[1]}).second) {
      in.refuse(range, fmt::format("{} is one rigid body with a link named before", name),
                "give the mass of the whole once");
    }
  }
}

}  // namespace

RobotNotes read_robot_yaml(const std::string& path, Robot& robot) {
  const YamlInput in(path);
  const YAML::Node& root = in.root();
  in.check_keys(root, "robot.yaml", {}, {"imu", "contacts", "noise", "rotors", "expected_mass"});
  RobotNotes notes;
  notes.imu_given = static_cast<bool>(root["imu"]);
  if (notes.imu_given) {
    notes.imu = in.pose(root["imu"], "imu");
    check_on_robot(in, root["imu"], "imu xyz", notes.imu.translation(), robot);
  }
  std::vector<Contact> contacts;
  if (const YAML::Node list = root["contacts"]) {
    if (!list.IsSequence()) in.refuse(list, "contacts is not a list", "write - {link: NAME}");
    for (const YAML::Node& node : list) {
      const Contact contact = read_contact(in, node, robot);
      check_new(in, node, contact, contacts);
      contacts.push_back(contact);
    }
  }
  if (root["noise"]) read_noise(in, root["noise"], robot, notes);
  std::vector<double> rotors;
  if (root["rotors"]) rotors = read_rotors(in, root["rotors"], robot);
  if (root["expected_mass"]) read_masses(in, root["expected_mass"], robot, notes);
  // Nothing has been refused: only now does the robot change.
  notes.contacts_given = static_cast<bool>(root["contacts"]);
  if (notes.contacts_given) robot.contacts = std::move(contacts);
  for (std::size_t j = 0; j < rotors.size(); ++j) {
    robot.links[j + 1].joint.rotor_inertia = rotors[j];
  }
  return notes;
}

double expected_mass(const Robot& robot, const RobotNotes& notes, const std::vector<int>& links) {
  double mass = 0.0;
  for (const int index : links) {
    const Link& link = robot.links[static_cast<std::size_t>(index)];
    const auto range = notes.expected_mass.find(link.name);
    mass += range != notes.expected_mass.end() ? 0.5 * (range->second.lower + range->second.upper)
                                               : link.inertia.mass();
  }
  return mass;
}

}  // namespace shapeid

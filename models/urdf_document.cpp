#include "shapeid/models/urdf_document.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>

#include "shapeid/models/note_list.hpp"
#include "shapeid/models/number.hpp"
#include "shapeid/models/urdf_unread.hpp"
#include "shapeid/models/urdf_xml.hpp"

namespace shapeid::urdf {

using tinyxml2::XMLElement;

namespace {

/// Half a unit of the last digit of a decimal number: 0.5e-4 for "0.0012", 0.5e-7 for "1.2e-6".
/// Numbers without decimals ("0", "3") are taken as exact.
double half_last_digit(std::string_view text) {
  const std::size_t exponent_at = text.find_first_of("eE");
  const std::string_view mantissa = text.substr(0, exponent_at);
  const std::size_t point = mantissa.find('.');
  if (point == std::string_view::npos) return 0.0;
  double exponent = 0.0;
  if (exponent_at != std::string_view::npos) {
    // One that no double holds belongs to a zero.
    constexpr double too_long = std::numeric_limits<double>::infinity();
    exponent = parse_number(text.substr(exponent_at + 1)).value_or(too_long);
  }
  for (const char c : mantissa.substr(point + 1)) exponent -= c >= '0' && c <= '9' ? 1.0 : 0.0;
  const double half = 0.5 * std::pow(10.0, exponent);
  return std::isfinite(half) ? half : 0.0;  // "0.0e999" is a way to write zero
}

Inertial read_inertial(const Reader& read, const XMLElement& element) {
  Inertial result;
  result.line = element.GetLineNum();
  result.origin = read.origin(element);
  result.mass =
      read.number(read.needed_child(element, "mass", "write <mass value=\"...\"/>"), "value");
  const XMLElement& inertia = read.needed_child(
      element, "inertia", "write <inertia ixx ixy ixz iyy iyz izz/>, zero for a point mass");
  const double xy = read.number(inertia, "ixy");
  const double xz = read.number(inertia, "ixz");
  const double yz = read.number(inertia, "iyz");
  // Read before the comma initialiser starts: an exception inside it trips Eigen's own assertion.
  const double xx = read.number(inertia, "ixx"), yy = read.number(inertia, "iyy");
  const double zz = read.number(inertia, "izz");
  result.tensor << xx, xy, xz,  //
      xy, yy, yz,               //
      xz, yz, zz;
  result.rounding = {half_last_digit(inertia.Attribute("ixx")),
                     half_last_digit(inertia.Attribute("iyy")),
                     half_last_digit(inertia.Attribute("izz"))};
  return result;
}

double positive(const Reader& read, const XMLElement& element, const char* attribute) {
  const double value = read.number(element, attribute);
  if (value < 0.0) {
    throw InputError(read.at(element.GetLineNum()),
                     fmt::format("{} of <{}> is negative ({:g})", attribute, element.Name(), value),
                     "write a length in metres");
  }
  return value;
}

/// Empty for a geometry that URDF does not know, such as a simulator's capsule.
std::optional<CollisionBody> read_collision(const Reader& read, const XMLElement& element) {
  CollisionBody body;
  body.pose = read.origin(element);
  const XMLElement& geometry =
      read.needed_child(element, "geometry", "write <geometry> with one shape in it");
  if (const XMLElement* box = read.child(geometry, "box")) {
    const Eigen::Vector3d size = read.three(*box, "size", Eigen::Vector3d::Constant(-1.0));
    if (size.minCoeff() < 0.0) {
      throw InputError(read.at(box->GetLineNum()), "<box> has no size, or a negative one",
                       "write size=\"x y z\" in metres");
    }
    body.geometry = Box{size};
  } else if (const XMLElement* cylinder = read.child(geometry, "cylinder")) {
    body.geometry =
        CylinderGeometry{positive(read, *cylinder, "radius"), positive(read, *cylinder, "length")};
  } else if (const XMLElement* sphere = read.child(geometry, "sphere")) {
    body.geometry = SphereGeometry{positive(read, *sphere, "radius")};
  } else if (const XMLElement* mesh = read.child(geometry, "mesh")) {
    body.geometry = MeshGeometry{read.name(*mesh, "filename"),
                                 read.three(*mesh, "scale", Eigen::Vector3d::Ones())};
  } else {
    return std::nullopt;
  }
  return body;
}

DocumentLink read_link(const Reader& read, const XMLElement& element, NoteList& notes) {
  DocumentLink link;
  link.name = read.name(element, "name");
  link.line = element.GetLineNum();
  if (const XMLElement* inertial = read.child(element, "inertial")) {
    link.inertial = read_inertial(read, *inertial);
  }
  for (const XMLElement* c = element.FirstChildElement("collision"); c != nullptr;
       c = c->NextSiblingElement("collision")) {
    if (auto body = read_collision(read, *c)) {
      link.collision.push_back(*body);
    } else {
      notes.add("collision geometry that is no box, cylinder, sphere or mesh left out", link.name);
    }
  }
  return link;
}

DocumentJointType read_type(const Reader& read, const XMLElement& element,
                            const std::string& name) {
  const std::string type = read.name(element, "type");
  if (type == "fixed") return DocumentJointType::fixed;
  if (type == "revolute") return DocumentJointType::revolute;
  if (type == "continuous") return DocumentJointType::continuous;
  if (type == "prismatic") return DocumentJointType::prismatic;
  if (type == "floating") return DocumentJointType::floating;
  if (type == "planar") {
    throw InputError(read.at(element.GetLineNum()), fmt::format("joint {} is planar", name),
                     "write it as two prismatic joints and a revolute one");
  }
  throw InputError(read.at(element.GetLineNum()),
                   fmt::format("joint {} has the unknown type {}", name, type),
                   "known types are fixed, revolute, continuous, prismatic, floating");
}

/// A bound that forbids all motion is what exporters write when they know none.
double bound_or_none(std::optional<double> bound, const char* what, const Joint& joint,
                     NoteList& notes) {
  if (bound && *bound != 0.0) return *bound;
  notes.add(fmt::format("{} limit {}, taken as none", what, bound ? "is 0" : "is missing"),
            joint.name);
  return std::numeric_limits<double>::infinity();
}

void read_limits(const Reader& read, const XMLElement& element, Joint& joint, NoteList& notes) {
  const XMLElement* limit = read.child(element, "limit");
  if (limit == nullptr) {
    if (joint.kind != JointKind::continuous) notes.add("no <limit>, taken as none", joint.name);
    return;
  }
  const auto refuse = [&](const std::string& wrong, const char* right) {
    throw InputError(read.at(limit->GetLineNum()), fmt::format("joint {}: {}", joint.name, wrong),
                     right);
  };
  const std::optional<double> effort = read.optional_number(*limit, "effort");
  const std::optional<double> velocity = read.optional_number(*limit, "velocity");
  if (effort.value_or(0.0) < 0.0) refuse(fmt::format("effort limit {:g}", *effort), "N m, above 0");
  if (velocity.value_or(0.0) < 0.0) {
    refuse(fmt::format("velocity limit {:g}", *velocity), "rad/s, above 0");
  }
  joint.effort = bound_or_none(effort, "effort", joint, notes);
  joint.velocity = bound_or_none(velocity, "velocity", joint, notes);

  if (joint.kind == JointKind::continuous) return;
  const std::optional<double> given_lower = read.optional_number(*limit, "lower");
  const std::optional<double> given_upper = read.optional_number(*limit, "upper");
  const double lower = given_lower.value_or(0.0), upper = given_upper.value_or(0.0);
  if (given_lower.has_value() != given_upper.has_value()) {
    notes.add(fmt::format("no {} limit, taken as 0", given_lower ? "upper" : "lower"), joint.name);
  }
  if (lower > upper) {
    refuse(fmt::format("lower limit {:g} is above the upper limit {:g}", lower, upper),
           "swap them");
  }
  if (lower == upper) {
    notes.add("lower and upper limit are equal or missing, taken as none", joint.name);
    return;
  }
  joint.lower = lower;
  joint.upper = upper;
}

Eigen::Vector3d read_axis(const Reader& read, const XMLElement& element, const Joint& joint,
                          NoteList& notes) {
  const XMLElement* found = read.child(element, "axis");
  if (found == nullptr || found->FindAttribute("xyz") == nullptr) {
    notes.add("no <axis>, taken as x", joint.name);
    return Eigen::Vector3d::UnitX();
  }
  const Eigen::Vector3d axis = read.three(*found, "xyz", Eigen::Vector3d::Zero());
  // A direction written with six decimals has this length at least.
  constexpr double shortest = 1e-6;
  // Directions rounded to three decimals are meant as unit vectors; others may be a slip.
  constexpr double nearly_unit = 1e-3;
  const double length = axis.norm();
  if (length < shortest) {
    throw InputError(read.at(found->GetLineNum()),
                     fmt::format("the axis of joint {} is zero", joint.name),
                     "write a direction such as \"0 0 1\"");
  }
  if (std::abs(length - 1.0) > nearly_unit) notes.add("axis scaled to length one", joint.name);
  return axis / length;
}

std::optional<Mimic> read_mimic(const Reader& read, const XMLElement& element) {
  const XMLElement* found = read.child(element, "mimic");
  if (found == nullptr) return std::nullopt;
  return Mimic{read.name(*found, "joint"), read.optional_number(*found, "multiplier").value_or(1.0),
               read.optional_number(*found, "offset").value_or(0.0)};
}

DocumentJoint read_joint(const Reader& read, const XMLElement& element, NoteList& notes) {
  DocumentJoint result;
  result.line = element.GetLineNum();
  result.joint.name = read.name(element, "name");
  result.type = read_type(read, element, result.joint.name);
  result.parent =
      read.name(read.needed_child(element, "parent", "write <parent link=\"...\"/>"), "link");
  result.child =
      read.name(read.needed_child(element, "child", "write <child link=\"...\"/>"), "link");
  result.joint.placement = read.origin(element);
  switch (result.type) {
    case DocumentJointType::fixed:
    case DocumentJointType::floating:
      return result;  // neither axis nor limits mean anything here
    case DocumentJointType::revolute:
      result.joint.kind = JointKind::revolute;
      break;
    case DocumentJointType::continuous:
      result.joint.kind = JointKind::continuous;
      break;
    case DocumentJointType::prismatic:
      result.joint.kind = JointKind::prismatic;
      break;
  }
  result.mimic = read_mimic(read, element);
  result.joint.axis = read_axis(read, element, result.joint, notes);
  read_limits(read, element, result.joint, notes);
  return result;
}

}  // namespace

InertialParameters Inertial::parameters() const {
  return from_centre(mass, origin.translation(),
                     origin.linear() * tensor * origin.linear().transpose());
}

Document read_document(const std::string& text, const std::string& file) {
  tinyxml2::XMLDocument xml;
  const XMLElement& root = parse_robot(text, file, xml);
  const Reader read(file);
  Document document;
  document.file = file;
  document.name = root.FindAttribute("name") == nullptr ? "" : read.name(root, "name");
  NoteList notes;
  // Other children (materials, transmissions, simulator settings) say nothing about the dynamics.
  for (const XMLElement* e = root.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string_view kind = e->Name();
    if (kind == "link") {
      document.links.push_back(read_link(read, *e, notes));
      note_unread_in_link(*e, notes);
    } else if (kind == "joint") {
      document.joints.push_back(read_joint(read, *e, notes));
      note_unread_in_joint(*e, notes);
    }
  }
  if (document.links.empty()) {
    throw InputError(read.at(root.GetLineNum()), "the robot has no <link>",
                     "a URDF has one at least");
  }
  document.notes = notes.lines();
  return document;
}

}  // namespace shapeid::urdf

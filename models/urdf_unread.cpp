#include "shapeid/models/urdf_unread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>

#include "shapeid/models/lower_case.hpp"

namespace shapeid::urdf {

using tinyxml2::XMLAttribute;
using tinyxml2::XMLElement;

namespace {

using ReadNames = std::initializer_list<const char*>;

// Limits of acceleration and jerk are of URDF's later versions and not of our equations.
constexpr ReadNames of_limit = {"lower",        "upper",        "effort", "velocity",
                                "acceleration", "deceleration", "jerk"};
constexpr ReadNames of_inertia = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};

bool is_among(ReadNames names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether one letter more, less or changed, or two neighbours exchanged, make one of the other.
bool is_nearly(const std::string& a, const std::string& b) {
  const std::size_t shorter = std::min(a.size(), b.size());
  std::size_t front = 0, back = 0;
  while (front < shorter && a[front] == b[front]) ++front;
  while (back < shorter - front && a[a.size() - 1 - back] == b[b.size() - 1 - back]) ++back;
  const std::size_t left_a = a.size() - front - back, left_b = b.size() - front - back;
  if (left_a <= 1 && left_b <= 1) return true;
  return left_a == 2 && left_b == 2 && a[front] == b[front + 1] && a[front + 1] == b[front];
}

/// A prefix of XML names belongs to a program that reads them.
bool is_of_other_program(std::string_view name) { return name.find(':') != std::string_view::npos; }

/// What stands besides is then no misspelt one of these: ANYmal's limits have those of its drives.
bool has_all_limits(const XMLElement& joint) {
  const XMLElement* limit = joint.FirstChildElement("limit");
  const char* type = joint.Attribute("type");
  const bool turns_on = type != nullptr && std::string_view(type) == "continuous";
  const auto has = [&](const char* name) { return limit->FindAttribute(name) != nullptr; };
  return limit != nullptr && has("effort") && has("velocity") &&
         (turns_on || (has("lower") && has("upper")));
}

/// Notes of one link or joint.
class Unread {
 public:
  Unread(const XMLElement& owner, NoteList& notes) : notes_(notes) {
    const char* name = owner.Attribute("name");
    owner_ = fmt::format("{} {}", owner.Name(), name == nullptr ? "" : name);
  }

  void attributes(const XMLElement* element, ReadNames read) const {
    if (element == nullptr) return;
    for (const XMLAttribute* a = element->FirstAttribute(); a != nullptr; a = a->Next()) {
      if (is_among(read, a->Name()) || is_of_other_program(a->Name())) continue;
      add(fmt::format("unknown attribute {} of <{}> is not read", a->Name(), element->Name()),
          a->GetLineNum());
    }
  }

  void origin(const XMLElement& of) const {
    attributes(of.FirstChildElement("origin"), {"xyz", "rpy"});
  }

  /// Where nothing but these is expected.
  void other_children(const XMLElement& element, ReadNames read) const {
    for_children(element, [&](const XMLElement& child) {
      if (is_among(read, child.Name()) || is_of_other_program(child.Name())) return;
      add(fmt::format("unknown <{}> in <{}> is not read", child.Name(), element.Name()),
          child.GetLineNum());
    });
  }

  /// Where anything may stand besides.
  void misspelt_children(const XMLElement& element, ReadNames read) const {
    for_children(element, [&](const XMLElement& child) {
      if (is_among(read, child.Name())) return;
      const auto* const meant = std::find_if(read.begin(), read.end(), [&](const char* name) {
        return is_nearly(lower_case(child.Name()), name);
      });
      if (meant == read.end()) return;
      add(fmt::format("unknown <{}> in <{}> is not read (<{}>?)", child.Name(), element.Name(),
                      *meant),
          child.GetLineNum());
    });
  }

  void shapes(const XMLElement& geometry, ReadNames known) const {
    const auto* const taken = std::find_if(known.begin(), known.end(), [&](const char* name) {
      return geometry.FirstChildElement(name) != nullptr;
    });
    if (taken == known.end()) return;  // a note of the reader's
    for_children(geometry, [&](const XMLElement& child) {
      if (std::string_view(child.Name()) == *taken) return;
      add(fmt::format("<{}> beside <{}> in one <geometry> is left out", child.Name(), *taken),
          child.GetLineNum());
    });
  }

 private:
  template <typename Visit>
  static void for_children(const XMLElement& element, const Visit& visit) {
    for (const XMLElement* c = element.FirstChildElement(); c != nullptr;
         c = c->NextSiblingElement()) {
      visit(*c);
    }
  }

  void add(const std::string& note, int line) const {
    notes_.add(note, fmt::format("{} (line {})", owner_, line));
  }

  NoteList& notes_;
  std::string owner_;
};

}  // namespace

void note_unread_in_link(const XMLElement& link, NoteList& notes) {
  const Unread unread(link, notes);
  unread.misspelt_children(link, {"inertial", "collision"});
  if (const XMLElement* inertial = link.FirstChildElement("inertial")) {
    unread.other_children(*inertial, {"origin", "mass", "inertia"});
    unread.origin(*inertial);
    unread.attributes(inertial->FirstChildElement("mass"), {"value"});
    unread.attributes(inertial->FirstChildElement("inertia"), of_inertia);
  }
  for (const XMLElement* c = link.FirstChildElement("collision"); c != nullptr;
       c = c->NextSiblingElement("collision")) {
    unread.misspelt_children(*c, {"origin", "geometry"});
    unread.origin(*c);
    const XMLElement* geometry = c->FirstChildElement("geometry");
    if (geometry == nullptr) continue;  // refused by the reader
    // In the order in which the reader asks for them.
    unread.shapes(*geometry, {"box", "cylinder", "sphere", "mesh"});
    unread.attributes(geometry->FirstChildElement("mesh"), {"filename", "scale"});
  }
}

void note_unread_in_joint(const XMLElement& joint, NoteList& notes) {
  const Unread unread(joint, notes);
  unread.misspelt_children(joint, {"origin", "parent", "child", "axis", "limit", "mimic"});
  unread.origin(joint);
  unread.attributes(joint.FirstChildElement("axis"), {"xyz"});
  if (!has_all_limits(joint)) unread.attributes(joint.FirstChildElement("limit"), of_limit);
  unread.attributes(joint.FirstChildElement("mimic"), {"joint", "multiplier", "offset"});
}

}  // namespace shapeid::urdf

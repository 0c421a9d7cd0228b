#include "shapeid/models/urdf_xml.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <string_view>
#include <vector>

#include "shapeid/models/number.hpp"
#include "shapeid/models/text.hpp"

namespace shapeid::urdf {

using tinyxml2::XMLAttribute;
using tinyxml2::XMLElement;
using tinyxml2::XMLNode;

namespace {

std::string explain(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "the file is empty";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "not well-formed XML: an element is not closed, or another one is";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "not well-formed XML: an attribute is malformed, or given twice";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are nested more than 100 deep";
    default:
      return fmt::format("not well-formed XML ({})", document.ErrorName());
  }
}

/// Declarations can redefine what the rest of the file means (entities), so none is accepted.
void refuse_declarations(const XMLNode& node, const std::string& file) {
  // Depth is bounded by tinyxml2 (100 levels), so plain recursion is safe.
  for (const XMLNode* child = node.FirstChild(); child != nullptr; child = child->NextSibling()) {
    if (child->ToUnknown() != nullptr) {
      throw InputError({file, child->GetLineNum(), {}},
                       "a document type or entity declaration (\"<!\")",
                       "a URDF needs none: remove it");
    }
    refuse_declarations(*child, file);
  }
}

/// What a macro would put in its place is missing in the robot.
void refuse_macros(const XMLElement& element, const std::string& file) {
  for (const XMLElement* c = element.FirstChildElement(); c != nullptr;
       c = c->NextSiblingElement()) {
    if (std::string_view(c->Name()).starts_with("xacro:")) {
      throw InputError({file, c->GetLineNum(), {}},
                       fmt::format("<{}> is of xacro, which is not expanded here", c->Name()),
                       "expand the file first: xacro FILE > robot.urdf");
    }
    refuse_macros(*c, file);
  }
}

}  // namespace

const XMLElement& parse_robot(const std::string& text, const std::string& file,
                              tinyxml2::XMLDocument& document) {
  if (text.size() > largest_file) {
    throw InputError(Place{file, 0, {}},
                     fmt::format("{} bytes, more than {}", text.size(), largest_file),
                     "is this a URDF?");
  }
  const std::size_t nul = text.find('\0');
  if (nul != std::string::npos) {
    throw InputError({file, line_at(text, nul), {}}, "a zero byte: this is not XML text",
                     "give a URDF");
  }
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw InputError({file, document.ErrorLineNum(), {}}, explain(document), "give a URDF");
  }
  refuse_declarations(document, file);

  const XMLElement* root = document.RootElement();
  if (root == nullptr || std::strcmp(root->Name(), "robot") != 0) {
    const std::string found = root == nullptr ? "nothing" : fmt::format("<{}>", root->Name());
    throw InputError({file, root == nullptr ? 0 : root->GetLineNum(), {}},
                     fmt::format("the outermost element is {}", found),
                     "a URDF begins with <robot>");
  }
  for (const XMLNode* node = root->NextSibling(); node != nullptr; node = node->NextSibling()) {
    if (node->ToComment() == nullptr) {
      throw InputError({file, node->GetLineNum(), {}}, "something follows </robot>",
                       "one file holds one robot");
    }
  }
  refuse_macros(*root, file);
  return *root;
}

const XMLElement* Reader::child(const XMLElement& element, const char* name) const {
  const XMLElement* first = element.FirstChildElement(name);
  const XMLElement* second = first == nullptr ? nullptr : first->NextSiblingElement(name);
  if (second != nullptr) {
    throw InputError(at(second->GetLineNum()),
                     fmt::format("a second <{}> in <{}>", name, element.Name()), "keep one");
  }
  return first;
}

const XMLElement& Reader::needed_child(const XMLElement& element, const char* name,
                                       const char* why) const {
  const XMLElement* found = child(element, name);
  if (found == nullptr) {
    throw InputError(at(element.GetLineNum()),
                     fmt::format("<{}> has no <{}>", element.Name(), name), why);
  }
  return *found;
}

const XMLAttribute& Reader::needed(const XMLElement& element, const char* attribute) const {
  const XMLAttribute* found = element.FindAttribute(attribute);
  if (found == nullptr) {
    throw InputError(at(element.GetLineNum()),
                     fmt::format("<{}> has no attribute \"{}\"", element.Name(), attribute),
                     "write it, also where it is zero");
  }
  return *found;
}

std::string Reader::name(const XMLElement& element, const char* attribute) const {
  const XMLAttribute* found = element.FindAttribute(attribute);
  if (found == nullptr) {
    throw InputError(at(element.GetLineNum()),
                     fmt::format("<{}> has no attribute \"{}\"", element.Name(), attribute),
                     "name it");
  }
  std::string value = found->Value();
  if (const Violation why = why_no_name(value)) {
    throw InputError(at(found->GetLineNum()),
                     fmt::format("the {} of <{}> {}", attribute, element.Name(), *why),
                     "use letters, digits and underscores");
  }
  return value;
}

double Reader::bounded(const XMLElement& element, const XMLAttribute& attribute,
                       std::string_view text) const {
  const std::optional<double> value = parse_number(text);
  if (!value) {
    throw InputError(
        at(attribute.GetLineNum()),
        fmt::format("{} of <{}> {}", attribute.Name(), element.Name(), why_no_number(text)),
        "write a finite decimal number");
  }
  if (std::abs(*value) > largest_number) {
    throw InputError(at(attribute.GetLineNum()),
                     fmt::format("{} of <{}> is {:g}", attribute.Name(), element.Name(), *value),
                     fmt::format("SI units; nothing here exceeds {:g}", largest_number));
  }
  return *value;
}

double Reader::number(const XMLElement& element, const char* attribute) const {
  const XMLAttribute& found = needed(element, attribute);
  return bounded(element, found, found.Value());
}

std::optional<double> Reader::optional_number(const XMLElement& element,
                                              const char* attribute) const {
  const XMLAttribute* found = element.FindAttribute(attribute);
  if (found == nullptr) return std::nullopt;
  const std::optional<double> value = parse_number(found->Value());
  if (!value) {
    throw InputError(
        at(found->GetLineNum()),
        fmt::format("{} of <{}> {}", attribute, element.Name(), why_no_number(found->Value())),
        "write a finite decimal number, or leave the attribute out");
  }
  return value;
}

Eigen::Vector3d Reader::three(const XMLElement& element, const char* attribute,
                              const Eigen::Vector3d& otherwise) const {
  const XMLAttribute* found = element.FindAttribute(attribute);
  if (found == nullptr) return otherwise;
  const std::vector<std::string_view> parts = split_at_blanks(found->Value());
  if (parts.size() != 3) {
    throw InputError(at(found->GetLineNum()),
                     fmt::format("{} of <{}> has {} numbers (\"{}\")", attribute, element.Name(),
                                 parts.size(), found->Value()),
                     "write three, with blanks between them");
  }
  Eigen::Vector3d result;
  for (Eigen::Index i = 0; i < 3; ++i) {
    result[i] = bounded(element, *found, parts[static_cast<std::size_t>(i)]);
  }
  return result;
}

Eigen::Isometry3d Reader::origin(const XMLElement& element) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const XMLElement* found = child(element, "origin");
  if (found == nullptr) return pose;
  pose.translation() = three(*found, "xyz", Eigen::Vector3d::Zero());
  const Eigen::Vector3d rpy = three(*found, "rpy", Eigen::Vector3d::Zero());
  if (rpy.cwiseAbs().maxCoeff() > largest_angle) {
    throw InputError(at(found->GetLineNum()),
                     fmt::format("rpy of <origin> turns by {:g}", rpy.cwiseAbs().maxCoeff()),
                     "radians, a turn at most");
  }
  pose.linear() = rotation_from_rpy(rpy);
  return pose;
}

}  // namespace shapeid::urdf

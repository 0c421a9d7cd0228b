#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "shapeid/models/inertia_lint.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/models/urdf_spans.hpp"
#include "shapeid/models/urdf_xml.hpp"

namespace shapeid {
namespace {

using urdf::Document;
using urdf::Edit;
using urdf::ElementSpan;
using urdf::indent_before;

/// The link's numbers as the reader will take them: mass, centre, tensor about the centre.
struct Written {
  double mass;
  Eigen::Vector3d centre;
  Eigen::Matrix3d tensor;
};

Written as_written(const InertialParameters& body) {
  Written w{body.mass(), body.centre_of_mass(), body.tensor_about_centre()};
  // Taking the parallel axis term away leaves its rounding behind, which may push a body on the
  // edge of the cone (a rod, a plate) outside. A sphere's worth of that rounding brings it back.
  const auto impossible = [&] {
    return why_impossible(from_centre(w.mass, Eigen::Vector3d::Zero(), w.tensor)).has_value();
  };
  if (impossible()) {
    constexpr double roundings = 8.0;  // products and differences in the parallel axis term
    const double rounding =
        roundings * std::numeric_limits<double>::epsilon() * w.mass * w.centre.squaredNorm();
    w.tensor.diagonal().array() += rounding;
  }
  return w;
}

std::string inertial_text(const Written& w, const std::string& indent) {
  const Eigen::Vector3d& c = w.centre;
  const Eigen::Matrix3d& I = w.tensor;
  // fmt's {} is the shortest decimal that reads back as the same double.
  return fmt::format(
      "<inertial>\n{0}  <origin xyz=\"{1} {2} {3}\" rpy=\"0 0 0\"/>\n{0}  <mass value=\"{4}\"/>\n"
      "{0}  <inertia ixx=\"{5}\" ixy=\"{6}\" ixz=\"{7}\" iyy=\"{8}\" iyz=\"{9}\" izz=\"{10}\"/>\n"
      "{0}</inertial>",
      indent, c.x(), c.y(), c.z(), w.mass, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2));
}

Edit replace_inertial(std::string_view text, const ElementSpan& link, const Written& w) {
  if (!link.parts.empty()) {
    const urdf::Span& inertial = link.parts.front();
    return {inertial, inertial_text(w, indent_before(text, inertial.begin))};
  }
  const std::string indent = indent_before(text, link.start_tag.begin);
  const std::string inner = "\n" + indent + "  " + inertial_text(w, indent + "  ");
  if (!link.self_closed) return {{link.start_tag.end, link.start_tag.end}, inner};
  const std::size_t slash = link.start_tag.end - 2;
  return {{slash, link.start_tag.end}, fmt::format(">{}\n{}</link>", inner, indent)};
}

std::size_t document_index(const Document& document, const std::string& name) {
  const auto found = std::find_if(document.links.begin(), document.links.end(),
                                  [&](const auto& link) { return link.name == name; });
  if (found == document.links.end()) {
    throw Defect(fmt::format("{} has no link {}: not the file that the robot was read from",
                             document.file, name));
  }
  return static_cast<std::size_t>(found - document.links.begin());
}

/// The member that takes the lumped inertia: the first that has one in the file, so that a frame
/// such as `world` stays without mass.
const Member& bearer(const Link& link) {
  const auto found = std::find_if(link.members.begin(), link.members.end(),
                                  [](const Member& m) { return m.has_inertial; });
  return found == link.members.end() ? link.members.front() : *found;
}

std::vector<Edit> edits_for(std::string_view text, const std::vector<ElementSpan>& spans,
                            const Document& document, const Link& link,
                            const InertialParameters& inertia) {
  const Member& bearing = bearer(link);
  std::vector<Edit> edits;
  for (const Member& member : link.members) {
    const ElementSpan& span = spans.at(document_index(document, member.name));
    if (&member == &bearing && inertia.mass() > 0.0) {
      edits.push_back(
          replace_inertial(text, span, as_written(moved(inertia, member.pose.inverse()))));
    } else if (!span.parts.empty()) {
      edits.push_back({span.parts.front(), &member == &bearing
                                               ? "<!-- no mass was found here -->"
                                               : "<!-- its inertia is part of the link that it is "
                                                 "fixed to -->"});
    }
  }
  return edits;
}

/// Reads the result back: no inertia that our own reader refuses, the same parameters to rounding.
void verify(const std::string& text, const std::string& path, const Robot& robot,
            const std::vector<IdentifiedLink>& identified) {
  const Document document = urdf::read_document(text, path);
  for (const IdentifiedLink& one : identified) {
    const Link& link = robot.links.at(static_cast<std::size_t>(one.link));
    InertialParameters sum;
    double scale = one.inertia.values.norm();
    for (const Member& member : link.members) {
      const urdf::DocumentLink& written = document.links[document_index(document, member.name)];
      if (!written.inertial) continue;
      const auto finding = urdf::lint(written, path);
      if (finding && finding->fatal) throw Defect("written " + urdf::describe(*finding));
      const InertialParameters own = written.inertial->parameters();
      scale = std::max(scale, own.values.norm());
      sum = sum + moved(own, member.pose);
    }
    // Two changes of frame and two of reference point, a few dozen roundings each.
    constexpr double rounding = 1000.0 * std::numeric_limits<double>::epsilon();
    if (!((sum.values - one.inertia.values).norm() <= rounding * scale)) {
      throw Defect(fmt::format("link {} reads back with other parameters", link.name));
    }
  }
}

}  // namespace

std::string write_urdf(const std::string& original_path, const Robot& robot,
                       const std::vector<IdentifiedLink>& identified) {
  std::string text = read_small_file(original_path, urdf::largest_file);
  const Document document = urdf::read_document(text, original_path);
  const std::vector<ElementSpan> spans = urdf::find_elements(text, "link", "inertial");
  std::vector<Edit> edits;
  for (const IdentifiedLink& one : identified) {
    const Link& link = robot.links.at(static_cast<std::size_t>(one.link));
    if (const Violation wrong = why_impossible(one.inertia)) {
      throw Defect(fmt::format("link {} cannot be written: {}", link.name, *wrong));
    }
    for (Edit& edit : edits_for(text, spans, document, link, one.inertia)) {
      edits.push_back(std::move(edit));
    }
  }
  text = urdf::edited(std::move(text), std::move(edits));
  verify(text, original_path, robot, identified);
  return text;
}

}  // namespace shapeid

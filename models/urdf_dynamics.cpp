#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "shapeid/models/urdf.hpp"
#include "shapeid/models/urdf_document.hpp"
#include "shapeid/models/urdf_spans.hpp"

namespace shapeid {
namespace {

using urdf::DocumentJoint;
using urdf::Edit;
using urdf::ElementSpan;

void add_edits(std::vector<Edit>& edits, std::string_view text, const ElementSpan& joint,
               const JointFriction& found) {
  // fmt's {} is the shortest decimal that reads back as the same double.
  const std::string dynamics =
      fmt::format("<dynamics damping=\"{}\" friction=\"{}\"/>", found.damping, found.friction);
  if (joint.parts.empty()) {
    const std::string indent = urdf::indent_before(text, joint.start_tag.begin);
    const std::size_t at = joint.start_tag.end;
    edits.push_back({{at, at}, fmt::format("\n{}  {}", indent, dynamics)});
    return;
  }
  edits.push_back({joint.parts.front(), dynamics});
  // Whoever reads a second one would take what is no longer so.
  for (std::size_t k = 1; k < joint.parts.size(); ++k) edits.push_back({joint.parts[k], ""});
}

}  // namespace

std::string with_friction(const std::string& text, const std::string& file,
                          const std::map<std::string, JointFriction>& friction) {
  // A joint of the document has children, so none of the elements closes itself.
  const urdf::Document document = urdf::read_document(text, file);
  const std::vector<ElementSpan> spans = urdf::find_elements(text, "joint", "dynamics");
  std::vector<Edit> edits;
  for (const auto& [name, found] : friction) {
    const auto joint =
        std::find_if(document.joints.begin(), document.joints.end(),
                     [&wanted = name](const DocumentJoint& j) { return j.joint.name == wanted; });
    if (joint == document.joints.end()) {
      throw Defect(
          fmt::format("{} has no joint {}: not the file that the robot was read from", file, name));
    }
    const auto index = static_cast<std::size_t>(joint - document.joints.begin());
    add_edits(edits, text, spans.at(index), found);
  }
  return urdf::edited(text, std::move(edits));
}

}  // namespace shapeid

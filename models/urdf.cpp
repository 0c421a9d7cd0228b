#include "shapeid/models/urdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "shapeid/models/inertia_lint.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/models/urdf_tree.hpp"
#include "shapeid/models/urdf_xml.hpp"

namespace shapeid {

namespace {

/// An impossible member is forgiven where the rigid body that it is part of can exist: a camera's
/// placeholder of 1e-6 kg must not refuse a robot.
bool can_exist_lumped(const Robot& robot, const std::string& member) {
  const std::optional<int> index = robot.find_link(member);
  if (!index) return false;  // a world that was left out
  const Link& link = robot.links[static_cast<std::size_t>(*index)];
  return link.members.size() > 1 &&
         !why_impossible(from_centre(link.inertia.mass(), Eigen::Vector3d::Zero(),
                                     link.inertia.tensor_about_centre()));
}

}  // namespace

UrdfFile parse_urdf(const std::string& text, const std::string& name, const UrdfOptions& options) {
  const urdf::Document document = urdf::read_document(text, name);
  UrdfFile result;
  result.says_floating = std::ranges::any_of(document.joints, [](const urdf::DocumentJoint& joint) {
    return joint.type == urdf::DocumentJointType::floating;
  });
  result.robot = urdf::lump(document, urdf::resolve(document), options);
  for (const urdf::DocumentLink& link : document.links) {
    std::optional<InertiaFinding> finding = urdf::lint(link, name);
    if (!finding) continue;
    finding->fatal = finding->fatal && !can_exist_lumped(result.robot, link.name);
    if (finding->fatal && options.reject_impossible) {
      throw InputError(
          finding->place, urdf::describe(*finding),
          options.accepted_by.empty()
              ? "correct it, or leave it out"
              : fmt::format("correct it, leave it out, or read it with {} where the link is known",
                            options.accepted_by));
    }
    result.findings.push_back(std::move(*finding));
  }
  return result;
}

UrdfFile read_urdf(const std::string& path, const UrdfOptions& options) {
  return parse_urdf(read_small_file(path, urdf::largest_file), path, options);
}

}  // namespace shapeid

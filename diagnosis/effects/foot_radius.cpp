#include <cstddef>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::Index row_count(ContactKind kind) {
  return kind == ContactKind::point ? 3 : kind == ContactKind::line ? 5 : 6;
}

// A ball touches below its centre, wherever the leg points: along the specific force, downwards.
void lower(const Robot& robot, const Sample& sample, int contact, const Eigen::VectorXd& value,
           Rows& rows) {
  const auto wanted = static_cast<std::size_t>(contact);
  if (wanted >= sample.in_contact.size() || !sample.in_contact[wanted]) return;
  Eigen::Index row = 0;
  for (std::size_t c = 0; c < wanted; ++c) {
    if (sample.in_contact[c]) row += row_count(robot.contacts[c].kind);
  }
  const auto motions = reference::link_motions(robot, sample);
  const Contact& foot = robot.contacts[wanted];
  const Eigen::Isometry3d& pose = motions[static_cast<std::size_t>(foot.link)].pose;
  const Eigen::Vector3d down = -sample.base_specific_force.normalized();
  const Eigen::Vector3d point = pose * foot.frame.translation() + value[0] * down;
  rows.J.middleRows<3>(row) =
      reference::point_jacobian(robot, motions, foot.link, point).topRows<3>();
}

}  // namespace

Effect foot_radius() {
  Effect e;
  e.id = "foot_radius";
  e.title = "a ball-shaped foot touches below the declared point";
  e.equation = "contact point moved by r along gravity, in J";
  e.site = SiteKind::contact;
  e.parameters = {{"r", "m", true, 0.01}};
  e.confused_with = {"contact_point", "link_length"};
  e.separate_by = "measure the foot";
  e.under_contact = "it is what the projection uses: seen in stance only";
  e.source = "docs/derivations/projection.md";
  e.applies = is_point_contact;
  e.transform.rows = lower;
  return e;
}

}  // namespace shapeid::diagnosis

#include <cstddef>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/contact_parts.hpp"

namespace shapeid::diagnosis {
namespace {

void move(const Robot& robot, const Sample& sample, const Eigen::Vector3d&, int contact,
          const Eigen::VectorXd& value, Rows& rows) {
  const auto row = stance_row(robot, sample, contact, rows);
  if (!row) return;
  const auto motions = reference::link_motions(robot, sample);
  const int link = robot.contacts[static_cast<std::size_t>(contact)].link;
  const Eigen::Vector3d arm = motions[static_cast<std::size_t>(link)].pose.linear() * value;
  move_point(robot, motions, contact, arm, *row, rows);
}

}  // namespace

Effect contact_point() {
  Effect e;
  e.id = "contact_point";
  e.title = "the foot touches elsewhere on its link";
  e.equation = "contact point moved by (x, y, z), link axes, in J";
  e.site = SiteKind::contact;
  e.parameters = {
      {"x", "m", false, 0.01, 0.1}, {"y", "m", false, 0.01, 0.1}, {"z", "m", false, 0.01, 0.1}};
  e.confused_with = {"foot_radius", "link_length", "encoder_offset of the last joint"};
  e.separate_by = "measure where the foot touches";
  e.under_contact = "it is what the projection uses: seen in stance only";
  e.source = "docs/derivations/projection.md";
  e.transform.rows = move;
  return e;
}

}  // namespace shapeid::diagnosis

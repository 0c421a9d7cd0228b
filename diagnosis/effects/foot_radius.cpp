#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/contact_parts.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

// A ball touches below its centre, wherever the leg points, on level ground.
void lower(const Robot& robot, const Sample& sample, const Eigen::Vector3d& down, int contact,
           const Eigen::VectorXd& value, Rows& rows) {
  const auto row = stance_row(robot, sample, contact, rows);
  if (!row) return;
  move_point(robot, reference::link_motions(robot, sample), contact, value[0] * down, *row, rows);
}

}  // namespace

Effect foot_radius() {
  Effect e;
  e.id = "foot_radius";
  e.title = "a ball-shaped foot touches below the declared point";
  e.equation = "contact point moved by r along gravity, in J";
  e.site = SiteKind::contact;
  e.parameters = {{"r", "m", true, 0.01, 0.1}};
  e.confused_with = {"contact_point", "link_length"};
  e.separate_by = "measure the foot";
  e.under_contact = "it is what the projection uses: seen in stance only";
  e.source = "docs/derivations/projection.md";
  e.built_in = true;
  e.applies = is_point_contact;
  e.transform.rows = lower;
  return e;
}

}  // namespace shapeid::diagnosis

#include <cstddef>

#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

void move(Robot& robot, int contact, const Eigen::VectorXd& value) {
  robot.contacts[static_cast<std::size_t>(contact)].frame.translation() += value;
}

}  // namespace

Effect contact_point() {
  Effect e;
  e.id = "contact_point";
  e.title = "the foot touches elsewhere on its link";
  e.equation = "contact point moved by (x, y, z), link axes, in J";
  e.site = SiteKind::contact;
  e.parameters = {{"x", "m", false, 0.01}, {"y", "m", false, 0.01}, {"z", "m", false, 0.01}};
  e.confused_with = {"foot_radius", "link_length", "encoder_offset of the last joint"};
  e.separate_by = "measure where the foot touches";
  e.under_contact = "it is what the projection uses: seen in stance only";
  e.source = "docs/derivations/projection.md";
  e.transform.robot = move;
  return e;
}

}  // namespace shapeid::diagnosis

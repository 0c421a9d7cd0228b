// Robots and samples that the fast path is compared on, beside the generators' arbitrary ones.
#pragma once

#include <string>
#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::test {

/// Drawn with rapidcheck: a tree of either kind of root. Joints are as URDFs have them (about a
/// coordinate axis or against one, placed parallel to the parent) as often as they are arbitrary;
/// at times a contact is named twice, or two contacts are on one link.
[[nodiscard]] Robot any_robot(int fewest_links, int most_links);

/// A floating base with four legs of three joints and a point foot each, drawn with rapidcheck:
/// what the six-row path is made for.
[[nodiscard]] Robot any_quadruped();

/// A sample of it, with a measured force for each contact.
[[nodiscard]] Sample any_sample(const Robot& robot);

/// Drawn with rapidcheck: some links free (perhaps none), the others known; a free link may carry a
/// known part as well.
[[nodiscard]] BodyModel any_model(const Robot& robot);

/// The base as two cuboids, all other links known.
[[nodiscard]] BodyModel base_model(const Robot& robot);

/// All links sought.
[[nodiscard]] BodyModel whole_model(const Robot& robot);

/// Path of the bundled quadruped's file, e.g. "robot.yaml".
[[nodiscard]] std::string bundled_file(const std::string& ending);

/// With its feet as contacts.
[[nodiscard]] Robot bundled_quadruped();

/// Its base as eleven shapes, the legs known.
[[nodiscard]] BodyModel bundled_shapes(const Robot& robot);

struct NamedRobot {
  std::string name;
  Robot robot;
};

/// One link, fixed and floating; a foot on the base; a contact named twice; no contact; a chain of
/// sixty links; the bundled quadruped.
[[nodiscard]] std::vector<NamedRobot> corner_robots();

/// The one of this name.
[[nodiscard]] Robot corner_robot(const std::string& name);

/// Nothing moves and nothing pulls; the same with all contacts touching; stretched legs (all joints
/// at zero); each number that the dynamics read alone at one; joints sweeping several turns;
/// velocities from 1e-6 to 1e6. Forces are measured.
[[nodiscard]] std::vector<Sample> corner_samples(const Robot& robot);

/// All that a sample says about motion is zero, gravity too; nothing touches.
[[nodiscard]] Sample nothing_moves(const Robot& robot);

/// The numbers that Y depends on, one after the other.
[[nodiscard]] std::vector<double*> inputs(Sample& s);

}  // namespace shapeid::test

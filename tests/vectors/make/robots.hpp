// Robots and motions of the vectors, drawn and written as questions say them.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::vectors {

/// How a drawn robot hangs together: the parent of every link after the root, and its joint.
struct Plan {
  Root root = Root::floating;
  std::vector<int> parents;
  std::vector<JointKind> joints;
  std::vector<int> feet;  ///< links with a point contact
};

/// Joints about any axis, anywhere within 0.3 m, bodies of 0.5 to 20 kg.
[[nodiscard]] Robot drawn_robot(test::Draw& draw, const Plan& plan);

/// Everything moves; all feet touch. A fixed root stands still and upright.
[[nodiscard]] Sample drawn_sample(test::Draw& draw, const Robot& robot);

[[nodiscard]] nlohmann::json robot_json(const Robot& robot);
[[nodiscard]] nlohmann::json sample_json(const Sample& sample);

}  // namespace shapeid::vectors

// Cases of robots with several links: rows of the dynamics, and where contact forces enter them.
#include <array>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/vectors/make/cases.hpp"
#include "shapeid/tests/vectors/make/robots.hpp"

namespace shapeid::vectors {
namespace {

using nlohmann::json;

json robot_case(const Robot& robot, const Sample& sample) {
  const Eigen::MatrixXd Y = reference::regressor(robot, sample),
                        J = reference::contact_jacobian(robot, sample);
  const Eigen::VectorXd rows = Y.reshaped<Eigen::RowMajor>(),
                        jacobian = J.reshaped<Eigen::RowMajor>();
  const json input = {{"robot", robot_json(robot)}, {"sample", sample_json(sample)}};
  // Sums of a handful of terms along a chain, each no larger than a few of the largest entry.
  json made = number_case(input, "rows", rows, 10.0 * rows.cwiseAbs().maxCoeff());
  made.update(number_case(input, "jacobian", jacobian, 10.0), true);
  return made;
}

}  // namespace

json robot_cases(test::Draw& draw) {
  constexpr auto revolute = JointKind::revolute, prismatic = JointKind::prismatic;
  const Plan tree{Root::floating, {0, 1, 0}, {revolute, revolute, prismatic}, {2, 3}},
      arm{Root::fixed, {0, 1, 2}, {revolute, prismatic, revolute}, {3}},
      chain{Root::floating, {0, 1}, {revolute, revolute}, {2}};
  constexpr std::array kinds = {ContactKind::point, ContactKind::line, ContactKind::plane};
  json cases = json::array();
  for (std::size_t i = 0; i < 4; ++i) {
    for (const Plan& plan : {tree, arm, chain}) {
      Robot robot = drawn_robot(draw, plan);
      for (Contact& contact : robot.contacts) {
        contact.kind = kinds[i % 3];
        contact.frame.linear() = pose_of(Eigen::Vector3d::Zero(), draw.vector(1.5)).linear();
      }
      cases.push_back(robot_case(robot, drawn_sample(draw, robot)));
    }
  }
  const Robot robot = drawn_robot(draw, tree);
  Sample still = drawn_sample(draw, robot);
  still.base_angular_velocity.setZero();
  still.dq.setZero();
  cases.push_back(robot_case(robot, still));
  cases.back()["flags"].push_back("NoRotation");
  return cases;
}

}  // namespace shapeid::vectors

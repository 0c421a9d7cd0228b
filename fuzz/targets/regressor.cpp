// Any robot in any motion: Y Phi against Simbody's inverse dynamics, and what the fast path has
// instead against Y Phi.
#include <cstdint>
#include <numeric>
#include <vector>

#include "shapeid/fast/inverse_dynamics.hpp"
#include "shapeid/fast/kinematics.hpp"
#include "shapeid/fast/regressor.hpp"
#include "shapeid/fuzz/support/bytes.hpp"
#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/robots.hpp"
#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/physics/dynamics.hpp"
#include "shapeid/tests/support/scaled.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes(data, size);
  const Robot robot = fuzz::any_robot(bytes);
  fuzz::check(!why_malformed(robot), "bytes spell robots");
  const SimbodyRobot simbody(robot);
  const Eigen::VectorXd Phi = stacked_parameters(robot);
  std::vector<int> links(robot.links.size());
  std::iota(links.begin(), links.end(), 0);
  fast::Regressor regressor(robot, links);
  fast::Kinematics kinematics(robot);
  fast::InverseDynamics dynamics(robot, Phi);
  // Let loose, the root feels all wrenches whole; a joint may feel a small part of a large one.
  Robot loose = robot;
  loose.root = Root::floating;
  do {
    const Sample s = fuzz::any_sample(bytes, robot);
    const Eigen::VectorXd ours = reference::regressor(robot, s) * Phi;
    const double error = (ours - simbody.inverse_dynamics(s)).norm();
    fuzz::check(test::scaled(error, test::size_of_terms_with_weight(robot, s), robot.link_count()) <
                    test::few_hundred_eps,
                "Y Phi is the inverse dynamics");
    const double terms = test::size_of_terms_with_weight(loose, s);
    const auto is_ours = [&](const Eigen::VectorXd& forces) {
      return forces.size() == ours.size() &&
             test::scaled((forces - ours).norm(), terms, robot.link_count()) <
                 test::few_hundred_eps;
    };
    fuzz::check(is_ours(regressor(s) * Phi), "the fast path has the same Y");
    kinematics.start(s);
    fuzz::check(is_ours(dynamics(kinematics)), "the fast path has the same inverse dynamics");
  } while (!bytes.empty());
  return 0;
}

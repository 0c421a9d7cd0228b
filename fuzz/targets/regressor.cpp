// Any robot in any motion: Y Phi against Simbody's inverse dynamics.
#include <cstdint>

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
  do {
    const Sample s = fuzz::any_sample(bytes, robot);
    const Eigen::VectorXd ours = reference::regressor(robot, s) * stacked_parameters(robot);
    const double error = (ours - simbody.inverse_dynamics(s)).norm();
    fuzz::check(test::scaled(error, test::size_of_terms_with_weight(robot, s), robot.link_count()) <
                    test::few_hundred_eps,
                "Y Phi is the inverse dynamics");
  } while (!bytes.empty());
  return 0;
}

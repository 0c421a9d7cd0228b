// One free rigid body, its weight read off the regressor, by both paths: exits 0 if the installed
// libraries work.
#include <shapeid/fast/regressor.hpp>
#include <shapeid/models/robot.hpp>
#include <shapeid/models/sample.hpp>
#include <shapeid/reference/regressor.hpp>

namespace {

bool is_weight(const Eigen::VectorXd& force) { return force[2] > 19.6 && force[2] < 19.7; }

}  // namespace

int main() {
  shapeid::Robot robot;
  robot.links.resize(1);
  robot.links[0].inertia = shapeid::from_centre(2.0, {0.1, 0.2, 0.3}, Eigen::Matrix3d::Identity());
  const shapeid::Sample at_rest;
  const Eigen::VectorXd Phi = shapeid::stacked_parameters(robot);
  shapeid::fast::Regressor fast(robot, {0});
  return is_weight(shapeid::reference::regressor(robot, at_rest) * Phi) &&
                 is_weight(fast(at_rest) * Phi)
             ? 0
             : 1;
}

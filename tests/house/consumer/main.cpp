// One free rigid body, its weight read off the regressor: exits 0 if the installed library works.
#include <shapeid/models/robot.hpp>
#include <shapeid/models/sample.hpp>
#include <shapeid/reference/regressor.hpp>

int main() {
  shapeid::Robot robot;
  robot.links.resize(1);
  robot.links[0].inertia = shapeid::from_centre(2.0, {0.1, 0.2, 0.3}, Eigen::Matrix3d::Identity());
  const shapeid::Sample at_rest;
  const Eigen::VectorXd force =
      shapeid::reference::regressor(robot, at_rest) * shapeid::stacked_parameters(robot);
  return force[2] > 19.6 && force[2] < 19.7 ? 0 : 1;
}

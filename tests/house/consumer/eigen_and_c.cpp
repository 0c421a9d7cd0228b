// A controller that has Eigen for itself and asks by the C interface alone: exits 0 if that works.
// Arguments: URDF, robot.yaml and shapes.yaml of the bundled quadruped.
#include <Eigen/Geometry>

#include <shapeid/fast/shapeid.h>

int main(int argc, char** argv) {
  if (argc != 4) return 1;
  // Functions that the library has as well; aligned otherwise, this program's would end it.
  const Eigen::Isometry3d turned(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  const Eigen::Isometry3d twice = turned * turned;
  shapeid_identifier* identifier = shapeid_create(argv[1], argv[2], argv[3], nullptr, nullptr, 0);
  const bool works = shapeid_joint_count(identifier) == 12 && twice(0, 0) == 1.0;
  shapeid_destroy(identifier);
  return works ? 0 : 1;
}

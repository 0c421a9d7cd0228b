// robot.yaml: what is read is finite and speaks of the robot.
#include <cmath>
#include <cstdint>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/memory_file.hpp"
#include "shapeid/fuzz/support/robots.hpp"
#include "shapeid/models/robot_yaml.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Robot given = fuzz::hopper();
  const fuzz::MemoryFile file(data, size);
  fuzz::taken([&] {
    Robot robot = given;
    const RobotNotes notes = read_robot_yaml(file.path(), robot);
    fuzz::check(!why_malformed(robot), "a robot with its notes is well-formed");
    fuzz::check(notes.imu.matrix().allFinite(), "the IMU has a place");
    for (const auto& [name, sigma] : notes.noise_sigma) {
      fuzz::check(std::isfinite(sigma) && sigma > 0.0, "noise is finite and positive");
    }
    for (const auto& [name, range] : notes.expected_mass) {
      fuzz::check(range.lower >= 0.0 && range.lower <= range.upper, "ranges of mass are ranges");
    }
    fuzz::check(std::isfinite(expected_mass(robot, notes, {0, 1})), "expected masses are finite");
  });
  return 0;
}

// Shapes from places other than a file: areas on the command line, collision bodies of a URDF.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/hostile/refused.hpp"
#include "shapeid/tests/robot/two_link_robot.hpp"

namespace shapeid {
namespace {

using test::refusal, test::says;

TEST(HostileShapes, AreasAtTheEndsOfDouble) {
  const Robot robot = test::two_link_robot();
  const auto area = [&](double lower, double upper) {
    return refusal([&] {
      static_cast<void>(load_region(robot, 0, Eigen::Vector3d::Constant(lower),
                                    Eigen::Vector3d::Constant(upper)));
    });
  };
  EXPECT_EQ(area(-0.1, 0.1), "accepted");
  EXPECT_TRUE(says(area(-1e308, 1e308), "the area: "));
  EXPECT_TRUE(says(area(0.0, 1e200), "the area: "));
  EXPECT_TRUE(says(area(0.0, 5e-324), "the area: "));
  EXPECT_TRUE(says(area(1e9, 1e9), "has no volume"));
}

TEST(HostileShapes, CollisionBodiesOfNoSize) {
  for (const char* side : {"1e-200", "5e-324"}) {
    const Robot robot =
        parse_urdf(fmt::format("<robot name=\"r\"><link name=\"a\"><collision><geometry><box "
                               "size=\"{0} {0} {0}\"/></geometry></collision></link></robot>",
                               side),
                   "r.urdf")
            .robot;
    const std::string message = refusal([&] { static_cast<void>(default_shapes(robot, {0})); });
    EXPECT_TRUE(says(message, "a shape of link a: ")) << message;
  }
}

}  // namespace
}  // namespace shapeid

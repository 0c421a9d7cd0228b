// What `batch` does on several threads, without the command around it, so that ThreadSanitizer
// needs little of the tree: logs are read, filtered and compressed at once. (./run threads)
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "shapeid/diagnosis/in_parallel.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/reference/identify.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid::test {
namespace {

constexpr std::size_t logs = 6;

struct Robots {
  Robot robot;
  RobotNotes notes;
  BodyModel model;

  Robots() {
    const std::string path = SHAPEID_SOURCE_DIR "/models/robots/quadruped.";
    robot = read_urdf(path + "urdf").robot;
    notes = read_robot_yaml(path + "robot.yaml", robot);
    model = read_shapes_yaml(path + "shapes.yaml", robot);
  }
};

std::string log_name(std::size_t k) {
  const auto folder = std::filesystem::path(SHAPEID_BUILD_DIR) / "scratch" / "test_threads";
  std::filesystem::create_directories(folder);
  // Plain and compressed ones.
  return (folder / fmt::format("log{}.csv{}", k, k % 2 == 0 ? "" : ".gz")).string();
}

void write_log(const Robot& robot, std::size_t k) {
  std::vector<std::string> names = {"time"};
  for (const char* channel : {"base.gyro.", "base.accel."}) {
    for (const char* axis : {"x", "y", "z"}) names.push_back(std::string(channel) + axis);
  }
  for (const char* channel : {"q.", "tau."}) {
    for (int j = 0; j < robot.joint_count(); ++j) names.push_back(channel + robot.joint(j).name);
  }
  for (const Contact& contact : robot.contacts) names.push_back("contact." + contact.name);
  LogWriter out(log_name(k), names);
  for (const Sample& s :
       trot(robot, stacked_parameters(robot), 20 + k, 300 + 40 * k, Noise::sensors)) {
    std::vector<double> row = {s.time};
    row.insert(row.end(), s.base_angular_velocity.begin(), s.base_angular_velocity.end());
    row.insert(row.end(), s.base_specific_force.begin(), s.base_specific_force.end());
    row.insert(row.end(), s.q.begin(), s.q.end());
    row.insert(row.end(), s.tau.begin(), s.tau.end());
    // Feet of this motion do not stand: of one alone that is not asked.
    for (std::size_t c = 0; c < s.in_contact.size(); ++c) {
      row.push_back(c == 0 && s.in_contact[c] ? 1.0 : 0.0);
    }
    out.write(row);
  }
  out.close();
}

std::vector<Eigen::MatrixXd> compressed(const Robots& given, std::size_t threads) {
  std::vector<Eigen::MatrixXd> triangles(logs);
  diagnosis::in_parallel(logs, threads, [&](std::size_t k) {
    MotionReader reader(log_name(k), given.robot, given.notes, std::nullopt, {});
    reference::IdentifySettings settings;
    settings.row_filter.emplace();
    settings.row_filter->rate = reader.report().rate;
    triangles[k] = merged(compress(
                              given.robot, given.model, [&] { return reader.next(); }, settings)
                              .blocks);
  });
  return triangles;
}

TEST(Threads, LogsReadAtOnceAreTheSameToTheLastBit) {
  const Robots given;
  for (std::size_t k = 0; k < logs; ++k) write_log(given.robot, k);
  const std::vector<Eigen::MatrixXd> one = compressed(given, 1);
  for (const Eigen::MatrixXd& R : one) {
    ASSERT_GT(R.rows(), 0);
    ASSERT_TRUE(R.allFinite());
  }
  for (const std::size_t threads : {2U, 4U, 7U}) EXPECT_EQ(compressed(given, threads), one);
}

}  // namespace
}  // namespace shapeid::test

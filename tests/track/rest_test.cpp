// An arm rests between its moves, behind sensors that round: readings repeat to the last bit, and
// leave no error, however wrong they are.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

// SI units: the upper arm and the forearm, about their joints' level axes.
constexpr double m1 = 3.0, c1 = 0.17, I1 = 0.0416, length = 0.4;
constexpr double m2 = 1.5, c2 = 0.14, I2 = 0.0117;
constexpr double g = 9.81;

// The rest of the inertias is the boxes': nothing turns about x or z.
constexpr const char* arm_urdf = R"(<robot name="arm">
  <link name="mount"/>
  <link name="upper">
    <inertial><origin xyz="0.17 0 0"/><mass value="3.0"/>
      <inertia ixx="0.0032" ixy="0" ixz="0" iyy="0.0416" iyz="0" izz="0.0416"/></inertial>
    <collision><origin xyz="0.2 0 0"/><geometry><box size="0.4 0.08 0.1"/></geometry></collision>
  </link>
  <link name="fore">
    <inertial><origin xyz="0.14 0 0"/><mass value="1.5"/>
      <inertia ixx="0.0009" ixy="0" ixz="0" iyy="0.0117" iyz="0" izz="0.0117"/></inertial>
    <collision><origin xyz="0.15 0 0"/><geometry><box size="0.3 0.06 0.08"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute"><parent link="mount"/><child link="upper"/>
    <origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="200" velocity="30"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/>
    <origin xyz="0.4 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2.8" upper="2.8" effort="200" velocity="30"/></joint>
</robot>
)";

/// What sensors round to, rad and N m, zero for nothing; the pace, s; and what every second row
/// reads more at the elbow, rad and N m.
struct Rounded {
  double q, tau, rest, move, q_flickers = 0.0, tau_flickers = 0.0;
};

double rounded(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

struct Joint {
  double q, dq, ddq;
};

constexpr double encoder = 2.0 * std::numbers::pi / 65536.0;  // rad

/// From pose to pose, at rest before each move; three derivatives are continuous.
Joint joint_at(double time, const double (&poses)[5], const Rounded& way) {
  const double pace = way.rest + way.move;
  const auto k = static_cast<std::size_t>(time / pace);
  const double from = poses[k % 5], by = poses[(k + 1) % 5] - from;
  const double s = std::max(0.0, (time - static_cast<double>(k) * pace - way.rest) / way.move);
  const double t = way.move, left = 1.0 - s;
  return {from + by * s * s * s * s * (35.0 + s * (-84.0 + s * (70.0 - 20.0 * s))),
          by * 140.0 * s * s * s * left * left * left / t,
          by * 420.0 * s * s * left * left * (1.0 - 2.0 * s) / (t * t)};
}

/// Lagrange's equations of the two links; joints that turn about y lower what points along x.
std::string arm_log(const Rounded& way) {
  constexpr double seconds = 16.0, rate = 250.0;
  constexpr double shoulder[] = {-0.14, 1.1, -0.9, 0.4, -1.3},
                   elbow[] = {0.18, -0.7, 1.2, 0.5, -1.1};
  std::string text = "time,q.shoulder,q.elbow,tau.shoulder,tau.elbow\n";
  for (int row = 0; row < static_cast<int>(seconds * rate); ++row) {
    const double time = row / rate;
    const Joint a = joint_at(time, shoulder, way), b = joint_at(time, elbow, way);
    const double both = m2 * length * c2 * std::cos(b.q), h = m2 * length * c2 * std::sin(b.q);
    const double M22 = I2 + m2 * c2 * c2, M12 = M22 + both;
    const double M11 = I1 + m1 * c1 * c1 + M22 + m2 * length * length + 2.0 * both;
    const double fore = g * m2 * c2 * std::cos(a.q + b.q);
    const double upper = g * (m1 * c1 + m2 * length) * std::cos(a.q);
    const double tau1 = M11 * a.ddq + M12 * b.ddq - h * (2.0 * a.dq + b.dq) * b.dq - upper - fore;
    const double tau2 = M12 * a.ddq + M22 * b.ddq + h * a.dq * a.dq - fore;
    const double odd = row % 2;
    text += fmt::format("{:.3f},{:.9g},{:.9g},{:.9g},{:.9g}\n", time, rounded(a.q, way.q),
                        rounded(b.q, way.q) + odd * way.q_flickers, rounded(tau1, way.tau),
                        rounded(tau2, way.tau) + odd * way.tau_flickers);
  }
  return text;
}

/// Tracks the arm whole, and expects its mass, and nothing else, on every line.
void expect_the_arm(const Rounded& way) {
  constexpr double settled = 3.0;  // s: the first move is over
  scratch_file("arm.urdf", arm_urdf);
  scratch_file("rests.csv", arm_log(way));
  const CommandRun run = shapeid("track --robot arm.urdf --whole-body rests.csv");
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string said = fmt::format("{} rad, {} N m, rests {} s, flickers by {} rad, {} N m",
                                       way.q, way.tau, way.rest, way.q_flickers, way.tau_flickers);
  std::istringstream text(run.out);
  std::size_t lines = 0;
  for (std::string part; std::getline(text, part); ++lines) {
    const json line = json::parse(part);
    const double time = line.at("time").get<double>();
    EXPECT_TRUE(line.at("load").is_null()) << said << ", " << time << " s: " << line.at("load");
    EXPECT_TRUE(line.at("doubt").is_null()) << said << ", " << time << " s";
    if (time < settled + way.rest) continue;
    EXPECT_NEAR(line.at("mass").at("tracked").get<double>(), m1 + m2, 0.2 * (m1 + m2))
        << said << ", " << time << " s";
  }
  EXPECT_GT(lines, 300U) << said;
}

/// Noise that was learned while nothing changed once made the Kalman filter certain of what is
/// rounded: 16 seconds of such logs ended with tonnes, and told of loads that nobody put on.
TEST(TrackRest, WhatIsRoundedMakesNothingCertain) {
  for (const Rounded& way : {Rounded{encoder, 0.05, 3.0, 1.0}, Rounded{encoder, 0.05, 1.0, 0.8},
                             Rounded{encoder, 0.05, 0.8, 0.25}, Rounded{0.0, 0.01, 1.0, 1.0},
                             Rounded{encoder, 0.0, 1.0, 1.0}}) {
    expect_the_arm(way);
  }
}

/// One reading that goes on changing once made rests say what they had not said: such logs ended
/// with up to 22.6 kg, on the way 76, and doubted it.
TEST(TrackRest, OneReadingThatFlickersMakesNothingCertain) {
  for (const Rounded& way :
       {Rounded{encoder, 0.05, 3.0, 1.0, encoder, 0.0}, Rounded{encoder, 0.05, 1.0, 0.8, 1e-7, 0.0},
        Rounded{encoder, 0.05, 3.0, 1.0, 0.0, 0.05}, Rounded{encoder, 0.05, 1.0, 0.8, 0.0, 1e-6}}) {
    expect_the_arm(way);
  }
}

/// Cut in a rest, whose first rows are behind it and whose last are not.
TEST(TrackRest, GoesOnAsIfItHadNotBeenCut) {
  const Rounded way{encoder, 0.05, 1.0, 0.8};
  const std::string log = arm_log(way);
  scratch_file("arm.urdf", arm_urdf);
  scratch_file("whole.csv", log);
  std::filesystem::remove(scratch() + "/rest.json");
  std::string said;
  for (const char* end : {"\n5.440,", ""}) {
    scratch_file("cut.csv", *end == '\0' ? log : log.substr(0, log.find(end) + 1));
    const CommandRun run =
        shapeid("track --robot arm.urdf --whole-body --checkpoint rest.json --resume cut.csv");
    ASSERT_EQ(run.status, 0) << run.err;
    said += run.out;
  }
  EXPECT_EQ(said, shapeid("track --robot arm.urdf --whole-body whole.csv").out);
}

}  // namespace
}  // namespace shapeid::test

// What standing feet say of the gyro and of the labels, on a trot by Simbody.
#include "shapeid/reference/standing_feet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/signed_axes.hpp"
#include "shapeid/reference/identify.hpp"
#include "shapeid/tests/recovery/quadruped.hpp"

namespace shapeid {
namespace {

using reference::StandingFeet;

class StandingFeetOfATrot : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    test::Trot wanted;
    wanted.seconds = 5.0;
    for (const SimulatedSample& s : test::trot(q_.robot, wanted)) samples_.push_back(s.sample);
  }

  /// What is refused if the gyro reads M times the base's turning; empty if nothing is.
  static std::string refused(const Eigen::Matrix3d& M) {
    StandingFeet feet(q_.robot);
    for (Sample s : samples_) {
      s.base_angular_velocity = M * s.base_angular_velocity;
      feet.add(s);
    }
    return said_by(feet);
  }
  static std::string said_by(StandingFeet& feet) {
    try {
      feet.judge();
    } catch (const Refusal& refusal) {
      return refusal.what();
    }
    return "";
  }

  inline static const test::Quadruped q_ = test::bundled_quadruped();
  inline static std::vector<Sample> samples_;
};

TEST_F(StandingFeetOfATrot, AcceptTheGyroAsItIs) {
  EXPECT_EQ(refused(Eigen::Matrix3d::Identity()), "");
  // A gain, or a mounting that is a little off, is no other axis.
  EXPECT_EQ(refused(1.2 * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix()), "");
}

TEST_F(StandingFeetOfATrot, NameTheAxesThatTheGyroHas) {
  std::size_t named = 0;
  for (const SignedAxes& axes : all_signed_axes()) {
    // The inverse of an exchange with signs is its transpose.
    const std::string said = refused(axes.matrix().transpose());
    if (said.empty()) continue;
    ++named;
    EXPECT_NE(said.find("imu-axes"), std::string::npos) << said;
    EXPECT_NE(said.find("if its axes were " + axes.words() + ","), std::string::npos) << said;
  }
  EXPECT_GE(named, signed_axes_count - 4);
}

TEST_F(StandingFeetOfATrot, KnowDegrees) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  const std::string said = refused(degrees * Eigen::Matrix3d::Identity());
  EXPECT_NE(said.find("if its unit were degrees per second,"), std::string::npos) << said;
  const SignedAxes& exchanged = all_signed_axes()[20];
  const std::string both = refused(degrees * exchanged.matrix().transpose());
  EXPECT_NE(both.find("if its unit were degrees per second and its axes were " + exchanged.words()),
            std::string::npos)
      << both;
}

/// Where nearly all feet slip, the few that do not tell by how many stances they are of.
TEST_F(StandingFeetOfATrot, NameTheAxesWhereMostFeetSlip) {
  const auto said_of = [](double sign, std::size_t count) {
    StandingFeet feet(q_.robot);
    for (std::size_t i = 0; i < count; ++i) {
      Sample s = samples_[i];
      s.base_angular_velocity *= sign;
      // Of each pair a leg; but of a quarter of a second one sample at least is left as it is.
      constexpr double slipping = 5.0;  // rad/s
      for (const int joint : {0, 3}) s.dq[joint] += i % 17 != 0 ? slipping : 0.0;
      feet.add(s);
    }
    return said_by(feet);
  };
  const std::string said = said_of(-1.0, samples_.size());
  EXPECT_NE(said.find("if its axes were (-x, -y, -z), more in 1"), std::string::npos) << said;
  EXPECT_EQ(said_of(1.0, samples_.size()).find("imu-axes"), std::string::npos);
  EXPECT_EQ(said_of(-1.0, samples_.size() / 2).find("imu-axes"), std::string::npos);
}

/// Of a diagonal pair in the air together the labels say nothing; of one foot in the air they do.
TEST_F(StandingFeetOfATrot, RefuseLabelsOfOtherFeet) {
  StandingFeet feet(q_.robot);
  for (Sample s : samples_) {
    std::rotate(s.in_contact.begin(), s.in_contact.begin() + 1, s.in_contact.end());
    feet.add(s);
  }
  EXPECT_NE(said_by(feet).find("contact-labels"), std::string::npos);
}

TEST_F(StandingFeetOfATrot, SayNothingWhereNothingOrOneFootStands) {
  StandingFeet feet(q_.robot);
  EXPECT_EQ(said_by(feet), "");
  for (Sample s : samples_) {
    s.base_angular_velocity *= -1.0;
    s.in_contact.assign(s.in_contact.size(), false);
    s.in_contact.front() = true;
    feet.add(s);
  }
  EXPECT_EQ(said_by(feet), "");
}

/// They are asked wherever contact forces are projected out, and nowhere else.
TEST_F(StandingFeetOfATrot, AreAskedByIdentify) {
  const auto code = [&](ContactTreatment contacts) -> std::string {
    reference::IdentifySettings settings;
    settings.expected_mass = 5.5;
    settings.contacts = contacts;
    std::size_t next = 0;
    try {
      (void)compress(
          q_.robot, q_.base,
          [&]() -> std::optional<Sample> {
            if (next == samples_.size()) return std::nullopt;
            Sample s = samples_[next++];
            s.base_angular_velocity *= -1.0;
            return s;
          },
          settings);
    } catch (const Refusal& refusal) {
      return refusal.code();
    }
    return "accepted";
  };
  EXPECT_EQ(code(ContactTreatment::project), "imu-axes");
  EXPECT_EQ(code(ContactTreatment::ignore), "accepted");
}

}  // namespace
}  // namespace shapeid

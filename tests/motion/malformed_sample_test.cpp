// What a sample has to be before the dynamics see it.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "shapeid/models/sample.hpp"

namespace shapeid {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Two joints in a row, a foot at the end.
Robot leg() {
  Robot robot;
  robot.links.resize(3);
  robot.links[1].parent = 0;
  robot.links[2].parent = 1;
  robot.contacts.resize(1);
  return robot;
}

Sample step() {
  Sample s;
  s.q = s.dq = s.ddq = s.tau = Eigen::Vector2d(0.1, 0.2);
  s.in_contact = {true};
  s.contact_force = {Eigen::Vector3d(1.0, 2.0, 30.0)};
  return s;
}

TEST(MalformedSample, OneAsItShouldBeIsNone) {
  EXPECT_FALSE(why_malformed(step(), leg()));
  Sample bare = step();
  bare.in_contact.clear();
  bare.contact_force.clear();
  bare.extra = {nan};  // which no equation reads
  EXPECT_FALSE(why_malformed(bare, leg()));
}

TEST(MalformedSample, EveryNumberMustBeFinite) {
  const std::vector<std::function<double&(Sample&)>> numbers = {
      [](Sample& s) -> double& { return s.time; },
      [](Sample& s) -> double& { return s.base_angular_velocity[1]; },
      [](Sample& s) -> double& { return s.base_angular_acceleration[2]; },
      [](Sample& s) -> double& { return s.base_specific_force[0]; },
      [](Sample& s) -> double& { return s.q[1]; },
      [](Sample& s) -> double& { return s.dq[0]; },
      [](Sample& s) -> double& { return s.ddq[1]; },
      [](Sample& s) -> double& { return s.tau[0]; },
      [](Sample& s) -> double& { return s.contact_force[0][2]; }};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
      Sample s = step();
      numbers[i](s) = bad;
      EXPECT_EQ(why_malformed(s, leg()), "a number of the sample is not finite") << i;
    }
  }
}

TEST(MalformedSample, HasANumberForEachJointAndContact) {
  const std::vector<std::function<void(Sample&)>> changes = {
      [](Sample& s) { s.q.resize(1); },          [](Sample& s) { s.dq.resize(3); },
      [](Sample& s) { s.ddq.resize(0); },        [](Sample& s) { s.tau.resize(1); },
      [](Sample& s) { s.in_contact.resize(2); }, [](Sample& s) { s.contact_force.resize(2); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Sample s = step();
    changes[i](s);
    EXPECT_TRUE(why_malformed(s, leg())) << i;
  }
}

}  // namespace
}  // namespace shapeid

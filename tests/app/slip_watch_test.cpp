// Feet that slip, among contacts of every kind and on either kind of base.
#include "shapeid/app/track_slip.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace shapeid::app {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A plate with a sliding joint under each of four contacts: an edge, a sole, and two points, in an
/// order in which each kind stands before another.
Robot table(Root root) {
  Robot robot;
  robot.name = "table";
  robot.root = root;
  robot.links.resize(5);
  robot.links[0].name = "plate";
  const ContactKind kinds[] = {ContactKind::line, ContactKind::plane, ContactKind::point,
                               ContactKind::point};
  const Vector3d places[] = {
      {0.3, 0.2, -0.1}, {-0.3, 0.25, -0.2}, {0.35, -0.2, -0.1}, {-0.4, -0.3, 0.1}};
  for (int leg = 0; leg < 4; ++leg) {
    Link& link = robot.links[static_cast<std::size_t>(leg) + 1];
    link.name = "leg" + std::to_string(leg);
    link.parent = 0;
    link.joint.name = "slide" + std::to_string(leg);
    link.joint.kind = JointKind::prismatic;
    link.joint.axis = Vector3d(1.0, 2.0, -2.0) / 3.0;
    link.joint.placement = Isometry3d::Identity();
    link.joint.placement.translation() = places[leg];
    Contact contact;
    contact.name = link.name;
    contact.link = leg + 1;
    contact.kind = kinds[leg];
    contact.frame.translation() = Vector3d(0.01, -0.02, -0.3);
    robot.contacts.push_back(contact);
  }
  return robot;
}

constexpr double rate = 100.0;
constexpr int samples = 8;  // 0.08 s

/// At these speeds of the joints, all feet down: who slips after so many samples.
std::vector<int> after(SlipWatch& watch, int count, const Eigen::Vector4d& speeds,
                       const std::vector<bool>& touching = {true, true, true, true}) {
  Sample sample;
  sample.q = Eigen::Vector4d(0.01, -0.02, 0.03, 0.0);
  sample.dq = speeds;
  sample.ddq = sample.tau = Eigen::Vector4d::Zero();
  sample.base_angular_velocity = Vector3d(0.02, -0.01, 0.03);
  sample.in_contact = touching;
  std::vector<int> slipping;
  for (int i = 0; i < count; ++i) slipping = watch.watch(sample);
  return slipping;
}

TEST(SlipWatch, NamesTheFootThatMovesWhateverTheKindsBeforeIt) {
  for (const Root root : {Root::floating, Root::fixed}) {
    const Robot robot = table(root);
    for (int foot = 0; foot < 4; ++foot) {
      SlipWatch watch(robot, rate);
      const Eigen::Vector4d speeds = 0.5 * Eigen::Vector4d::Unit(foot);
      EXPECT_EQ(after(watch, samples - 1, speeds), std::vector<int>{}) << foot;
      EXPECT_EQ(after(watch, 1, speeds), std::vector<int>{foot});
      EXPECT_EQ(after(watch, 3, speeds), std::vector<int>{foot});
      EXPECT_EQ(after(watch, 1, 0.4 * speeds), std::vector<int>{}) << "slower than a slip";
    }
  }
}

/// A base that moves over feet that rest is seen as all feet moving alike.
TEST(SlipWatch, FeetThatMoveAlikeRestOnTheGround) {
  const Eigen::Vector4d alike = Eigen::Vector4d::Constant(2.0);
  const Robot loose = table(Root::floating);
  SlipWatch floating(loose, rate);
  EXPECT_EQ(after(floating, 2 * samples, alike), std::vector<int>{});
  const Robot bolted = table(Root::fixed);
  SlipWatch fixed(bolted, rate);
  EXPECT_EQ(after(fixed, 2 * samples, alike), (std::vector<int>{0, 1, 2, 3}));
}

TEST(SlipWatch, AFootInTheAirBeginsAnew) {
  const Robot robot = table(Root::floating);
  SlipWatch watch(robot, rate);
  const Eigen::Vector4d speeds = 0.5 * Eigen::Vector4d::Unit(2);
  EXPECT_EQ(after(watch, samples - 1, speeds), std::vector<int>{});
  EXPECT_EQ(after(watch, 1, speeds, {true, true, false, true}), std::vector<int>{});
  EXPECT_EQ(after(watch, samples - 1, speeds), std::vector<int>{});
  EXPECT_EQ(after(watch, 1, speeds), std::vector<int>{2});
  watch.restart();
  EXPECT_EQ(after(watch, samples - 1, speeds), std::vector<int>{});
}

}  // namespace
}  // namespace shapeid::app

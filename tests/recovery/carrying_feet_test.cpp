// Flags that are dead: what the torques of a leg say of a foot that is declared in the air.
#include "shapeid/reference/carrying_feet.hpp"

#include <gtest/gtest.h>
#include <Eigen/QR>

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/contact_detection.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/recovery/quadruped.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using Change = std::function<void(Sample&)>;

/// What is said of a trot of which `change` makes another one; empty if nothing is.
class Trotting {
 public:
  Trotting() {
    test::Trot wanted;
    wanted.seconds = 5.0;
    for (const SimulatedSample& s : test::trot(q_.robot, wanted)) samples_.push_back(s.sample);
  }
  [[nodiscard]] const Robot& robot() const { return q_.robot; }
  [[nodiscard]] double begin() const { return samples_.front().time; }

  [[nodiscard]] std::string said(const Robot& robot, const Change& change) const {
    reference::CarryingFeet feet(robot);
    for (Sample s : samples_) {
      change(s);
      feet.add(s);
    }
    try {
      feet.judge();
    } catch (const Refusal& refusal) {
      return refusal.code() + ": " + refusal.what();
    }
    return "";
  }
  [[nodiscard]] std::string said(const Change& change) const { return said(robot(), change); }

 private:
  test::Quadruped q_ = test::bundled_quadruped();
  std::vector<Sample> samples_;
};

/// By the ratio of forces: also of a robot whose base is given without mass.
TEST(CarryingFeet, AreNamedWhoseFlagIsDead) {
  const Trotting trot;
  for (std::size_t foot = 0; foot < 4; ++foot) {
    const std::string all = trot.said([foot](Sample& s) { s.in_contact[foot] = false; });
    EXPECT_EQ(all.rfind("contact-labels: ", 0), 0U) << all;
    EXPECT_NE(all.find(trot.robot().contacts[foot].name + " is declared in the air for "),
              std::string::npos)
        << all;
  }
  const std::string later = trot.said([&](Sample& s) {
    if (s.time > trot.begin() + 2.0) s.in_contact[1] = false;
  });
  EXPECT_NE(later.find("FL_foot is declared in the air for"), std::string::npos) << later;
  Robot light = trot.robot();
  light.links[0].inertia.values.setZero();
  EXPECT_NE(trot.said(light, [](Sample& s) { s.in_contact[2] = false; }), "");
  EXPECT_EQ(trot.said(light, [](Sample&) {}), "");
}

/// Flags as they are, torques in another unit, a step or two that no flag tells of, logs of less
/// than a second each, and a leg that is held up: its torques carry nothing.
TEST(CarryingFeet, AreNotFoundElsewhere) {
  const Trotting trot;
  EXPECT_EQ(trot.said([](Sample&) {}), "");
  EXPECT_EQ(trot.said([](Sample& s) { s.tau *= 8.0; }), "");
  const auto for_a_second = [&](Sample& s) {
    if (s.time > trot.begin() + 2.0 && s.time < trot.begin() + 3.0) s.in_contact[1] = false;
  };
  EXPECT_EQ(trot.said(for_a_second), "");
  const auto short_logs = [&](Sample& s) {
    s.in_contact[1] = false;
    s.time += 10.0 * std::floor((s.time - trot.begin()) / 0.9);
  };
  EXPECT_EQ(trot.said(short_logs), "");
  const auto held_up = [](Sample& s) {
    s.in_contact[0] = false;
    s.tau.head<3>() = Eigen::Vector3d(0.2, -0.3, 0.1);
  };
  EXPECT_EQ(trot.said(held_up), "");
  reference::CarryingFeet none(trot.robot());
  EXPECT_NO_THROW(none.judge());
}

/// What the joints of the robot must do so that feet 1 to 3 carry it, as it stands with foot 0 up.
Sample standing_on_three(const Robot& robot, double knee) {
  const Eigen::Index n = robot.joint_count();
  Sample s;
  s.q = s.dq = s.ddq = s.tau = Eigen::VectorXd::Zero(n);
  for (Eigen::Index leg = 0; leg < n; leg += 3) s.q.segment<3>(leg) << 0.1, 0.8, -1.6;
  s.q.head<3>() << 0.1, -0.5 * knee, knee;
  s.base_specific_force = {0.3, -0.2, 9.8};
  s.in_contact = {false, true, true, true};
  const Eigen::MatrixXd J = reference::contact_jacobian(robot, s);
  const Eigen::VectorXd need = reference::regressor(robot, s) * stacked_parameters(robot);
  const Eigen::VectorXd f =
      J.leftCols(6).transpose().completeOrthogonalDecomposition().solve(need.head(6));
  s.tau = (need - J.transpose() * f).tail(n);
  return s;
}

/// What is said of a robot that stands like that for four seconds.
std::string said_of(const Robot& robot, Sample s) {
  reference::CarryingFeet feet(robot);
  for (int k = 0; k < 2000; ++k) {
    s.time = 0.002 * k;
    feet.add(s);
  }
  try {
    feet.judge();
  } catch (const Refusal& refusal) {
    return refusal.what();
  }
  return "accepted";
}

/// At the end of its range the knee takes half a newton metre of friction for a fifth of a foot's
/// load, and beyond it a tenth for all. Bent as the others it is named for what it carries.
TEST(CarryingFeet, AreNotLegsThatAreHeldUpStraight) {
  const Robot robot = test::bundled_quadruped().robot;
  for (const double knee : {-0.1, -0.2, -0.4, -0.55}) {
    for (const double friction : {0.0, 0.3, -0.3, 0.6, -0.6}) {
      Sample s = standing_on_three(robot, knee);
      s.tau[2] += friction;
      EXPECT_EQ(said_of(robot, s), "accepted") << knee << " " << friction;
    }
  }
  Sample carries = standing_on_three(robot, -1.6);
  EXPECT_EQ(said_of(robot, carries), "accepted");
  carries.in_contact = {true, false, true, true};
  EXPECT_NE(said_of(robot, carries).find("FL_foot is declared in the air"), std::string::npos);
}

/// Links of a kilogram each, as exporters write: a leg in the air would need more torque than there
/// is, as though a foot carried it.
TEST(CarryingFeet, AreNotLegsThatAreGivenTooHeavy) {
  const Robot robot = test::bundled_quadruped().robot;
  Robot heavy = robot;
  for (std::size_t link = 1; link < heavy.links.size(); ++link) {
    heavy.links[link].inertia.values *= 8.0;
  }
  const Sample s = standing_on_three(robot, -1.6);
  const Eigen::VectorXd force = reference::supporting_forces(heavy, s, stacked_parameters(heavy));
  EXPECT_GT(force[0], 0.2 * force.tail(3).mean());
  EXPECT_EQ(said_of(heavy, s), "accepted");
}

/// A change of any torque changes the forces as the columns say: forces are linear in torques.
TEST(CarryingFeet, HaveForcesThatFollowTorques) {
  const Robot robot = test::bundled_quadruped().robot;
  const Eigen::VectorXd Phi = stacked_parameters(robot);
  const Sample s = standing_on_three(robot, -1.1);
  const Eigen::VectorXd force = reference::supporting_forces(robot, s, Phi);
  const Eigen::MatrixXd per_torque = reference::support_per_torque(robot, s);
  ASSERT_EQ(per_torque.cols(), robot.joint_count());
  for (Eigen::Index j = 0; j < per_torque.cols(); ++j) {
    Sample less = s;
    less.tau[j] -= 1.0;
    const Eigen::VectorXd change = reference::supporting_forces(robot, less, Phi) - force;
    EXPECT_LT(test::scaled((change - per_torque.col(j)).norm(), force.norm() + change.norm(), 12),
              test::few_hundred_eps)
        << j;
  }
}

}  // namespace
}  // namespace shapeid

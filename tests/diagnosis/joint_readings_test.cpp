// Joints that are read from another zero than the model's, or with another sign.
#include "shapeid/diagnosis/joint_readings.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/joint_signs.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/diagnosis/trot.hpp"

namespace shapeid::diagnosis {
namespace {

using test::effect;

constexpr double a_quarter = 0.5 * std::numbers::pi;

/// What is refused, as this; empty if nothing is.
std::string refused(const Robot& robot, const Recording& log, const std::string& code) {
  try {
    check_joint_readings(robot, log, ContactTreatment::ignore);
  } catch (const Refusal& r) {
    EXPECT_EQ(r.code(), code) << r.what();
    return r.what();
  }
  return "";
}
/// Of the arm's log with these in it.
std::string zeros_of(const Robot& robot, const Recording& log) {
  return refused(robot, log, "joint-zero");
}
std::string zeros_of(const std::vector<AppliedEffect>& effects) {
  return zeros_of(test::arm(), test::record({effects}));
}

TEST(JointZeros, AreNamedWithWhatIsToBeAdded) {
  EXPECT_NE(zeros_of({effect("encoder_offset", 1, {a_quarter})}).find("(joint2 +1.5708 rad)"),
            std::string::npos);
  EXPECT_NE(zeros_of({effect("encoder_offset", 1, {-a_quarter})}).find("(joint2 -1.5708 rad)"),
            std::string::npos);
  EXPECT_NE(zeros_of({effect("encoder_offset", 1, {2.0 * a_quarter})}).find("(joint2 +3.1416 rad)"),
            std::string::npos);
  // Not quite a quarter, and friction beside it.
  EXPECT_NE(zeros_of({effect("encoder_offset", 1, {1.4}), effect("viscous_friction", 0, {0.5})})
                .find("(joint2 +1.5708 rad)"),
            std::string::npos);
}

TEST(JointZeros, OfSeveralJointsAreAllNamed) {
  const std::string said = zeros_of(
      {effect("encoder_offset", 1, {a_quarter}), effect("encoder_offset", 2, {-a_quarter})});
  EXPECT_NE(said.find("joint2 +1.5708 rad"), std::string::npos) << said;
  EXPECT_NE(said.find("joint3 -1.5708 rad"), std::string::npos) << said;
}

TEST(JointZeros, AreNoneWhereSomethingElseIsWrong) {
  EXPECT_EQ(zeros_of({}), "");
  EXPECT_EQ(zeros_of({effect("encoder_offset", 1, {0.3})}), "");
  EXPECT_EQ(zeros_of({effect("torque_offset", 1, {20.0}), effect("viscous_friction", 0, {5.0})}),
            "");
  for (const double roll : {a_quarter, -a_quarter}) {
    EXPECT_EQ(zeros_of({effect("gravity_tilt", 0, {roll, 0.0})}), "") << roll;
    EXPECT_EQ(zeros_of({effect("gravity_tilt", 0, {0.0, roll})}), "") << roll;
  }
}

/// The arm's log as another convention has it: of a joint position and torque with these signs, and
/// zero elsewhere.
struct Convention {
  int joint;
  double position_sign, torque_sign, further;
};
Recording read_as(const std::vector<Convention>& conventions) {
  return test::record({}, [&](std::vector<Sample>& samples) {
    for (Sample& s : samples) {
      for (const Convention& c : conventions) {
        s.q[c.joint] = c.position_sign * (s.q[c.joint] - c.further);
        s.dq[c.joint] *= c.position_sign;
        s.ddq[c.joint] *= c.position_sign;
        s.tau[c.joint] *= c.torque_sign;
      }
    }
  });
}
std::string signs_of(const std::vector<Convention>& conventions) {
  return refused(test::arm(), read_as(conventions), "joint-sign");
}

TEST(JointSigns, AreNamed) {
  EXPECT_NE(signs_of({{1, -1.0, 1.0, 0.0}}).find("(joint2 position of the other sign)"),
            std::string::npos);
  EXPECT_NE(signs_of({{1, 1.0, -1.0, 0.0}}).find("(joint2 torque of the other sign)"),
            std::string::npos);
  EXPECT_NE(signs_of({{1, -1.0, -1.0, a_quarter}})
                .find("(joint2 position of the other sign and +1.5708 rad and torque of the other "
                      "sign)"),
            std::string::npos);
  const std::string both = signs_of({{1, -1.0, 1.0, 0.0}, {2, 1.0, -1.0, 0.0}});
  EXPECT_NE(both.find("joint2 position of the other sign"), std::string::npos) << both;
  EXPECT_NE(both.find("joint3 torque of the other sign"), std::string::npos) << both;
}

/// Of legs, whose feet stand, each joint and each sign is told.
TEST(JointSigns, OfALegAreNamed) {
  const test::Trot trot;
  const auto said = [&trot](int joint, double position_sign, double torque_sign) -> std::string {
    std::vector<Sample> samples = trot.samples;
    for (Sample& s : samples) {
      s.q[joint] *= position_sign;
      s.dq[joint] *= position_sign;
      s.ddq[joint] *= position_sign;
      s.tau[joint] *= torque_sign;
    }
    try {
      check_joint_readings(trot.robot, {std::move(samples), test::Trot::rate},
                           ContactTreatment::project);
    } catch (const Refusal& r) {
      EXPECT_EQ(r.code(), "joint-sign");
      return r.what();
    }
    return "";
  };
  EXPECT_EQ(said(0, 1.0, 1.0), "");
  for (const int joint : {0, 4, 11}) {
    const std::string& name = trot.robot.joint(joint).name;
    EXPECT_NE(said(joint, -1.0, 1.0)
                  .find("(" + name + " position of the other sign, or others of that leg)"),
              std::string::npos)
        << name;
  }
  EXPECT_NE(said(1, 1.0, -1.0).find("(" + trot.robot.joint(1).name + " torque of the other sign,"),
            std::string::npos);
}

/// What masses that are fitted tell, of links that are given ten times too light.
std::string fitted_signs_of(const Recording& log) {
  Robot given = test::arm();
  for (Link& link : given.links) link.inertia.values *= 0.1;
  EXPECT_EQ(refused(given, log, "none"), "");
  try {
    check_joint_signs(given, log, test::arm_settings());
  } catch (const Refusal& r) {
    EXPECT_EQ(r.code(), "joint-sign") << r.what();
    return r.what();
  }
  return "";
}

TEST(JointSigns, AreToldByMassesThatAreFitted) {
  EXPECT_NE(fitted_signs_of(read_as({{1, -1.0, 1.0, 0.0}}))
                .find("masses that are fitted predict the logged torque far better if joints are "
                      "read otherwise (joint2 position of the other sign):"),
            std::string::npos);
  EXPECT_NE(
      fitted_signs_of(read_as({{2, 1.0, -1.0, 0.0}})).find("(joint3 torque of the other sign)"),
      std::string::npos);
  EXPECT_NE(fitted_signs_of(read_as({{1, -1.0, -1.0, 0.0}}))
                .find("(joint2 position of the other sign and torque of the other sign)"),
            std::string::npos);
  const std::string both = fitted_signs_of(read_as({{1, -1.0, 1.0, 0.0}, {2, -1.0, -1.0, 0.0}}));
  EXPECT_NE(both.find("joint2 position of the other sign"), std::string::npos) << both;
  EXPECT_NE(both.find("joint3 position of the other sign and torque of the other sign"),
            std::string::npos)
      << both;
}

/// Whatever else is in the log, and a lot of it.
TEST(JointSigns, AreNotWhatAnEffectLooksLikeToMasses) {
  EXPECT_EQ(fitted_signs_of(test::record({})), "");
  EXPECT_EQ(fitted_signs_of(test::record({{}, 20.0, 0.0})), "") << "exact";
  constexpr double size = 30.0;
  for (const char* id : {"viscous_friction", "coulomb_friction", "torque_offset", "joint_spring",
                         "rotor_inertia", "load_friction"}) {
    for (const int joint : {0, 1, 2}) {
      AppliedEffect put = at_start(*find_effect(id), joint);
      put.value[0] = size * put.effect->parameters[0].size;
      EXPECT_EQ(fitted_signs_of(test::record({{put}})), "") << id << joint;
    }
  }
  for (const double angle : {0.3, 2.0, -a_quarter}) {
    EXPECT_EQ(fitted_signs_of(test::record({{effect("gravity_tilt", 0, {angle, 0.2})}})), "");
    EXPECT_EQ(fitted_signs_of(test::record({{effect("encoder_offset", 1, {angle})}})), "");
  }
}

/// A pendulum near its zero takes the same torque as one whose axis points the other way: more than
/// half is predicted, and what is not may be a centre of mass.
TEST(JointSigns, AreNotSoughtWhereHalfIsPredicted) {
  EXPECT_EQ(signs_of({{1, -1.0, -1.0, 0.0}}), "");
}

/// About a level first axis a base on its side is what a turned joint is: left to the tilt.
TEST(JointZeros, OfALevelFirstAxisAreLeftToTheBase) {
  Robot robot = test::arm();
  robot.links[1].joint.axis = Eigen::Vector3d::UnitY();
  EXPECT_EQ(
      zeros_of(robot, test::moved_as_arm(robot, {effect("gravity_tilt", 0, {0.0, a_quarter})})),
      "");
  EXPECT_NE(zeros_of(robot, test::moved_as_arm(robot, {effect("encoder_offset", 1, {a_quarter})})),
            "");
}

/// Stretched out, and given four times too heavy: upright links would do less harm, and predict
/// nothing.
TEST(JointZeros, AreNoneWhereTheGivenLinksPredictNothing) {
  Robot robot = test::arm();
  for (Link& link : robot.links) {
    if (link.parent < 0) continue;
    link.joint.placement.translation() = Eigen::Vector3d(0.3, 0.0, 0.02);
    link.inertia = from_centre(2.0, {0.3, 0.01, 0.02}, 0.01 * Eigen::Matrix3d::Identity());
  }
  const Recording log = test::moved_as_arm(robot, {});
  for (const double times : {4.0, 1e-3}) {
    Robot given = robot;
    for (Link& link : given.links) link.inertia.values *= times;
    EXPECT_EQ(zeros_of(given, log), "") << times;
  }
}

/// A centre of mass near an axis that is given on its other side is no other zero, as on seven of
/// 150 drawn arms (seed 9556): all else is predicted.
TEST(JointZeros, AreNotThoseOfCentresNearAnAxis) {
  Robot robot = test::arm(), given = robot;
  const auto with_centre = [](Robot& of, double side) {
    of.links.back().inertia =
        from_centre(1.0, {0.004 * side, 0.1, -0.003 * side}, 0.004 * Eigen::Matrix3d::Identity());
  };
  with_centre(robot, 1.0);
  with_centre(given, -1.0);
  EXPECT_EQ(zeros_of(given, test::moved_as_arm(robot, {})), "");
}

}  // namespace
}  // namespace shapeid::diagnosis

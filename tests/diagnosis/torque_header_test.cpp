// The generated header, compiled and run, says what the model says.
#include "shapeid/diagnosis/torque_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::diagnosis {
namespace {

/// "q, dq, ddq, base": the names of arrays, whose declarations are added to `arrays`.
std::string arguments(const Sample& s, Root root, std::string& arrays) {
  std::vector<Eigen::VectorXd> numbers = {s.q, s.dq, s.ddq};
  if (root == Root::floating) {
    numbers.emplace_back(9);
    numbers.back() << s.base_angular_velocity, s.base_angular_acceleration, s.base_specific_force;
  }
  std::string names;
  for (const Eigen::VectorXd& v : numbers) {
    const std::string name = fmt::format("s{}", arrays.size());
    arrays += fmt::format("  const double {}[] = {{{}}};\n", name, fmt::join(v, ", "));
    names += (names.empty() ? "" : ", ") + name;
  }
  return names + (root == Root::floating ? "" : ", nullptr");
}

/// What predict() of the compiled header says, one column for each `call` (its arguments).
Eigen::MatrixXd said_by_header(const std::string& header, const std::string& arrays,
                               const std::vector<std::string>& calls) {
  std::string main =
      "#include \"model.hpp\"\n#include <cstdio>\nint main() {\n" + arrays + "  double tau[3];\n";
  for (const std::string& call : calls) {
    main += "  shapeid_model::predict(" + call +
            ", tau);\n  for (double t : tau) std::printf(\"%.17g\\n\", t);\n";
  }
  const test::ScratchFolder scratch;
  scratch.write("model.hpp", header);
  const std::string program = scratch.write("main.cpp", main + "}\n");
  const std::string binary = scratch.path("predict");
  const std::string build = "c++ -std=c++17 -Wall -Wextra -Werror -o " + binary + " " + program;
  EXPECT_EQ(std::system(build.c_str()), 0) << header;
  EXPECT_EQ(std::system((binary + " > " + scratch.path("out")).c_str()), 0);
  std::ifstream out(scratch.path("out"));
  Eigen::MatrixXd said(3, std::ssize(calls));
  for (double& x : said.reshaped()) out >> x;
  EXPECT_TRUE(out);
  return said;
}

TEST(TorqueHeader, PredictsWhatTheModelPredicts) {
  const Robot robot = test::arm();
  const std::vector<AppliedEffect> effects = {test::effect("viscous_friction", 0, {0.3}),
                                              test::effect("coulomb_friction", 1, {0.2}),
                                              test::effect("stribeck_friction", 2, {0.1}),
                                              test::effect("load_friction", 1, {0.05}),
                                              test::effect("torque_offset", 2, {-0.4}),
                                              test::effect("rotor_inertia", 2, {0.02}),
                                              test::effect("rotor_reaction", 2, {0.01}),
                                              test::effect("joint_spring", 0, {0.5, 0.1}),
                                              test::effect("cogging", 1, {0.1, -0.2}),
                                              test::effect("link_length", 2, {0.01}),
                                              test::effect("encoder_offset", 1, {0.02}),
                                              test::effect("torque_gain", 1, {0.1}),
                                              test::effect("external_force", 3, {2.0, -1.0, 0.5})};
  const auto follows = [](const std::string& law, int site, CurveSignal signal, int joint) {
    return Curve{test::effect(law, site, {0.0}),
                 {signal, joint},
                 Eigen::Vector3d(-2.0, 0.3, 2.5),
                 Eigen::Vector3d(0.2, -0.1, 0.7)};
  };
  const RichModel model{stacked_parameters(robot),
                        effects,
                        {follows("torque_offset", 0, CurveSignal::position, 2),
                         follows("viscous_friction", 1, CurveSignal::acceleration, 0),
                         follows("coulomb_friction", 2, CurveSignal::speed, 1),
                         follows("rotor_inertia", 1, CurveSignal::load, 1)}};
  const Recording recording = test::record({});
  const Viewer viewer(robot, ContactTreatment::ignore, effects);
  const Eigen::VectorXd wanted = predict(viewer, viewer.view(recording, 500), model).force;
  std::string arrays;
  const std::string call = arguments(recording[500], robot.root, arrays);
  const Eigen::VectorXd got = said_by_header(torque_header(robot, model), arrays, {call});
  // load_friction counts with the load of the rigid links, computed in another order.
  EXPECT_LT(test::scaled_difference(got, wanted, 20), test::few_hundred_eps);
}

TEST(TorqueHeader, SaysWhichNumberIsWhichJoint) {
  const Robot robot = test::arm();
  const std::string header = torque_header(robot, {stacked_parameters(robot), {}, {}});
  EXPECT_NE(header.find("//   0 joint1\n//   1 joint2\n//   2 joint3\n"), std::string::npos);
}

/// With the motion before and after, a lag too; what a payload weighs is no part of the load that
/// lags and rubs, in the library and so here.
void expect_lag_follows_the_rigid_links(Root root) {
  Robot robot = test::arm();
  robot.root = root;
  const std::vector<AppliedEffect> effects = {
      test::effect("torque_gain", 1, {0.1}),
      test::effect("torque_lag", 1, {0.03}),
      test::effect("torque_lag", 2, {0.01}),
      test::effect("load_friction", 0, {0.05}),
      test::effect("encoder_offset", 1, {0.02}),
      test::effect("link_length", 2, {0.01}),
      test::effect("payload", 3, {0.8, 0.02, 0.01, 0.2, 0.06, 0.001, -0.004, 0.06, 0.002, 0.01})};
  const RichModel model{stacked_parameters(robot), effects};
  const Recording recording = test::record({}, [&](std::vector<Sample>& samples) {
    if (root == Root::fixed) return;
    for (Sample& s : samples) {
      const double t = s.time;
      s.base_angular_velocity = {0.8 * std::sin(3.0 * t), 0.5 * std::cos(4.0 * t), std::sin(t)};
      s.base_angular_acceleration = {2.4 * std::cos(3.0 * t), -2.0 * std::sin(4.0 * t),
                                     std::cos(t)};
      s.base_specific_force = {std::sin(5.0 * t), 0.3, 9.6 + 1.5 * std::cos(2.0 * t)};
    }
  });
  const Viewer viewer(robot, ContactTreatment::ignore, effects);
  const std::vector<std::size_t> instants = {300, 551, 902, 1203, 1604};
  Eigen::MatrixXd wanted(3, std::ssize(instants));
  std::string arrays;
  std::vector<std::string> calls;
  const double step = neighbour_step(robot);
  for (const std::size_t i : instants) {
    wanted.col(std::ssize(calls)) =
        predict(viewer, viewer.view(recording, i), model).force.tail<3>();
    std::string call;
    for (const double dt : {-step, 0.0, step}) {
      call += (call.empty() ? "{" : ", {") +
              arguments(recording.shifted(i, dt), robot.root, arrays) + "}";
    }
    calls.push_back(call);
  }
  const std::string header = torque_header(robot, model);
  EXPECT_EQ(header.find("not part of this prediction"), std::string::npos);
  const Eigen::MatrixXd got = said_by_header(header, arrays, calls);
  // The rate divides the rounding of loads by twice the step.
  const double magnified = 1.0 + 0.03 / step;
  for (Eigen::Index k = 0; k < wanted.cols(); ++k) {
    EXPECT_LT(test::scaled_difference(got.col(k), wanted.col(k), 20),
              magnified * test::few_hundred_eps);
  }
}

TEST(TorqueHeader, LagOfADriveFollowsTheLoadOfTheRigidLinks) {
  expect_lag_follows_the_rigid_links(Root::fixed);
}
TEST(TorqueHeader, LagOfADriveFollowsTheLoadOfTheRigidLinksInTheAir) {
  expect_lag_follows_the_rigid_links(Root::floating);
}

/// With what feet carry taken off, where a gain, friction by load and a lag see it as the library
/// does.
TEST(TorqueHeader, TakesOffContactForcesBeforeWhatDependsOnThem) {
  Robot robot = test::arm();
  robot.root = Root::floating;
  robot.contacts = {{"tip", 3, ContactKind::point, Eigen::Isometry3d::Identity()}};
  robot.contacts[0].frame.translation() = Eigen::Vector3d(0.02, -0.01, -0.2);
  const std::vector<AppliedEffect> effects = {test::effect("torque_gain", 1, {0.3}),
                                              test::effect("torque_lag", 2, {0.03}),
                                              test::effect("load_friction", 0, {0.05})};
  const RichModel model{stacked_parameters(robot), effects};
  const Recording recording = test::record({}, [&](std::vector<Sample>& samples) {
    for (Sample& s : samples) {
      s.base_angular_velocity = {0.8 * std::sin(3.0 * s.time), 0.5, std::sin(s.time)};
      s.base_angular_acceleration = {2.4 * std::cos(3.0 * s.time), 0.0, std::cos(s.time)};
      s.base_specific_force = {std::sin(5.0 * s.time), 0.3, 9.6 + std::cos(2.0 * s.time)};
      s.in_contact = {true};
    }
  });
  const Viewer viewer(robot, ContactTreatment::project, effects);
  const std::size_t at = 700;
  const View view = viewer.view(recording, at);
  const Prediction predicted = predict(viewer, view, model);
  const Eigen::VectorXd& f = predicted.load.force;
  ASSERT_GT(f.norm(), 1.0);
  const Eigen::VectorXd wanted = (predicted.force - predicted.J.transpose() * f).tail<3>();
  std::string arrays, call;
  const double step = neighbour_step(robot);
  ASSERT_EQ(view.around.size(), 2U);
  for (const int place : {0, 1, 2}) {
    const Eigen::MatrixXd& J = place == 1 ? view.J : view.around[place == 0 ? 0 : 1].J;
    const Eigen::MatrixXd& Y = place == 1 ? view.Y : view.around[place == 0 ? 0 : 1].Y;
    const Eigen::VectorXd force =
        predicted_load(robot, Eigen::VectorXd::Zero(robot.dof()), Y * model.Phi, J).force;
    const Eigen::VectorXd contact = (J.transpose() * force).tail<3>();
    const std::string name = fmt::format("contact{}", place);
    call += (call.empty() ? "{" : ", {") +
            arguments(recording.shifted(at, (place - 1) * step), robot.root, arrays) + ", " + name +
            "}";
    arrays += fmt::format("  const double {}[] = {{{}}};\n", name, fmt::join(contact, ", "));
  }
  const Eigen::MatrixXd got = said_by_header(torque_header(robot, model), arrays, {call});
  const double magnified = (1.0 + 0.03 / step) * (1.0 + f.norm());
  EXPECT_LT(test::scaled_difference(got.col(0), wanted, 20), magnified * test::few_hundred_eps);
}

/// What a name says in a comment stays in it.
TEST(TorqueHeader, NamesEndNoLine) {
  Robot robot = test::arm();
  robot.links[1].name = "upper\\";
  robot.links[2].joint.name = "elbow\\";
  const RichModel model{stacked_parameters(robot), {}};
  const Recording recording = test::record({});
  const Viewer viewer(robot, ContactTreatment::ignore, {});
  const Eigen::VectorXd wanted = predict(viewer, viewer.view(recording, 500), model).force;
  std::string arrays;
  const std::string call = arguments(recording[500], robot.root, arrays);
  const Eigen::MatrixXd got = said_by_header(torque_header(robot, model), arrays, {call});
  EXPECT_LT(test::scaled_difference(got, wanted, 20), test::few_hundred_eps);
}

}  // namespace
}  // namespace shapeid::diagnosis

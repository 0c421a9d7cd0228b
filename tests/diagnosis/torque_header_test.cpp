// The generated header, compiled and run, says what the model says.
#include "shapeid/diagnosis/torque_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
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

/// The same motion, dt (s) later everywhere.
Recording later_by(const Recording& recording, double dt) {
  std::vector<Sample> samples = recording.samples();
  for (const std::size_t i : recording.usable(1)) samples[i] = recording.shifted(i, dt);
  return {std::move(samples), recording.rate()};
}

/// Where the slope of a load begins and ends for a lag of T, s from now.
struct Slope {
  Slope(const Robot& robot, double T)
      : half(std::max(std::sqrt(3.0) * T, neighbour_step(robot))),
        begin(-T - half),
        end(-T + half) {}
  double half, begin, end;
};

/// Rates divide the rounding of loads by this.
double magnified(double T, const Robot& robot) { return 1.0 + T / neighbour_step(robot); }

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
      test::effect("torque_lag", 1, {0.014}),
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
  for (const std::size_t i : instants) {
    const View view = viewer.view(recording, i);
    PredictedLoad load = predict(viewer, view, model).load;
    std::string around;
    for (const AppliedEffect& a : effects) {
      if (!a.effect->filters_load) continue;
      const Slope slope(robot, a.value[0]);
      std::vector<double> loads;
      for (const double dt : {slope.begin, slope.end}) {
        const View then = viewer.view(later_by(recording, dt), i);
        loads.push_back(predict(viewer, then, model).load.joint[a.site]);
        around += "{" + arguments(recording.shifted(i, dt), robot.root, arrays) + "}, ";
      }
      load.rate[a.site] = (loads[1] - loads[0]) / (2.0 * slope.half);
    }
    wanted.col(std::ssize(calls)) =
        predict(viewer, view, view.Y * model.Phi, model, load).force.tail<3>();
    arrays += fmt::format("  const shapeid_model::Motion around{}[] = {{{}}};\n", i, around);
    calls.push_back(
        fmt::format("{{{}}}, around{}", arguments(recording[i], robot.root, arrays), i));
  }
  const std::string header = torque_header(robot, model);
  EXPECT_EQ(header.find("not part of this prediction"), std::string::npos);
  const Eigen::MatrixXd got = said_by_header(header, arrays, calls);
  for (Eigen::Index k = 0; k < wanted.cols(); ++k) {
    EXPECT_LT(test::scaled_difference(got.col(k), wanted.col(k), 20),
              magnified(0.014, robot) * test::few_hundred_eps);
  }
}

TEST(TorqueHeader, LagOfADriveFollowsTheLoadOfTheRigidLinks) {
  expect_lag_follows_the_rigid_links(Root::fixed);
}
TEST(TorqueHeader, LagOfADriveFollowsTheLoadOfTheRigidLinksInTheAir) {
  expect_lag_follows_the_rigid_links(Root::floating);
}

/// The contact forces that carry the base.
Eigen::VectorXd carrying(const Robot& robot, const View& view, const RichModel& model) {
  return predicted_load(robot, Eigen::VectorXd::Zero(robot.dof()), view.Y * model.Phi, view.J)
      .force;
}

/// With what feet carry taken off, where a gain, friction by load and a lag see it as the library
/// does.
TEST(TorqueHeader, TakesOffContactForcesBeforeWhatDependsOnThem) {
  Robot robot = test::arm();
  robot.root = Root::floating;
  robot.contacts = {{"tip", 3, ContactKind::point, Eigen::Isometry3d::Identity()}};
  robot.contacts[0].frame.translation() = Eigen::Vector3d(0.02, -0.01, -0.2);
  const std::vector<AppliedEffect> effects = {test::effect("torque_gain", 1, {0.3}),
                                              test::effect("torque_lag", 2, {0.014}),
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
  const Slope slope(robot, effects[1].value[0]);
  std::string arrays;
  const auto motion = [&](const View& view, double dt) {
    const Eigen::VectorXd contact = (view.J.transpose() * carrying(robot, view, model)).tail<3>();
    const std::string name = fmt::format("contact{}", arrays.size());
    arrays += fmt::format("  const double {}[] = {{{}}};\n", name, fmt::join(contact, ", "));
    return "{" + arguments(recording.shifted(at, dt), robot.root, arrays) + ", " + name + "}";
  };
  const View view = viewer.view(recording, at);
  PredictedLoad load = predict(viewer, view, model).load;
  ASSERT_GT(load.force.norm(), 1.0);
  std::string around;
  std::vector<double> loads;
  for (const double dt : {slope.begin, slope.end}) {
    const View then = viewer.view(later_by(recording, dt), at);
    const Eigen::VectorXd f = carrying(robot, then, model);
    loads.push_back((then.Y * model.Phi - then.J.transpose() * f).tail<3>()[2]);
    around += motion(then, dt) + ", ";
  }
  load.rate[2] = (loads[1] - loads[0]) / (2.0 * slope.half);
  const Prediction predicted = predict(viewer, view, view.Y * model.Phi, model, load);
  const Eigen::VectorXd wanted = (predicted.force - predicted.J.transpose() * load.force).tail<3>();
  const std::string call = motion(view, 0.0) + ", around";
  arrays += "  const shapeid_model::Motion around[] = {" + around + "};\n";
  const Eigen::MatrixXd got = said_by_header(torque_header(robot, model), arrays, {call});
  EXPECT_LT(test::scaled_difference(got.col(0), wanted, 20),
            magnified(0.014, robot) * (1.0 + load.force.norm()) * test::few_hundred_eps);
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

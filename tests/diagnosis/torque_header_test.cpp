// The generated header, compiled and run, says what the model says.
#include "shapeid/diagnosis/torque_header.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/motion/scratch.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::diagnosis {
namespace {

TEST(TorqueHeader, PredictsWhatTheModelPredicts) {
  const Robot robot = test::arm();
  const std::vector<AppliedEffect> effects = {
      test::effect("viscous_friction", 0, {0.3}),  test::effect("coulomb_friction", 1, {0.2}),
      test::effect("stribeck_friction", 2, {0.1}), test::effect("load_friction", 1, {0.05}),
      test::effect("torque_offset", 2, {-0.4}),    test::effect("rotor_inertia", 2, {0.02}),
      test::effect("rotor_reaction", 2, {0.01}),   test::effect("joint_spring", 0, {0.5, 0.1}),
      test::effect("cogging", 1, {0.1, -0.2}),     test::effect("link_length", 2, {0.01}),
      test::effect("encoder_offset", 1, {0.02}),   test::effect("torque_gain", 1, {0.1})};
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
  const Sample sample = recording[500];
  const Viewer viewer(robot, reference::ContactTreatment::ignore, effects);
  const Eigen::VectorXd wanted = predict(viewer, viewer.view(recording, 500), model).force;

  const test::Scratch scratch;
  static_cast<void>(scratch.file("model.hpp", torque_header(robot, model)));
  std::string numbers;
  for (const auto& v : {sample.q, sample.dq, sample.ddq}) {
    std::string list;
    for (const double x : v) {
      std::array<char, 40> text{};
      static_cast<void>(std::snprintf(text.data(), text.size(), "%.17g", x));
      list += (list.empty() ? "" : ", ") + std::string(text.data());
    }
    numbers += (numbers.empty() ? "{" : ", {") + list + "}";
  }
  const std::string program = scratch.file(
      "main.cpp", "#include \"model.hpp\"\n#include <cstdio>\nint main() {\n  double s[3][3] = {" +
                      numbers +
                      "}, tau[3];\n  shapeid_model::predict(s[0], s[1], s[2], nullptr, tau);\n"
                      "  for (double t : tau) std::printf(\"%.17g\\n\", t);\n}\n");
  const std::string binary = scratch.path("predict");
  const std::string build = "c++ -std=c++17 -Wall -Wextra -Werror -o " + binary + " " + program;
  ASSERT_EQ(std::system(build.c_str()), 0) << torque_header(robot, model);
  ASSERT_EQ(std::system((binary + " > " + scratch.path("out")).c_str()), 0);
  std::ifstream out(scratch.path("out"));
  Eigen::VectorXd got(3);
  for (double& x : got) out >> x;
  // load_friction counts with the load of the rigid links, computed in another order.
  EXPECT_LT(test::scaled_difference(got, wanted, 20), test::few_hundred_eps);
}

}  // namespace
}  // namespace shapeid::diagnosis

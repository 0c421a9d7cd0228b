// The answer for a load: its mass, its place and its inertia are those of a block that was there.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/app/farthest.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

const std::string yaml = fmt::format("--robot-yaml {}quadruped.robot.yaml", robots);

// So many leave cells smaller than a block around it, which can make it exactly.
constexpr int enough = 40;

struct Answer {
  json document;
  std::string text;
};

Answer load(const std::string& words, int divisions) {
  const CommandRun run = shapeid(fmt::format(
      "load {} {} --divisions {} --eps 0 --lambda 0 --out load_found", words, yaml, divisions));
  EXPECT_EQ(run.status, 0) << run.err;
  if (run.status != 0) return {};
  return {json::parse(text_of(scratch() + "/load_found/result.json")), run.out};
}

InertialParameters found(const json& load) {
  const auto c = load.at("centre").get<std::vector<double>>();
  const auto I = load.at("inertia_about_centre").get<std::vector<double>>();
  Eigen::Matrix3d tensor;
  tensor << I[0], I[1], I[2], I[1], I[3], I[4], I[2], I[4], I[5];
  return from_centre(load.at("mass").get<double>(), {c[0], c[1], c[2]}, tensor);
}

Vector10 numbers(const json& list) {
  const auto values = list.get<std::vector<double>>();
  EXPECT_EQ(values.size(), 10U);
  return Eigen::Map<const Vector10>(values.data());
}

// kg, kg m, kg m^2: what the rows may leave open where the shapes can make the truth.
constexpr double little = 1e-9;

/// `truth` in the carrier's frame, as the answer is.
void expect_found(const Answer& answer, const std::string& carrier, const Vector10& given,
                  const InertialParameters& truth) {
  const json& load = answer.document.at("load");
  EXPECT_EQ(load.at("link"), carrier);
  const InertialParameters body = found(load);
  const MassProblem rows =
      problem_from_json(text_of(scratch() + "/load_found/problem.json"), "problem.json");
  const double error =
      farthest(rows.Y, rows.F, truth.values, answer.document.at("objective").at("data"));
  EXPECT_LE((body.values - truth.values).norm(), error);
  EXPECT_LT(error, little);

  // The link is there with its load.
  ASSERT_EQ(answer.document.at("links").size(), 1U);
  const json& link = answer.document.at("links")[0];
  EXPECT_EQ(link.at("name"), carrier);
  EXPECT_EQ(numbers(link.at("given")), given);
  EXPECT_LT(scaled_difference(numbers(link.at("parameters")), given + body.values, 10),
            few_hundred_eps);
  // What the data say without shapes leaves no more of them than the truth does.
  EXPECT_LE((numbers(link.at("data_value")) - given - truth.values).norm(),
            farthest(rows.Y, rows.F, truth.values, (rows.Y * truth.values - rows.F).squaredNorm()));

  // In words.
  const auto c = load.at("centre").get<std::vector<double>>();
  EXPECT_TRUE(answer.text.ends_with(fmt::format(
      "\nload on {}: {:.4g} kg (s.e. {:.2g}) at ({:.4f}, {:.4f}, {:.4f}) m of {}'s frame\n",
      carrier, body.mass(), link.at("standard_error")[0].get<double>(), c[0], c[1], c[2], carrier)))
      << answer.text;
}

TEST(LoadAnswer, OfABlockOnTheBase) {
  simulated_log("cube.csv", "--exact --seconds 2 --rate 100 --load 1.3 0.07 -0.03 0.09 0.06");
  const Answer answer = load(fmt::format("--robot {}quadruped.urdf --exact --log cube.csv "
                                         "--area base -0.1 0.2 -0.12 0.08 0.03 0.16",
                                         robots),
                             enough);
  expect_found(answer, "base", read_urdf(robots + "quadruped.urdf").robot.links[0].inertia.values,
               cuboid_body(1.3, {0.07, -0.03, 0.09}, Vector3d::Constant(0.06)));
}

/// The bundled quadruped with a rack on a link, turned; on the rack there may be something.
std::string with_rack(const std::string& carrier, const std::string& on_it) {
  std::string text = text_of(robots + "quadruped.urdf");
  return text.replace(text.rfind("</robot>"), std::string::npos,
                      fmt::format("<link name=\"rack\">{}</link>\n<joint name=\"rack_fixed\" "
                                  "type=\"fixed\"><parent link=\"{}\"/><child link=\"rack\"/>"
                                  "<origin xyz=\"0.05 0.02 0.07\" rpy=\"0.3 -0.4 0.9\"/></joint>\n"
                                  "</robot>\n",
                                  on_it, carrier));
}

/// The answer is in the frame of the thigh, the area in that of the rack.
TEST(LoadAnswer, OfABlockOnATurnedRackOfAThigh) {
  const std::string carrier = "FR_thigh";
  constexpr double mass = 0.25;
  const Vector3d centre(0.03, -0.02, 0.04), sides(0.05, 0.08, 0.03);
  const InertialParameters block = cuboid_body(mass, centre, sides);
  const Eigen::Matrix3d I = block.tensor_about_centre();
  scratch_file(
      "loaded.urdf",
      with_rack(carrier,
                fmt::format("<inertial><origin xyz=\"{} {} {}\"/><mass value=\"{}\"/>"
                            "<inertia ixx=\"{}\" iyy=\"{}\" izz=\"{}\" ixy=\"0\" "
                            "ixz=\"0\" iyz=\"0\"/></inertial>",
                            centre.x(), centre.y(), centre.z(), mass, I(0, 0), I(1, 1), I(2, 2))));
  const std::string bare = scratch_file("bare.urdf", with_rack(carrier, ""));
  const CommandRun simulated = shapeid(fmt::format(
      "simulate --robot loaded.urdf {} --exact --seconds 2 --rate 100 --out block.csv", yaml));
  ASSERT_EQ(simulated.status, 0) << simulated.err;
  const Robot robot = read_urdf(bare).robot;
  const LinkSite rack = robot.find_site("rack").value();
  const Answer answer = load(
      "--robot bare.urdf --exact --log block.csv --area rack 0 0.07 -0.07 0.04 0.02 0.065", enough);
  expect_found(answer, carrier, robot.links[static_cast<std::size_t>(rack.link)].inertia.values,
               moved(block, rack.pose));
}

/// What the data say of the load is what its own share of the link is held against.
TEST(LoadAnswer, IsHeldAgainstWhatTheDataSayOfIt) {
  simulated_log("noisy_cube.csv", "--seconds 2 --rate 100 --load 1.3 0.07 -0.03 0.09 0.06");
  const Answer answer = load(fmt::format("--robot {}quadruped.urdf --log noisy_cube.csv "
                                         "--area base 0.03 0.12 -0.07 0.02 0.05 0.14",
                                         robots),
                             12);
  const json& link = answer.document.at("links").at(0);
  const Vector10 off = (numbers(link.at("parameters")) - numbers(link.at("data_value"))).cwiseAbs(),
                 error = numbers(link.at("data_standard_error"));
  int near = 0, against = 0;
  for (std::size_t p = 0; p < 10; ++p) {
    const auto i = static_cast<Eigen::Index>(p);
    against += link.at("determined")[p] && link.at("against_data")[p] ? 1 : 0;
    if (off[i] > 3.0 * error[i]) continue;
    EXPECT_FALSE(link.at("against_data")[p]) << p;
    ++near;
  }
  EXPECT_GT(near, 0);
  for (std::size_t at = 0; (at = answer.text.find("against the data", at)) != std::string::npos;
       ++at) {
    --against;
  }
  EXPECT_EQ(against, 0) << "as many in the table";
}

/// A robot that weighs less than it should carries nothing.
TEST(LoadAnswer, OfNothing) {
  std::string heavier = text_of(robots + "quadruped.urdf");
  const std::string mass = "<mass value=\"5.48\"/>";
  heavier.replace(heavier.find(mass), mass.size(), "<mass value=\"5.98\"/>");
  scratch_file("heavier.urdf", heavier);
  simulated_log("empty.csv", "--exact --seconds 2 --rate 100");
  const Answer answer = load(
      "--robot heavier.urdf --exact --log empty.csv --area base -0.1 0.2 -0.12 0.08 0.03 0.16", 2);
  const json nothing = {{"link", "base"}, {"mass", 0.0}};
  EXPECT_EQ(answer.document.at("load"), nothing);
  EXPECT_TRUE(answer.text.ends_with("\nno load on base\n")) << answer.text;
  EXPECT_NE(answer.text.find("note: by themselves the data ask for a load of -0.5 kg "),
            std::string::npos)
      << answer.text;
}

/// Not that there is no load.
TEST(LoadAnswer, OfTorquesOfTheOtherSignIsRefused) {
  const std::string log = simulated_log("cube.csv",
                                        "--seconds 4 --seed 3 --load 1.3 0.07 -0.03 "
                                        "0.09 0.06");
  std::string mapping = "columns:\n";
  for (const char* leg : {"FR", "FL", "RR", "RL"}) {
    for (const char* joint : {"abad", "hip", "knee"}) {
      mapping += fmt::format("  tau.{0}_{1}: {{from: tau.{0}_{1}, sign: -1}}\n", leg, joint);
    }
  }
  scratch_file("pulls.yaml", mapping);
  const CommandRun run = shapeid(fmt::format(
      "load --robot {}quadruped.urdf {} --log {} --mapping pulls.yaml --divisions 2 --area base "
      "-0.1 0.2 -0.12 0.08 0.03 0.16",
      robots, yaml, log));
  expect_one_line(run, 1, "refused (no-mass): the log asks for a load of -");
}

/// Its mass is right all the same, and its place is the area's edge.
TEST(LoadAnswer, SaysThatTheDataPutItOutsideTheArea) {
  simulated_log("cube.csv", "--seconds 4 --seed 3 --load 1.3 0.07 -0.03 0.09 0.06");
  const std::string words = fmt::format("--robot {}quadruped.urdf --log cube.csv --area", robots);
  const std::string said = "note: by themselves the data put the load's centre at (0.0";
  const Answer beside = load(words + " base -0.2 0 -0.12 0.08 0.03 0.16", 10);
  EXPECT_NE(beside.text.find(said), std::string::npos) << beside.text;
  EXPECT_NE(beside.text.find(" m outside the area: "), std::string::npos) << beside.text;
  const Answer around = load(words + " base -0.1 0.2 -0.12 0.08 0.03 0.16", 10);
  EXPECT_EQ(around.text.find(said), std::string::npos) << around.text;
}

/// Torques ten times too large, and what robot.yaml expects of loads.
TEST(LoadAnswer, SaysThatItIsHeavierThanItCanBe) {
  simulated_log("bare.csv", "--seconds 5 --seed 3");
  std::string mapping = "torque:\n  kind: motor\n  factor: {";
  for (const char* leg : {"FR", "FL", "RR", "RL"}) {
    for (const char* joint : {"abad", "hip", "knee"}) {
      mapping += fmt::format("{}_{}: 10, ", leg, joint);
    }
  }
  mapping.replace(mapping.size() - 2, 2, "}\n");
  scratch_file("tenfold.yaml", mapping);
  const Answer answer =
      load(fmt::format(
               "--robot {}quadruped.urdf --log bare.csv --mapping tenfold.yaml --area base -0.25 "
               "0.25 -0.15 0.15 0.05 0.2",
               robots),
           2);
  EXPECT_NE(answer.text.find("note: the load weighs "), std::string::npos) << answer.text;
  EXPECT_NE(answer.text.find("quadruped.robot.yaml expects a load of 0 to 3 kg\n"),
            std::string::npos)
      << answer.text;
}

/// A trot's touch-downs, behind 20 Hz, look like 13 g that nobody carries; its error does not say
/// so.
TEST(LoadAnswer, SaysWhatAnotherFilterMakesOfIt) {
  simulated_log("bare.csv", "--seconds 5 --seed 3");
  const std::string words = fmt::format(
      "--robot {}quadruped.urdf --log bare.csv --area base -0.25 0.25 -0.15 0.15 0.05 0.2 ",
      robots);
  const std::string said = "behind another filter (--cutoff 80 --row-cutoff 20) the load is ";
  const Answer answer = load(words, 10);
  const json& here = answer.document.at("load");
  const json& other = here.at("other_filter");
  EXPECT_NE(answer.text.find(said), std::string::npos) << answer.text;
  EXPECT_LT(other.at("mass").get<double>(), 3.0 * other.at("standard_error").get<double>());

  const Answer there = load(words + "--cutoff 80 --row-cutoff 20", 10);
  EXPECT_EQ(there.document.at("load").at("mass"), other.at("mass"));
  EXPECT_EQ(there.document.at("links")[0].at("standard_error")[0], other.at("standard_error"));
  EXPECT_FALSE(there.document.at("load").contains("other_filter"));
  EXPECT_EQ(there.text.find("behind another filter"), std::string::npos);
}

/// Where both agree nothing is said: a load that is there.
TEST(LoadAnswer, SaysNothingOfFiltersThatAgree) {
  simulated_log("cube.csv", "--seconds 4 --seed 3 --load 1.3 0.07 -0.03 0.09 0.06");
  const Answer answer = load(
      fmt::format("--robot {}quadruped.urdf --log cube.csv --cutoff 45 --area base -0.1 0.2 -0.12 "
                  "0.08 0.03 0.16",
                  robots),
      10);
  const json& load = answer.document.at("load");
  EXPECT_NEAR(load.at("other_filter").at("mass").get<double>(), load.at("mass").get<double>(),
              0.02);
  EXPECT_EQ(answer.text.find("behind another filter"), std::string::npos) << answer.text;
}

}  // namespace
}  // namespace shapeid::test

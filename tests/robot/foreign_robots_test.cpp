// Robots described by others: each is read, or refused for the reason that is truly in the file.
// They are not ours to copy, so the test looks for them and says what it could not find.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

struct Foreign {
  const char* file;
  const char* refusal;  ///< how it begins, after the path; empty: the file is read
  int links = 0;        ///< rigid bodies, with mimic joints locked and impossible inertias let in
  int findings = 0;     ///< about its inertias
};

// Each line leads to the element that the reason speaks of.
const std::vector<Foreign> robots = {
    {"kuka_lwr4/kuka_lwr4.urdf", ":55: a second <origin> in <joint>", 0, 0},
    {"kuka_lwr4/kuka_lwr4_gaz.urdf",
     ":104: inertia of link lwr_1_link: a principal moment about the centre of mass is negative "
     "(-0.00584512 kg m^2, largest 0.0277384)",
     8, 6},
    {"kuka_lwr4/kuka_lwr4_identified.urdf",
     ":89: inertia of link lwr_1_link: the triangle inequality is broken: principal moments "
     "9.97579e-07 + 0.00403416 < 0.0190945 kg m^2 (short by 0.0150594)",
     8, 7},
    {"mini_cheetah_umich/mini_cheetah_from_mit_constants.urdf",
     ":8: inertia of link FR_thigh_link: the triangle inequality is broken: principal moments "
     "0.000407893 + 0.00179082 < 0.00229528 kg m^2 (short by 9.65697e-05)",
     13, 4},
    {"robots/a1.urdf", "", 13, 1},
    {"robots/anymal.urdf", "", 13, 1},
    {"robots/double_pendulum.urdf", "", 3, 0},
    {"robots/go1.urdf", "", 13, 10},
    {"robots/hyq_no_sensors.urdf", "", 13, 6},
    {"robots/icub_reduced.urdf", ":4: inertia of link base_link: the triangle inequality is broken",
     30, 15},
    {"robots/kinova.urdf", "", 7, 0},
    {"robots/romeo.urdf", ":1476: joint LFinger21 mimics LHand, a coupling that is not modelled",
     34, 2},
    {"robots/solo12.urdf", "", 13, 0},
    {"robots/talos_reduced.urdf", "", 33, 7},
    {"robots/tiago.urdf",
     ":994: inertia of link arm_1_link: the triangle inequality is broken: principal moments "
     "0.00191031 + 0.0084598 < 0.0105939 kg m^2 (short by 0.000223764)",
     49, 25},
    {"ur10e_load/ur10e.urdf", "", 7, 0},
};

/// The sum of all mass values outside comments, found as text.
double mass_in(const std::string& path) {
  const std::string text = std::regex_replace(test::text_of(path), std::regex("<!--[^]*?-->"), "");
  const std::regex mass("<mass[^>]*value=\"([^\"]*)\"");
  double sum = 0.0;
  for (std::sregex_iterator i(text.begin(), text.end(), mass), end; i != end; ++i) {
    sum += std::stod((*i)[1]);
  }
  return sum;
}

double total_mass(const Robot& robot) {
  double sum = 0.0;
  for (const Link& link : robot.links) sum += link.inertia.mass();
  return sum;
}

TEST(ForeignRobots, AreReadOrRefusedForTheTrueReason) {
  for (const Foreign& robot : robots) {
    const std::string path = (test::data_folder() / robot.file).string();
    if (!std::filesystem::exists(path)) {
      fmt::print("  skipped {}: not found (set SHAPEID_DATA)\n", path);
      continue;
    }
    std::string refusal;
    try {
      static_cast<void>(read_urdf(path));
    } catch (const InputError& error) {
      refusal = std::string(error.what()).substr(path.size());
    }
    EXPECT_TRUE(refusal.starts_with(robot.refusal)) << robot.file << refusal;
    EXPECT_EQ(refusal.empty(), std::string(robot.refusal).empty()) << robot.file << refusal;
    fmt::print("  {:45} {}\n", robot.file, refusal.empty() ? "read" : refusal);
    if (robot.links == 0) continue;

    const UrdfFile file = read_urdf(
        path,
        {.root = Root::floating, .locked = {}, .lock_mimic = true, .reject_impossible = false});
    EXPECT_EQ(file.robot.link_count(), robot.links) << robot.file;
    EXPECT_EQ(static_cast<int>(file.findings.size()), robot.findings) << robot.file;
    const double mass = total_mass(file.robot);
    const double written = mass_in(path);
    EXPECT_LT(test::scaled(std::abs(mass - written), written, 100), test::few_hundred_eps)
        << robot.file << " has " << written << " kg";
    EXPECT_FALSE(why_malformed(file.robot)) << robot.file;
  }
}

}  // namespace
}  // namespace shapeid

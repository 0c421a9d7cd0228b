// Y Phi against Simbody on robots made by others: every URDF in the data folder, with its own
// inertias. The files lie outside the project; without them the test says so and checks nothing.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/physics/dynamics.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

namespace fs = std::filesystem;

using test::data_folder;

std::vector<fs::path> published_urdfs() {
  std::vector<fs::path> files;
  if (!fs::is_directory(data_folder())) return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(data_folder())) {
    if (entry.path().extension() == ".urdf") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The robot of a file, or the one line that says why it cannot be read.
std::optional<Robot> readable(const fs::path& file, Root root) {
  UrdfOptions options;
  options.root = root;
  options.lock_mimic = true;
  options.reject_impossible = false;  // the bodies that cannot exist are told below, by Simbody
  try {
    return read_urdf(file.string(), options).robot;
  } catch (const InputError& wrong) {
    std::cout << fmt::format("not read: {}\n", wrong.what());
    return std::nullopt;
  }
}

/// Simbody takes no body that cannot exist. The tree of such a robot is still worth a comparison,
/// so those bodies, and only those, are replaced, and the test says which.
Robot with_possible_bodies(Robot robot) {
  for (Link& link : robot.links) {
    const Violation why = why_impossible(link.inertia);
    if (!why) continue;
    std::cout << fmt::format("  {}: replaced, {}\n", link.name, *why);
    link.inertia = from_centre(1.0, {0.1, -0.2, 0.05}, Eigen::Vector3d(3, 4, 5).asDiagonal());
  }
  return robot;
}

/// The worst scaled residual over random states, in eps.
double worst_residual(const Robot& robot) {
  const SimbodyRobot simbody(robot);
  const Eigen::VectorXd Phi = stacked_parameters(robot);
  double worst = 0.0;
  EXPECT_TRUE(rc::check(robot.name, [&] {
    const Sample s = *test::sample(robot);
    const double error =
        (reference::regressor(robot, s) * Phi - simbody.inverse_dynamics(s)).norm();
    const double residual =
        test::scaled(error, test::size_of_terms_with_weight(robot, s), robot.link_count());
    worst = std::max(worst, residual);
    RC_ASSERT(residual < test::few_hundred_eps);
  }));
  return worst;
}

class PublishedRobots : public testing::TestWithParam<Root> {};
INSTANTIATE_TEST_SUITE_P(Roots, PublishedRobots, testing::Values(Root::floating, Root::fixed),
                         [](const auto& root) {
                           return root.param == Root::floating ? "floating" : "fixed";
                         });

TEST_P(PublishedRobots, AgreeWithSimbody) {
  const std::vector<fs::path> files = published_urdfs();
  if (files.empty()) {
    GTEST_SKIP() << "no URDF below " << data_folder() << " (set SHAPEID_DATA)";
  }
  int compared = 0;
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename().string());
    const std::optional<Robot> read = readable(file, GetParam());
    if (!read) continue;
    const Robot robot = with_possible_bodies(*read);
    std::cout << fmt::format("{}: {} links, worst {:.2g} eps\n", file.filename().string(),
                             robot.link_count(), worst_residual(robot));
    ++compared;
  }
  EXPECT_GT(compared, 0) << "none of " << files.size() << " files was read";
}

}  // namespace
}  // namespace shapeid

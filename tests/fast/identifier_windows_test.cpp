// The fast identifier on motions that a robot could make, every window against the reference.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapeid/fast/identifier.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/fast/agreement.hpp"
#include "shapeid/tests/fast/allocations.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/fast/window_runs.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid {
namespace {

using fast::Identifier;
using fast::IdentifierSettings;
using Fed = Identifier::Fed;

/// Of the squared torques: ten times what is promised of every answer's gradient.
constexpr double answer_bound = 1e-9;

void expect_as_reference(const test::WindowRuns& runs) {
  fmt::print("  {}\n", describe(runs));
  EXPECT_EQ(runs.first_wrong, "");
  EXPECT_EQ(runs.declined, 0);
  EXPECT_EQ(runs.stopped, 0);
  EXPECT_LT(runs.worst_objective, test::few_hundred_eps);
  EXPECT_LT(runs.worst_gap, answer_bound);
  EXPECT_LT(runs.worst_filter, test::few_hundred_eps);
}

std::vector<Sample> trot_of(const Robot& robot, std::size_t count, test::Noise noise) {
  return test::trot(robot, stacked_parameters(robot), 7, count, noise);
}

struct Pace {
  std::size_t window, stride;
  int divisions;
  test::Noise noise;
};

class FastIdentifierTrots : public testing::TestWithParam<Pace> {};

TEST_P(FastIdentifierTrots, AsTheReference) {
  const Pace& pace = GetParam();
  const Robot robot = test::bundled_quadruped();
  const BodyModel model = test::bundled_shapes(robot);
  IdentifierSettings settings;
  settings.window = pace.window;
  settings.stride = pace.stride;
  settings.expected_mass = 6.0;
  settings.division.most_divisions = pace.divisions;
  const std::size_t count = 30 * pace.stride + pace.window;
  const test::WindowRuns runs =
      test::run_windows(robot, model, settings, trot_of(robot, count, pace.noise));
  expect_as_reference(runs);
  EXPECT_EQ(runs.six_rows, count);  // two feet on regular legs, always
  EXPECT_LE(runs.iterations, test::most_iterations(model, pace.divisions));
  EXPECT_EQ(runs.parted, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Paces, FastIdentifierTrots,
    testing::Values(Pace{10, 10, 0, test::Noise::none}, Pace{10, 10, 0, test::Noise::sensors},
                    Pace{10, 10, 10, test::Noise::sensors}, Pace{10, 1, 0, test::Noise::sensors},
                    Pace{10, 3, 0, test::Noise::sensors}, Pace{10, 7, 0, test::Noise::sensors},
                    Pace{10, 3, 10, test::Noise::sensors}, Pace{4, 9, 0, test::Noise::sensors},
                    Pace{100, 20, 10, test::Noise::sensors}),
    [](const auto& instance) {
      const Pace& pace = instance.param;
      return fmt::format("Window{}Stride{}Divisions{}{}", pace.window, pace.stride, pace.divisions,
                         pace.noise == test::Noise::none ? "Exact" : "");
    });

/// Any motion of joints and base, and any torques: nothing need fit.
std::vector<Sample> any_motion(const Robot& robot, std::size_t count, std::uint64_t seed) {
  test::Draw draw(seed);
  const auto fill = [&draw](auto& v, double size) {
    for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = size * draw.sign();
  };
  std::vector<Sample> samples(count, test::nothing_moves(robot));
  for (std::size_t k = 0; k < count; ++k) {
    Sample& s = samples[k];
    s.time = 0.002 * static_cast<double>(k);
    fill(s.q, 2.0);
    fill(s.dq, 5.0);
    fill(s.ddq, 30.0);
    fill(s.tau, 20.0);
    s.base_specific_force << 0.0, 0.0, 9.81;
    if (robot.root == Root::floating) {
      fill(s.base_angular_velocity, 2.0);
      fill(s.base_angular_acceleration, 10.0);
      s.base_specific_force += draw.vector(3.0);
    }
    for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
      s.in_contact[c] = true;
      s.contact_force[c] = draw.vector(5.0) + 0.8 * 9.81 * s.base_specific_force.normalized();
    }
  }
  return samples;
}

/// Free links of an arm on a fixed base. The first ones move about few axes, so that most of their
/// parameters reach no row.
class FastIdentifierArms : public testing::TestWithParam<std::vector<int>> {};

TEST_P(FastIdentifierArms, AsTheReference) {
  UrdfOptions options;
  options.root = Root::fixed;
  const Robot robot = read_urdf(SHAPEID_SOURCE_DIR "/docs/examples/panda.urdf", options).robot;
  const BodyModel model = default_shapes(robot, GetParam());
  const auto shapes = static_cast<Eigen::Index>(model.shapes.size());
  const Eigen::VectorXd m = Eigen::VectorXd::LinSpaced(shapes, 1.0, 3.0);
  const Eigen::VectorXd truth = all_parameters(model, shape_columns(model) * m);
  std::vector<Sample> samples = any_motion(robot, 100, 11);
  for (const double noise : {0.0, 0.1}) {
    SCOPED_TRACE(noise);
    test::Draw draw(12);
    for (Sample& s : samples) {
      s.tau = reference::regressor(robot, s) * truth;
      for (double& torque : s.tau) torque += noise * draw.normal();
    }
    for (const int divisions : {0, 10}) {
      IdentifierSettings settings;
      settings.contacts = ContactTreatment::ignore;
      settings.expected_mass = m.sum();
      settings.division.most_divisions = divisions;
      const test::WindowRuns runs = test::run_windows(robot, model, settings, samples);
      expect_as_reference(runs);
      EXPECT_LT(runs.worst_tie, test::damped_rounding);  // as well as v is known
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    FreeLinks, FastIdentifierArms,
    testing::Values(std::vector{1}, std::vector{2}, std::vector{3}, std::vector{4}, std::vector{5},
                    std::vector{6}, std::vector{7}, std::vector{6, 7}, std::vector{1, 2},
                    std::vector{2, 3, 4, 5, 6, 7}, std::vector{1, 2, 3, 4, 5, 6, 7}),
    [](const auto& instance) { return fmt::format("Links{}", fmt::join(instance.param, "")); });

TEST(FastIdentifierWindows, OneLinkAsTheReference) {
  const Robot robot = test::corner_robot("a foot alone");
  IdentifierSettings settings;
  settings.contacts = ContactTreatment::measured;
  settings.expected_mass = 1.0;
  settings.division.most_divisions = 5;
  expect_as_reference(
      test::run_windows(robot, test::base_model(robot), settings, any_motion(robot, 300, 21)));
}

TEST(FastIdentifierWindows, SixtyLinksAsTheReference) {
  const Robot robot = test::corner_robot("sixty links");
  IdentifierSettings settings;
  settings.contacts = ContactTreatment::measured;
  settings.expected_mass = 40.0;
  expect_as_reference(
      test::run_windows(robot, test::whole_model(robot), settings, any_motion(robot, 20, 22)));
}

// A shock that leaves no digit of anything else in its windows: these are answered as well as their
// rows allow, or declined, and then the last answer stays. The first window without it is solved as
// if it had never been.
TEST(FastIdentifierWindows, AShockLeavesNoTrace) {
  const Robot robot = test::bundled_quadruped();
  const BodyModel model = test::bundled_shapes(robot);
  const std::vector<Sample> samples = trot_of(robot, 80, test::Noise::sensors);
  constexpr std::size_t shocked = 25;
  for (const std::size_t stride : {std::size_t{10}, std::size_t{5}, std::size_t{3}}) {
    SCOPED_TRACE(fmt::format("stride {}", stride));
    IdentifierSettings settings;
    settings.stride = stride;
    settings.expected_mass = 6.0;
    Identifier clean(robot, model, settings), disturbed(robot, model, settings);
    int shaken = 0, answered_later = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      Sample s = samples[k];
      if (k == shocked) s.base_specific_force *= 1e20;
      const Eigen::VectorXd last = disturbed.Phi();
      const Fed expected = clean.feed(samples[k]), fed = disturbed.feed(s);
      const bool has_shock = k >= shocked && k < shocked + settings.window;
      if (expected == Fed::answered && has_shock) {
        ++shaken;
        ASSERT_TRUE(disturbed.Phi().allFinite());
        EXPECT_GE(disturbed.Phi()[0], 0.0);
        if (fed == Fed::answered) continue;
        ASSERT_EQ(fed, Fed::window_declined);
        EXPECT_EQ(disturbed.Phi(), last);
        EXPECT_LT(disturbed.answer().time, samples[shocked].time);
        continue;
      }
      ASSERT_EQ(fed, expected);
      if (fed != Fed::answered) continue;
      answered_later += k > shocked ? 1 : 0;
      const double scale = samples[k].tau.squaredNorm();
      EXPECT_LT(std::abs(disturbed.answer().value.total() - clean.answer().value.total()),
                answer_bound * scale);
      EXPECT_LT(disturbed.answer().gap, answer_bound * scale);
    }
    EXPECT_GT(shaken, 0);
    EXPECT_GT(answered_later, 3);
  }
}

TEST(FastIdentifierWindows, NothingGrowsWithTheStream) {
  const Robot robot = test::bundled_quadruped();
  const std::vector<Sample> samples = trot_of(robot, 500, test::Noise::sensors);
  for (const std::size_t stride : {std::size_t{1}, std::size_t{7}, std::size_t{10}}) {
    IdentifierSettings settings;
    settings.stride = stride;
    settings.expected_mass = 6.0;
    settings.division.most_divisions = 10;
    Identifier identifier(robot, test::bundled_shapes(robot), settings);
    EXPECT_EQ(test::allocations_during([&] {
                for (int round = 0; round < 10; ++round) {
                  for (const Sample& s : samples) identifier.feed(s);
                }
              }),
              0U);
    EXPECT_EQ(identifier.samples_by_six_rows(), 5000U);
  }
}

// Every other test bounds the gap from above, which a gap that is always zero keeps.
TEST(FastIdentifierWindows, TheGapIsThatOfTheLastMasses) {
  const Robot robot = test::bundled_quadruped();
  const std::vector<Sample> samples = trot_of(robot, 200, test::Noise::sensors);
  for (const std::optional<double> bound : {std::optional<double>(), std::optional<double>(17.0)}) {
    IdentifierSettings settings;
    settings.expected_mass = 6.0;
    settings.mass_bound = bound;
    Identifier identifier(robot, test::bundled_shapes(robot), settings);
    int apart = 0;
    for (const Sample& s : samples) {
      if (identifier.feed(s) != Fed::answered) continue;
      const fast::MassSolver& masses = identifier.division().masses();
      EXPECT_EQ(identifier.answer().gap, masses.gap(bound.value_or(10.0 * 6.0)));
      apart += masses.gap(60.0) != masses.gap(17.0) ? 1 : 0;
    }
    EXPECT_GT(apart, 0) << "the bound is not seen in any window";
  }
}

// What times mean; never how long anything takes.
TEST(FastIdentifierWindows, TimesAddUp) {
  const Robot robot = test::bundled_quadruped();
  for (const std::size_t stride : {std::size_t{3}, std::size_t{10}}) {
    IdentifierSettings settings;
    settings.stride = stride;
    settings.expected_mass = 6.0;
    Identifier identifier(robot, test::bundled_shapes(robot), settings);
    EXPECT_EQ(identifier.answer().seconds, 0.0);
    for (const Sample& s : trot_of(robot, 200, test::Noise::sensors)) {
      if (identifier.feed(s) != Fed::answered) continue;
      const fast::WindowAnswer& answer = identifier.answer();
      EXPECT_GE(answer.slowest_sample, 0.0);
      EXPECT_GE(answer.last_call, 0.0);
      // The window's time is a sum that has both as terms, rounded.
      EXPECT_GE(answer.seconds * (1.0 + 1e-12), answer.slowest_sample + answer.last_call);
      EXPECT_LE(answer.seconds * (1.0 - 1e-12), answer.slowest_sample * 9.0 + answer.last_call);
    }
  }
}

}  // namespace
}  // namespace shapeid

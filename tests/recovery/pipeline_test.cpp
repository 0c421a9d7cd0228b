// The steps between samples and parameters: blocks, refusals, standard errors, windows, contacts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/reference/contact_detection.hpp"
#include "shapeid/reference/identify.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/reference/online.hpp"
#include "shapeid/tests/recovery/quadruped.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using reference::Identification;
using reference::identify;
using reference::IdentifySettings;
using test::few_hundred_eps;
using test::scaled_difference;

reference::SampleStream stream(const std::vector<Sample>& samples) {
  return [&samples, k = std::size_t{0}]() mutable {
    return k < samples.size() ? std::optional(samples[k++]) : std::nullopt;
  };
}

std::vector<Sample> trot_samples(const test::Quadruped& q, double seconds, double torque_noise) {
  std::vector<Sample> samples;
  test::Draw draw(5);
  test::Trot wanted;
  wanted.seconds = seconds;
  wanted.seed = 3;
  for (const SimulatedSample& s : test::trot(q.robot, wanted)) {
    samples.push_back(s.sample);
    for (double& tau : samples.back().tau) tau += torque_noise * draw.normal();
  }
  return samples;
}

IdentifySettings once() {
  IdentifySettings settings;
  settings.expected_mass = 5.5;
  settings.division.most_divisions = 0;
  return settings;
}

std::string refusal_code(const test::Quadruped& q, const std::vector<Sample>& samples) {
  try {
    (void)identify(q.robot, q.base, stream(samples), once());
  } catch (const Refusal& refusal) {
    return refusal.code();
  }
  return "accepted";
}

TEST(Pipeline, LogsThatCannotAnswerAreRefused) {
  const test::Quadruped q = test::bundled_quadruped();
  EXPECT_EQ(refusal_code(q, {}), "no-data");
  EXPECT_EQ(refusal_code(q, trot_samples(q, 0.3, 0.0)), "too-short");
  std::vector<Sample> in_millimetres = trot_samples(q, 2.0, 0.1);
  for (Sample& s : in_millimetres) s.tau *= 1e3;  // N mm
  EXPECT_EQ(refusal_code(q, in_millimetres), "torque-scale");
}

// Blocks of one sample each are more than most_blocks: neighbours merge, nothing may be lost.
TEST(Pipeline, ManyBlocksSayTheSameAsFew) {
  const test::Quadruped q = test::bundled_quadruped();
  const std::vector<Sample> samples = trot_samples(q, 2.0, 0.1);
  ASSERT_GT(samples.size(), 2 * reference::most_blocks);
  IdentifySettings few = once(), many = once();
  few.block_seconds = 0.5;
  many.block_seconds = 1e-6;
  const Identification a = identify(q.robot, q.base, stream(samples), few);
  const Identification b = identify(q.robot, q.base, stream(samples), many);
  EXPECT_EQ(a.samples, samples.size());
  EXPECT_EQ(b.samples, samples.size());
  const double condition = 100.0;  // of the scaled rows of a trot, measured by Exact.*: 10 to 40
  EXPECT_LT(scaled_difference(a.Phi, b.Phi, 10), condition * few_hundred_eps);
}

// Torque noise alone: errors are of the size of the standard errors.
TEST(Pipeline, StandardErrorsAreTheSizeOfTheErrors) {
  const test::Quadruped q = test::bundled_quadruped();
  IdentifySettings settings = once();
  settings.block_seconds = 0.05;
  const Identification found =
      identify(q.robot, q.base, stream(trot_samples(q, 4.0, 0.5)), settings);
  const Eigen::VectorXd error = (found.Phi - stacked_parameters(q.robot)).head<10>().cwiseAbs();
  double jackknife = 0.0, sandwich = 0.0;
  for (Eigen::Index p = 0; p < 10; ++p) {
    jackknife += std::pow(error[p] / found.standard_error[p], 2) / 10.0;
    sandwich += std::pow(error[p] / found.data.standard_error[p], 2) / 10.0;
  }
  std::cout << fmt::format("errors in standard errors, rms: jackknife {:.2f}, sandwich {:.2f}\n",
                           std::sqrt(jackknife), std::sqrt(sandwich));
  // Ten correlated parameters: one of two chi-square ratios in a thousand is beyond a factor
  // of 2.5.
  EXPECT_LT(std::sqrt(jackknife), 2.5);
  EXPECT_GT(std::sqrt(jackknife), 1.0 / 2.5);
  EXPECT_LT(std::sqrt(sandwich), 2.5);
}

// A window of the online identifier is the mass problem of its samples, with the first lambda.
TEST(Online, EveryWindowIsItsOwnMassProblem) {
  const test::Quadruped q = test::bundled_quadruped();
  const std::vector<Sample> samples = trot_samples(q, 1.0, 0.05);
  reference::OnlineSettings settings;
  settings.expected_mass = 5.5;
  settings.window = 10;
  settings.stride = 7;
  settings.alpha = 0.5;
  reference::OnlineIdentifier online(q.robot, q.base, settings);
  reference::Window window(q.robot, q.base, settings.contacts,
                           Eigen::VectorXd::Ones(q.robot.dof()));
  std::optional<double> lambda;
  Eigen::VectorXd filtered;
  int windows = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto result = online.feed(samples[k]);
    // The first window is full at sample 10; after that one every 7 samples.
    const bool expected = k + 1 >= 10 && (k + 1 - 10) % 7 == 0;
    ASSERT_EQ(result.has_value(), expected) << k;
    if (!result) continue;
    window.clear();
    for (std::size_t i = k - 9; i <= k; ++i) window.add(samples[i]);
    MassProblem problem = window.problem(q.base);
    if (!lambda) lambda = default_lambda(problem, settings.expected_mass);
    problem.lambda = *lambda;
    const Eigen::VectorXd Phi = reference::solve_masses(problem).Phi;
    // Warm or cold, the solver returns the same masses; the window's own condition does not enter.
    EXPECT_LT(scaled_difference(result->solution.Phi, Phi, 10), few_hundred_eps);
    filtered = windows == 0 ? Phi : Eigen::VectorXd(0.5 * Phi + 0.5 * filtered);
    EXPECT_LT(scaled_difference(result->filtered, filtered, 10), few_hundred_eps);
    EXPECT_EQ(result->time, samples[k].time);
    ++windows;
  }
  EXPECT_GT(windows, 10);
}

TEST(Online, RefusesSettingsThatMakeNoSense) {
  const test::Quadruped q = test::bundled_quadruped();
  reference::OnlineSettings settings;
  EXPECT_THROW((reference::OnlineIdentifier{q.robot, q.base, settings}), InputError);  // no mass
  settings.expected_mass = 5.5;
  settings.window = 0;
  EXPECT_THROW((reference::OnlineIdentifier{q.robot, q.base, settings}), InputError);
  settings.window = 10;
  settings.weight = Eigen::VectorXd::Ones(1);
  EXPECT_THROW((reference::OnlineIdentifier{q.robot, q.base, settings}), InputError);
  settings.weight = -Eigen::VectorXd::Ones(q.robot.dof());
  EXPECT_THROW((reference::OnlineIdentifier{q.robot, q.base, settings}), InputError);
  settings.weight = Eigen::VectorXd::Ones(q.robot.dof());
  EXPECT_NO_THROW((reference::OnlineIdentifier{q.robot, q.base, settings}));
}

TEST(ContactDetection, AgreesWithTheGround) {
  const test::Quadruped q = test::bundled_quadruped();
  const Eigen::VectorXd Phi = stacked_parameters(q.robot);
  std::size_t same = 0, all = 0;
  double worst = 0.0;
  for (const Sample& sample : trot_samples(q, 2.0, 0.0)) {
    const Eigen::VectorXd force = reference::supporting_forces(q.robot, sample, Phi);
    constexpr double threshold = 0.15;
    const std::vector<bool> found = reference::detect_contacts(q.robot, sample, Phi, threshold);
    double mass = 0.0;
    for (Eigen::Index i = 0; i < Phi.size(); i += 10) mass += Phi[i];
    const Eigen::Vector3d up = sample.base_specific_force.normalized();
    for (std::size_t c = 0; c < found.size(); ++c) {
      worst = std::max(
          worst, std::abs(force[static_cast<Eigen::Index>(c)] - sample.contact_force[c].dot(up)));
      EXPECT_EQ(found[c], force[static_cast<Eigen::Index>(c)] > threshold * mass * 9.81);
      same += found[c] == sample.in_contact[c] ? 1 : 0;
      ++all;
    }
  }
  const double share = static_cast<double>(same) / static_cast<double>(all);
  std::cout << fmt::format("{:.3f} of the flags agree; forces to {:.1e} N\n", share, worst);
  // Exact data: the force itself is exact. Flags differ while a foot carries less than the
  // threshold at touch-down and lift-off: a few samples of every step.
  EXPECT_LT(worst, 1e-6 * 13.0 * 9.81);
  EXPECT_GT(share, 0.9);
}

/// Of a foot's points none carries all that the foot does.
TEST(ContactDetection, AFootOfSeveralPointsTouchesWhereTheFootDoes) {
  const test::Quadruped q = test::bundled_quadruped();
  const Eigen::VectorXd Phi = stacked_parameters(q.robot);
  Robot many = q.robot;
  constexpr std::size_t times = 4;
  for (std::size_t more = 1; more < times; ++more) {
    many.contacts.insert(many.contacts.end(), q.robot.contacts.begin(), q.robot.contacts.end());
  }
  std::size_t touching = 0;
  for (const Sample& sample : trot_samples(q, 1.0, 0.0)) {
    constexpr double threshold = 0.05;
    const std::vector<bool> once = reference::detect_contacts(q.robot, sample, Phi, threshold);
    const std::vector<bool> found = reference::detect_contacts(many, sample, Phi, threshold);
    ASSERT_EQ(found.size(), times * once.size());
    for (std::size_t c = 0; c < found.size(); ++c) EXPECT_EQ(found[c], once[c % once.size()]) << c;
    touching += static_cast<std::size_t>(std::count(once.begin(), once.end(), true));
  }
  EXPECT_GT(touching, 100U);
}

}  // namespace
}  // namespace shapeid

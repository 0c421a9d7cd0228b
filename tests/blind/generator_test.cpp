// What the generator puts into a trial is there, of the size it says, and the seal is needed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/tests/blind/parts/drawn.hpp"
#include "shapeid/tests/blind/parts/score.hpp"
#include "shapeid/tests/blind/parts/yardstick.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::blind {
namespace {

Trial arm_trial(std::vector<Item> items) {
  Trial t;
  t.machine = "arm";
  t.items = std::move(items);
  return t;
}

Item some(const std::string& id, int site) {
  return {id, {site, kind(id).nominal, Eigen::Vector3d(0.48, -0.6, 0.64)}, 1.0};
}

/// What the catalogue's equation with the item's numbers leaves of these readings, over what the
/// robot alone leaves: not a number if that is nothing.
double left_by_the_truth(const Machine& m, const Item& item, const Readings& readings) {
  std::vector<Sample> samples;
  for (const Reading& r : readings) samples.push_back(r.sample);
  const diagnosis::Recording log(samples, m.rate);
  const diagnosis::RichModel truth{stacked_parameters(m.robot), {applied(m, item)}};
  const diagnosis::RichModel rigid{truth.Phi, {}};
  const diagnosis::Viewer with(m.robot, ContactTreatment::ignore, truth.effects);
  const diagnosis::Viewer without(m.robot, ContactTreatment::ignore, {});
  double told = 0.0, untold = 0.0;
  for (const std::size_t i : log.usable(20)) {
    told += diagnosis::residual(with, with.view(log, i), truth).squaredNorm();
    untold += diagnosis::residual(without, without.view(log, i), rigid).squaredNorm();
  }
  return std::sqrt(told / untold);
}

TEST(Generator, SealKeepsTheTrial) {
  Trial t = arm_trial({some("cogging", 2), some("drag", 3)});
  t.noise_seed = 77;
  const Trial back = trial_from_json(to_json(t));
  EXPECT_EQ(to_json(back), to_json(t));
  EXPECT_EQ(back.items[1].amount.direction, t.items[1].amount.direction);
}

/// Every effect changes the log, on each robot that it is for; without it the log is the clean one.
TEST(Generator, EveryEffectOfSignalsShows) {
  const Machine m = arm();
  const Readings clean = simulate_clean(m, 5);
  for (const Kind& k : kinds()) {
    if (k.dynamic || !k.arm) continue;
    SCOPED_TRACE(k.id);
    Readings changed = clean;
    change_signals(m, {some(k.id, k.place == Place::joint ? 2 : 0)}, changed);
    double difference = 0.0;
    for (std::size_t i = 0; i < clean.size(); ++i) {
      difference += (changed[i].sample.q - clean[i].sample.q).norm() +
                    (changed[i].sample.tau - clean[i].sample.tau).norm();
    }
    EXPECT_GT(difference, 0.0);
  }
}

/// The catalogue's equation with the trial's numbers explains the simulated torque: the truth that
/// is sealed is the truth that is simulated. Both come from equations of their own.
TEST(Generator, SealedNumbersExplainTheSimulation) {
  const Machine m = arm();
  for (const Kind& k : kinds()) {
    if (k.foreign || !k.arm || (!k.dynamic && k.id != "rotor_reaction")) continue;
    SCOPED_TRACE(k.id);
    const Item item = some(k.id, k.place == Place::whole ? 0 : 2);
    const Readings readings = simulate_trial(m, arm_trial({item}));
    ASSERT_FALSE(readings.empty());
    constexpr double all_of_it = 1e-6;  // equations agree to rounding
    EXPECT_LT(left_by_the_truth(m, item, readings), all_of_it);
  }
}

/// Likewise what is put into the signals afterwards: small, for the catalogue's equations are of
/// first order in these, and a lag well below the interval of the log.
TEST(Generator, SealedNumbersExplainTheSignals) {
  const Machine m = arm();
  const Readings clean = simulate_clean(m, 5);
  int kinds_seen = 0;
  for (const Kind& k : kinds()) {
    if (k.foreign || k.dynamic || !k.arm || k.id == "rotor_reaction") continue;
    SCOPED_TRACE(k.id);
    ++kinds_seen;
    Item item = some(k.id, k.place == Place::whole ? 0 : 2);
    item.amount.size *= 0.05;
    Readings readings = clean;
    change_signals(m, {item}, readings);
    constexpr double all_but_second_order = 0.05;
    EXPECT_LT(left_by_the_truth(m, item, readings), all_but_second_order);
  }
  EXPECT_GE(kinds_seen, 5);
}

/// The next drawn arm with a slider at the last of the places where something can be.
Machine arm_with_slider(const Kind& k, std::uint64_t& seed) {
  while (true) {
    Machine m = drawn_arm(seed++);
    const std::vector<int> places = sites(m, k);
    if (places.empty()) continue;
    const int joint = k.place == Place::joint ? places.back() : m.robot.joint_count() - 1;
    if (m.robot.joint(joint).kind == JointKind::prismatic) return m;
  }
}

/// On any arm, at its last joint or link, which slides.
TEST(Generator, SealedNumbersExplainDrawnArms) {
  std::uint64_t seed = 1;
  for (const Kind& k : kinds()) {
    if (k.foreign || !k.arm || !k.dynamic) continue;
    const Machine m = arm_with_slider(k, seed);
    const Item item = some(k.id, sites(m, k).back());
    SCOPED_TRACE(m.name + " " + k.id);
    const Readings readings = simulate_trial(m, arm_trial({item}));
    ASSERT_FALSE(readings.empty());
    constexpr double all_of_it = 1e-6;  // equations agree to rounding
    EXPECT_LT(left_by_the_truth(m, item, readings), all_of_it);
  }
}

/// An effect of twice the detectable size gains more than one of the size, by what a model of known
/// truth is worth: in noise alone the size is about 6.6 standard errors of its own fit.
TEST(Yardstick, DetectableSizeFollowsTheNoise) {
  const test::ScratchFolder scratch;
  Machine m = arm();
  const Item item = some("torque_offset", 1);
  const Readings readings = simulate_clean(m, 5);
  const auto size = [&](double sigma) {
    m.notes.noise_sigma["tau"] = sigma;
    Trial t = arm_trial({});
    write_logs(m, t, readings, scratch.path(""));
    const diagnosis::Recording log = read_log(m, scratch.path("log.csv"));
    return detectable_size(m, log, unit_change(m, item, readings, log, scratch.path(""), 1));
  };
  const double quiet = size(0.2), loud = size(0.8);
  EXPECT_GT(loud, 2.5 * quiet);
  EXPECT_LT(loud, 6.0 * quiet);
}

/// Rows that are missing from a log by the true model: its noise.
Eigen::MatrixXd noise_of(const Machine& m, const diagnosis::Recording& log) {
  const diagnosis::RichModel truth{stacked_parameters(m.robot), {}};
  const diagnosis::Viewer viewer(m.robot, ContactTreatment::ignore, {});
  const auto indices = log.usable(1);
  Eigen::MatrixXd noise(m.robot.dof(), std::ssize(indices));
  for (std::size_t i = 0; i < indices.size(); ++i) {
    noise.col(static_cast<Eigen::Index>(i)) =
        -diagnosis::residual(viewer, viewer.view(log, indices[i]), truth);
  }
  return noise;
}

/// Noise may hide an item, and by luck does not show one: an item that is the noise itself has a
/// size, and what is its opposite must first make up for it.
TEST(Yardstick, LuckShowsNothingAndMayHide) {
  const test::ScratchFolder scratch;
  const Machine m = arm();
  write_logs(m, arm_trial({}), simulate_clean(m, 5), scratch.path(""));
  const diagnosis::Recording log = read_log(m, scratch.path("log.csv"));
  const Eigen::MatrixXd noise = noise_of(m, log);
  EXPECT_GT(detectable_size(m, log, noise), 0.05);
  EXPECT_GT(detectable_size(m, log, -noise), 2.0);
}

/// Who knows how far given inertias are off as a rule is nearer to the truth by a log of 12 s in
/// most cases (docs/blind.md: 834 of 880), and predicts as the truth does.
TEST(Yardstick, WhoIsToldAllIsNearerAsARule) {
  const test::ScratchFolder scratch;
  const Machine m = arm();
  Trial t = arm_trial({});
  write_logs(m, t, simulate_clean(m, 5), scratch.path(""));
  const diagnosis::Recording log = read_log(m, scratch.path("log.csv")),
                             test = read_log(m, scratch.path("test.csv"));
  const double noise =
      std::sqrt(noise_of(m, test).squaredNorm() / static_cast<double>(test.usable(1).size()));
  constexpr int draws = 12;
  int nearer = 0;
  for (std::uint64_t seed = 1; seed <= draws; ++seed) {
    t.inertia_seed = seed;
    const ToldTruth told = told_truth(m, t, log, test);
    EXPECT_NEAR(told.error / noise, 1.0, 0.02);
    ASSERT_EQ(told.inertias.size(), m.free_links.size());
    const double given = distance_from_truth(m, wrong_inertias(m, seed));
    EXPECT_GT(given, 0.0);
    if (distance_from_truth(m, told.inertias) < given) ++nearer;
  }
  EXPECT_GE(nearer, draws - 2);
}

/// A load that was never absent is a part of its link, but for a log without it.
TEST(Yardstick, LogWithoutALoadShowsIt) {
  const test::ScratchFolder scratch;
  const Machine m = arm();
  const Readings readings = simulate_clean(m, 5);
  Trial earlier = arm_trial({});
  ++earlier.noise_seed;
  write_logs(m, earlier, readings, scratch.path(""));
  const diagnosis::Recording without = read_log(m, scratch.path("log.csv"));
  write_logs(m, arm_trial({}), readings, scratch.path(""));
  const diagnosis::Recording log = read_log(m, scratch.path("log.csv"));
  const Eigen::MatrixXd change =
      unit_change(m, some("payload", 4), readings, log, scratch.path(""), 1);
  EXPECT_LT(10.0 * detectable_size(m, log, change, &without), detectable_size(m, log, change));
}

}  // namespace
}  // namespace shapeid::blind

// What has no name, as curves that a model predicts with: found, fitted, written and read.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shapeid/diagnosis/curve_fit.hpp"
#include "shapeid/diagnosis/effects_yaml.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr auto no_contacts = ContactTreatment::ignore;
constexpr std::size_t stride = 2;

Curve curve(const std::string& law, int site, CurveVariable over, std::vector<double> at,
            std::vector<double> number) {
  Curve c;
  c.law = test::effect(law, site, {0.0});
  c.over = over;
  c.at = Eigen::Map<const Eigen::VectorXd>(at.data(), std::ssize(at));
  c.number = Eigen::Map<const Eigen::VectorXd>(number.data(), std::ssize(number));
  return c;
}

TEST(Curves, AreStraightBetweenKnotsAndConstantBeyond) {
  const Eigen::Vector3d at(-1.0, 0.5, 2.0), number(3.0, 0.0, -6.0);
  const auto value = [&](double x) { return knot_shares(at, x).dot(number); };
  EXPECT_EQ(value(-7.0), 3.0);
  EXPECT_EQ(value(-1.0), 3.0);
  EXPECT_EQ(value(-0.5), 2.0);
  EXPECT_EQ(value(0.5), 0.0);
  EXPECT_EQ(value(1.0), -2.0);
  EXPECT_EQ(value(2.0), -6.0);
  EXPECT_EQ(value(9.0), -6.0);
  for (const double x : {-3.0, -0.2, 0.5, 1.7, 4.0}) {
    EXPECT_EQ(knot_shares(at, x).sum(), 1.0);
    EXPECT_GE(knot_shares(at, x).minCoeff(), 0.0);
  }
}

/// Whether a curve predicts, or is known while masses are sought, its force is the same.
TEST(Curves, CountInPredictionsAndInMassRows) {
  const Robot robot = test::arm();
  const Recording log = test::record({});
  const RichModel plain{stacked_parameters(robot), {}};
  RichModel curved = plain;
  curved.curves = {
      curve("torque_offset", 0, {CurveSignal::position, 2}, {-1.0, 1.0}, {0.3, -0.4}),
      curve("viscous_friction", 1, {CurveSignal::load, 1}, {-9.0, 0.0, 9.0}, {0.1, 0.3, 0.2})};
  const Viewer viewer(robot, no_contacts, {});
  const View view = viewer.view(log, 500);
  const Eigen::VectorXd rigid = predict(viewer, view, plain).load.joint;
  const double offset = 0.3 - 0.35 * (std::clamp(view.sample.q[2], -1.0, 1.0) + 1.0);
  const double load = std::clamp(rigid[1], -9.0, 9.0);
  const double friction = load < 0.0 ? 0.3 + 0.2 * load / 9.0 : 0.3 - 0.1 * load / 9.0;
  const Eigen::Vector3d wanted(offset, friction * view.sample.dq[1], 0.0);
  const Eigen::VectorXd added =
      predict(viewer, view, curved).force - predict(viewer, view, plain).force;
  EXPECT_LT(test::scaled_difference(added, wanted, 20), test::few_hundred_eps);
  const std::vector<int> links = {1, 2, 3};
  const Eigen::VectorXd moved =
      mass_rows(viewer, view, plain, links).F - mass_rows(viewer, view, curved, links).F;
  EXPECT_LT(test::scaled_difference(moved, wanted, 20), test::few_hundred_eps);
}

/// A torque over the position of another joint: no entry of the catalogue.
TEST(Curves, TakeUnexplainedTorqueAwayOnOtherMotion) {
  const auto foreign = [](std::vector<Sample>& samples) {
    for (Sample& s : samples) s.tau[0] += 0.4 * std::tanh(2.0 * s.q[1]);
  };
  const Robot robot = test::arm();
  const Recording log = test::record({}, foreign);
  const LoopResult loop = test::loop_of(log);
  RichModel model = loop.model;
  model.curves = curves_for(robot, no_contacts, model, loop, log, stride);
  ASSERT_FALSE(model.curves.empty());
  bool over_the_other = false;
  for (const Curve& c : model.curves) {
    over_the_other =
        over_the_other || (c.law.site == 0 && c.over == CurveVariable{CurveSignal::position, 1});
  }
  EXPECT_TRUE(over_the_other);
  const Recording other = test::record({{}, 20.0, 0.02, 5}, foreign);
  const double without = series(robot, no_contacts, loop.model, other, stride).rms()[0];
  const double with = series(robot, no_contacts, model, other, stride).rms()[0];
  EXPECT_LT(with, 0.5 * without);
}

TEST(Curves, NothingIsDrawnWhereNothingIsMissing) {
  const Recording log = test::record({{test::effect("viscous_friction", 1, {0.3})}});
  const LoopResult loop = test::loop_of(log);
  EXPECT_TRUE(curves_for(test::arm(), no_contacts, loop.model, loop, log, stride).empty());
}

/// A law whose number follows a signal keeps its law: friction that grows with position.
TEST(Curves, FollowTheLawThatVaries) {
  const Recording log = test::record({}, [](std::vector<Sample>& samples) {
    for (Sample& s : samples) s.tau[1] += (0.5 + 0.45 * std::sin(s.q[1])) * s.dq[1];
  });
  const LoopResult loop = test::loop_of(log);
  const std::vector<Curve> curves =
      curves_for(test::arm(), no_contacts, loop.model, loop, log, stride);
  ASSERT_FALSE(curves.empty());
  EXPECT_EQ(curves.front().law.effect->id, "viscous_friction");
  EXPECT_EQ(curves.front().over, (CurveVariable{CurveSignal::position, 1}));
  EXPECT_GT(curves.front().number[curves.front().number.size() - 1], curves.front().number[0]);
}

/// Torque that is scaled by a gain is so with the curve in it.
TEST(Curves, AreFittedInTheRowsThatTheModelScales) {
  const Robot robot = test::arm();
  const AppliedEffect gain = test::effect("torque_gain", 0, {0.5});
  const Recording log = test::record({{gain}}, [](std::vector<Sample>& samples) {
    for (Sample& s : samples) s.tau[0] += 0.4 * std::tanh(2.0 * s.q[1]);
  });
  LoopResult loop;
  loop.model = {stacked_parameters(robot), {gain}};
  RichModel model = loop.model;
  model.curves = curves_for(robot, no_contacts, model, loop, log, stride);
  ASSERT_FALSE(model.curves.empty());
  const double without = series(robot, no_contacts, loop.model, log, stride).rms()[0];
  const double with = series(robot, no_contacts, model, log, stride).rms()[0];
  EXPECT_LT(with, 0.2 * without);  // a curve that comes out half as large again leaves half
}

/// Names mean something to YAML as well.
TEST(EffectsYaml, NamesOfAnyKindAreReadBack) {
  for (const char* name : {"leg #2", "left: knee", "[a]", "*x", "- a", "true", "~", "1e3", "it's",
                           "\"q\"", "{b}", "% c", "a\\n"}) {
    Robot robot = test::arm();
    robot.links[2].joint.name = name;
    KnownEffects known{{test::effect("torque_offset", 1, {0.25})}, {}};
    known.curves = {curve("torque_offset", 1, {CurveSignal::speed, 1}, {-1.5, 0.1}, {0.3, -0.4})};
    const test::ScratchFolder scratch;
    const std::string text = write_effects_yaml(robot, known);
    const KnownEffects again = read_effects_yaml(scratch.write("effects.yaml", text), robot);
    EXPECT_EQ(again.effects.at(0).site, 1) << text;
    EXPECT_EQ(again.curves.at(0).over, (CurveVariable{CurveSignal::speed, 1})) << text;
  }
}

TEST(EffectsYaml, OneEntryAnEffectAndPlaceAndOneOfWhatCameSince) {
  const Robot robot = test::arm();
  const auto read = [&](const std::vector<AppliedEffect>& effects) {
    const test::ScratchFolder scratch;
    return read_effects_yaml(
               scratch.write("effects.yaml", write_effects_yaml(robot, {effects, {}})), robot)
        .effects;
  };
  const AppliedEffect friction = test::effect("viscous_friction", 1, {0.25});
  AppliedEffect more = test::effect("viscous_friction", 1, {0.1});
  more.when = When::since_reference;
  const std::vector<AppliedEffect> both = read({friction, more});
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0].when, When::always);
  EXPECT_EQ(both[1].when, When::since_reference);
  EXPECT_THROW(static_cast<void>(read({friction, friction})), InputError);
  // Two delays of one log together would look further than there is anything to see.
  const AppliedEffect delay = test::effect("torque_delay", 0, {0.018});
  AppliedEffect later = delay;
  later.when = When::since_reference;
  EXPECT_THROW(static_cast<void>(read({delay, later})), InputError);
}

/// Several contacts of one link share its flag and its name, and are places of their own.
TEST(EffectsYaml, TellsContactsOfOneLinkApart) {
  Robot robot = test::arm();
  for (const int link : {1, 3, 3, 1, 3}) {
    Contact contact;
    contact.link = link;
    contact.name = robot.links[static_cast<std::size_t>(link)].name;
    robot.contacts.push_back(contact);
  }
  KnownEffects known;
  for (const int contact : {4, 0, 3, 2, 1}) {
    known.effects.push_back(test::effect("contact_point", contact, {0.01 * contact, 0.0, 0.002}));
  }
  const test::ScratchFolder scratch;
  const KnownEffects again =
      read_effects_yaml(scratch.write("effects.yaml", write_effects_yaml(robot, known)), robot);
  ASSERT_EQ(again.effects.size(), known.effects.size());
  for (std::size_t i = 0; i < known.effects.size(); ++i) {
    EXPECT_EQ(again.effects[i].site, known.effects[i].site);
    EXPECT_EQ(again.effects[i].value, known.effects[i].value);
  }
}

/// All that a fit may end at is read back; a transformation has limits that it works within.
TEST(EffectsYaml, LimitsOfWhatIsBelievedAreNoLimitsOfWhatIsKnown) {
  const Robot robot = test::arm();
  const auto read = [&](const AppliedEffect& effect) {
    const test::ScratchFolder scratch;
    return read_effects_yaml(
               scratch.write("effects.yaml", write_effects_yaml(robot, {{effect}, {}})), robot)
        .effects.at(0)
        .value[0];
  };
  EXPECT_EQ(read(test::effect("torque_lag", 1, {0.07})), 0.07);
  EXPECT_THROW(read(test::effect("torque_lag", 1, {-0.001})), InputError);
  EXPECT_EQ(read(test::effect("torque_delay", 0, {-0.017})), -0.017);
  EXPECT_THROW(read(test::effect("torque_delay", 0, {0.5})), InputError);
}

TEST(EffectsYaml, APayloadIsABodyThatCanExist) {
  const Robot robot = test::arm();
  const auto read = [&](const std::vector<double>& load) {
    const test::ScratchFolder scratch;
    const AppliedEffect effect = test::effect("payload", 2, load);
    return read_effects_yaml(
               scratch.write("effects.yaml", write_effects_yaml(robot, {{effect}, {}})), robot)
        .effects.at(0)
        .value;
  };
  // Half a kilogram, a tenth of a metre off; a point; nothing; and a point without its m r^2.
  EXPECT_EQ(read({0.5, 0.05, 0, 0, 0.001, 0, 0, 0.006, 0, 0.006})[7], 0.006);
  EXPECT_EQ(read({0.5, 0.05, 0, 0, 0, 0, 0, 0.005, 0, 0.005})[7], 0.005);
  EXPECT_EQ(read(std::vector<double>(10, 0.0))[0], 0.0);
  EXPECT_THROW(read({0.5, 0.05, 0, 0, 0, 0, 0, 0, 0, 0}), InputError);
}

TEST(CurvesYaml, IsReadBackTheSame) {
  const Robot robot = test::arm();
  KnownEffects known{{test::effect("torque_offset", 2, {0.25})}, {}};
  known.curves = {
      curve("torque_offset", 0, {CurveSignal::speed, 2}, {-1.5, 0.1, 1.0}, {0.3, -0.4, 1e-7}),
      curve("coulomb_friction", 1, {CurveSignal::acceleration, 1}, {0.0, 2.0}, {0.1, 0.2})};
  known.curves[1].law.shape[0] = 0.07;
  const test::ScratchFolder scratch;
  const std::string text = write_effects_yaml(robot, known);
  const KnownEffects again = read_effects_yaml(scratch.write("effects.yaml", text), robot);
  EXPECT_EQ(write_effects_yaml(robot, again), text);
  ASSERT_EQ(again.curves.size(), 2U);
  EXPECT_EQ(again.curves[0].number, known.curves[0].number);
  EXPECT_EQ(again.curves[1].at, known.curves[1].at);
  EXPECT_EQ(again.curves[1].law.shape[0], 0.07);
  EXPECT_EQ(again.curves[1].over, (CurveVariable{CurveSignal::acceleration, 1}));
}

TEST(CurvesYaml, SaysWhatIsWrong) {
  const auto said_to = [](const std::string& text) -> std::string {
    const test::ScratchFolder scratch;
    try {
      static_cast<void>(read_effects_yaml(scratch.write("effects.yaml", text), test::arm()));
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  };
  const auto refused = [&](const std::string& entry) {
    return said_to("effects: []\ncurves:\n  - " + entry + "\n");
  };
  const auto expect = [&](const std::string& entry, const std::string& words) {
    const std::string said = refused(entry);
    EXPECT_NE(said.find("effects.yaml:3"), std::string::npos) << said;
    EXPECT_NE(said.find(words), std::string::npos) << said;
  };
  const std::string place = "{effect: torque_offset, site: joint1, ";
  EXPECT_EQ(refused(place + "over: q.joint2, at: [0, 1], number: [1, 2]}"), "taken");
  expect(place + "over: q.joint9, at: [0, 1], number: [1, 2]}", "there is no signal q.joint9");
  expect(place + "over: time, at: [0, 1], number: [1, 2]}", "there is no signal time");
  const std::string friction = "{effect: coulomb_friction, site: joint1, ",
                    over = "over: q.joint2, at: [0, 1], number: [1, 2]}";
  EXPECT_EQ(refused(friction + "shape: {width: 0.1}, " + over), "taken");
  expect(friction + over, "coulomb_friction has no shape here; give width");
  EXPECT_NE(said_to("effects: {}\n").find("effects.yaml:1: effects is no list"), std::string::npos);
  EXPECT_NE(said_to("effects: []\ncurves: 3\n").find("effects.yaml:2: curves is no list"),
            std::string::npos);
  expect(place + "over: q.joint2, at: [0, 0], number: [1, 2]}", "do not increase");
  expect(place + "over: q.joint2, at: [0], number: [1]}", "do not increase");
  expect(place + "over: q.joint2, at: [0, 1], number: [1, 2, 3]}", "3 numbers for 2 knots");
  expect(place + "over: q.joint2, at: [0, .nan], number: [1, 2]}", "at");
  expect(place + "over: q.joint2, at: 3, number: [1, 2]}", "at");
  expect("{effect: encoder_offset, site: joint1, over: q.joint2, at: [0, 1], number: [1, 2]}",
         "cannot follow a signal");
  expect("{effect: coulomb_friction, site: joint1, over: q.joint2, at: [0, 1], number: [1, 2]}",
         "shape");
  expect(place + "shape: {width: 1}, over: q.joint2, at: [0, 1], number: [1, 2]}", "width");
}

}  // namespace
}  // namespace shapeid::diagnosis

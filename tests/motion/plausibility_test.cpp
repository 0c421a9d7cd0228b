#include "shapeid/models/plausibility.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "shapeid/models/error.hpp"
#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/motion/message_of.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::chain;
using test::message_of;
using test::read_motion;
using test::regular_times;
using test::ScratchFolder;
using test::smooth_motion;
using test::write_log;

constexpr double radian = 180.0 / std::numbers::pi;

/// Writes what `spoil` makes of a good motion, and says how it is received.
std::string reception(const std::function<void(Sample&)>& spoil, const Robot& robot,
                      const MotionOptions& options = {}) {
  const ScratchFolder scratch;
  const auto path = scratch.path("x.csv");
  write_log(path, robot, regular_times(0.0, 500.0, 5000), [&](double t) {
    Sample s = smooth_motion(robot, t);
    s.in_contact.assign(robot.contacts.size(), true);
    spoil(s);
    return s;
  });
  return message_of<InputError>([&] { static_cast<void>(read_motion(path, robot, options)); },
                                path);
}

Robot standing() {
  Robot robot = chain(3, Root::floating);
  robot.contacts.push_back({"l2", 3, ContactKind::point, Eigen::Isometry3d::Identity()});
  return robot;
}

TEST(Plausibility, GoodLogsPass) {
  EXPECT_EQ(reception([](Sample&) {}, chain(3, Root::floating)), "accepted");
  EXPECT_EQ(reception([](Sample&) {}, chain(3, Root::fixed)), "accepted");
  EXPECT_EQ(reception([](Sample&) {}, standing()), "accepted");
}

TEST(Plausibility, UnitsAndSignsThatCannotBeAreNamed) {
  struct Case {
    std::function<void(Sample&)> spoil;
    std::string message;
  };
  const Case table[] = {
      {[](Sample& s) { s.q *= radian, s.dq *= radian; },
       "x.csv:79, column q.j0: 32.5646 lies outside the limits -2.5 to 2.5 rad: the unit looks "
       "like degrees; give radians, or map with scale: 0.017453292519943295"},
      {[](Sample& s) { s.dq *= radian; },
       "x.csv, column dq.j0: is 57.3 times the derivative of q.j0: its unit looks like degrees per "
       "second; give rad/s and rad (m/s and m) of the same joint, and seconds"},
      {[](Sample& s) { s.q *= radian; },
       "x.csv, column dq.j0: is 0.0175 times the derivative of q.j0: the position's unit looks "
       "like "
       "degrees; give rad/s and rad (m/s and m) of the same joint, and seconds"},
      {[](Sample& s) { s.dq[1] *= -1.0; },
       "x.csv, column dq.j1: is -1 times the derivative of q.j1; give both the same sign (mapping: "
       "sign: -1)"},
      {[](Sample& s) { s.dq[2] *= 6.0; },
       "x.csv, column dq.j2: is 6 times the derivative of q.j2; give rad/s and rad (m/s and m) of "
       "the same joint, and seconds"},
      {[](Sample& s) { s.q *= 2e4, s.dq *= 2e4; },
       "x.csv:79, column q.j0: 11367.2 rad on the limited joint j0; give radians of the joint, "
       "not of the motor or in encoder counts"},
      {[](Sample& s) { s.q.array() -= 1e4; },
       "x.csv:4041, column q.j0: 10000.6 rad on the limited joint j0; give radians of the joint, "
       "not of the motor or in encoder counts"},
      {[](Sample& s) { s.time *= 1000.0; },
       "x.csv, column time: the median step is 2 s; give seconds, and at least five rows a second; "
       "milliseconds take scale: 0.001, microseconds 1e-6"},
      {[](Sample& s) { s.time *= 1e-7; },
       "x.csv, column time: the median step is 2e-10 s; give seconds, and at least five rows a "
       "second"},
      {[](Sample& s) { s.tau[1] = 1.5; },
       "x.csv, column tau.j1: stays at 1.5 while the joints move; log the live signal, or leave "
       "the rows out"},
  };
  for (const Case& wrong : table) {
    EXPECT_EQ(reception(wrong.spoil, chain(3, Root::fixed)), wrong.message);
  }
}

TEST(Plausibility, AVelocityOfAnotherJointIsNamed) {
  const Robot robot = chain(3, Root::fixed);
  EXPECT_EQ(reception([](Sample& s) { std::swap(s.q[0], s.q[2]); }, robot),
            "x.csv, column dq.j0: is the derivative of q.j2, and not of q.j0; give position, "
            "velocity and torque of the same joint one name (mapping)");
  EXPECT_EQ(reception([](Sample& s) { s.dq[0] = s.dq[2]; }, robot),
            "x.csv, column dq.j0: is the derivative of q.j2, and not of q.j0; give position, "
            "velocity and torque of the same joint one name (mapping)");
  // Legs that move alike tell nothing, nor does a velocity that is none of the joints'.
  EXPECT_EQ(reception([](Sample& s) { s.q[2] = s.q[0], s.dq[2] = s.dq[0]; }, robot), "accepted");
  EXPECT_EQ(reception([](Sample& s) { s.dq[1] = std::sin(40.0 * s.time); }, robot), "accepted");
}

TEST(Plausibility, LengthsAndTurnsThatCannotBeAreNamed) {
  Robot slides = chain(3, Root::fixed);
  slides.links[1].joint.kind = JointKind::prismatic;
  slides.links[1].joint.lower = -0.6;
  slides.links[1].joint.upper = 0.6;
  EXPECT_EQ(reception([](Sample&) {}, slides), "accepted");
  const auto in_units = [&](double unit) {
    return reception([=](Sample& s) { s.q[0] *= unit, s.dq[0] *= unit; }, slides);
  };
  EXPECT_NE(in_units(1e3).find("column q.j0: 568.359 lies outside the limits -0.6 to 0.6 m: the "
                               "unit looks like millimetres; give metres"),
            std::string::npos)
      << in_units(1e3);
  EXPECT_NE(in_units(1e2).find("millimetres or centimetres"), std::string::npos) << in_units(1e2);
  EXPECT_EQ(in_units(3.0), "accepted");  // stops are given roughly
  // Where the stops are on one side of zero, one unit alone fits.
  slides.links[1].joint.lower = -0.1;
  slides.links[1].joint.upper = 6.0;
  const std::string high =
      reception([](Sample& s) { s.q[0] = 300.0 + 100.0 * s.q[0], s.dq[0] *= 100.0; }, slides);
  EXPECT_NE(high.find("looks like millimetres or centimetres"), std::string::npos) << high;
  slides.links[1].joint.lower = 2.0;
  const std::string far =
      reception([](Sample& s) { s.q[0] = 300.0 + 50.0 * s.q[0], s.dq[0] *= 50.0; }, slides);
  EXPECT_NE(far.find("looks like centimetres; give"), std::string::npos) << far;

  constexpr double turn = 2.0 * std::numbers::pi;
  for (const double off : {turn, -turn}) {
    const std::string message = reception([=](Sample& s) { s.q[1] += off; }, chain(3, Root::fixed));
    EXPECT_NE(message.find("it looks a whole turn off"), std::string::npos) << message;
    EXPECT_NE(message.find(fmt::format("offset: {:.17g}", -off)), std::string::npos) << message;
  }
}

TEST(Plausibility, GravityIsLookedForWhereSomethingCarriesTheRobot) {
  struct Case {
    std::function<void(Sample&)> spoil;
    std::string hint;
  };
  const Case table[] = {
      {[](Sample& s) { s.base_specific_force /= 9.81; }, "the unit looks like g (scale: 9.80665)"},
      {[](Sample& s) { s.base_specific_force *= 1e3; }, "the unit looks like mm/s^2"},
      {[](Sample& s) { s.base_specific_force.z() -= 9.81; }, "gravity seems to be removed"},
      {[](Sample& s) { s.base_specific_force *= 3.0; }, "gravity included"},
  };
  for (const Case& wrong : table) {
    const std::string message = reception(wrong.spoil, standing());
    EXPECT_NE(message.find(wrong.hint), std::string::npos) << message;
    EXPECT_NE(message.find("column base.accel.x: the accelerometer's mean magnitude is"),
              std::string::npos)
        << message;
    MotionOptions trusting;
    trusting.expect_gravity = false;
    EXPECT_EQ(reception(wrong.spoil, standing(), trusting), "accepted");
  }
  const auto falling = [](Sample& s) {
    s.base_specific_force.z() -= 9.81;
    s.in_contact = {false};
  };
  EXPECT_EQ(reception(falling, standing()), "accepted");
}

TEST(Plausibility, AFrozenImuIsRefused) {
  const auto frozen = [](Sample& s) { s.base_specific_force = {0.1, 0.2, 9.8}; };
  EXPECT_EQ(reception(frozen, chain(2, Root::floating)),
            "x.csv, column base.accel.x: stays at 0.1 while the joints move; log the live signal, "
            "or leave the rows out");
  MotionOptions trusting;
  trusting.refuse_frozen = false;
  EXPECT_EQ(reception(frozen, chain(2, Root::floating), trusting), "accepted");
}

/// An encoder that begins anew after each turn; a wheel that makes turns from row to row does not.
TEST(Plausibility, AnglesThatWrapAreRefused) {
  Robot wheel = chain(1, Root::fixed);
  wheel.links[1].joint.kind = JointKind::continuous;
  const auto wrapped = [](Sample& s) {
    s.q[0] = std::remainder(3.0 * s.time, 2.0 * std::numbers::pi);
    s.dq[0] = 3.0;
  };
  const std::string message = reception(wrapped, wheel);
  EXPECT_NE(message.find("x.csv:526, column q.j0: jumps by -6.28 rad"), std::string::npos)
      << message;
  EXPECT_NE(message.find("wraps; count its turns on"), std::string::npos) << message;
  const auto fast = [](Sample& s) {
    s.q[0] = 2.0 * std::numbers::pi * 500.0 * s.time;
    s.dq[0] = 2.0 * std::numbers::pi * 500.0;
  };
  EXPECT_EQ(reception(fast, wheel), "accepted");
}

/// One encoder reading of five thousand that is a radian off.
TEST(Plausibility, AWildReadingIsRefused) {
  const auto at = [](double t, double off) {
    return [t, off](Sample& s) {
      if (std::abs(s.time - t) < 1e-4) s.q[1] += off;
    };
  };
  for (const double off : {1.0, -3.0}) {
    const std::string message = reception(at(2.0, off), chain(3, Root::fixed));
    EXPECT_NE(message.find("x.csv:1002, column q.j1: is "), std::string::npos) << message;
    EXPECT_NE(message.find("a wild reading; leave the row out"), std::string::npos) << message;
  }
  EXPECT_EQ(reception(at(2.0, 0.01), chain(3, Root::fixed)), "accepted");
}

/// An encoder that slips, and one whose readings are elsewhere for more than one row. What goes as
/// fast for longer is a wheel.
TEST(Plausibility, AJumpThatStaysIsRefused) {
  const auto from_to = [](double from, double to, double off) {
    return [=](Sample& s) {
      if (s.time > from && s.time < to) s.q[1] += off;
    };
  };
  constexpr double end = 100.0;
  for (const double off : {1.0, -3.0}) {
    for (const double to : {end, 2.005}) {
      const std::string message = reception(from_to(2.001, to, off), chain(3, Root::fixed));
      EXPECT_NE(message.find("x.csv:1003, column q.j1: jumps by "), std::string::npos) << message;
      EXPECT_NE(message.find("stays there"), std::string::npos) << message;
    }
  }
  EXPECT_EQ(reception(from_to(2.0, end, 0.1), chain(3, Root::fixed)), "accepted");
  Robot wheel = chain(1, Root::fixed);
  wheel.links[1].joint.kind = JointKind::continuous;
  const auto starts = [](Sample& s) {
    const double turning = std::max(0.0, s.time - 2.0);
    s.q[0] += 400.0 * turning;
    s.dq[0] += turning > 0.0 ? 400.0 : 0.0;
  };
  EXPECT_EQ(reception(starts, wheel), "accepted");
}

/// The grid is that of the first rows.
TEST(Plausibility, AnotherRateIsRefused) {
  const Robot robot = chain(3, Root::fixed);
  const ScratchFolder scratch;
  const auto path = scratch.path("x.csv");
  const auto with_steps = [&](double first, double second) {
    std::vector<double> times;
    for (double t = 0.0; times.size() < 10000; t += times.size() < 5000 ? first : second) {
      times.push_back(t);
    }
    write_log(path, robot, times, [&](double t) { return smooth_motion(robot, t); });
    return message_of<InputError>([&] { static_cast<void>(read_motion(path, robot, {})); }, path);
  };
  EXPECT_EQ(with_steps(0.005, 0.004), "accepted");
  for (const double second : {0.001, 0.02}) {
    const std::string message = with_steps(0.005, second);
    EXPECT_NE(message.find("x.csv:4098, column time: rows come "), std::string::npos) << message;
    EXPECT_NE(message.find("times a second from about here on, and did 200 times before"),
              std::string::npos)
        << message;
  }
}

/// Without smoothing the cutoff is nothing that a slow log could be too slow for.
TEST(Plausibility, WithoutSmoothingNoCutoffIsAskedFor) {
  const Robot robot = chain(3, Root::fixed);
  const ScratchFolder scratch;
  const auto path = scratch.path("x.csv");
  write_log(path, robot, regular_times(0.0, 30.0, 600),
            [&](double t) { return smooth_motion(robot, t); });
  MotionOptions options;
  const auto received = [&] {
    return message_of<InputError>([&] { static_cast<void>(read_motion(path, robot, options)); },
                                  path);
  };
  EXPECT_NE(received().find("a filter of 20 Hz for data at 30 Hz"), std::string::npos)
      << received();
  options.smoothing = Smoothing::none;
  EXPECT_EQ(received(), "accepted");
}

/// What has gone dead mostly reads zero. Without noise, in a plane, a sound axis does.
TEST(Plausibility, AnAxisThatReadsZeroIsDead) {
  const Robot robot = chain(2, Root::floating);
  const auto no_roll = [](Sample& s) { s.base_angular_velocity.x() = 0.0; };
  EXPECT_EQ(reception(no_roll, robot),
            "x.csv, column base.gyro.x: stays at 0 while the joints move; log the live signal, or "
            "leave the rows out");
  const auto no_side = [](Sample& s) { s.base_specific_force.y() = 0.0; };
  EXPECT_NE(reception(no_side, robot).find("base.accel.y: stays at 0"), std::string::npos);
}

/// A base that does not turn, as in a squat: only a gyro of which some axis turns has a dead one,
/// or that of a base which is thrown about.
TEST(Plausibility, AGyroOfABaseThatDoesNotTurnIsNotDead) {
  const Robot robot = chain(2, Root::floating);
  const auto squats = [](Sample& s) {
    s.base_angular_velocity.setZero();
    s.base_specific_force = {0.0, 0.1 * std::sin(s.time), 9.81 + std::sin(3.0 * s.time)};
    s.base_specific_force.x() = 0.05 * std::cos(s.time);
  };
  EXPECT_EQ(reception(squats, robot), "accepted");
  const auto gallops = [&](Sample& s) {
    squats(s);
    s.base_specific_force.x() = std::sin(2.0 * s.time);
  };
  EXPECT_NE(reception(gallops, robot).find("column base.gyro.x: stays at 0"), std::string::npos);
}

/// An encoder that is dead where the motor's speed is not; a joint that stands, whose speed is
/// noise and a little off.
TEST(Plausibility, APositionThatStaysWhileItsVelocityMovesIsRefused) {
  const auto stuck = [](Sample& s) { s.q[1] = 0.2; };
  EXPECT_NE(reception(stuck, chain(3, Root::fixed)).find("column q.j1: stays at 0.2 while"),
            std::string::npos);
  const auto stands = [](Sample& s) {
    s.q[1] = 0.2;
    s.dq[1] = 0.02 * std::sin(1e5 * s.time) + 0.01;
  };
  EXPECT_EQ(reception(stands, chain(3, Root::fixed)), "accepted");
}

/// The same joint for a minute and a half of slow logs: an offset sums up to radians there, and
/// noise to tenths of one. What its drive does slowly is motion.
TEST(Plausibility, AnOffsetAndNoiseOfVelocityAreNoMotionInAnyLog) {
  const Robot robot = chain(3, Root::fixed);
  const ScratchFolder scratch;
  const auto path = scratch.path("x.csv");
  for (const double rate : {50.0, 200.0, 500.0}) {
    test::Draw draw(20261130);
    const auto received = [&](double offset, double noise, double speed) {
      write_log(path, robot, regular_times(0.0, rate, 4200), [&](double t) {
        Sample s = smooth_motion(robot, t);
        s.q[1] = 0.3;
        s.dq[1] = offset + noise * draw.normal() + speed * std::sin(2.0 * t);
        return s;
      });
      return message_of<InputError>([&] { static_cast<void>(read_motion(path, robot, {})); }, path);
    };
    EXPECT_EQ(received(0.1, 0.0, 0.0), "accepted") << rate;
    EXPECT_EQ(received(0.0, 0.2, 0.0), "accepted") << rate;
    EXPECT_EQ(received(0.1, 0.2, 0.0), "accepted") << rate;
    EXPECT_NE(received(0.1, 0.1, 0.3).find("column q.j1: stays at 0.3 while"), std::string::npos)
        << rate;
  }
}

TEST(Plausibility, PassiveJointsAndWheelsPass) {
  EXPECT_EQ(reception([](Sample& s) { s.tau[1] = 0.0; }, chain(3, Root::fixed)), "accepted");
  Robot wheel = chain(1, Root::fixed);
  wheel.links[1].joint.kind = JointKind::continuous;
  EXPECT_EQ(reception([](Sample& s) { s.q *= 200.0, s.dq *= 200.0; }, wheel), "accepted");
}

// Too little motion decides nothing: encoder noise has no slope.
TEST(Plausibility, ARestingRobotPasses) {
  const auto resting = [](Sample& s) {
    s.q *= 1e-3;
    s.dq *= -0.3;
  };
  EXPECT_EQ(reception(resting, chain(3, Root::fixed)), "accepted");
}

// A unit that changes later in the log is found there.
TEST(Plausibility, EveryBlockIsJudged) {
  const auto late = [](Sample& s) {
    if (s.time > 8.0) s.dq *= radian;
  };
  EXPECT_NE(reception(late, chain(3, Root::fixed)).find("is 57.3 times"), std::string::npos);
}

// Of many lines with the same value, the first: there the log can be looked at.
TEST(Plausibility, TheFirstLineOfAnExtremeIsNamed) {
  const Robot robot = chain(3, Root::fixed);
  constexpr double stop = 25.0;
  for (const double sign : {-1.0, 1.0}) {
    int first = 0;
    for (int k = 0; first == 0; ++k) {
      if (sign * radian * smooth_motion(robot, k / 500.0).q[0] > stop) first = k;
    }
    const auto stopped = [&](Sample& s) {
      const double q = sign * radian * s.q[0];
      s.q[0] = sign * (q > stop ? stop : std::max(q, 0.0));
      s.dq.setZero();
    };
    const std::string message = reception(stopped, robot);
    EXPECT_EQ(message.rfind(
                  fmt::format("x.csv:{}, column q.j0: {} lies outside", first + 2, sign * stop), 0),
              0U)
        << message;
  }
}

// A clock that counts in microseconds steps by one at most; what is longer by a rounding is taken.
TEST(Plausibility, AStepOfAMicrosecondIsRefused) {
  constexpr double microsecond = 1e-6;
  EXPECT_THROW(check_clock("x.csv", "time", microsecond), InputError);
  EXPECT_NO_THROW(check_clock("x.csv", "time", std::nextafter(microsecond, 1.0)));
}

/// As a stream has it whose clock is set by another one: an integral over the step back would have
/// the other sign.
TEST(Plausibility, AClockThatIsSetBackIsNoMotion) {
  const Robot robot = chain(1, Root::fixed);
  const LogTable table("x.csv", "time,q.j0,dq.j0,tau.j0", 1);
  const ChannelPlan plan = plan_channels(table, robot, {});
  Plausibility plausibility("x.csv", robot, plan, {.longest_step = 0.1});
  for (int k = 0; k < 4000; ++k) {
    const double step = 0.002, back = 0.07;
    const int times_back = k / 17;  // a row more than a span of the test takes
    MeasuredRow row;
    row.line = k + 2;
    row.time = step * k - back * times_back;
    row.values.resize(static_cast<Eigen::Index>(plan.channels.size()));
    row.values[plan.q] = std::sin(3.0 * step * k);
    row.values[plan.dq] = 3.0 * std::cos(3.0 * step * k);
    row.values[plan.tau] = std::sin(5.0 * step * k);
    plausibility.add(row);
  }
  EXPECT_NO_THROW(plausibility.judge());
}

}  // namespace
}  // namespace shapeid

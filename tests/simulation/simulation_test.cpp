#include "shapeid/models/simbody/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/shape.hpp"
#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/tests/simulation/quadruped.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled;

std::vector<SimulatedSample> run(const SimulationOptions& options) {
  std::vector<SimulatedSample> samples;
  simulate(test::quadruped(), options,
           [&](const SimulatedSample& sample) { samples.push_back(sample); });
  return samples;
}

SimulationOptions short_run(std::uint64_t seed) {
  SimulationOptions options;
  options.duration = 2.0;
  options.seed = seed;
  return options;
}

Load corner_load(double x, double y) {
  Load load;
  load.centre << x, y, 0.078;
  return load;
}

/// Both sides of the equation of motion, H qddot + C qdot + G and S^T tau + J^T f.
struct Balance {
  Eigen::VectorXd motion, forces;
};

Balance balance(const SimbodyRobot& simbody, const Robot& robot, const Sample& s) {
  Eigen::VectorXd f(3 * static_cast<Eigen::Index>(s.contact_force.size()));
  for (std::size_t c = 0; c < s.contact_force.size(); ++c) {
    f.segment<3>(3 * static_cast<Eigen::Index>(c)) = s.contact_force[c];
  }
  Balance b{simbody.inverse_dynamics(s), simbody.contact_point_jacobian(s.q).transpose() * f};
  b.forces.tail(robot.joint_count()) += s.tau;
  return b;
}

// The heart of the simulator: its samples satisfy the declared model exactly, load included.
TEST(Simulation, EquationOfMotionHoldsToRounding) {
  SimulationOptions options = short_run(3);
  options.load = corner_load(0.18, -0.08);
  const Robot loaded = with_load(test::quadruped(), *options.load);
  const SimbodyRobot simbody(loaded);
  double weight = 0.0;
  for (const Link& link : loaded.links) weight += 9.81 * link.inertia.mass();
  for (const SimulatedSample& sample : run(options)) {
    const Balance b = balance(simbody, loaded, sample.sample);
    ASSERT_LT(scaled((b.motion - b.forces).norm(), weight + b.forces.norm(), loaded.dof()),
              few_hundred_eps)
        << "at " << sample.sample.time;
  }
}

/// The robot with its contact points moved by so much (m, world axes).
Robot with_contacts_moved(const Robot& robot, const SimulatedSample& sample,
                          const std::vector<Eigen::Vector3d>& by) {
  Robot marked = robot;  // three more points of each foot's link show how it is turned
  for (const Contact& contact : robot.contacts) {
    for (int axis = 0; axis < 3; ++axis) {
      marked.contacts.push_back(contact);
      marked.contacts.back().frame.translation() += Eigen::Vector3d::Unit(axis);
    }
  }
  const Eigen::Matrix3Xd points = SimbodyRobot(marked).contact_positions(sample.sample.q);
  Robot moved = robot;
  for (std::size_t c = 0; c < by.size(); ++c) {
    const auto foot = static_cast<Eigen::Index>(c);
    const Eigen::Matrix3d turn =
        points.middleCols<3>(std::ssize(by) + 3 * foot).colwise() - points.col(foot);
    moved.contacts[c].frame.translation() +=
        turn.transpose() * sample.state.base.linear().transpose() * by[c];
  }
  return moved;
}

// The ground pushes on a ball where it is lowest, however the leg stands.
TEST(Simulation, BallsTouchWhereTheyAreLowest) {
  SimulationOptions options = short_run(4);
  options.ground.foot_radius = {0.02, 0.0, 0.013, 0.03};
  const Robot robot = test::quadruped();
  std::vector<Eigen::Vector3d> down;
  for (const double r : options.ground.foot_radius) down.emplace_back(0.0, 0.0, -r);
  const double weight = 9.81 * 13.0;
  double largest_of_points = 0.0;
  const std::vector<SimulatedSample> samples = run(options);
  constexpr std::size_t every = 20;
  for (std::size_t i = 0; i < samples.size(); i += every) {
    const Robot moved = with_contacts_moved(robot, samples[i], down);
    const Balance b = balance(SimbodyRobot(moved), moved, samples[i].sample);
    ASSERT_LT(scaled((b.motion - b.forces).norm(), weight + b.forces.norm(), robot.dof()),
              few_hundred_eps);
    const Balance points = balance(SimbodyRobot(robot), robot, samples[i].sample);
    largest_of_points = std::max(largest_of_points, (points.motion - points.forces).norm());
  }
  EXPECT_GT(largest_of_points, 0.1);  // N m: 13 mm beside a foot that bears some ten N
}

// The residual of the model without the load is the load's own Newton-Euler wrench.
TEST(Simulation, ModelWithoutTheLoadMissesExactlyTheLoad) {
  SimulationOptions options = short_run(3);
  options.duration = 0.2;
  options.load = corner_load(0.18, -0.08);
  const InertialParameters load = inertia_of(*options.load);
  const Eigen::Vector3d h = load.first_moment();
  const Robot robot = test::quadruped();
  const SimbodyRobot simbody(robot);
  for (const SimulatedSample& sample : run(options)) {
    const Sample& s = sample.sample;
    const Eigen::Vector3d& w = s.base_angular_velocity;
    const Eigen::Vector3d& dw = s.base_angular_acceleration;
    const Eigen::Vector3d& a = s.base_specific_force;
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(robot.dof());
    expected.head<6>() << load.mass() * a + dw.cross(h) + w.cross(w.cross(h)),
        h.cross(a) + load.tensor() * dw + w.cross(load.tensor() * w);
    const Balance b = balance(simbody, robot, s);
    ASSERT_LT(scaled((b.forces - b.motion - expected).norm(), 14.0 * 9.81 + b.forces.norm(), 18),
              few_hundred_eps);
    ASSERT_GT(expected.head<3>().norm(), 5.0);  // N, of a weight of 9.81
  }
}

TEST(Simulation, LoadIsACuboidOfUniformDensity) {
  Load load = corner_load(0.1, -0.05);
  load.mass = 1.7;
  load.sides << 0.03, 0.05, 0.08;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = load.centre;
  const InertialParameters expected = load.mass * unit_parameters(make_cuboid(load.sides, pose));
  EXPECT_LT(test::scaled_difference(inertia_of(load).values, expected.values, 10), few_hundred_eps);
  const Robot robot = test::quadruped();
  const Eigen::VectorXd grown =
      stacked_parameters(with_load(robot, load)) - stacked_parameters(robot);
  EXPECT_LT(scaled((grown.head<10>() - expected.values).norm(), 5.48, 10), few_hundred_eps);
  EXPECT_TRUE(grown.tail(grown.size() - 10).isZero(0.0));
}

/// The largest entry of the rise of `value` from sample to sample minus the trapezoid of `slope`,
/// as a slope, and the largest entry of `slope` itself.
template <typename Value, typename Slope>
std::pair<double, double> slope_error(const std::vector<SimulatedSample>& samples, double rate,
                                      Value value, Slope slope) {
  double error = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const Eigen::VectorXd rise =
        rate * (Eigen::VectorXd(value(samples[i + 1])) - value(samples[i]));
    const Eigen::VectorXd before = slope(samples[i]);
    const Eigen::VectorXd after = slope(samples[i + 1]);
    error = std::max(error, (rise - 0.5 * (before + after)).cwiseAbs().maxCoeff());
    size = std::max(size, after.cwiseAbs().maxCoeff());
  }
  return {error, size};
}

// Positions, velocities and accelerations belong to one motion. Torques are straight lines between
// samples, so trapezoids of accelerations miss only what the compliant ground bends them at
// take-off and landing, within milliseconds: at 5 kHz below a percent of the largest.
TEST(Simulation, VelocitiesAndAccelerationsAreTheDerivatives) {
  SimulationOptions options = short_run(8);
  options.rate = 5000.0;
  options.duration = 0.5;
  options.trot.stand = 0.1;
  auto samples = run(options);
  // Feet at rest have no friction yet: it builds up within 0.1 ms of the start.
  samples.erase(samples.begin(), samples.begin() + 5);
  using S = const SimulatedSample&;
  constexpr double percent = 0.01;
  const auto joints = slope_error(
      samples, options.rate, [](S s) { return s.sample.q; }, [](S s) { return s.sample.dq; });
  EXPECT_LT(joints.first, percent * joints.second);
  const auto velocities = slope_error(
      samples, options.rate, [](S s) { return s.sample.dq; }, [](S s) { return s.sample.ddq; });
  EXPECT_LT(velocities.first, percent * velocities.second);
  const auto gyro = slope_error(
      samples, options.rate, [](S s) { return s.sample.base_angular_velocity; },
      [](S s) { return s.sample.base_angular_acceleration; });
  EXPECT_LT(gyro.first, percent * gyro.second);
  // The specific force plus gravity is what changes the base's velocity in the world.
  const auto base = slope_error(
      samples, options.rate,
      [](S s) -> Eigen::Vector3d { return s.state.base.linear() * s.state.base_linear_velocity; },
      [](S s) -> Eigen::Vector3d {
        return s.state.base.linear() * s.sample.base_specific_force + SimbodyRobot::gravity();
      });
  EXPECT_LT(base.first, percent * base.second);
}

TEST(Simulation, ContactsPushWithinFrictionAndFlagsSayWhen) {
  const SimulationOptions options = short_run(5);
  std::vector<std::size_t> touching(4, 0);
  const auto samples = run(options);
  for (const SimulatedSample& sample : samples) {
    for (std::size_t c = 0; c < 4; ++c) {
      const Eigen::Vector3d force =
          sample.state.base.linear() * sample.sample.contact_force[c];  // world axes
      if (!sample.sample.in_contact[c]) {
        ASSERT_EQ(force.norm(), 0.0);
        continue;
      }
      ++touching[c];
      ASSERT_GT(force.z(), 0.0);
      ASSERT_LE(force.head<2>().norm(), options.ground.friction * force.z() * (1.0 + 1e-12));
    }
  }
  // Standing for 0.4 s of 2 s, then a duty of 0.55: every foot swings and every foot stands.
  for (const std::size_t count : touching) {
    EXPECT_GT(count, samples.size() / 2);
    EXPECT_LT(count, samples.size() * 4 / 5);
  }
}

/// Largest error of: change of energy = work of the joints + work of the ground; and the work.
struct Audit {
  double error = 0.0, work = 0.0;
};

Audit audit(double accuracy) {
  SimulationOptions options = short_run(2);
  options.accuracy = accuracy;
  const SimbodyRobot simbody(test::quadruped());
  Audit result;
  double start = 0.0;
  for (const SimulatedSample& sample : run(options)) {
    const double energy =
        simbody.kinetic_energy(sample.state) + simbody.potential_energy(sample.state);
    if (sample.sample.time == 0.0) start = energy;
    const double work = sample.drive_work + sample.ground_work;
    result.error = std::max(result.error, std::abs(energy - start - work));
    result.work = std::max(result.work, std::abs(sample.drive_work));
  }
  return result;
}

TEST(Simulation, WorkOfJointsAndGroundIsTheChangeOfEnergy) {
  const Audit coarse = audit(1e-3);
  const Audit fine = audit(1e-6);
  EXPECT_GT(fine.work, 1.0);                    // J: there is something to audit
  EXPECT_LT(coarse.error, 1e-3 * coarse.work);  // the accuracy asked of the integrator
  EXPECT_LT(fine.error, 1e-6 * fine.work);
}

// Beside what the load brings and takes, moving along already.
TEST(Simulation, WorkIsCountedOnWhereALoadComesAndGoes) {
  SimulationOptions options = short_run(2);
  options.accuracy = 1e-6;
  options.load = corner_load(0.05, 0.02);
  options.load_from = 0.6;
  options.load_until = 1.4;
  const SimbodyRobot empty(test::quadruped());
  const SimbodyRobot full(with_load(test::quadruped(), *options.load));
  const auto energy_of = [](const SimbodyRobot& simbody, const RobotState& state) {
    return simbody.kinetic_energy(state) + simbody.potential_energy(state);
  };
  const std::vector<SimulatedSample> samples = run(options);
  double brought = energy_of(empty, samples.front().state), worst = 0.0, work_of_joints = 0.0;
  bool carried = false;
  int changes = 0;
  for (const SimulatedSample& sample : samples) {
    const double time = sample.sample.time;
    const bool carries = time >= options.load_from && time < options.load_until;
    const double energy = energy_of(carries ? full : empty, sample.state);
    if (carries != carried) {
      brought += energy - energy_of(carried ? full : empty, sample.state);
      ++changes;
    }
    carried = carries;
    const double work = sample.drive_work + sample.ground_work;
    worst = std::max(worst, std::abs(energy - brought - work));
    work_of_joints = std::max(work_of_joints, std::abs(sample.drive_work));
  }
  EXPECT_EQ(changes, 2);
  EXPECT_GT(work_of_joints, 1.0);  // J
  EXPECT_LT(worst, 1e-5 * work_of_joints);
}

TEST(Simulation, SameSeedSameSamplesBitForBit) {
  SimulationOptions options = short_run(4);
  options.duration = 0.8;
  const auto once = run(options);
  const auto again = run(options);
  options.seed = 6;
  const auto other = run(options);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    ASSERT_EQ(once[i].sample.q, again[i].sample.q);
    ASSERT_EQ(once[i].sample.ddq, again[i].sample.ddq);
    ASSERT_EQ(once[i].sample.tau, again[i].sample.tau);
    ASSERT_EQ(once[i].sample.base_specific_force, again[i].sample.base_specific_force);
  }
  EXPECT_NE(once.back().sample.q, other.back().sample.q);
}

TEST(Simulation, TrotsWithAndWithoutLoad) {
  const Robot robot = test::quadruped();
  for (const std::optional<Load>& load :
       {std::optional<Load>(), std::optional<Load>(corner_load(0.18, 0.08)),
        std::optional<Load>(corner_load(-0.18, -0.08))}) {
    SimulationOptions options;
    options.duration = 3.0;
    options.seed = 11;
    options.load = load;
    double steepest = 0.0;
    const SimulationReport report = simulate(robot, options, [&](const SimulatedSample& s) {
      steepest = std::max(steepest, std::acos(s.state.base.linear()(2, 2)));
    });
    EXPECT_FALSE(report.fell_at);
    EXPECT_EQ(report.samples, 1501u);
    EXPECT_GT(report.distance, 0.2);
    EXPECT_GT(steepest, 0.05);  // rad: it is asked to tilt by 0.08
    EXPECT_LT(steepest, 0.30);
  }
}

TEST(Simulation, SamplesComeAtTheRateAskedFor) {
  SimulationOptions options = short_run(1);
  options.duration = 0.1;
  options.rate = 100.0;
  const auto slow = run(options);
  options.rate = 1000.0;
  const auto fast = run(options);
  ASSERT_EQ(slow.size(), 11u);
  ASSERT_EQ(fast.size(), 101u);
  EXPECT_DOUBLE_EQ(slow[7].sample.time, 0.07);
  EXPECT_DOUBLE_EQ(fast[73].sample.time, 0.073);
}

TEST(Simulation, OnIceItFallsAndSaysWhen) {
  SimulationOptions options;
  options.duration = 10.0;
  options.ground.friction = 0.02;
  const SimulationReport report = simulate(test::quadruped(), options, [](const auto&) {});
  ASSERT_TRUE(report.fell_at);
  EXPECT_LT(*report.fell_at, 10.0);
  EXPECT_LT(report.samples, 5001u);
}

TEST(Simulation, RefusesWhatCannotTrot) {
  const auto ignore = [](const SimulatedSample&) {};
  Robot robot = test::quadruped();
  robot.contacts.pop_back();
  EXPECT_THROW(simulate(robot, {}, ignore), InputError);
  robot = test::quadruped();
  robot.root = Root::fixed;
  EXPECT_THROW(simulate(robot, {}, ignore), InputError);
  SimulationOptions options;
  options.rate = 0.0;
  EXPECT_THROW(simulate(test::quadruped(), options, ignore), InputError);
  options = {};
  options.trot.height = 0.9;  // longer than the legs
  EXPECT_THROW(simulate(test::quadruped(), options, ignore), InputError);
}

}  // namespace
}  // namespace shapeid

// Effects of sensors and contacts, with their signs: a log is spoilt as the effect's words say,
// without its code, and the model that has the effect is right again.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <functional>

#include "shapeid/diagnosis/series.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/diagnosis/trot.hpp"

namespace shapeid::diagnosis {
namespace {

using test::effect;
using test::Trot;

// Of the residual's squares: what is left with the effect, and what its opposite adds at least.
constexpr double nearly_nothing = 0.02, much = 1.5;

const Trot& trot() {
  static const Trot one;
  return one;
}

double squares(const Robot& robot, const std::vector<Sample>& samples,
               const std::vector<AppliedEffect>& effects, double rate, ContactTreatment contacts) {
  const RichModel model{stacked_parameters(robot), effects};
  constexpr std::size_t stride = 4;
  return series(robot, contacts, model, Recording(samples, rate), stride).residual.squaredNorm();
}

/// The effect takes away what it brought in, and its opposite doubles it.
void expect_restored(const Robot& robot, const std::vector<Sample>& right,
                     const std::vector<Sample>& spoilt, const AppliedEffect& by, double rate,
                     ContactTreatment contacts) {
  AppliedEffect opposite = by;
  opposite.value *= -1.0;
  const auto of = [&](const std::vector<Sample>& samples, const std::vector<AppliedEffect>& e) {
    return squares(robot, samples, e, rate, contacts);
  };
  const double clean = of(right, {}), wrong = of(spoilt, {});
  EXPECT_GT(wrong, 1.5 * clean) << "the fault is seen";
  EXPECT_LT(of(spoilt, {by}) - clean, nearly_nothing * (wrong - clean));
  EXPECT_GT(of(spoilt, {opposite}) - clean, much * (wrong - clean));
}

void expect_restored_on_the_trot(const std::function<void(std::vector<Sample>&)>& spoil,
                                 const AppliedEffect& by) {
  std::vector<Sample> spoilt = trot().samples;
  spoil(spoilt);
  expect_restored(trot().robot, trot().samples, spoilt, by, Trot::rate, ContactTreatment::project);
}

TEST(Sensors, AnAccelerometerThatReadsTooMuch) {
  const Eigen::Vector3d bias(0.9, -0.6, 0.5);
  expect_restored_on_the_trot(
      [&](std::vector<Sample>& samples) {
        for (Sample& s : samples) s.base_specific_force += bias;
      },
      effect("accel_bias", 0, {0.9, -0.6, 0.5}));
}

/// Its axes are the base's, turned; it reads the same vector in its own.
TEST(Sensors, AnAccelerometerMountedAskew) {
  const Eigen::Vector3d turn(0.08, -0.11, 0.05);
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(turn.norm(), turn.normalized()).matrix();
  expect_restored_on_the_trot(
      [&](std::vector<Sample>& samples) {
        for (Sample& s : samples) s.base_specific_force = axes.transpose() * s.base_specific_force;
      },
      effect("accel_misalignment", 0, {turn[0], turn[1], turn[2]}));
}

TEST(Sensors, AnImuThatIsLate) {
  constexpr std::size_t late = 3;  // samples
  expect_restored_on_the_trot(
      [&](std::vector<Sample>& samples) {
        for (std::size_t i = samples.size(); i-- > late;) {
          const Sample& before = trot().samples[i - late];
          samples[i].base_angular_velocity = before.base_angular_velocity;
          samples[i].base_angular_acceleration = before.base_angular_acceleration;
          samples[i].base_specific_force = before.base_specific_force;
        }
      },
      effect("imu_delay", 0, {late / Trot::rate}));
}

/// The torque is that of an arm whose base leans, the log says that it stands upright.
TEST(Sensors, ABaseThatLeans) {
  const Robot robot = test::arm();
  const std::vector<Sample> upright = test::record({{}, 20.0, 0.0}).samples();
  const Eigen::Matrix3d leans =
      Eigen::AngleAxisd(std::hypot(0.05, 0.03), Eigen::Vector3d(0.05, -0.03, 0.0).normalized())
          .matrix();
  std::vector<Sample> spoilt = upright;
  for (Sample& s : spoilt) {
    Sample leaning = s;
    leaning.base_specific_force = leans * s.base_specific_force;
    s.tau = reference::regressor(robot, leaning) * stacked_parameters(robot);
  }
  expect_restored(robot, upright, spoilt, effect("gravity_tilt", 0, {0.05, -0.03}), 100.0,
                  ContactTreatment::ignore);
}

/// The robot's file says that a foot touches elsewhere than it did.
TEST(Sensors, AFootThatTouchesElsewhere) {
  const Eigen::Vector3d by(0.03, -0.02, 0.025);
  Robot declared = trot().robot;
  constexpr std::size_t foot = 2;
  declared.contacts[foot].frame.translation() -= by;
  const auto of = [&](const Robot& robot, const std::vector<AppliedEffect>& effects) {
    return squares(robot, trot().samples, effects, Trot::rate, ContactTreatment::project);
  };
  const auto moved = [&](double times) {
    return effect("contact_point", foot, {times * by[0], times * by[1], times * by[2]});
  };
  const double clean = of(trot().robot, {}), wrong = of(declared, {});
  EXPECT_GT(wrong, 1.5 * clean);
  EXPECT_LT(of(declared, {moved(1.0)}) - clean, nearly_nothing * (wrong - clean));
  EXPECT_GT(of(declared, {moved(-1.0)}) - clean, much * (wrong - clean));
}

/// A ball touches below its centre, wherever the shank points.
TEST(Sensors, AFootThatIsABall) {
  constexpr double radius = 0.03;
  constexpr int foot = 1;
  const Robot& robot = trot().robot;
  const Recording log(trot().samples, Trot::rate);
  const Viewer viewer(robot, ContactTreatment::project, {effect("foot_radius", foot, {radius})});
  int seen = 0;
  for (std::size_t i = 200; i < log.samples().size(); i += 50) {
    if (!log[i].in_contact[foot]) continue;
    const auto motions = reference::link_motions(robot, log[i]);
    const Contact& contact = robot.contacts[foot];
    const Eigen::Vector3d centre =
        motions[static_cast<std::size_t>(contact.link)].pose * contact.frame.translation();
    const Eigen::Vector3d lowest = centre + radius * log.down(i);
    EXPECT_LT(log.down(i).z(), -0.9) << "down is down";
    const View view = viewer.view(log, i);
    Rows rows{view.Y, view.J};
    viewer.transform(view, rows);
    Eigen::Index row = 0;
    for (int c = 0; c < foot; ++c) row += log[i].in_contact[static_cast<std::size_t>(c)] ? 3 : 0;
    const Eigen::MatrixXd wanted =
        reference::point_jacobian(robot, motions, contact.link, lowest).topRows<3>();
    EXPECT_LT((rows.J.middleRows<3>(row) - wanted).norm(), 1e-12 * wanted.norm()) << i;
    ++seen;
  }
  EXPECT_GT(seen, 10);
}

}  // namespace
}  // namespace shapeid::diagnosis

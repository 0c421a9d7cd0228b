// Loads of joints of a robot on feet: what carries the base, and what feet push against each other.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/rich_model.hpp"
#include "shapeid/tests/diagnosis/trot.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::diagnosis {
namespace {

using test::few_hundred_eps;

/// What sums of numbers of this size may be off by.
double rounding_of(double size) {
  return few_hundred_eps * std::numeric_limits<double>::epsilon() * 20 * size;
}

/// A robot that stands with any forces at its feet: `carried` makes them balance its base.
struct Standing {
  Standing() : Standing(*test::robot({5, 10, Root::floating})) {}
  explicit Standing(const Robot& r) : Standing(r, touching(r)) {}
  Standing(const Robot& r, Sample sample)
      : robot(r),
        viewer(robot, ContactTreatment::project, {}),
        model{stacked_parameters(robot), {}} {
    view = viewer.view(std::move(sample), {});
    f = *test::vector(view.J.rows(), 50.0);
    view.carried.head<6>() = (view.Y * model.Phi - view.J.transpose() * f).head<6>();
    size = (view.Y * model.Phi).norm() + (1.0 + view.J.norm()) * (1.0 + f.norm());
    load_with(f);
  }
  /// Contacts whose forces no joint feels have none.
  void without_what_no_joint_feels() { load_with(load().force); }

  [[nodiscard]] PredictedLoad load() const { return predict(viewer, view, model).load; }
  /// What the forces leave of the base's balance.
  [[nodiscard]] double unbalanced(const Eigen::VectorXd& force) const {
    return (view.Y * model.Phi - view.carried - view.J.transpose() * force).head<6>().norm();
  }

  Robot robot;
  Viewer viewer;
  View view;
  RichModel model;
  Eigen::VectorXd f;      ///< at the contacts that touch
  Eigen::VectorXd links;  ///< the joints' torques of rigid links, n
  double size;            ///< of the numbers that differ

 private:
  /// All contacts more often than some: only several push against each other.
  [[nodiscard]] static Sample touching(const Robot& robot) {
    Sample sample = *test::sample(robot);
    if (*rc::gen::inRange(0, 3) > 0) sample.in_contact.assign(robot.contacts.size(), true);
    return sample;
  }
  void load_with(const Eigen::VectorXd& force) {
    links = (view.Y * model.Phi - view.J.transpose() * force).tail(robot.joint_count());
    view.sample.tau = links;
  }
};

/// However contacts push against each other: the torque tells, as far as joints feel it.
RC_GTEST_PROP(PredictedLoad, IsTheTorqueOfLinksThatContactsLoadInAnyWay, ()) {
  Standing standing;
  const double rounding = rounding_of(standing.size / least_lever);
  const PredictedLoad load = standing.load();
  const double felt = standing.view.J.rightCols(standing.robot.joint_count()).norm();
  const double unfelt = least_lever * felt * standing.f.norm();
  RC_CLASSIFY(standing.view.J.rows() > 6, "more forces than the base's balance tells");
  RC_ASSERT((load.joint - standing.links).norm() <= unfelt + rounding);
  RC_ASSERT(standing.unbalanced(load.force) <= rounding);
  standing.without_what_no_joint_feels();
  RC_ASSERT((standing.load().joint - standing.links).norm() <= rounding);
}

/// Two feet that push against each other do so along the line between them.
RC_GTEST_PROP(PredictedLoad, IsKnownOnTwoFeetWhateverTheyPush, ()) {
  const Robot robot = test::quadruped();
  Sample sample = *test::sample(robot);
  sample.in_contact = {true, false, false, true};
  const Standing standing(robot, sample);
  const auto foot = [&](std::size_t c) -> Eigen::Vector3d {
    const Contact& contact = robot.contacts[c];
    return standing.view.motions[static_cast<std::size_t>(contact.link)].pose *
           contact.frame.translation();
  };
  Eigen::VectorXd against(6);
  against.head<3>() = (foot(3) - foot(0)).normalized();
  against.tail<3>() = -against.head<3>();
  const Eigen::MatrixXd JT = standing.view.J.rightCols(robot.joint_count()).transpose();
  RC_PRE((JT * against).norm() > 2.0 * least_lever * JT.norm());
  RC_ASSERT(test::scaled((standing.load().joint - standing.links).norm(),
                         standing.size / least_lever, 20) < few_hundred_eps);
  RC_ASSERT(test::scaled((standing.load().force - standing.f).norm(), standing.size / least_lever,
                         20) < few_hundred_eps);
}

/// In other units of length forces are others, and the torques are the same.
RC_GTEST_PROP(PredictedLoad, DoesNotHangOnTheUnitOfLevers, ()) {
  Standing standing;
  const double unit = *rc::gen::element(1e-3, 0.1, 64.0, 1e3);
  const Eigen::VectorXd torque = *test::vector(standing.robot.dof(), 20.0);
  const Eigen::VectorXd YPhi = standing.view.Y * standing.model.Phi;
  const Eigen::MatrixXd J = standing.view.J;
  const PredictedLoad one = predicted_load(standing.robot, torque, YPhi, J);
  const PredictedLoad other = predicted_load(standing.robot, torque, YPhi, unit * J);
  const double size = standing.size + torque.norm();
  RC_ASSERT((one.joint - other.joint).norm() <= rounding_of(size / least_lever));
}

/// On a fixed base every row tells of the contacts' forces: they are those of least squares.
RC_GTEST_PROP(PredictedLoad, OfAFixedBaseIsByAllItsRows, ()) {
  Standing standing;
  Robot fixed = standing.robot;
  fixed.root = Root::fixed;
  const Eigen::Index n = fixed.joint_count();
  Eigen::MatrixXd J = standing.view.J.rightCols(n);
  if (J.rows() > 0) J.row(0) *= 1e-3;  // also what joints hardly feel
  const Eigen::VectorXd torque = *test::vector(n, 20.0), YPhi = *test::vector(n, 20.0);
  const PredictedLoad load = predicted_load(fixed, torque, YPhi, J);
  const double rounding =
      rounding_of((1.0 + J.norm()) * (torque.norm() + YPhi.norm() + J.norm() * load.force.norm()));
  RC_ASSERT((load.joint - (YPhi - J.transpose() * load.force)).norm() <= rounding);
  // What is left is at right angles to all that contacts can do.
  RC_ASSERT((J * (load.joint - torque)).norm() <= rounding);
}

/// No measured torque is in what the base's balance tells.
RC_GTEST_PROP(PredictedLoad, CarriesTheBaseWhateverTheTorque, ()) {
  Standing standing;
  const PredictedLoad load = standing.load();
  const Eigen::VectorXd more = *test::vector(standing.robot.joint_count(), 20.0);
  standing.view.sample.tau += more;
  const PredictedLoad other = standing.load();
  const double rounding = rounding_of((standing.size + more.norm()) / least_lever);
  RC_ASSERT(standing.unbalanced(other.force) <= rounding);
  const std::vector<bool>& touch = standing.view.sample.in_contact;
  const double difference = (other.joint - load.joint).norm();
  if (std::count(touch.begin(), touch.end(), true) <= 1) RC_ASSERT(difference <= rounding);
  // Least squares go part of the way, never beyond.
  RC_ASSERT(difference <= more.norm() + rounding);
}

/// With what effects ask for in the torque, contacts are known as well as without: friction mu of
/// the load leaves mu times the error that would be left if it were taken for a contact's force.
RC_GTEST_PROP(PredictedLoad, KnowsWhatEffectsAskOfTheTorque, ()) {
  Standing standing(test::quadruped());
  standing.without_what_no_joint_feels();
  const int joint = *rc::gen::inRange(0, standing.robot.joint_count());
  const double mu = *test::real(0.01, 0.3);
  AppliedEffect friction = at_start(*find_effect("load_friction"), joint);
  friction.value[0] = mu;
  const double slip = std::tanh(standing.view.sample.dq[joint] / friction.shape[0]);
  standing.view.sample.tau[joint] += mu * std::abs(standing.links[joint]) * slip;
  const double unaware = (standing.load().joint - standing.links).norm();
  standing.model.effects = {friction};
  const double aware = (standing.load().joint - standing.links).norm();
  RC_ASSERT(aware <= mu * unaware + rounding_of(standing.size / least_lever));
}

/// An effect that acts on the base itself is carried by contacts.
RC_GTEST_PROP(PredictedLoad, HasForcesOnTheBaseInItsBalance, ()) {
  Standing standing(test::quadruped());
  standing.without_what_no_joint_feels();
  AppliedEffect pull = at_start(*find_effect("external_force"), 0);
  pull.value = *test::vector(3, 30.0);
  const Instant instant = instant_of(standing.viewer, standing.view, standing.load());
  const Eigen::VectorXd E = pull.effect->columns(instant, pull.site, pull.shape) * pull.value;
  standing.view.carried.head<6>() += E.head<6>();
  standing.model.effects = {pull};
  const PredictedLoad load = standing.load();
  const double size = standing.size + E.norm();
  RC_ASSERT(test::scaled((load.joint - standing.links).norm(), size, 20) < few_hundred_eps);
}

}  // namespace
}  // namespace shapeid::diagnosis

// Laws of single effects: each column against the effect's equation, evaluated another way.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/tally.hpp"
#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::diagnosis {
namespace {

using test::few_hundred_eps;

/// An instant that owns what it refers to.
struct Scene {
  Scene(Robot r, Sample s) : robot(std::move(r)), sample(std::move(s)) {
    motions = reference::link_motions(robot, sample);
    Y = reference::regressor(robot, sample);
    J = reference::contact_jacobian(robot, sample);
    Phi = stacked_parameters(robot);
    load = predicted_load(robot, reference::applied_force(robot, sample), Y * Phi, J).joint;
    load_rate = load.array().sin();  // any numbers
    surroundings.elapsed = 2.0;
    surroundings.down = -sample.base_specific_force.normalized();
    // Contacts that do not touch have been, or will be, declared so near.
    surroundings.since_touch.resize(std::ssize(sample.in_contact));
    for (std::size_t c = 0; c < sample.in_contact.size(); ++c) {
      surroundings.since_touch[static_cast<Eigen::Index>(c)] = sample.in_contact[c] ? 0.0 : 0.004;
    }
    surroundings.until_touch = 2.5 * surroundings.since_touch;
  }
  [[nodiscard]] Instant instant() const {
    return {robot, sample, motions, load, load_rate, surroundings};
  }
  [[nodiscard]] Eigen::MatrixXd columns(const Effect& e, int site) const {
    Eigen::VectorXd shape(static_cast<Eigen::Index>(e.shape.size()));
    for (std::size_t i = 0; i < e.shape.size(); ++i) {
      shape[static_cast<Eigen::Index>(i)] = e.shape[i].start;
    }
    return e.columns(instant(), site, shape);
  }

  Robot robot;
  Sample sample;
  std::vector<reference::LinkMotion> motions;
  Eigen::MatrixXd Y, J;
  Eigen::VectorXd Phi, load, load_rate;
  Surroundings surroundings;
};

Scene any_scene(Root root) {
  const Robot robot = *test::robot({2, 8, root});
  return {robot, *test::sample(robot)};
}

Scene any_scene() { return any_scene(*rc::gen::element(Root::fixed, Root::floating)); }

bool has_site(const Effect& e, const Robot& robot, int site) {
  return site < site_count(robot, e.site) && (e.applies == nullptr || e.applies(robot, site));
}

RC_GTEST_PROP(Effects, ColumnsHaveTheirSizeAndAreFinite, ()) {
  const Scene scene = any_scene();
  for (const Effect& e : all_effects()) {
    if (e.columns == nullptr) continue;
    for (int site = 0; site < site_count(scene.robot, e.site); ++site) {
      if (!has_site(e, scene.robot, site)) continue;
      const Eigen::MatrixXd columns = scene.columns(e, site);
      RC_ASSERT(columns.rows() == scene.robot.dof());
      RC_ASSERT(columns.cols() == static_cast<Eigen::Index>(e.parameters.size()));
      RC_ASSERT(columns.allFinite());
    }
  }
}

/// What a joint's own effect asks of its joint, from the equation in the catalogue.
double joint_equation(const std::string& id, const Scene& s, int j, int parameter) {
  const double q = s.sample.q[j], dq = s.sample.dq[j], ddq = s.sample.ddq[j];
  const double width = 0.05;
  if (id == "viscous_friction") return dq;
  if (id == "coulomb_friction") return 1.0 - 2.0 / (std::exp(2.0 * dq / width) + 1.0);
  if (id == "stribeck_friction") {
    return std::exp(-25.0 * dq * dq) * (1.0 - 2.0 / (std::exp(100.0 * dq) + 1.0));
  }
  if (id == "load_friction") {
    return std::abs(s.load[j]) * (1.0 - 2.0 / (std::exp(2.0 * dq / width) + 1.0));
  }
  if (id == "torque_lag") return -s.load_rate[j];
  if (id == "torque_offset") return 1.0;
  if (id == "rotor_inertia") return ddq;
  if (id == "joint_spring") return parameter == 0 ? q : 1.0;
  if (id == "cogging") return parameter == 0 ? std::cos(12.0 * q) : std::sin(12.0 * q);
  RC_FAIL(id + " has no equation in this test");
}

RC_GTEST_PROP(Effects, JointEffectsActOnTheirJointAloneAsTheirEquationSays, ()) {
  const Scene scene = any_scene();
  for (const Effect& e : all_effects()) {
    if (e.site != SiteKind::joint || e.columns == nullptr || e.id == "rotor_reaction") continue;
    const int j = *rc::gen::inRange(0, scene.robot.joint_count());
    const Eigen::MatrixXd columns = scene.columns(e, j);
    for (Eigen::Index p = 0; p < columns.cols(); ++p) {
      Eigen::VectorXd wanted = Eigen::VectorXd::Zero(scene.robot.dof());
      wanted[scene.robot.base_dof() + j] = joint_equation(e.id, scene, j, static_cast<int>(p));
      const double size = 1.0 + wanted.norm();
      RC_ASSERT(test::scaled((columns.col(p) - wanted).norm(), size, 10) < few_hundred_eps);
    }
  }
}

/// Adding a load to a link's inertia asks for what the payload's columns say.
RC_GTEST_PROP(Effects, PayloadIsABodyAddedToTheLink, ()) {
  const Scene scene = any_scene();
  const Effect& e = *find_effect("payload");
  const int link = *rc::gen::inRange(1, scene.robot.link_count());
  const InertialParameters load = *test::body();
  Eigen::VectorXd Phi = Eigen::VectorXd::Zero(scene.Phi.size());
  Phi.segment<10>(Eigen::Index{10} * link) = load.values;
  const Eigen::VectorXd wanted = scene.Y * Phi;
  const Eigen::VectorXd got = scene.columns(e, link) * load.values;
  RC_ASSERT(test::scaled_difference(got, wanted, 10) < few_hundred_eps);
  const Effect& later = *find_effect("payload_from");
  RC_ASSERT(later.columns(scene.instant(), link, Eigen::VectorXd::Constant(1, 1.9)) ==
            scene.columns(e, link));
  RC_ASSERT(later.columns(scene.instant(), link, Eigen::VectorXd::Constant(1, 2.1)).isZero(0.0));
}

/// Virtual power: a force on a point does what the same force does along the point's path, found by
/// moving every joint a little.
RC_GTEST_PROP(Effects, ForcesDoTheWorkThatTheirPointsMove, ()) {
  const Scene scene = any_scene(Root::fixed);
  const int link = *rc::gen::inRange(1, scene.robot.link_count());
  const Eigen::MatrixXd columns = scene.columns(*find_effect("external_force"), link);
  constexpr double h = 1e-6;  // the error is h^2 times a third derivative of order one
  for (int j = 0; j < scene.robot.joint_count(); ++j) {
    const auto place = [&](double step) -> Eigen::Vector3d {
      Sample moved = scene.sample;
      moved.q[j] += step;
      return reference::link_motions(scene.robot, moved)[static_cast<std::size_t>(link)]
          .pose.translation();
    };
    const Eigen::Vector3d slope = (place(h) - place(-h)) / (2.0 * h);
    constexpr double rounding = 1e-8;  // eps / h, and lengths of a few metres
    RC_ASSERT((columns.row(j).transpose() + slope).norm() < rounding);
  }
}

/// Power of drag on a fixed base is c |v|^2.
RC_GTEST_PROP(Effects, DragTakesPowerFromTheLink, ()) {
  const Scene scene = any_scene(Root::fixed);
  const int link = *rc::gen::inRange(1, scene.robot.link_count());
  const double power = scene.columns(*find_effect("drag"), link).col(0).dot(scene.sample.dq);
  const double wanted = scene.motions[static_cast<std::size_t>(link)].velocity.squaredNorm();
  RC_ASSERT(test::scaled(std::abs(power - wanted), wanted + 1e-3, 10) < few_hundred_eps);
}

/// The robot with contact `c` touching and no other, and the Jacobian of its point.
Eigen::MatrixXd rows_of_point(const Scene& scene, int c) {
  Sample alone = scene.sample;
  alone.in_contact.assign(alone.in_contact.size(), false);
  alone.in_contact[static_cast<std::size_t>(c)] = true;
  return reference::contact_jacobian(scene.robot, alone).topRows<3>();
}

/// A contact that is declared otherwise than it is: its force, where the flag is wrong alone.
RC_GTEST_PROP(Effects, ForcesAtContactsAreTheirJacobian, ()) {
  const Scene scene = any_scene();
  for (int c = 0; c < std::ssize(scene.robot.contacts); ++c) {
    const bool touches = scene.sample.in_contact[static_cast<std::size_t>(c)];
    const Eigen::MatrixXd force = -rows_of_point(scene, c).transpose();
    for (const bool declared : {true, false}) {
      const Effect& e = *find_effect(declared ? "contact_absent" : "contact_undeclared");
      if (!has_site(e, scene.robot, c)) continue;
      const Eigen::MatrixXd got = scene.columns(e, c);
      if (touches == declared) {
        RC_ASSERT(test::scaled_difference(got, force, 10) < few_hundred_eps);
      } else {
        RC_ASSERT(got.isZero(0.0));
      }
    }
  }
}

/// On a floating base a force is felt by the base itself: as it is, and by its moment about the
/// base's origin.
RC_GTEST_PROP(Effects, ForcesReachTheBaseWithTheirMoments, ()) {
  const Scene scene = any_scene(Root::floating);
  const int link = *rc::gen::inRange(0, scene.robot.link_count());
  const Eigen::MatrixXd columns = scene.columns(*find_effect("external_force"), link);
  const Eigen::Vector3d p = scene.motions[static_cast<std::size_t>(link)].pose.translation();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d force = Eigen::Vector3d::Unit(k);
    RC_ASSERT((columns.col(k).head<3>() + force).norm() < few_hundred_eps);
    const Eigen::Vector3d moment = columns.col(k).segment<3>(3) + p.cross(force);
    RC_ASSERT(test::scaled(moment.norm(), 1.0 + p.norm(), 10) < few_hundred_eps);
  }
}

/// With one foot on the ground the base moves as that foot stands still, and drag takes c |v|^2 of
/// what all joints and the base's motion give. Without a foot nobody knows how fast the base is.
RC_GTEST_PROP(Effects, DragOfAFloatingRobotGoesByItsStandingFoot, ()) {
  Scene scene = any_scene(Root::floating);
  const int contacts = static_cast<int>(std::ssize(scene.robot.contacts));
  const Effect& drag = *find_effect("drag");
  const int link = *rc::gen::inRange(0, scene.robot.link_count());
  scene.sample.in_contact.assign(scene.robot.contacts.size(), false);
  RC_ASSERT(scene.columns(drag, link).isZero(0.0));
  if (contacts == 0) return;
  const int foot = *rc::gen::inRange(0, contacts);
  scene.sample.in_contact[static_cast<std::size_t>(foot)] = true;
  Eigen::VectorXd velocity(scene.robot.dof());
  velocity << Eigen::Vector3d::Zero(), scene.sample.base_angular_velocity, scene.sample.dq;
  const Eigen::Vector3d relative = rows_of_point(scene, foot) * velocity;
  velocity.head<3>() = -relative;
  const Eigen::Vector3d v =
      scene.motions[static_cast<std::size_t>(link)].velocity + velocity.head<3>();
  const double power = scene.columns(drag, link).col(0).dot(velocity);
  const double size = velocity.squaredNorm() * (1.0 + scene.columns(drag, link).norm());
  RC_ASSERT(test::scaled(std::abs(power - v.squaredNorm()), size + 1e-3, 10) < few_hundred_eps);
}

/// Two parallel joints: the textbook's extra terms of a rotor in the second joint's motor,
/// k (0 1; 1 0) times (ddq1, ddq2) (double pendulum with motors, gear times rotor inertia k).
TEST(RotorReaction, IsTheTextbooksForTwoParallelJoints) {
  Robot robot;
  robot.root = Root::fixed;
  robot.links.resize(3);
  for (int i = 1; i < 3; ++i) {
    Link& link = robot.links[static_cast<std::size_t>(i)];
    link.parent = i - 1;
    link.joint.axis = Eigen::Vector3d::UnitY();
    link.joint.placement.translation() = Eigen::Vector3d(0.1, 0.0, -0.3);
  }
  Sample sample;
  sample.q = Eigen::Vector2d(0.3, -0.8);
  sample.dq = Eigen::Vector2d(1.5, -0.7);
  sample.ddq = Eigen::Vector2d(2.0, 3.0);
  sample.tau = Eigen::Vector2d::Zero();
  const Scene scene(robot, sample);
  const Eigen::VectorXd column = scene.columns(*find_effect("rotor_reaction"), 1);
  EXPECT_LT(test::scaled_difference(column, Eigen::Vector2d(3.0, 2.0), 10), few_hundred_eps);
}

/// A rotor of spin k dq z on a turning carrier: its power is the change of k (dq z . omega), the
/// mixed term of the kinetic energy.
RC_GTEST_PROP(RotorReaction, PowerIsTheChangeOfItsKineticEnergy, ()) {
  const Scene scene = any_scene(Root::fixed);
  const Effect& e = *find_effect("rotor_reaction");
  const int j = *rc::gen::inRange(0, scene.robot.joint_count());
  RC_PRE(has_site(e, scene.robot, j));
  const auto energy = [&](double t) {
    Sample moved = scene.sample;
    moved.q += t * moved.dq + 0.5 * t * t * moved.ddq;
    moved.dq += t * moved.ddq;
    const auto motions = reference::link_motions(scene.robot, moved);
    const Link& link = scene.robot.links[static_cast<std::size_t>(j) + 1];
    const Eigen::Vector3d z =
        motions[static_cast<std::size_t>(j) + 1].pose.linear() * link.joint.axis;
    return moved.dq[j] * z.dot(motions[static_cast<std::size_t>(link.parent)].angular_velocity);
  };
  constexpr double h = 1e-5;
  const double wanted = (energy(h) - energy(-h)) / (2.0 * h);
  const double power = scene.columns(e, j).col(0).dot(scene.sample.dq);
  // Rounding of the difference, and h^2 times third derivatives: speeds up to ten, to the fourth.
  const double size = 1.0 + scene.sample.dq.squaredNorm() + scene.sample.ddq.squaredNorm();
  constexpr double tolerance = 1e-7;
  RC_ASSERT(std::abs(power - wanted) < tolerance * size * size);
}

RC_GTEST_PROP(Transformations, ZeroChangesNothing, ()) {
  const Scene scene = any_scene();
  const Moment moment{scene.sample, [&](double) { return scene.sample; }};
  for (const Effect& e : all_effects()) {
    if (!e.transform.any()) continue;
    const Eigen::VectorXd zero =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(e.parameters.size()));
    for (int site = 0; site < site_count(scene.robot, e.site); ++site) {
      if (!has_site(e, scene.robot, site)) continue;
      Robot robot = scene.robot;
      if (e.transform.robot != nullptr) e.transform.robot(robot, site, zero);
      const Sample sample =
          e.transform.sample != nullptr ? e.transform.sample(moment, site, zero) : scene.sample;
      Rows rows{reference::regressor(robot, sample), reference::contact_jacobian(robot, sample)};
      const Eigen::Vector3d down = -sample.base_specific_force.normalized();
      if (e.transform.rows != nullptr) e.transform.rows(robot, sample, down, site, zero, rows);
      RC_ASSERT(rows.E == scene.Y);
      RC_ASSERT((rows.J - scene.J).norm() <= 1e-14 * (1.0 + scene.J.norm()));
      RC_ASSERT(sample.tau == scene.sample.tau);
    }
  }
}

/// Forty samples like this one.
Recording held(const Sample& sample) {
  constexpr double rate = 100.0;
  std::vector<Sample> samples(40, sample);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].time = static_cast<double>(i) / rate;
  }
  return {std::move(samples), rate};
}

constexpr std::size_t middle_of_held = 20;

/// The flags may say that feet touch: without projection there is nothing to move.
RC_GTEST_PROP(Transformations, OfContactsChangeNothingWhereNoneIsProjected, ()) {
  const Scene scene = any_scene();
  RichModel model{scene.Phi, {}};
  for (int c = 0; c < std::ssize(scene.robot.contacts); ++c) {
    for (const char* id : {"contact_point", "foot_radius"}) {
      const Effect& e = *find_effect(id);
      if (!has_site(e, scene.robot, c)) continue;
      model.effects.push_back(at_start(e, c));
      model.effects.back().value.setConstant(0.02);
    }
  }
  const Recording recording = held(scene.sample);
  const HypothesisColumns columns(scene.robot, ContactTreatment::ignore, model, model.effects);
  const View view = columns.viewer().view(recording, middle_of_held);
  const Prediction predicted = predict(columns.viewer(), view, model);
  RC_ASSERT(predicted.J.rows() == 0);
  RC_ASSERT(predicted.force == Eigen::VectorXd(view.Y * scene.Phi));
  RC_ASSERT(columns.at(recording, middle_of_held, view, predicted).isZero(0.0));
}

/// A gain scales where the foot is found to be as well, wherever both stand in a list.
RC_GTEST_PROP(Transformations, ThatScaleComeLast, ()) {
  const Scene scene = any_scene(Root::floating);
  RC_PRE(scene.robot.contacts.size() > 0 && scene.robot.joint_count() > 0);
  AppliedEffect gain = at_start(*find_effect("torque_gain"), 0);
  AppliedEffect point = at_start(*find_effect("contact_point"), 0);
  gain.value[0] = 0.2;
  point.value = *test::vector3(0.1);
  const Recording recording = held(scene.sample);
  const auto said = [&](const std::vector<AppliedEffect>& effects) {
    const Viewer viewer(scene.robot, ContactTreatment::project, effects);
    return predict(viewer, viewer.view(recording, middle_of_held), {scene.Phi, effects});
  };
  const Prediction one = said({gain, point}), other = said({point, gain});
  RC_ASSERT(one.J == other.J);
  RC_ASSERT(one.force == other.force);
}

/// What measured forces carry the joints need not provide: a gain scales what is left, in
/// predictions and in the sums that are fitted.
RC_GTEST_PROP(MeasuredForces, AreScaledWithTheTorqueThatTheySpare, ()) {
  Scene scene = any_scene(Root::floating);
  RC_PRE(scene.robot.contacts.size() > 0 && scene.robot.joint_count() > 0);
  scene.sample.contact_force.clear();
  for (std::size_t c = 0; c < scene.robot.contacts.size(); ++c) {
    scene.sample.contact_force.push_back(*test::vector3(50.0));
  }
  const auto measured = ContactTreatment::measured;
  AppliedEffect gain = at_start(*find_effect("torque_gain"), 0);
  gain.value[0] = 0.2;
  const RichModel model{scene.Phi, {gain}};
  const Recording recording = held(scene.sample);
  const Viewer viewer(scene.robot, measured, model.effects);
  const View view = viewer.view(recording, middle_of_held);
  const Eigen::VectorXd carried = reference::measured_contact_force(scene.robot, scene.sample);
  Eigen::VectorXd wanted = scene.Y * scene.Phi - carried;
  wanted[scene.robot.base_dof()] *= 1.2;
  const Prediction predicted = predict(viewer, view, model);
  const double terms = (scene.Y.cwiseAbs() * scene.Phi.cwiseAbs()).norm() + carried.norm();
  RC_ASSERT(test::scaled((predicted.force - wanted).norm(), terms, 10) < few_hundred_eps);
  RC_ASSERT(test::scaled((predicted.load.joint -
                          (scene.Y * scene.Phi - carried).tail(scene.robot.joint_count()))
                             .norm(),
                         terms, 10) < few_hundred_eps);

  Tally tally = empty_tally(scene.robot, {});
  TallyOptions options;
  options.stride = 1;
  options.weight = Eigen::VectorXd::Ones(scene.robot.dof());
  options.block_seconds = 10.0;
  add_to_tally(tally, scene.robot, measured, model, recording, options, false);
  Eigen::VectorXd x(tally.columns() + 1);
  x << scene.Phi, -1.0;
  const auto samples = static_cast<double>(recording.usable(1).size());
  const double squares = samples * (wanted - logged_force(viewer, view)).squaredNorm();
  const double all = samples * std::pow(terms + scene.sample.tau.norm(), 2);
  RC_ASSERT(test::scaled(x.dot(tally.blocks.at(0).sums * x) - squares, all, 100) < few_hundred_eps);
}

/// A robot that stays as it is while its contact flags flip: looking a little earlier or later
/// changes nothing, though other feet are in contact there.
RC_GTEST_PROP(Transformations, ContactsAreHeldWhereADelayLooksAcrossATouchdown, ()) {
  const Scene scene = any_scene(Root::floating);
  RC_PRE(scene.sample.in_contact.size() > 0);
  constexpr double rate = 100.0;
  constexpr std::size_t count = 40, middle = count / 2;
  std::vector<Sample> samples(count, scene.sample);
  for (std::size_t i = 0; i < count; ++i) {
    samples[i].time = static_cast<double>(i) / rate;
    if (i % 2 == 1) samples[i].in_contact.flip();
  }
  const Recording recording(std::move(samples), rate);
  AppliedEffect delay = at_start(*find_effect("torque_delay"), 0);
  delay.value[0] = 0.5 / rate;  // where the nearest sample changes
  const RichModel model{scene.Phi, {delay}};
  const HypothesisColumns columns(scene.robot, ContactTreatment::project, model, {delay});
  const View view = columns.viewer().view(recording, middle);
  const Prediction predicted = predict(columns.viewer(), view, model);
  const Eigen::MatrixXd change = columns.at(recording, middle, view, predicted);
  // A difference of equal forces, over its step of two hundredths of a usual size.
  const double step = 0.02 * delay.effect->parameters[0].size;
  const double terms = (view.Y.cwiseAbs() * scene.Phi.cwiseAbs()).norm() +
                       view.J.norm() * predicted.load.force.norm();
  RC_ASSERT(test::scaled(change.norm(), terms / step, scene.robot.dof()) < few_hundred_eps);
}

/// Where a delay looks across a touchdown, either way, the contact counts as touching.
TEST(Transformations, ADelayKeepsContactsOfNowAndOfThen) {
  constexpr double rate = 100.0;
  constexpr std::size_t count = 40, middle = count / 2;
  std::vector<Sample> samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    samples[i].time = static_cast<double>(i) / rate;
    samples[i].q = samples[i].dq = samples[i].ddq = samples[i].tau = Eigen::VectorXd::Zero(1);
    // One lifts between the sample and the one before, one touches, and two stay as they are.
    samples[i].in_contact = {i < middle, i >= middle, true, false};
  }
  const Recording recording(samples, rate);
  const Effect& delay = *find_effect("torque_delay");
  for (const double d : {0.004, 0.006, 0.014}) {
    const Moment moment{recording[middle],
                        [&](double dt) { return recording.shifted(middle, dt); }};
    const Sample then = delay.transform.sample(moment, 0, Eigen::VectorXd::Constant(1, d));
    const bool other = d > 0.5 / rate;  // the nearest sample is the one before
    EXPECT_EQ(then.in_contact, (std::vector<bool>{other, true, true, false})) << d;
  }
}

}  // namespace
}  // namespace shapeid::diagnosis

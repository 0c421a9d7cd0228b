// Equations (4)-(5): a window's problem against the sum of squares that it stands for, computed
// from all links' parameters, sample by sample and with no reduction.
#include "shapeid/reference/window.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/shape.hpp"
#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/projection.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/physics/touching.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using reference::Window;
using test::few_hundred_eps;
using test::scaled;

/// Some links free, each with two cuboids; the last link carries unknown shapes on top of its given
/// inertia, the other free links are sought whole.
BodyModel arbitrary_model(const Robot& robot) {
  BodyModel model;
  model.known = stacked_parameters(robot);
  const int last = robot.link_count() - 1;
  for (int link = 0; link <= last; ++link) {
    if (link != last && !*rc::gen::arbitrary<bool>()) continue;
    model.free_links.push_back(link);
    if (link != last) model.known.segment<10>(Eigen::Index{10} * link).setZero();
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector3d sides(0.1, 0.2, 0.3 + 0.1 * k);
      model.shapes.push_back({link, make_cuboid(sides, *test::pose(0.4)), std::to_string(k)});
    }
  }
  return model;
}

struct Drawn {
  Robot robot;
  BodyModel model;
  std::vector<Sample> samples;
  VectorXd weight;
};

/// Enough samples that a window with few free links must reduce its rows several times.
Drawn drawn_log() {
  Drawn d;
  d.robot = *rc::gen::suchThat(test::robot({2, 5, Root::floating}),
                               [](const Robot& r) { return !r.contacts.empty(); });
  d.model = arbitrary_model(d.robot);
  for (int k = 0; k < 60; ++k) {
    d.samples.push_back(*test::sample(d.robot));
    for (std::size_t c = 0; c < d.robot.contacts.size(); ++c) {
      d.samples.back().contact_force.push_back(*test::vector3(100.0));
    }
  }
  d.weight = *test::weights(d.robot.dof());
  return d;
}

/// || W^(1/2) (Y Phi - S^T tau - J^T f) ||^2 over all samples, f as the treatment has it, and the
/// same sum for the terms apart.
struct SumOfSquares {
  double value = 0.0;
  double terms = 0.0;
};

SumOfSquares sum_of_squares(const Drawn& d, ContactTreatment contacts, const VectorXd& m) {
  const VectorXd Phi = all_parameters(d.model, shape_columns(d.model) * m);
  SumOfSquares sum;
  for (const Sample& s : d.samples) {
    const MatrixXd Y = reference::regressor(d.robot, s);
    VectorXd F = reference::applied_force(d.robot, s);
    if (contacts == ContactTreatment::measured) {
      F += reference::measured_contact_force(d.robot, s);
    }
    const MatrixXd J = contacts == ContactTreatment::project
                           ? reference::contact_jacobian(d.robot, s)
                           : MatrixXd(0, d.robot.dof());
    const auto left =
        reference::eliminate_contacts(Y * Phi - F, VectorXd::Zero(F.size()), J, d.weight);
    sum.value += left.Y.squaredNorm();
    const VectorXd terms = Y.cwiseAbs() * Phi.cwiseAbs() + F.cwiseAbs();
    sum.terms += terms.dot(d.weight.cwiseProduct(terms));
  }
  return sum;
}

Window filled(const Drawn& d, ContactTreatment contacts) {
  Window window(d.robot, d.model, contacts, d.weight);
  for (const Sample& s : d.samples) window.add(s);
  return window;
}

/// [Y F]^T [Y F]: the normal equations and the constant of the objective.
MatrixXd normal_matrix(const Window& window) {
  const MatrixXd Y = window.Y();
  MatrixXd rows(Y.rows(), Y.cols() + 1);
  rows << Y, window.F();
  return rows.transpose() * rows;
}

// Reduction, moving known links over and the treatments of contact, all at once: whatever the
// masses are, the problem's data term is the sum of squares over all links and samples.
RC_GTEST_PROP(Window, ProblemIsTheSumOfSquares, ()) {
  const Drawn d = drawn_log();
  const VectorXd m =
      (*test::vector(static_cast<Eigen::Index>(d.model.shapes.size()), 5.0)).cwiseAbs();
  for (const auto contacts :
       {ContactTreatment::project, ContactTreatment::measured, ContactTreatment::ignore}) {
    const Window window = filled(d, contacts);
    const MassProblem problem = window.problem(d.model);
    const SumOfSquares expected = sum_of_squares(d, contacts, m);
    RC_ASSERT(window.samples() == d.samples.size());
    RC_ASSERT(problem.lambda == 0.0 && problem.mass_bound == 0.0);
    RC_ASSERT(scaled(std::abs(objective(problem, m).data - expected.value), expected.terms,
                     problem.Y.cols()) < few_hundred_eps);
  }
}

RC_GTEST_PROP(Window, MemoryDoesNotGrowWithTheLog, ()) {
  const Drawn d = drawn_log();
  const Window window = filled(d, ContactTreatment::ignore);
  const Eigen::Index columns = 10 * static_cast<Eigen::Index>(d.model.free_links.size()) + 1;
  RC_ASSERT(window.Y().rows() == window.F().size());
  RC_ASSERT(window.Y().rows() <= 4 * columns + d.robot.dof());
}

RC_GTEST_PROP(Window, OrderOfSamplesDoesNotMatter, ()) {
  Drawn d = drawn_log();
  const MatrixXd forth = normal_matrix(filled(d, ContactTreatment::project));
  std::reverse(d.samples.begin(), d.samples.end());
  const MatrixXd back = normal_matrix(filled(d, ContactTreatment::project));
  RC_ASSERT(test::scaled_difference(forth, back, forth.cols()) < few_hundred_eps);
}

RC_GTEST_PROP(Window, ClearedIsNew, ()) {
  const Drawn d = drawn_log();
  Window window = filled(d, ContactTreatment::project);
  window.clear();
  RC_ASSERT(window.samples() == 0U);
  RC_ASSERT(window.Y().rows() == 0);
  for (const Sample& s : d.samples) window.add(s);
  RC_ASSERT(window.Y() == filled(d, ContactTreatment::project).Y());
  RC_ASSERT(window.F() == filled(d, ContactTreatment::project).F());
}

/// A sample that obeys equation (1) for the parameters Phi with point forces at every contact: the
/// forces are drawn, the base's acceleration follows from its rows, the torques from theirs.
Sample consistent(const Robot& robot, const VectorXd& Phi) {
  Sample s = *test::sample(robot);
  s.in_contact.assign(robot.contacts.size(), true);
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    s.contact_force.push_back(*test::vector3(100.0));
  }
  const VectorXd JTf = reference::measured_contact_force(robot, s);
  const auto force_with = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& alpha) -> VectorXd {
    s.base_specific_force = a;
    s.base_angular_acceleration = alpha;
    return reference::regressor(robot, s) * Phi;
  };
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const VectorXd without = force_with(zero, zero);
  Eigen::Matrix<double, 6, 6> H;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
    H.col(i) = (force_with(unit, zero) - without).head<6>();
    H.col(i + 3) = (force_with(zero, unit) - without).head<6>();
  }
  const Eigen::Matrix<double, 6, 1> a = H.partialPivLu().solve((JTf - without).head<6>());
  s.tau = (force_with(a.head<3>(), a.tail<3>()) - JTf).tail(robot.joint_count());
  return s;
}

// Where the data are consistent it does not matter whether forces are measured or unknown: both
// windows are satisfied by the true masses, and by them alone as far as they determine any.
RC_GTEST_PROP(Window, MeasuredAndProjectedForcesAgreeOnConsistentData, ()) {
  Drawn d = drawn_log();
  for (Contact& contact : d.robot.contacts) contact.kind = ContactKind::point;
  const auto shapes = static_cast<Eigen::Index>(d.model.shapes.size());
  const VectorXd m = (*test::vector(shapes, 5.0)).cwiseAbs() + VectorXd::Constant(shapes, 0.1);
  const VectorXd Phi = all_parameters(d.model, shape_columns(d.model) * m);
  for (Sample& s : d.samples) s = consistent(d.robot, Phi);

  for (const auto contacts : {ContactTreatment::measured, ContactTreatment::project}) {
    const MassProblem p = filled(d, contacts).problem(d.model);
    // A row of zeros says nothing, and Eigen's SVD wants a row even where forces reach all of ours.
    MatrixXd A = MatrixXd::Zero(p.Y.rows() + 1, shapes);
    A.topRows(p.Y.rows()) = p.Y * p.U;
    VectorXd b = VectorXd::Zero(A.rows());
    b.head(p.F.size()) = p.F;
    const test::ThinSvd svd(A);
    const VectorXd& sigma = svd.sigma;
    const double size = std::sqrt(sum_of_squares(d, contacts, m).terms);
    RC_ASSERT(scaled(std::sqrt(objective(p, m).data), size, p.Y.cols()) < few_hundred_eps);

    const double smallest = sigma[sigma.size() - 1];
    const bool determined = sigma.size() == shapes && smallest > 1e-6 * sigma[0];
    RC_TAG(determined ? "determined" : "undetermined");
    if (determined) {
      RC_ASSERT(scaled((svd.solve(b) - m).norm(), size / smallest, p.Y.cols()) < few_hundred_eps);
    }
  }
}

TEST(Window, MeasuredForcesThatAreNotThereAreRefused) {
  const Robot robot = test::leg(Root::floating);
  BodyModel model;
  model.known = stacked_parameters(robot);
  Window window(robot, model, ContactTreatment::measured, VectorXd::Ones(robot.dof()));
  EXPECT_THROW(window.add(test::posture(0.1, 0.2)), Refusal);
}

}  // namespace
}  // namespace shapeid

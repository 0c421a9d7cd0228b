// fast::SampleRows, by either path, against reference::sample_rows and eliminate_contacts.
#include "shapeid/fast/sample_rows.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/projection.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/fast/expected_rows.hpp"
#include "shapeid/tests/fast/first_difference.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using fast::SampleRows;
using fast::Verdict;
using test::expected_rows;

using test::no_difference;

constexpr ContactTreatment project = ContactTreatment::project;
const std::vector<ContactTreatment> treatments = {project, ContactTreatment::measured,
                                                  ContactTreatment::ignore};

static_assert(noexcept(std::declval<SampleRows&>().update(std::declval<const Sample&>())));

MatrixXd gram(const SampleRows& made) {
  MatrixXd product = made.rows().transpose() * made.rows();
  product(product.rows() - 1, product.cols() - 1) += made.constant();
  return product;
}

/// Weights over four orders of magnitude.
VectorXd any_weight(const Robot& robot) {
  VectorXd weight(robot.dof());
  for (double& w : weight) w = *test::magnitude(1e-2, 1e2);
  return weight;
}

RC_GTEST_PROP(FastSampleRows, AsTheReference, ()) {
  const Robot robot = test::any_robot(1, 12);
  const BodyModel model = test::any_model(robot);
  const VectorXd weight = any_weight(robot);
  for (const ContactTreatment contacts : treatments) {
    SampleRows made(robot, model, contacts, weight);
    for (int k = 0; k < 3; ++k) {  // nothing of an earlier sample stays
      const Sample s = test::any_sample(robot);
      RC_ASSERT(made.update(s) == Verdict::taken);
      RC_ASSERT(test::first_difference(gram(made), expected_rows(robot, model, contacts, weight, s),
                                       robot, s) == no_difference);
    }
  }
}

// The rank rule as well, seen in the number of rows that are left.
RC_GTEST_PROP(FastSampleRows, LeavesAsManyRowsAsTheReference, ()) {
  const Robot robot = test::any_robot(1, 12);
  BodyModel model = test::any_model(robot);
  RC_PRE(model.free_links != std::vector<int>{0});
  const VectorXd weight = any_weight(robot);
  const Sample s = test::any_sample(robot);
  SampleRows made(robot, model, project, weight);
  RC_ASSERT(made.update(s) == Verdict::taken);
  const int rank =
      reference::contact_free_basis(reference::contact_jacobian(robot, s), weight).rank;
  RC_ASSERT(made.rows().rows() == robot.dof() - rank);
}

RC_GTEST_PROP(FastSampleRows, QuadrupedsByEitherPathAsTheReference, ()) {
  const Robot robot = test::any_quadruped();
  const BodyModel model = test::base_model(robot);
  const VectorXd weight = any_weight(robot);
  for (const ContactTreatment contacts : treatments) {
    SampleRows made(robot, model, contacts, weight);
    const Sample s = test::any_sample(robot);
    RC_ASSERT(made.update(s) == Verdict::taken);
    if (contacts == project) RC_TAG(made.by_six_rows() ? "six rows" : "general path");
    RC_ASSERT(test::first_difference(gram(made), expected_rows(robot, model, contacts, weight, s),
                                     robot, s) == no_difference);
  }
}

TEST(FastSampleRows, CornerCasesAsTheReference) {
  for (const auto& [name, robot] : test::corner_robots()) {
    SCOPED_TRACE(name);
    const BodyModel model = test::base_model(robot);
    const VectorXd weight = VectorXd::LinSpaced(robot.dof(), 0.5, 2.0);
    for (const ContactTreatment contacts : treatments) {
      SampleRows made(robot, model, contacts, weight);
      for (const Sample& s : test::corner_samples(robot)) {
        ASSERT_EQ(made.update(s), Verdict::taken);
        EXPECT_EQ(test::first_difference(
                      gram(made), expected_rows(robot, model, contacts, weight, s), robot, s),
                  no_difference);
      }
    }
  }
}

/// Whether six rows were enough for a robot that stands with these joints on all contacts.
bool by_six_rows(const Robot& robot, const VectorXd& q, const BodyModel& model,
                 const VectorXd& weight) {
  Sample s = test::nothing_moves(robot);
  s.in_contact.assign(robot.contacts.size(), true);
  s.q = q;
  SampleRows made(robot, model, project, weight);
  EXPECT_EQ(made.update(s), Verdict::taken);
  return made.by_six_rows();
}

bool by_six_rows(const Robot& robot, const VectorXd& q) {
  return by_six_rows(robot, q, test::base_model(robot), VectorXd::Ones(robot.dof()));
}

TEST(SixRows, ServeRegularLegsAlone) {
  const VectorXd bent = Eigen::Vector3d(0.1, 0.8, -1.5), straight = Eigen::Vector3d(0.1, 0.8, 0.0);
  const Robot leg = test::corner_robot("one leg");
  EXPECT_TRUE(by_six_rows(leg, bent));
  EXPECT_TRUE(by_six_rows(test::corner_robot("no contact"), straight));
  EXPECT_TRUE(by_six_rows(test::corner_robot("bundled quadruped"), bent.replicate<4, 1>()));

  EXPECT_FALSE(by_six_rows(leg, straight));
  EXPECT_FALSE(by_six_rows(leg, Eigen::Vector3d(0.1, 0.8, std::numbers::pi)));
  EXPECT_FALSE(by_six_rows(leg, Eigen::Vector3d(0.1, 0.8, 1e-4)));
  EXPECT_FALSE(by_six_rows(test::corner_robot("a foot on the base"), bent));
  EXPECT_FALSE(by_six_rows(test::corner_robot("a contact named twice"), bent));
  EXPECT_FALSE(by_six_rows(test::corner_robot("a flat foot"), bent));
  EXPECT_FALSE(by_six_rows(test::corner_robot("a foot alone"), VectorXd()));
}

TEST(SixRows, DeclineWhereTheCovarianceIsNearSingular) {
  const Robot leg = test::corner_robot("one leg");
  const VectorXd bent = Eigen::Vector3d(0.1, 0.8, -1.5);
  VectorXd weight = VectorXd::Ones(9);
  weight.head<6>().setConstant(1e3);  // base rows known much better than torques
  EXPECT_FALSE(by_six_rows(leg, bent, test::base_model(leg), weight));
}

// With base rows that hardly count the covariance is well conditioned; the leg is not.
TEST(SixRows, DeclineNearSingularLegsWhateverTheWeights) {
  const Robot leg = test::corner_robot("one leg");
  VectorXd weight = VectorXd::Ones(9);
  weight.head<6>().setConstant(1e-12);
  const BodyModel model = test::base_model(leg);
  EXPECT_TRUE(by_six_rows(leg, Eigen::Vector3d(0.1, 0.8, -1.5), model, weight));
  EXPECT_FALSE(by_six_rows(leg, Eigen::Vector3d(0.1, 0.8, -1e-3), model, weight));
}

TEST(SixRows, DeclineLegsWithAFreeLink) {
  const Robot leg = test::corner_robot("one leg");
  BodyModel model = test::base_model(leg);
  model.free_links.push_back(2);
  model.shapes.push_back({2, model.shapes.front().shape, "0"});
  EXPECT_FALSE(by_six_rows(leg, Eigen::Vector3d(0.1, 0.8, -1.5), model, VectorXd::Ones(9)));
}

// On a robot as it walks both paths agree to the last digits, not only to what a bad leg may lose.
TEST(SixRows, AgreeWithTheGeneralPathToTheLastDigits) {
  const Robot robot = test::corner_robot("bundled quadruped");
  const VectorXd bent = Eigen::Vector3d(0.1, 0.8, -1.5);
  BodyModel model = test::base_model(robot), with_shank = model;
  with_shank.free_links.push_back(3);  // a leg link that is sought makes the path the general one
  with_shank.shapes.push_back({3, model.shapes.front().shape, "0"});
  SampleRows six(robot, model, project, VectorXd::Ones(18));
  SampleRows general(robot, with_shank, project, VectorXd::Ones(18));
  for (Sample s : test::corner_samples(robot)) {
    if (s.base_specific_force.isZero()) continue;
    s.q = bent.replicate<4, 1>() + 0.02 * s.q;
    s.dq /= 1.0 + s.dq.norm();
    s.in_contact = {true, false, false, true};
    ASSERT_EQ(six.update(s), Verdict::taken);
    ASSERT_EQ(general.update(s), Verdict::taken);
    ASSERT_TRUE(six.by_six_rows());
    ASSERT_FALSE(general.by_six_rows());
    MatrixXd expected(11, 11);
    const std::vector<int> kept = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 20};
    expected = gram(general)(kept, kept);
    EXPECT_LT(test::scaled_difference(gram(six), expected, robot.dof()), test::few_hundred_eps);
  }
}

TEST(FastSampleRows, ANumberThatIsNotFiniteIsDeclined) {
  const Robot robot = test::corner_robot("bundled quadruped");
  const BodyModel model = test::base_model(robot);
  SampleRows made(robot, model, project, VectorXd::Ones(robot.dof()));
  Sample s = test::corner_samples(robot).back();
  std::vector<double*> numbers = test::inputs(s);
  for (double& tau : s.tau) numbers.push_back(&tau);
  numbers.push_back(&s.contact_force[1].y());
  for (double* number : numbers) {
    const double kept = *number;
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), -1e200}) {
      *number = bad;
      const bool harmless = bad == -1e200 && number == &s.contact_force[1].y();
      const bool angle = bad == -1e200 && number >= s.q.data() && number < s.q.data() + s.q.size();
      if (harmless || angle) continue;
      EXPECT_EQ(made.update(s), Verdict::not_finite);
      EXPECT_EQ(made.rows().rows(), 0);
      EXPECT_EQ(made.constant(), 0.0);
    }
    *number = kept;
  }
  EXPECT_EQ(made.update(s), Verdict::taken);
}

TEST(FastSampleRows, ATimeThatIsNotFiniteIsDeclined) {
  const Robot robot = test::corner_robot("bundled quadruped");
  SampleRows made(robot, test::base_model(robot), project, VectorXd::Ones(robot.dof()));
  Sample s = test::corner_samples(robot).back();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    s.time = bad;
    EXPECT_EQ(made.update(s), Verdict::not_finite);
    EXPECT_EQ(made.rows().rows(), 0);
  }
  s.time = -1e200;  // whatever clock it is of
  EXPECT_EQ(made.update(s), Verdict::taken);
}

TEST(FastSampleRows, WithoutMeasuredForcesASampleIsDeclined) {
  const Robot robot = test::corner_robot("bundled quadruped");
  SampleRows made(robot, test::base_model(robot), ContactTreatment::measured,
                  VectorXd::Ones(robot.dof()));
  Sample s = test::corner_samples(robot).back();
  s.contact_force.clear();
  EXPECT_EQ(made.update(s), Verdict::no_contact_forces);
  EXPECT_EQ(made.rows().rows(), 0);
}

#ifndef NDEBUG
TEST(FastSampleRowsDeathTest, SampleOfAnotherRobotEndsTheProgram) {
  const Robot robot = test::corner_robot("bundled quadruped");
  SampleRows made(robot, test::base_model(robot), project, VectorXd::Ones(robot.dof()));
  EXPECT_DEATH(static_cast<void>(made.update(Sample())), "an entry for each joint");
  Sample s = test::nothing_moves(robot);
  s.in_contact.resize(1);
  EXPECT_DEATH(static_cast<void>(made.update(s)), "a flag for each contact");
}
#endif

}  // namespace
}  // namespace shapeid

// fast::Window against reference::Window.
#include "shapeid/fast/window.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/reference/window.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/fast/expected_rows.hpp"
#include "shapeid/tests/fast/first_difference.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using fast::Verdict;
using fast::Window;
using test::ExpectedRows;

using test::no_difference;

static_assert(noexcept(std::declval<Window&>().add(std::declval<const Sample&>())));
static_assert(noexcept(std::declval<Window&>().triangle()));
static_assert(noexcept(std::declval<Window&>().forget(0.5)));

struct Drawn {
  Robot robot;
  BodyModel model;
  ContactTreatment contacts;
  VectorXd weight;
  std::vector<Sample> samples;
};

Drawn drawn_log() {
  Drawn d;
  const bool legged = *rc::gen::arbitrary<bool>();
  d.robot = legged ? test::any_quadruped() : test::any_robot(1, 6);
  d.model = legged ? test::base_model(d.robot) : test::any_model(d.robot);
  d.contacts = *rc::gen::element(ContactTreatment::project, ContactTreatment::project,
                                 ContactTreatment::measured, ContactTreatment::ignore);
  d.weight.resize(d.robot.dof());
  for (double& w : d.weight) w = *test::magnitude(1e-2, 1e2);
  const int count = *rc::gen::inRange(0, 30);
  for (int k = 0; k < count; ++k) d.samples.push_back(test::any_sample(d.robot));
  return d;
}

Window window_of(const Drawn& d) { return {d.robot, d.model, d.contacts, d.weight}; }

MatrixXd gram(Window& window) {
  const MatrixXd& R = window.triangle().R();
  return R.transpose() * R;
}

/// What the reference makes of all samples.
ExpectedRows expected_window(const Drawn& d, const std::vector<Sample>& samples) {
  const auto columns = 10 * static_cast<Eigen::Index>(d.model.free_links.size()) + 1;
  reference::Window window(d.robot, d.model, d.contacts, d.weight);
  MatrixXd rounding = MatrixXd::Zero(columns, columns);
  for (const Sample& s : samples) {
    window.add(s);
    rounding += test::expected_rows(d.robot, d.model, d.contacts, d.weight, s).rounding;
  }
  MatrixXd YF(window.Y().rows(), columns);
  YF << window.Y(), window.F();
  return {YF.transpose() * YF, rounding};
}

RC_GTEST_PROP(FastWindow, AsTheReference, ()) {
  const Drawn d = drawn_log();
  Window window = window_of(d);
  for (const Sample& s : d.samples) RC_ASSERT(window.add(s) == Verdict::taken);
  RC_ASSERT(window.samples() == d.samples.size());
  RC_PRE(!d.samples.empty());
  RC_ASSERT(test::first_difference(gram(window), expected_window(d, d.samples), d.robot,
                                   d.samples.front()) == no_difference);
}

// To look at the triangle on the way changes nothing but roundings.
RC_GTEST_PROP(FastWindow, MayBeLookedAtAtAnyTime, ()) {
  const Drawn d = drawn_log();
  Window window = window_of(d), watched = window_of(d);
  for (const Sample& s : d.samples) {
    RC_ASSERT(window.add(s) == Verdict::taken);
    RC_ASSERT(watched.add(s) == Verdict::taken);
    const MatrixXd R = watched.triangle().R();
    RC_ASSERT(R == watched.triangle().R());
  }
  RC_ASSERT(test::scaled_difference(gram(window), gram(watched), d.robot.dof()) <
            test::few_hundred_eps);
}

RC_GTEST_PROP(FastWindow, ClearedIsNew, ()) {
  const Drawn d = drawn_log();
  Window window = window_of(d), fresh = window_of(d);
  for (const Sample& s : d.samples) RC_ASSERT(window.add(s) == Verdict::taken);
  window.clear();
  RC_ASSERT(window.samples() == 0U);
  RC_ASSERT(window.samples_by_six_rows() == 0U);
  RC_ASSERT(window.triangle().R().isZero(0.0));
  for (const Sample& s : d.samples) {
    RC_ASSERT(window.add(s) == Verdict::taken);
    RC_ASSERT(fresh.add(s) == Verdict::taken);
  }
  RC_ASSERT(window.triangle().R() == fresh.triangle().R());
}

RC_GTEST_PROP(FastWindow, DeclinedSamplesLeaveNoTrace, ()) {
  const Drawn d = drawn_log();
  Window window = window_of(d), fresh = window_of(d);
  for (const Sample& s : d.samples) {
    Sample bad = s;
    bad.base_specific_force.y() = std::numeric_limits<double>::quiet_NaN();
    RC_ASSERT(window.add(bad) == Verdict::not_finite);
    RC_ASSERT(window.add(s) == Verdict::taken);
    RC_ASSERT(fresh.add(s) == Verdict::taken);
  }
  RC_ASSERT(window.samples() == fresh.samples());
  RC_ASSERT(window.triangle().R() == fresh.triangle().R());
}

// What was forgotten by half, twice, counts a quarter.
RC_GTEST_PROP(FastWindow, ForgetsByTheFactorSaid, ()) {
  const Drawn d = drawn_log();
  const double factor = *test::real(0.0, 1.0);
  Window window = window_of(d);
  const auto columns = window.triangle().R().cols();
  MatrixXd expected = MatrixXd::Zero(columns, columns);
  for (const Sample& s : d.samples) {
    window.forget(factor);
    RC_ASSERT(window.add(s) == Verdict::taken);
    Window alone = window_of(d);
    RC_ASSERT(alone.add(s) == Verdict::taken);
    expected = factor * expected + gram(alone);
  }
  RC_ASSERT(test::scaled_difference(gram(window), expected, d.robot.dof()) < test::few_hundred_eps);
}

TEST(FastWindow, CountsThePathsThatSamplesTook) {
  const Robot robot = test::corner_robots()[2].robot;  // one leg
  Window window(robot, test::base_model(robot), ContactTreatment::project,
                VectorXd::Ones(robot.dof()));
  Sample s = test::nothing_moves(robot);
  s.in_contact = {true};
  s.q << 0.1, 0.8, -1.5;
  EXPECT_EQ(window.add(s), Verdict::taken);
  EXPECT_EQ(window.add(s), Verdict::taken);
  s.q[2] = 0.0;  // stretched
  EXPECT_EQ(window.add(s), Verdict::taken);
  EXPECT_EQ(window.samples(), 3U);
  EXPECT_EQ(window.samples_by_six_rows(), 2U);
}

}  // namespace
}  // namespace shapeid

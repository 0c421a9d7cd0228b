// The fast path asks for no memory after construction; and the counter that says so does count.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "shapeid/fast/contact.hpp"
#include "shapeid/fast/inverse_dynamics.hpp"
#include "shapeid/fast/regressor.hpp"
#include "shapeid/fast/triangle.hpp"
#include "shapeid/fast/window.hpp"
#include "shapeid/tests/fast/allocations.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/fast/wanted.hpp"
#include "shapeid/tests/support/generators.hpp"

namespace shapeid {
namespace {

using test::allocations_during;

TEST(Allocations, EveryWayToAskForMemoryIsCounted) {
  struct alignas(64) Wide {
    char bytes[64];
  };
  void* volatile kept = nullptr;  // the compiler may not leave out what is stored here
  EXPECT_EQ(allocations_during([] {}), 0U);
  EXPECT_EQ(allocations_during([&] { kept = std::malloc(100); }), 1U);
  EXPECT_EQ(allocations_during([&] { kept = std::realloc(kept, 10000); }), 1U);
  std::free(kept);
  EXPECT_EQ(allocations_during([&] { kept = std::calloc(10, 10); }), 1U);
  std::free(kept);
  EXPECT_EQ(allocations_during([&] { kept = std::aligned_alloc(64, 128); }), 1U);
  std::free(kept);
  EXPECT_EQ(allocations_during([&] { kept = ::operator new(100); }), 1U);
  ::operator delete(kept);
  std::unique_ptr<Wide> wide;
  EXPECT_EQ(allocations_during([&] {
              wide = std::make_unique<Wide>();
              kept = wide.get();
            }),
            1U);
  std::string text;
  EXPECT_EQ(allocations_during([&] {
              text = std::string(100, 'x');
              kept = text.data();
            }),
            1U);
  Eigen::MatrixXd matrix;
  EXPECT_EQ(allocations_during([&] {
              matrix = Eigen::MatrixXd::Ones(7, 9);
              kept = matrix.data();
            }),
            1U);
  // What a slip in the fast path would look like: a product that is evaluated before it is added.
  const Eigen::MatrixXd A = Eigen::MatrixXd::Ones(30, 30);
  Eigen::MatrixXd sum = A;
  EXPECT_GE(allocations_during([&] { sum += A * A; }), 1U);
}

RC_GTEST_PROP(Allocations, RegressorMakesNoneAfterConstruction, ()) {
  const Robot robot = *test::robot({1, 20, *rc::gen::element(Root::fixed, Root::floating)});
  const std::vector<Sample> samples =
      *rc::gen::container<std::vector<Sample>>(3, test::sample(robot));
  const std::vector<int> links = test::some_links(robot);
  fast::Regressor regressor(robot, links);
  Eigen::MatrixXd Y(static_cast<Eigen::Index>(samples.size()) * robot.dof(),
                    10 * static_cast<Eigen::Index>(links.size()));
  RC_ASSERT(allocations_during([&] {
              for (const Sample& sample : samples) regressor(sample);
              regressor.of_block(samples, Y);
            }) == 0U);
}

RC_GTEST_PROP(Allocations, ContactsAndKnownLinksMakeNoneAfterConstruction, ()) {
  const Robot robot = test::any_robot(1, 20);
  const std::vector<Sample> samples = {test::any_sample(robot), test::any_sample(robot)};
  fast::Kinematics kinematics(robot);
  fast::InverseDynamics dynamics(robot, stacked_parameters(robot));
  fast::ContactJacobian jacobian(robot);
  fast::MeasuredForces forces(robot);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(robot.dof());
  RC_ASSERT(allocations_during([&] {
              for (const Sample& sample : samples) {
                kinematics.start(sample);
                force -= dynamics(kinematics);
                jacobian.update(kinematics, sample);
                static_cast<void>(forces.add_to(force, kinematics, sample));
              }
            }) == 0U);
}

RC_GTEST_PROP(Allocations, WindowMakesNoneAfterConstruction, ()) {
  const bool legged = *rc::gen::arbitrary<bool>();
  const Robot robot = legged ? test::any_quadruped() : test::any_robot(1, 12);
  const BodyModel model = legged ? test::base_model(robot) : test::any_model(robot);
  std::vector<Sample> samples(12);
  for (Sample& sample : samples) sample = test::any_sample(robot);
  samples.front().tau.setConstant(std::numeric_limits<double>::quiet_NaN());
  fast::Window window(robot, model,
                      *rc::gen::element(ContactTreatment::project, ContactTreatment::measured),
                      Eigen::VectorXd::Ones(robot.dof()));
  RC_ASSERT(allocations_during([&] {
              for (const Sample& sample : samples) static_cast<void>(window.add(sample));
              static_cast<void>(window.triangle());
              window.forget(0.5);
              window.clear();
            }) == 0U);
}

RC_GTEST_PROP(Allocations, TriangleMakesNoneAfterConstruction, ()) {
  const Eigen::Index unknowns = *rc::gen::inRange(0, 60), rows = *rc::gen::inRange(0, 200);
  const Eigen::MatrixXd Y = Eigen::MatrixXd::Random(rows + 3, unknowns + 2);
  const Eigen::VectorXd F = Eigen::VectorXd::Random(rows + 3);
  fast::Triangle triangle(unknowns), other(unknowns);
  RC_ASSERT(allocations_during([&] {
              // A block of a larger matrix, as it comes from a regressor.
              triangle.add(Y.block(1, 2, rows, unknowns), F.segment(2, rows));
              other.add(Y.block(3, 0, rows, unknowns), F.segment(1, rows));
              triangle.merge(other);
              other.clear();
            }) == 0U);
}

}  // namespace
}  // namespace shapeid

// fast::ContactJacobian and fast::MeasuredForces against reference/contact.hpp.
#include "shapeid/fast/contact.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "shapeid/reference/contact.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/fast/first_difference.hpp"

namespace shapeid {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using test::no_difference;

/// J and J^T f of one robot by both paths.
class Contacts {
 public:
  explicit Contacts(const Robot& robot)
      : robot_(robot), kinematics_(robot), jacobian_(robot), forces_(robot) {}

  std::string difference(const Sample& s) {
    kinematics_.start(s);
    jacobian_.update(kinematics_, s);
    const MatrixXd J = reference::contact_jacobian(robot_, s);
    // Lever arms are differences of places that rounded at the size of the robot.
    const double reach = 1.0 + J.norm() + size_.norm();
    std::string found =
        test::first_difference(jacobian_.transposed().transpose(), J, reach, links(), robot_, s);
    if (!found.empty()) return "J: " + found;

    const VectorXd before = VectorXd::LinSpaced(robot_.dof(), -1.0, 2.0);
    VectorXd force = before;
    if (!forces_.add_to(force, kinematics_, s)) return "measured forces are refused";
    double scale = before.norm();
    for (const Eigen::Vector3d& f : s.contact_force) scale += reach * f.norm();
    found = test::first_difference(force, before + reference::measured_contact_force(robot_, s),
                                   scale, links(), robot_, s);
    return found.empty() ? no_difference : "J^T f: " + found;
  }

 private:
  [[nodiscard]] int links() const { return robot_.link_count(); }
  [[nodiscard]] static VectorXd sizes(const Robot& robot) {
    VectorXd size(robot.link_count());
    for (int i = 0; i < robot.link_count(); ++i) {
      size[i] = robot.links[static_cast<std::size_t>(i)].joint.placement.translation().norm();
    }
    return size;
  }

  Robot robot_;
  VectorXd size_ = sizes(robot_);
  fast::Kinematics kinematics_;
  fast::ContactJacobian jacobian_;
  fast::MeasuredForces forces_;
};

RC_GTEST_PROP(FastContact, AsTheReference, ()) {
  const Robot robot = test::any_robot(1, 20);
  Contacts contacts(robot);
  for (int k = 0; k < 3; ++k) {  // nothing of an earlier sample stays
    RC_ASSERT(contacts.difference(test::any_sample(robot)) == no_difference);
  }
}

TEST(FastContact, CornerCasesAsTheReference) {
  for (const auto& [name, robot] : test::corner_robots()) {
    SCOPED_TRACE(name);
    Contacts contacts(robot);
    for (const Sample& s : test::corner_samples(robot))
      EXPECT_EQ(contacts.difference(s), no_difference);
  }
}

TEST(FastContact, WithoutFlagsNothingTouches) {
  const Robot robot = test::corner_robots().back().robot;
  Sample s = test::corner_samples(robot).back();
  s.in_contact.clear();
  fast::Kinematics kinematics(robot);
  fast::ContactJacobian jacobian(robot);
  kinematics.start(s);
  jacobian.update(kinematics, s);
  EXPECT_EQ(jacobian.rows(), 0);
}

TEST(FastContact, ForcesThatAreNotThereAreRefused) {
  const Robot robot = test::corner_robots().back().robot;
  Sample s = test::corner_samples(robot).back();
  s.contact_force.clear();
  fast::Kinematics kinematics(robot);
  const fast::MeasuredForces forces(robot);
  kinematics.start(s);
  VectorXd force = VectorXd::Ones(robot.dof());
  EXPECT_FALSE(forces.add_to(force, kinematics, s));
  EXPECT_EQ(force, VectorXd::Ones(robot.dof()));
}

}  // namespace
}  // namespace shapeid

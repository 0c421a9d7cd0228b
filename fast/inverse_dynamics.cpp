#include "shapeid/fast/inverse_dynamics.hpp"

#include <Eigen/Geometry>

#include <cstddef>

#include "shapeid/models/contract.hpp"
#include "shapeid/models/inertia.hpp"

namespace shapeid::fast {

InverseDynamics::InverseDynamics(const Robot& robot, const Eigen::VectorXd& Phi)
    : wrenches_(robot.links.size()), force_(Eigen::VectorXd::Zero(robot.dof())) {
  SHAPEID_CONTRACT(why_malformed(robot));
  SHAPEID_CONTRACT(why_not_stacked(Phi, robot));
  std::vector<bool> counts(robot.links.size(), false);
  for (std::size_t i = robot.links.size(); i-- > 0;) {
    counts[i] = counts[i] || !Phi.segment<10>(static_cast<Eigen::Index>(10 * i)).isZero(0.0);
    if (i > 0 && counts[i]) counts[static_cast<std::size_t>(robot.links[i].parent)] = true;
  }
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (!counts[i]) continue;
    const PseudoInertia sigma =
        pseudo_inertia({Phi.segment<10>(static_cast<Eigen::Index>(10 * i))});
    bodies_.push_back({static_cast<int>(i), sigma(3, 3), sigma.topRightCorner<3, 1>(),
                       sigma.topLeftCorner<3, 3>()});
  }
}

// The mass at r takes the force (a + K r) dm and the moment r x (a + K r) dm. Integrated:
// m a + K h, and h x a + what is skew in K Sigma.
const Eigen::VectorXd& InverseDynamics::operator()(Kinematics& kinematics) noexcept {
  for (const Body& body : bodies_) {
    const LinkMotion& link = kinematics.motion(body.link);
    Wrench& w = wrenches_[static_cast<std::size_t>(body.link)];
    w.f = body.m * link.a + link.K * body.h;
    const auto entry = [&](int i, int j) { return link.K.row(i).dot(body.Sigma.col(j)); };
    w.n =
        body.h.cross(link.a) + Eigen::Vector3d(entry(2, 1) - entry(1, 2), entry(0, 2) - entry(2, 0),
                                               entry(1, 0) - entry(0, 1));
  }
  const int base_dof = kinematics.base_dof();
  for (auto body = bodies_.rbegin(); body != bodies_.rend() && body->link != 0; ++body) {
    const int link = body->link;
    const Wrench& w = wrenches_[static_cast<std::size_t>(link)];
    force_[base_dof + link - 1] = kinematics.axis(link).dot(kinematics.slides(link) ? w.f : w.n);
    Wrench& parent = wrenches_[static_cast<std::size_t>(kinematics.parent(link))];
    const Eigen::Vector3d f = kinematics.up(link, w.f);
    parent.f += f;
    parent.n += kinematics.up(link, w.n) + kinematics.arm(link).cross(f);
  }
  if (base_dof != 0 && !bodies_.empty()) {
    force_.head<3>() = wrenches_.front().f;
    force_.segment<3>(3) = wrenches_.front().n;
  }
  return force_;
}

}  // namespace shapeid::fast

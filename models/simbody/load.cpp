#include "shapeid/models/simbody/load.hpp"

namespace shapeid {

InertialParameters inertia_of(const Load& load) {
  const Eigen::Vector3d squares = load.sides.cwiseAbs2();
  const Eigen::Matrix3d tensor =
      load.mass / 12.0 *
      (squares.sum() * Eigen::Matrix3d::Identity() - Eigen::Matrix3d(squares.asDiagonal()));
  return from_centre(load.mass, load.centre, tensor);
}

Robot with_load(const Robot& robot, const Load& load) {
  Robot loaded = robot;
  Link& link = loaded.links.at(static_cast<std::size_t>(load.link));
  link.inertia = link.inertia + inertia_of(load);
  CollisionBody body;
  body.pose.translation() = load.centre;
  body.geometry = Box{load.sides};
  link.collision.push_back(body);
  return loaded;
}

}  // namespace shapeid

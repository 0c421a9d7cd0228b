// The ground of the simulation.
#pragma once

#include <vector>

namespace shapeid {

/// A level, compliant ground at z = 0 that pushes on the robot's contact points themselves, so
/// that the Jacobian of a declared point contact is exactly the simulated one; or on balls around
/// these, at their lowest points. With penetration d
/// and sliding velocity v:
///   normal    n = stiffness d^(3/2) (1 + dissipation d'), not below zero (Hunt and Crossley 1975)
///   friction  - friction n v / sqrt(|v|^2 + slip_speed^2)
struct Ground {
  double stiffness = 2.5e5;  ///< N / m^(3/2): 4 mm under a foot that carries half of 13 kg
  double dissipation = 3.0;  ///< s / m
  double friction = 0.8;
  double slip_speed = 0.02;  ///< m/s: below it friction is viscous, so standing feet creep a little
  std::vector<double> foot_radius = {};  ///< m, one a contact; empty: points
};

}  // namespace shapeid

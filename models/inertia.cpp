#include "shapeid/models/inertia.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace shapeid {
namespace {

Eigen::Matrix3d steiner(double mass, const Eigen::Vector3d& r) {
  return mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
}

}  // namespace

Eigen::Matrix3d InertialParameters::tensor() const {
  Eigen::Matrix3d I;
  I << values[4], values[5], values[6],  //
      values[5], values[7], values[8],   //
      values[6], values[8], values[9];
  return I;
}

Eigen::Vector3d InertialParameters::centre_of_mass() const {
  if (mass() == 0.0) return Eigen::Vector3d::Zero();
  return first_moment() / mass();
}

Eigen::Matrix3d InertialParameters::tensor_about_centre() const {
  return tensor() - steiner(mass(), centre_of_mass());
}

InertialParameters from_origin(double mass, const Eigen::Vector3d& first_moment,
                               const Eigen::Matrix3d& tensor) {
  InertialParameters body;
  body.values << mass, first_moment, tensor(0, 0), tensor(0, 1), tensor(0, 2), tensor(1, 1),
      tensor(1, 2), tensor(2, 2);
  return body;
}

InertialParameters from_centre(double mass, const Eigen::Vector3d& centre,
                               const Eigen::Matrix3d& tensor_about_centre) {
  return from_origin(mass, mass * centre, tensor_about_centre + steiner(mass, centre));
}

InertialParameters operator+(const InertialParameters& a, const InertialParameters& b) {
  return {a.values + b.values};
}

InertialParameters operator*(double factor, const InertialParameters& a) {
  return {factor * a.values};
}

PseudoInertia pseudo_inertia(const InertialParameters& body) {
  const Eigen::Matrix3d I = body.tensor();
  PseudoInertia sigma;
  // integral r r^T dm = tr(I)/2 - I, because tr(I) = 2 integral |r|^2 dm.
  sigma.topLeftCorner<3, 3>() = 0.5 * I.trace() * Eigen::Matrix3d::Identity() - I;
  sigma.topRightCorner<3, 1>() = body.first_moment();
  sigma.bottomLeftCorner<1, 3>() = body.first_moment().transpose();
  sigma(3, 3) = body.mass();
  return sigma;
}

InertialParameters from_pseudo_inertia(const PseudoInertia& sigma) {
  const Eigen::Matrix3d S = sigma.topLeftCorner<3, 3>();
  return from_origin(sigma(3, 3), sigma.topRightCorner<3, 1>(),
                     S.trace() * Eigen::Matrix3d::Identity() - S);
}

InertialParameters moved(const InertialParameters& body, const Eigen::Isometry3d& placement) {
  return from_pseudo_inertia(placement.matrix() * pseudo_inertia(body) *
                             placement.matrix().transpose());
}

double consistency_margin(const InertialParameters& body) {
  const PseudoInertia sigma = pseudo_inertia(body);
  const double mass = std::abs(body.mass());
  const double second = sigma.topLeftCorner<3, 3>().cwiseAbs().maxCoeff();
  if (body.values.isZero(0.0)) return 0.0;
  if (mass == 0.0 || second == 0.0) {
    // A point at the origin is on the edge of the cone; anything else without mass is outside it.
    const bool point_at_origin = body.mass() > 0.0 && body.first_moment().isZero(0.0);
    return point_at_origin && second == 0.0 ? 0.0 : -1.0;
  }
  // Lengths in units of sqrt(second / mass), mass in units of itself: a congruence, so the signs
  // of the eigenvalues are those of Sigma.
  Eigen::Vector4d scale = Eigen::Vector4d::Constant(1.0 / std::sqrt(second));
  scale[3] = 1.0 / std::sqrt(mass);
  const Eigen::Matrix4d scaled = scale.asDiagonal() * sigma * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(scaled, Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

Violation why_impossible(const InertialParameters& body, double tolerance) {
  if (!body.values.allFinite()) return "a parameter is not a finite number";
  if (body.mass() < 0.0) return fmt::format("mass is negative ({:g} kg)", body.mass());
  const double margin = consistency_margin(body);
  if (margin >= -tolerance) return std::nullopt;
  if (body.mass() == 0.0) return "the body has moments but no mass";

  const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(
                                        body.tensor_about_centre(), Eigen::EigenvaluesOnly)
                                        .eigenvalues();
  // A rod's zero comes out as rounding of either sign: only a moment below that is negative.
  if (principal[0] < -tolerance * principal[2]) {
    return fmt::format(
        "a principal moment about the centre of mass is negative ({:g} kg m^2, largest {:g})",
        principal[0], principal[2]);
  }
  return fmt::format(
      "the triangle inequality is broken: principal moments {:g} + {:g} < {:g} kg m^2 (short by "
      "{:g})",
      principal[0], principal[1], principal[2], principal[2] - principal[0] - principal[1]);
}

}  // namespace shapeid

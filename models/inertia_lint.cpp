#include "shapeid/models/inertia_lint.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace shapeid::urdf {
namespace {

struct Unit {
  const char* name;
  double in_si;
};

/// Units in which CAD programs and data sheets print moments of inertia.
constexpr std::array<Unit, 6> moment_units = {{{"g mm^2", 1e-9},
                                               {"g cm^2", 1e-7},
                                               {"kg mm^2", 1e-6},
                                               {"kg cm^2", 1e-4},
                                               {"lb in^2", 2.9263965e-4},
                                               {"g m^2", 1e-3}}};

std::string join(const std::vector<std::string>& causes) {
  std::string result;
  for (const std::string& cause : causes) result += (result.empty() ? "" : "; or ") + cause;
  return result;
}

/// Whether the link with another tensor could exist, in the space that it has.
bool would_fit(Inertial inertial, const Eigen::Matrix3d& tensor, const Extent& extent,
               double padding) {
  inertial.tensor = tensor;
  const InertialParameters body = inertial.parameters();
  return !why_impossible(body) && compare(body, extent, padding) == Fit::fits;
}

/// Numbers that were typed to satisfy a parser: all equal, or one power of ten on the diagonal.
bool is_placeholder(const Eigen::Matrix3d& I) {
  const double t = I(0, 0);
  if (t == 0.0) return false;
  if (I == Eigen::Matrix3d::Constant(t)) return true;
  const double exponent = std::log10(t);
  return I == Eigen::Matrix3d(t * Eigen::Matrix3d::Identity()) &&
         std::abs(exponent - std::round(exponent)) < 1e-12;
}

/// What would bring the link's tensor to the size of its collision geometry.
std::string causes_of_size(const DocumentLink& link, const Extent& extent) {
  const Inertial& inertial = *link.inertial;
  if (is_placeholder(inertial.tensor)) return "a placeholder, not a measurement";
  std::vector<std::string> causes;
  for (const Unit& unit : moment_units) {
    if (would_fit(inertial, unit.in_si * inertial.tensor, extent, generous)) {
      causes.push_back(fmt::format("the moments are in {}, not kg m^2", unit.name));
    }
  }
  return join(causes);
}

InertiaFinding suspicious(const DocumentLink& link, const std::string& file, std::string wrong,
                          std::string cause) {
  return {link.name, {file, link.inertial->line, {}}, std::move(wrong), std::move(cause), false};
}

/// Largest standard deviation of the mass about its centre, m.
double largest_spread(const InertialParameters& body) {
  const Eigen::Matrix3d I = body.tensor_about_centre();
  const Eigen::Matrix3d second = 0.5 * I.trace() * Eigen::Matrix3d::Identity() - I;
  const double largest =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(second, Eigen::EigenvaluesOnly)
          .eigenvalues()[2];
  return std::sqrt(std::max(largest, 0.0) / body.mass());
}

std::optional<InertiaFinding> lint_size(const DocumentLink& link, const std::string& file) {
  const std::optional<Extent> extent = collision_extent(link);
  if (!extent) return std::nullopt;
  const Inertial& inertial = *link.inertial;
  const InertialParameters body = inertial.parameters();
  const double size = (extent->upper - extent->lower).maxCoeff();
  switch (compare(body, *extent, generous)) {
    case Fit::centre_outside: {
      const Eigen::Vector3d c = body.centre_of_mass();
      Inertial in_millimetres = inertial;
      in_millimetres.origin.translation() *= 1e-3;
      const Fit then = compare(in_millimetres.parameters(), *extent, generous);
      return suspicious(
          link, file,
          fmt::format("the centre of mass ({:g}, {:g}, {:g}) m is far outside the collision "
                      "geometry",
                      c.x(), c.y(), c.z()),
          then == Fit::centre_outside ? "" : "the centre of mass is in mm, not m");
    }
    case Fit::too_large:
      return suspicious(link, file,
                        fmt::format("the mass is spread over {:.3g} m about its centre, more than "
                                    "a link of {:.3g} m can hold",
                                    largest_spread(body), size),
                        causes_of_size(link, *extent));
    case Fit::too_small:
      return suspicious(link, file,
                        fmt::format("the mass is spread over {:.3g} m only, in a link of {:.3g} m",
                                    largest_spread(body), size),
                        causes_of_size(link, *extent));
    case Fit::fits:
      break;
  }
  // A parallel axis term too many is a matter of tens of percent: the geometry is taken at its
  // word, and believed only if taking the term away makes everything fit.
  if (compare(body, *extent, 0.0) == Fit::too_large &&
      would_fit(inertial, shifted_to_centre(inertial), *extent, 0.0)) {
    return suspicious(link, file, "the mass is spread wider than the collision geometry can hold",
                      "the tensor is about the link's origin, not the centre of mass");
  }
  return std::nullopt;
}

/// A shortage of less than this, relative to the largest moment, is rounding in the third digit.
constexpr double forgivable_shortage = 0.01;

InertiaFinding impossible(const DocumentLink& link, const std::string& file,
                          const std::string& wrong) {
  const Inertial& inertial = *link.inertial;
  std::vector<std::string> causes;
  bool rounded = false;
  if (inertial.mass > 0.0) {
    if (explained_by_rounding(inertial)) {
      causes.emplace_back("the moments were rounded; write more digits");
      const Eigen::Vector3d p =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertial.tensor, Eigen::EigenvaluesOnly)
              .eigenvalues();
      rounded = std::max(p[2] - p[1] - p[0], -p[0]) <= forgivable_shortage * p[2];
    }
    if (is_placeholder(inertial.tensor)) {
      causes.emplace_back("a placeholder; products of inertia belong to zero there");
    } else if (!rounded) {
      for (const Repair& r : plausible_repairs(link)) causes.push_back(r.cause);
    }
  }
  return {link.name, {file, inertial.line, {}}, wrong, join(causes), !rounded};
}

}  // namespace

std::optional<Extent> collision_extent(const DocumentLink& link) {
  if (link.collision.empty()) return std::nullopt;
  Extent all{Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()),
             Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity())};
  for (const CollisionBody& body : link.collision) {
    Eigen::Vector3d half;
    if (const auto* box = std::get_if<Box>(&body.geometry)) {
      half = body.pose.linear().cwiseAbs() * (0.5 * box->size);
    } else if (const auto* cylinder = std::get_if<CylinderGeometry>(&body.geometry)) {
      half = body.pose.linear().cwiseAbs() *
             Eigen::Vector3d(cylinder->radius, cylinder->radius, 0.5 * cylinder->length);
    } else if (const auto* sphere = std::get_if<SphereGeometry>(&body.geometry)) {
      half.setConstant(sphere->radius);
    } else {
      return std::nullopt;
    }
    all.lower = all.lower.cwiseMin(body.pose.translation() - half);
    all.upper = all.upper.cwiseMax(body.pose.translation() + half);
  }
  return all;
}

Fit compare(const InertialParameters& body, const Extent& extent, double padding) {
  // A uniform rod spreads 0.29 of its length; a motor at one end of a long thin shell leaves a
  // tenth of that. Less than this share takes a slip in the units.
  constexpr double smallest_share = 0.02;
  // A sheet or a rod drawn without thickness still has some.
  constexpr double thinnest = 0.1;
  const Eigen::Vector3d drawn = extent.upper - extent.lower;
  const double longest = drawn.maxCoeff();
  const Eigen::Vector3d half =
      0.5 * drawn.cwiseMax(thinnest * longest) + Eigen::Vector3d::Constant(padding * longest);
  const Eigen::Vector3d off = body.centre_of_mass() - 0.5 * (extent.lower + extent.upper);
  if ((off.cwiseAbs().array() > half.array()).any()) return Fit::centre_outside;

  const Eigen::Matrix3d I = body.tensor_about_centre();
  const Eigen::Vector3d variance =
      (0.5 * I.trace() * Eigen::Vector3d::Ones() - I.diagonal()) / body.mass();
  const Eigen::Vector3d bound = half.cwiseAbs2() - off.cwiseAbs2();  // (half - off)(half + off)
  if ((variance.array() > bound.array()).any()) return Fit::too_large;
  if (largest_spread(body) < smallest_share * longest) return Fit::too_small;
  return Fit::fits;
}

std::optional<InertiaFinding> lint(const DocumentLink& link, const std::string& file) {
  if (!link.inertial) return std::nullopt;
  const Inertial& inertial = *link.inertial;
  // Moments of a body a micrometre in size are what is left of zero after somebody's arithmetic.
  constexpr double micrometre = 1e-6;
  const double tiny = micrometre * micrometre * inertial.mass;
  if (inertial.mass > 0.0 && (inertial.tensor.cwiseAbs().array() <= tiny).all()) {
    return suspicious(link, file, "the tensor is zero: all mass is in one point",
                      "the moments were left out");
  }
  if (const Violation wrong =
          why_impossible(from_centre(inertial.mass, Eigen::Vector3d::Zero(), inertial.tensor))) {
    return impossible(link, file, *wrong);
  }
  if (inertial.mass == 0.0) return std::nullopt;
  if (inertial.tensor.isIdentity(0.0)) {
    return suspicious(link, file, "the tensor is the identity, 1 kg m^2 about each axis",
                      "a placeholder, not a measurement");
  }
  return lint_size(link, file);
}

std::string describe(const InertiaFinding& finding) {
  std::string text = fmt::format("inertia of link {}: {}", finding.link, finding.wrong);
  if (!finding.likely_cause.empty()) text += fmt::format(" (likely: {})", finding.likely_cause);
  return text;
}

}  // namespace shapeid::urdf

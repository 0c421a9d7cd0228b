#include "shapeid/fast/asked_of_masses.hpp"

#include <cmath>
#include <string>

namespace shapeid::fast {
namespace {

/// Half the digits of a double: the volume of a thin mesh far from the link's origin loses some; a
/// part that is not the shape's is off by its own size.
constexpr double cut_rounding = 1.5e-8;

/// Some fifty roundings: what a cut costs that is computed as the shape itself was.
constexpr double exact_rounding = 1e-14;

/// What the moments of a unit mass are rounded by: its mass, its arm, the tensor's size.
Eigen::Vector3d sizes(const Vector10& u) {
  const double tensor = u.tail<6>().norm();
  return {std::abs(u[0]), u.segment<3>(1).norm() + std::sqrt(tensor), tensor};
}

}  // namespace

bool fits_in_single(const Vector10& u) {
  constexpr double least = 1e-30, most = 1e30;
  const double largest = u.lpNorm<Eigen::Infinity>();
  return largest == 0.0 || (largest > least && largest < most);
}

Violation why_no_shape(int link, const Vector10& u, double V, int links) {
  if (link < 0 || link >= links) {
    return "a shape on free link " + std::to_string(link) + " of " + std::to_string(links);
  }
  if (!u.allFinite()) return "a shape's unit parameters are not finite";
  if (!fits_in_single(u)) return "a shape's unit parameters are beyond 1e-30 to 1e30";
  if (!(V > 0.0 && std::isfinite(V))) return "a shape's volume is " + std::to_string(V);
  return std::nullopt;
}

Violation why_no_lambda(double lambda) {
  if (lambda >= 0.0) return std::nullopt;
  return "lambda is " + std::to_string(lambda);
}

Violation why_no_triangle(const Eigen::MatrixXd& R, int links) {
  const Eigen::Index size = Eigen::Index{10} * links + 1;
  if (R.rows() == size && R.cols() == size) return std::nullopt;
  return "the triangle of " + std::to_string(links) + " links has " + std::to_string(R.rows()) +
         " rows and " + std::to_string(R.cols()) + " columns";
}

Violation why_no_rows(bool has_rows) {
  if (has_rows) return std::nullopt;
  return "no triangle has been solved for";
}

Violation why_no_start(int j, double mass, int shapes) {
  if (j < 0 || j >= shapes) {
    return "a mass for shape " + std::to_string(j) + " of " + std::to_string(shapes);
  }
  if (mass > 0.0 && std::isfinite(mass)) return std::nullopt;
  return "a mass to start at is " + std::to_string(mass);
}

// Without a root: this is asked at divisions that are to take a microsecond.
bool adds_up(const Vector10& u, double V, const Vector10& first, double V1, const Vector10& second,
             double V2) noexcept {
  const Vector10 missing = (V1 * first + V2 * second - V * u).cwiseAbs();
  const Vector10 terms = V1 * first.cwiseAbs() + V2 * second.cwiseAbs();
  const double tensor = terms.tail<6>().maxCoeff(), arm = terms.segment<3>(1).maxCoeff();
  const double missing_arm = missing.segment<3>(1).maxCoeff();
  constexpr double share = exact_rounding;
  return std::abs(V1 + V2 - V) <= share * V && missing[0] <= share * terms[0] &&
         missing_arm * missing_arm <= share * share * (arm * arm + terms[0] * tensor) &&
         missing.tail<6>().maxCoeff() <= share * tensor;
}

Violation why_no_parts(const Vector10& u, double V, const Vector10& first, double V1,
                       const Vector10& second, double V2) {
  if (!(V1 > 0.0 && V2 > 0.0)) return "a part of a shape has no volume";
  if (!(std::abs(V1 + V2 - V) <= cut_rounding * V)) {
    return "the parts of a shape differ from its volume by " + std::to_string(V1 + V2 - V);
  }
  const Vector10 missing = (V1 * first + V2 * second) / (V1 + V2) - u;
  const Eigen::Vector3d allowed =
      cut_rounding * (sizes(u) + (V1 * sizes(first) + V2 * sizes(second)) / (V1 + V2));
  if (std::abs(missing[0]) <= allowed[0] && missing.segment<3>(1).norm() <= allowed[1] &&
      missing.tail<6>().norm() <= allowed[2]) {
    return std::nullopt;
  }
  return "the parts of a shape differ from its moments by " + std::to_string(missing.norm());
}

}  // namespace shapeid::fast

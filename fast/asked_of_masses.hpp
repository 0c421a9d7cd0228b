// What MassSolver asks of its caller, each condition written once: debug builds check them, tests
// call them. Claim C3.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/contract.hpp"
#include "shapeid/models/inertia.hpp"

namespace shapeid::fast {

/// Whether single precision holds these unit parameters: the largest is between 1e-30 and 1e30, or
/// all are zero.
[[nodiscard]] bool fits_in_single(const Vector10& u);

/// Empty if a shape of these unit parameters and this volume (m^3) can stand on free link `link` of
/// `links`: all finite, V > 0, and fits_in_single().
[[nodiscard]] Violation why_no_shape(int link, const Vector10& u, double V, int links);

/// Empty for lambda >= 0; also where it is so large that no answer can be had.
[[nodiscard]] Violation why_no_lambda(double lambda);

/// Empty if R has 10 `links` + 1 rows and columns. Its numbers are judged by the solver.
[[nodiscard]] Violation why_no_triangle(const Eigen::MatrixXd& R, int links);

/// Empty if there are rows to solve for again: some triangle was solved.
[[nodiscard]] Violation why_no_rows(bool has_rows);

/// Empty if shape `j` of `shapes` can start at this mass (kg): finite, > 0.
[[nodiscard]] Violation why_no_start(int j, double mass, int shapes);

/// Empty if two parts make up the shape (u, V) at its density: V1 + V2 = V and V1 first + V2 second
/// = V u, to half the digits. Moments are judged by the size of the parts, not number by
/// number: those that cancel are rounded as those that do not.
[[nodiscard]] Violation why_no_parts(const Vector10& u, double V, const Vector10& first, double V1,
                                     const Vector10& second, double V2);

/// Whether they do to a few roundings, so that the one may be taken for the other.
[[nodiscard]] bool adds_up(const Vector10& u, double V, const Vector10& first, double V1,
                           const Vector10& second, double V2) noexcept;

}  // namespace shapeid::fast

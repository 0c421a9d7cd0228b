// An answer of the fast mass solver beside the reference's, legal differences taken out first.
#pragma once

#include <Eigen/Core>

#include <limits>
#include <string>

#include "shapeid/fast/mass_solver.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {

/// The solver's own bound on a gradient entry over its terms.
inline constexpr double promised_slope = 1e-10;

/// What a condition of 1e6, that of the damped problem at the default lambda, leaves of masses,
/// over their sum.
inline constexpr double damped_rounding =
    few_hundred_eps * 1e6 * std::numeric_limits<double>::epsilon();

/// Differences in roundings of the problem's own terms (tests/support/scaled.hpp), the KKT residual
/// as it is.
struct Agreement {
  double kkt = 0.0;        ///< of the fast masses, from the rows themselves
  double objective = 0.0;  ///< f at the fast masses and at the reference's
  double value = 0.0;      ///< what the solver says f is, and what it is
  double Phi = 0.0;        ///< what the solver says U m is, and what it is
  double masses = 0.0;     ///< lambda > 0 only: otherwise they are not unique
  /// Largest difference of two masses over the sum of all, likewise. Only if all shapes are on the
  /// same side: where a slope is no more than rounding, a mass follows that rounding over lambda,
  /// up to 1e-4 of the sum, and `masses` is its measure.
  double largest_move = 0.0;
  double motion = 0.0;       ///< || R (Phi - Phi) ||^2 against its bound, see the source
  int other_side = 0;        ///< shapes that have mass in one answer and none in the other
  double other_slope = 0.0;  ///< the largest half gradient among those (lambda > 0)
};

[[nodiscard]] Agreement agreement(const TriangleCase& given, const fast::MassSolver& solver,
                                  const Eigen::VectorXd& reference);

/// Keeps the worst of each.
void keep_worst(const Agreement& one, Agreement& worst);

/// Empty if all of it is as it should be, otherwise what is not.
[[nodiscard]] std::string why_not_equal(const Agreement& here, const TriangleCase& given,
                                        const fast::MassSolver& solver);

/// Counts cases, and prints the count and the worst differences at the end of the program.
class Tally {
 public:
  explicit Tally(const char* name) : name_(name) {}
  ~Tally();
  Tally(const Tally&) = delete;
  Tally& operator=(const Tally&) = delete;

  void count(const Agreement& here, int iterations);
  void count_declined() { ++declined_; }
  [[nodiscard]] int declined() const { return declined_; }

 private:
  const char* name_;
  int compared_ = 0, declined_ = 0, other_side_ = 0, most_iterations_ = 0;
  Agreement worst_;
};

}  // namespace shapeid::test

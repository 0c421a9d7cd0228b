#include "shapeid/proofs/certificate/consistency.hpp"

#include <array>

namespace shapeid::certificate {

Existence existence(const Vector& p) {
  // Twice the pseudo-inertia: the second moments are (tr I) / 2 - I.
  const Rational &xx = p[4], &yy = p[7], &zz = p[9];
  std::array<std::array<Rational, 4>, 4> A = {{{yy + zz - xx, -2 * p[5], -2 * p[6], 2 * p[1]},
                                               {-2 * p[5], xx + zz - yy, -2 * p[8], 2 * p[2]},
                                               {-2 * p[6], -2 * p[8], xx + yy - zz, 2 * p[3]},
                                               {2 * p[1], 2 * p[2], 2 * p[3], 2 * p[0]}}};
  Existence found = Existence::definite;
  for (std::size_t k = 0; k < 4; ++k) {
    if (sgn(A[k][k]) < 0) return Existence::impossible;
    if (sgn(A[k][k]) == 0) {  // then the rest of its row must be zero
      for (std::size_t j = k + 1; j < 4; ++j) {
        if (sgn(A[k][j]) != 0) return Existence::impossible;
      }
      found = Existence::semidefinite;
      continue;
    }
    for (std::size_t i = k + 1; i < 4; ++i) {
      const Rational factor = A[i][k] / A[k][k];
      for (std::size_t j = k + 1; j < 4; ++j) A[i][j] -= factor * A[k][j];
    }
  }
  return found;
}

}  // namespace shapeid::certificate

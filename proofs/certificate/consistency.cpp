#include "shapeid/proofs/certificate/consistency.hpp"

#include <algorithm>

#include "shapeid/proofs/certificate/linear.hpp"

namespace shapeid::certificate {

Existence existence(const Vector& p) {
  const auto is_zero = [](const Rational& x) { return x == 0; };
  if (is_zero(p[0])) {  // the form below would let second moments be there without mass
    const bool nothing = std::all_of(p.begin(), p.end(), is_zero);
    return nothing ? Existence::semidefinite : Existence::impossible;
  }
  // Twice the pseudo-inertia: the second moments are (tr I) / 2 - I.
  const Rational &xx = p[4], &yy = p[7], &zz = p[9];
  switch (sign_of_form({{yy + zz - xx, -2 * p[5], -2 * p[6], 2 * p[1]},
                        {-2 * p[5], xx + zz - yy, -2 * p[8], 2 * p[2]},
                        {-2 * p[6], -2 * p[8], xx + yy - zz, 2 * p[3]},
                        {2 * p[1], 2 * p[2], 2 * p[3], 2 * p[0]}})) {
    case Sign::positive:
      return Existence::definite;
    case Sign::nonnegative:
      return Existence::semidefinite;
    case Sign::indefinite:
      break;
  }
  return Existence::impossible;
}

}  // namespace shapeid::certificate

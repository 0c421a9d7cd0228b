#include "shapeid/diagnosis/prior.hpp"

#include <algorithm>

namespace shapeid::diagnosis {

double choose_prior(BlockFits& fits, const std::vector<Term>& terms) {
  double chosen = fits.prior();
  std::vector<double> priors;
  std::vector<Eigen::VectorXd> errors;
  // Of its natural size, one as standard deviation of each parameter, and a thirtieth. (A hundred
  // times its size was allowed, too: masses of 28 kg, for 8, then stood for an offset of torque.)
  constexpr double weakest = 1.0, strongest = 1000.0;
  double prior = 1e-4;  // as if nothing held them
  while (prior <= 1.5 * strongest) {
    fits.set_prior(prior);
    priors.push_back(prior);
    errors.push_back(fits.held_out(terms));
    prior *= 10.0;
  }
  const auto best = std::min_element(
      errors.begin(), errors.end(), [](const auto& a, const auto& b) { return a.sum() < b.sum(); });
  constexpr double told_apart = 1.0;  // standard errors, as usual in cross-validation
  // What differs by less than the square of one number's noise is no evidence, be it so in every
  // block.
  const double noise = best->sum() / std::max(1.0, fits.tally().freedom);
  for (std::size_t i = 0; i < priors.size(); ++i) {
    const double worse = errors[i].sum() - best->sum();
    if (!(worse > noise) || gain_of(errors[i], *best).t < told_apart) chosen = priors[i];
  }
  chosen = std::max(chosen, weakest);
  fits.set_prior(chosen);
  return chosen;
}

}  // namespace shapeid::diagnosis

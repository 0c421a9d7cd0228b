#include "shapeid/diagnosis/prior.hpp"

#include <algorithm>

namespace shapeid::diagnosis {

double choose_prior(BlockFits& fits, const std::vector<Term>& terms) {
  double chosen = fits.prior();
  std::vector<double> priors;
  std::vector<Eigen::VectorXd> errors;
  constexpr double strongest = 1000.0;  // a thirtieth of its natural size, for each parameter
  double prior = 1e-4;
  while (prior <= 1.5 * strongest) {
    fits.set_prior(prior);
    priors.push_back(prior);
    errors.push_back(fits.held_out(terms));
    prior *= 10.0;
  }
  const auto best = std::min_element(
      errors.begin(), errors.end(), [](const auto& a, const auto& b) { return a.sum() < b.sum(); });
  constexpr double told_apart = 1.0;  // standard errors, as usual in cross-validation
  for (std::size_t i = 0; i < priors.size(); ++i) {
    if (errors[i].sum() == best->sum() || gain_of(errors[i], *best).t < told_apart) {
      chosen = priors[i];
    }
  }
  fits.set_prior(chosen);
  return chosen;
}

}  // namespace shapeid::diagnosis

#include "shapeid/diagnosis/prior.hpp"

#include <algorithm>

namespace shapeid::diagnosis {
namespace {

// Of its natural size, one as standard deviation of each parameter, and a thirtieth. (A hundred
// times its size was allowed, too: masses of 28 kg, for 8, then stood for an offset of torque.)
constexpr double weakest = 1.0, strongest = 1000.0;
constexpr double as_if_nothing_held = 1e-4;

}  // namespace

double choose_prior(BlockFits& fits, const std::vector<Term>& terms) {
  double chosen = fits.prior();
  std::vector<double> priors;
  std::vector<Eigen::VectorXd> errors;
  double prior = as_if_nothing_held;
  while (prior <= 1.5 * strongest) {
    fits.set_prior(prior);
    priors.push_back(prior);
    errors.push_back(fits.held_out(terms));
    prior *= 10.0;
  }
  const auto best = std::min_element(
      errors.begin(), errors.end(), [](const auto& a, const auto& b) { return a.sum() < b.sum(); });
  constexpr double told_apart = 1.0;  // standard errors, as usual in cross-validation
  const double noise = fits.square_of_noise(best->sum());
  for (std::size_t i = 0; i < priors.size(); ++i) {
    const double worse = errors[i].sum() - best->sum();
    if (!(worse > noise) || gain_of(errors[i], *best).t < told_apart) chosen = priors[i];
  }
  chosen = std::max(chosen, weakest);
  fits.set_prior(chosen);
  return chosen;
}

bool masses_want_more(BlockFits fits, const std::vector<Term>& terms, double least_t) {
  fits.set_prior(weakest);
  const Eigen::VectorXd within = fits.held_out(terms);
  fits.set_prior(as_if_nothing_held);
  const Eigen::VectorXd beyond = fits.held_out(terms);
  return within.sum() - beyond.sum() > fits.square_of_noise(beyond.sum()) &&
         gain_of(within, beyond).t > least_t;
}

}  // namespace shapeid::diagnosis

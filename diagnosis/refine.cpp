#include "shapeid/diagnosis/refine.hpp"

#include <algorithm>
#include <cmath>

namespace shapeid::diagnosis {
namespace {

/// Values of one shape number for a pass.
std::vector<double> grid(const ShapeNumber& number, double present, int pass, int points,
                         double block) {
  if (number.is_moment) {
    std::vector<double> values;
    const double reach = block / std::pow(0.5 * (points - 1), pass);
    for (int i = 0; i < points; ++i) {
      const double value = present + reach * (2.0 * i / (points - 1) - 1.0);
      values.push_back(std::clamp(value, number.lower, number.upper));
    }
    return values;
  }
  double lower = std::log(number.lower), upper = std::log(number.upper);
  if (number.nearby > 0.0) {
    lower = std::log(present * (1.0 - number.nearby));
    upper = std::log(present * (1.0 + number.nearby));
  }
  if (pass > 0) {
    // One grid step of the pass before to either side.
    const double reach = (upper - lower) / std::pow(0.5 * (points - 1), pass) / 2.0;
    lower = std::log(present) - reach;
    upper = std::log(present) + reach;
  }
  std::vector<double> values;
  for (int i = 0; i < points; ++i) {
    const double value = std::exp(lower + (upper - lower) * i / (points - 1));
    values.push_back(std::clamp(value, number.lower, number.upper));
  }
  return values;
}

}  // namespace

std::vector<AppliedEffect> shape_variants(const AppliedEffect& effect, int pass, double block) {
  std::vector<AppliedEffect> variants = {effect};
  const auto& numbers = effect.effect->shape;
  const int points = numbers.size() > 1 ? 5 : 9;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const std::vector<AppliedEffect> so_far = variants;
    for (const double value : grid(numbers[k], effect.shape[at], pass, points, block)) {
      for (AppliedEffect variant : so_far) {
        variant.shape[at] = value;
        variants.push_back(variant);
      }
    }
  }
  return variants;
}

std::vector<AppliedEffect> distant_variants(const AppliedEffect& effect) {
  std::vector<AppliedEffect> variants = {effect};
  const auto& numbers = effect.effect->shape;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (!(numbers[k].nearby > 0.0)) continue;
    // Close enough that searches nearby overlap.
    const int steps = static_cast<int>(std::ceil(0.5 / numbers[k].nearby));
    for (int i = -steps; i <= steps; ++i) {
      const double octaves = static_cast<double>(i) / steps;
      AppliedEffect& variant = variants.emplace_back(effect);
      double& number = variant.shape[static_cast<Eigen::Index>(k)];
      number = std::clamp(number * std::exp2(octaves), numbers[k].lower, numbers[k].upper);
    }
  }
  return variants;
}

std::vector<std::size_t> best_variants(const BlockFits& fits, const Term& masses,
                                       const std::vector<std::vector<Term>>& choices) {
  std::vector<std::size_t> chosen(choices.size(), 0);
  const auto error = [&] {
    std::vector<Term> terms = {masses};
    for (std::size_t i = 0; i < choices.size(); ++i) terms.push_back(choices[i][chosen[i]]);
    return fits.held_out(terms).sum();
  };
  double least = error();
  constexpr int sweeps = 2;  // effects of different joints hardly interact
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = 0; i < choices.size(); ++i) {
      std::size_t best = chosen[i];
      for (std::size_t v = 0; v < choices[i].size(); ++v) {
        chosen[i] = v;
        const double e = error();
        if (e < least) {
          least = e;
          best = v;
        }
      }
      chosen[i] = best;
    }
  }
  return chosen;
}

}  // namespace shapeid::diagnosis

// With noise in gyro, accelerometer and encoders least squares has a bias: a plateau that more data
// does not cure. Smoothing the signals lowers the noise and adds a bias of its own, since products
// of smoothed signals are not smoothed products. Filtering rows instead (reference/row_filter)
// lowers both. docs/recovery.md holds the table that this test prints with SHAPEID_LONG=1.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "shapeid/tests/recovery/noisy_logs.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::base_error;
using test::BaseError;
using test::bundled_quadruped;
using test::Cutoffs;
using test::fit_base;
using test::Quadruped;

constexpr std::uint64_t seeds = 4;  // of the sensors' noise

/// One motion, logged without noise and with four noises.
class Logs {
 public:
  explicit Logs(double seconds) {
    const auto motion = test::trot(quadruped_.robot, {seconds, 500.0, 1, {}});
    test::write_log(path(0), quadruped_, motion, false, 0);
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      test::write_log(path(seed), quadruped_, motion, true, seed);
    }
  }

  [[nodiscard]] const Quadruped& quadruped() const { return quadruped_; }
  /// Log 0 has no noise.
  [[nodiscard]] std::string path(std::uint64_t log) const {
    return scratch_.path(fmt::format("{}.csv", log));
  }

 private:
  Quadruped quadruped_ = bundled_quadruped();
  test::ScratchFolder scratch_;
};

/// How the errors of one way of filtering come about.
struct Errors {
  BaseError exact;    ///< without noise: what the filter distorts
  BaseError typical;  ///< with noise, root mean square over the seeds
  BaseError bias;     ///< of the mean over the seeds
};

std::string text(const BaseError& e) {
  return fmt::format("{:.4f} {:.5f} {:.5f} {:4.1f}", e.mass, e.first_moment, e.tensor,
                     100.0 * e.principal);
}

Errors errors(const Logs& logs, const Cutoffs& cutoffs, double seconds) {
  const auto fit = [&](std::uint64_t log) {
    return fit_base(logs.path(log), logs.quadruped(), cutoffs, seconds);
  };
  std::vector<BaseError> each;
  InertialParameters mean;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const InertialParameters found = fit(seed);
    each.push_back(base_error(logs.quadruped(), found));
    mean = mean + (1.0 / seeds) * found;
  }
  const Errors result = {base_error(logs.quadruped(), fit(0)), test::rms(each),
                         base_error(logs.quadruped(), mean)};
  const auto name = [](const std::optional<double>& cutoff) {
    return cutoff ? fmt::format("{:.0f}", *cutoff) : "-";
  };
  fmt::print("| {} | {} | {:.0f} | {} | {} | {} |\n", name(cutoffs.signals), name(cutoffs.rows),
             seconds, text(result.exact), text(result.typical), text(result.bias));
  return result;
}

/// The bias in standard errors of the mean over the seeds.
double significance(double typical, double bias) {
  return bias * std::sqrt(seeds - 1.0) / std::sqrt(typical * typical - bias * bias);
}

TEST(NoiseInY, HasAPlateauThatFilteredRowsLower) {
  const bool is_long = std::getenv("SHAPEID_LONG") != nullptr;
  const double longest = is_long ? 32.0 : 8.0, shorter = longest / 4.0;
  const Logs logs(longest);
  fmt::print(
      "each: mass kg, first moment kg m, tensor kg m^2, worst principal inertia percent\n"
      "| signals Hz | rows Hz | s | without noise | with noise | bias "
      "|\n|---|---|---|---|---|---|\n");
  const auto at_lengths = [&](const Cutoffs& cutoffs) {
    if (is_long) errors(logs, cutoffs, 2.0);
    const Errors before = errors(logs, cutoffs, shorter);
    return std::pair{before, errors(logs, cutoffs, longest)};
  };
  const auto raw = at_lengths({{}, {}}).second;
  for (const double cutoff : {5.0, 10.0}) at_lengths({cutoff, {}});
  const auto [usual_before, usual] = at_lengths({20.0, {}});
  for (const double cutoff : {40.0, 80.0}) at_lengths({cutoff, {}});
  at_lengths({{}, 20.0});
  const auto rows = at_lengths({80.0, 20.0}).second;

  // Smoothing helps against noise ...
  EXPECT_LT(usual.typical.mass, 0.5 * raw.typical.mass);
  EXPECT_LT(raw.exact.mass, 0.5 * raw.typical.mass) << "it was not noise that smoothing removed";
  // ... but leaves a bias, far beyond chance (five standard errors of a mean of four) ...
  EXPECT_GT(significance(usual.typical.first_moment, usual.bias.first_moment), 5.0);
  EXPECT_GT(significance(usual.typical.tensor, usual.bias.tensor), 5.0);
  // ... and four times the data do not halve it, as they would halve an error of chance. The
  // bound lies between a half and one.
  constexpr double no_cure = 0.71;
  EXPECT_GT(usual.typical.first_moment, no_cure * usual_before.typical.first_moment);
  EXPECT_GT(usual.typical.tensor, no_cure * usual_before.typical.tensor);
  // Filtered rows: less than half of the error in every group, with noise and without.
  for (const auto entry :
       {&BaseError::mass, &BaseError::first_moment, &BaseError::tensor, &BaseError::principal}) {
    EXPECT_LT(rows.typical.*entry, 0.5 * usual.typical.*entry);
    EXPECT_LT(rows.exact.*entry, 0.5 * usual.exact.*entry);
  }
}

}  // namespace
}  // namespace shapeid

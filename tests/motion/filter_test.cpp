#include "shapeid/models/butterworth.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "shapeid/models/differences.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/segment_filter.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using std::numbers::pi;
using test::few_hundred_eps;
using test::scaled;

struct Drawn {
  int order;
  double cutoff, rate;
};

Drawn draw_filter() {
  const double rate = *test::real(50.0, 2000.0);
  return {*rc::gen::inRange(1, 9), rate * *test::real(0.01, 0.45), rate};
}

/// H at a frequency from the sections alone, on the unit circle.
std::complex<double> response(const Butterworth& design, double frequency, double rate) {
  const std::complex<double> z1 = std::polar(1.0, -2.0 * pi * frequency / rate);
  std::complex<double> H = 1.0;
  for (const Section& s : design.sections()) {
    H *= (s.b0 + z1 * (s.b1 + z1 * s.b2)) / (1.0 + z1 * (s.a1 + z1 * s.a2));
  }
  return H;
}

// The sections have a pole close to one at low cutoffs: 1 + a1 + a2 is then a small difference,
// which the bound divides by.
double conditioning(const Drawn& f) { return std::pow(f.rate / f.cutoff, 2); }

RC_GTEST_PROP(Butterworth, SectionsHaveTheGainOfTheClosedForm, ()) {
  const Drawn f = draw_filter();
  const Butterworth design(f.order, f.cutoff, f.rate);
  const double frequency = f.rate * *test::real(0.0, 0.49);
  const double measured = std::abs(response(design, frequency, f.rate));
  RC_ASSERT(scaled(std::abs(measured - design.gain(frequency)), conditioning(f), f.order) <
            few_hundred_eps);
  RC_ASSERT(scaled(std::abs(design.gain(f.cutoff) - std::sqrt(0.5)), 1.0, f.order) <
            few_hundred_eps);
}

// The phase of the sections, differentiated by a five-point difference.
RC_GTEST_PROP(Butterworth, SectionsHaveTheGroupDelayOfTheClosedForm, ()) {
  const Drawn f = draw_filter();
  const Butterworth design(f.order, f.cutoff, f.rate);
  const double frequency = f.cutoff * *test::real(0.0, 1.0);
  const double h = f.cutoff * 1e-4;
  const auto phase = [&](int k) {
    return std::arg(response(design, frequency + k * h, f.rate) /
                    response(design, frequency, f.rate));
  };
  const double slope = (8.0 * (phase(1) - phase(-1)) - (phase(2) - phase(-2))) / (12.0 * h);
  const double measured = -slope / (2.0 * pi);
  // Rounding of the phase over the step dominates the h^5 of the difference, also where the
  // bilinear transform stretches frequencies twentyfold.
  RC_ASSERT(scaled(std::abs(measured - design.group_delay(frequency)) * h * 2.0 * pi,
                   conditioning(f), f.order) < few_hundred_eps);
}

TEST(Butterworth, DelayAtLowFrequencyIsKnown) {
  // 1 / (2 rate tan(pi fc / rate) sin(pi / 2n)), the sum over all poles
  for (int order = 1; order <= 8; ++order) {
    const Butterworth design(order, 20.0, 500.0);
    const double known =
        1.0 / (1000.0 * std::tan(pi * 20.0 / 500.0) * std::sin(pi / (2.0 * order)));
    EXPECT_LT(scaled(std::abs(design.group_delay(0.0) - known), known, order), few_hundred_eps);
  }
}

// A slow ramp comes out late by the group delay, and by nothing from two passes.
TEST(SegmentFilter, RampsAreLateByTheGroupDelay) {
  const double rate = 500.0;
  const Butterworth design(3, 25.0, rate);
  for (const Smoothing smoothing : {Smoothing::causal, Smoothing::zero_phase}) {
    SegmentFilter filter(smoothing, design, 1);
    std::vector<double> out;
    for (int k = 0; k < 2000; ++k) filter.push(Eigen::VectorXd::Constant(1, 3.0 * k / rate));
    filter.finish();
    while (const auto row = filter.next()) out.push_back((*row)[0]);
    ASSERT_EQ(out.size(), 2000u);
    const double late = 1000.0 / rate - out[1000] / 3.0;
    const double expected = smoothing == Smoothing::causal ? design.group_delay(0.0) : 0.0;
    EXPECT_LT(scaled(std::abs(late - expected), 1000.0 / rate, 100), few_hundred_eps);
  }
}

// The bilinear transform takes a pole s of the prototype to (1 + K s) / (1 - K s); what is left of
// a start shrinks by the largest of their magnitudes a row.
RC_GTEST_PROP(Butterworth, DecaysAsItsSlowestPole, ()) {
  const Drawn f = draw_filter();
  const double K = std::tan(pi * f.cutoff / f.rate), fraction = *test::magnitude(1e-12, 0.5);
  double radius = 0.0;
  for (int k = 1; k <= f.order; ++k) {
    const std::complex<double> s = std::polar(1.0, pi * (2 * k + f.order - 1) / (2.0 * f.order));
    radius = std::max(radius, std::abs((1.0 + K * s) / (1.0 - K * s)));
  }
  const auto rows =
      static_cast<double>(Butterworth(f.order, f.cutoff, f.rate).samples_to_decay(fraction));
  const double wanted = std::log(fraction) / std::log(radius);
  // A section's pole is the root of its coefficients, whose roundings the slow ones double.
  constexpr double roundings = 1e-6;
  RC_ASSERT(rows >= wanted * (1.0 - roundings));
  RC_ASSERT(rows <= wanted * (1.0 + roundings) + 1.0);
}

TEST(Butterworth, APoleNearZeroIsForgottenAtOnce) {
  EXPECT_EQ(Butterworth(1, 125.0, 500.0).samples_to_decay(1e-3), 1);
  // So far below the rate that the poles round to one, nothing is forgotten.
  for (const double cutoff : {1e-8, 1e-20, 1e-300}) {
    EXPECT_GT(Butterworth(2, cutoff, 500.0).samples_to_decay(1e-3), 1000000) << cutoff;
  }
}

/// The textbook: extend by reflection, forward over all, backward over all.
Eigen::MatrixXd whole_segment(const Butterworth& design, const Eigen::MatrixXd& x,
                              Eigen::Index reflected) {
  const Eigen::Index n = x.cols();
  Eigen::MatrixXd extended(x.rows(), n + 2 * reflected);
  extended.middleCols(reflected, n) = x;
  for (Eigen::Index k = 1; k <= reflected; ++k) {
    extended.col(reflected - k) = 2.0 * x.col(0) - x.col(k);
    extended.col(reflected + n - 1 + k) = 2.0 * x.col(n - 1) - x.col(n - 1 - k);
  }
  for (int pass = 0; pass < 2; ++pass) {
    FilterState state(design, x.rows());
    state.settle(extended.col(0));
    for (Eigen::Index k = 0; k < extended.cols(); ++k) {
      extended.col(k) = state.step(extended.col(k)).eval();
    }
    extended = extended.rowwise().reverse().eval();
  }
  return extended.middleCols(reflected, n);
}

Eigen::MatrixXd noise(Eigen::Index rows, Eigen::Index cols, std::uint32_t seed) {
  std::srand(seed);
  return Eigen::MatrixXd::Random(rows, cols);
}

RC_GTEST_PROP(SegmentFilter, ChunksEqualTheWholeSegment, ()) {
  const Drawn f = draw_filter();
  const Butterworth design(f.order, f.cutoff, f.rate);
  SegmentFilter filter(Smoothing::zero_phase, design, 2);
  const Eigen::Index n = *rc::gen::inRange<Eigen::Index>(filter.unsettled() + 1, 6000);
  RC_PRE(n > filter.unsettled() + 1);
  const Eigen::MatrixXd x = noise(2, n, *rc::gen::arbitrary<std::uint32_t>());
  Eigen::MatrixXd chunked(2, n);
  Eigen::Index out = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    filter.push(x.col(k));
    while (const auto row = filter.next()) chunked.col(out++) = *row;
  }
  filter.finish();
  while (const auto row = filter.next()) chunked.col(out++) = *row;
  RC_ASSERT(out == n);
  const Eigen::MatrixXd whole = whole_segment(design, x, filter.unsettled());
  RC_ASSERT(scaled((chunked - whole).lpNorm<Eigen::Infinity>(), conditioning(f), f.order) <
            few_hundred_eps);
}

TEST(SegmentFilter, GainOfTwoPassesIsThatOfOneSquared) {
  const double rate = 500.0, frequency = 15.0;
  const Butterworth design(2, 20.0, rate);
  SegmentFilter filter(Smoothing::zero_phase, design, 1);
  const auto wave = [&](int k) { return std::sin(2.0 * pi * frequency * k / rate); };
  for (int k = 0; k < 3000; ++k) filter.push(Eigen::VectorXd::Constant(1, wave(k)));
  filter.finish();
  const double gain = std::pow(design.gain(frequency), 2);
  for (int k = 0; k < 3000; ++k) {
    const auto row = filter.next();
    ASSERT_TRUE(row);
    if (k > 1000 && k < 2000) {
      EXPECT_LT(scaled(std::abs((*row)[0] - gain * wave(k)), 1.0, 100), few_hundred_eps);
    }
  }
}

// What the default margin around changes of contact rests on: the autocorrelation of the impulse
// response sqrt(2) exp(-t / sqrt 2) sin(t / sqrt 2), in units of the cutoff's angular frequency.
TEST(SegmentFilter, ImpulseResponseOfTwoPassesIsShort) {
  const double rate = 8000.0, cutoff = 20.0;  // fine against the cutoff: the analog closed form
  SegmentFilter filter(Smoothing::zero_phase, Butterworth(2, cutoff, rate), 1);
  constexpr int middle = 3000;
  for (int k = 0; k <= 2 * middle; ++k) {
    filter.push(Eigen::VectorXd::Constant(1, k == middle ? 1.0 : 0.0));
  }
  filter.finish();
  std::vector<double> response;
  while (const auto row = filter.next()) response.push_back((*row)[0]);
  const double peak = response[middle];
  for (const double periods : {0.1, 0.25, 0.5, 0.75}) {
    const double x = 2.0 * pi * periods / std::sqrt(2.0);
    const double closed = std::exp(-x) * (std::cos(x) + std::sin(x));
    const auto at = static_cast<std::size_t>(middle + std::lround(periods * rate / cutoff));
    // The bilinear transform is off by (pi cutoff / rate)^2 in relative terms.
    EXPECT_LT(std::abs(response[at] / peak - closed), std::pow(pi * cutoff / rate, 2) * 10.0);
    if (periods >= 0.5) {
      EXPECT_LT(std::abs(response[at]), 0.05 * peak);
    }
  }
}

// White noise through the filter itself.
TEST(SegmentFilter, LeavesOfWhiteNoiseWhatItSays) {
  for (const double cutoff : {20.0, 80.0}) {
    const double rate = 250.0;
    constexpr int samples = 40000;
    SegmentFilter filter(Smoothing::zero_phase, Butterworth(log_filter_order, cutoff, rate), 1);
    test::Draw draw(17);
    std::vector<double> noise;
    for (int k = 0; k < samples; ++k) {
      noise.push_back(draw.normal());
      filter.push(Eigen::VectorXd::Constant(1, noise.back()));
    }
    filter.finish();
    double left = 0.0, taken = 0.0;
    for (const double raw : noise) {
      const double smooth = (*filter.next())[0];
      left += smooth * smooth;
      taken += (raw - smooth) * (raw - smooth);
    }
    // The root of the mean of some 5000 independent squares scatters by a percent: three of them.
    EXPECT_NEAR(std::sqrt(left / taken) / noise_left_over_taken(cutoff, rate), 1.0, 0.03);
  }
}

TEST(SegmentFilter, ShortSegmentsAreLost) {
  SegmentFilter filter(Smoothing::zero_phase, Butterworth(2, 20.0, 500.0), 1);
  for (Eigen::Index k = 0; k < filter.unsettled(); ++k) filter.push(Eigen::VectorXd::Ones(1));
  filter.finish();
  EXPECT_FALSE(filter.next());
}

TEST(Butterworth, RefusesWhatItCannotBe) {
  EXPECT_THROW(Butterworth(0, 20.0, 500.0), InputError);
  EXPECT_THROW(Butterworth(9, 20.0, 500.0), InputError);
  EXPECT_THROW(Butterworth(2, 0.0, 500.0), InputError);
  EXPECT_THROW(Butterworth(2, 250.0, 500.0), InputError);
}

/// Five samples of a function around t.
template <typename Function>
Stencil stencil(const Function& f, double t, double h) {
  Stencil s;
  for (int k = 0; k < 5; ++k) {
    s[static_cast<std::size_t>(k)] = Eigen::VectorXd::Constant(1, f(t + (k - 2) * h));
  }
  return s;
}

TEST(Differences, ExactOnPolynomialsOfTheirOrder) {
  const double h = 0.25, t = 0.75;  // dyadic: no rounding in the arguments
  const auto quartic = [](double x) { return x * x * x * x - 2.0 * x * x * x + 3.0 * x - 1.0; };
  EXPECT_LT(scaled(std::abs(first_derivative(stencil(quartic, t, h), 1.0 / h)[0] -
                            (4.0 * t * t * t - 6.0 * t * t + 3.0)),
                   1.0 / h, 5),
            few_hundred_eps);
  EXPECT_LT(scaled(std::abs(second_derivative(stencil(quartic, t, h), 1.0 / h)[0] -
                            (12.0 * t * t - 12.0 * t)),
                   1.0 / (h * h), 5),
            few_hundred_eps);
}

// On exp(i w t) both operators are known factors: i w (8 sin a - sin 2a) / 6a and
// -w^2 (15 - 16 cos a + cos 2a) / 6a^2 with a = w h.
TEST(Differences, KnownFactorsOnSines) {
  const double h = 0.002, w = 2.0 * pi * 20.0, a = w * h, t = 0.3;
  const auto sine = [&](double x) { return std::sin(w * x); };
  const double first = w * (8.0 * std::sin(a) - std::sin(2.0 * a)) / (6.0 * a);
  const double second = -w * w * (15.0 - 16.0 * std::cos(a) + std::cos(2.0 * a)) / (6.0 * a * a);
  EXPECT_LT(
      scaled(std::abs(first_derivative(stencil(sine, t, h), 1.0 / h)[0] - first * std::cos(w * t)),
             1.0 / h, 5),
      few_hundred_eps);
  EXPECT_LT(scaled(std::abs(second_derivative(stencil(sine, t, h), 1.0 / h)[0] -
                            second * std::sin(w * t)),
                   1.0 / (h * h), 5),
            few_hundred_eps);
  EXPECT_LT(std::abs(first / w - 1.0), std::pow(a, 4) / 30.0);
  EXPECT_LT(std::abs(second / (w * w) + 1.0), std::pow(a, 4) / 90.0);
}

}  // namespace
}  // namespace shapeid

// Every continuous-time term of the error chain has the same statistics at any sample rate, from 25 to 1000 Hz, and a
// run made in shards is the run made at once. Simulators that define sigma per sample fail the first part by the root
// of the rate: the last test shows that these bands notice.
#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/inertial/allan/noise_terms.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/errors/flicker.h"

namespace canyon::inertial {
namespace {

constexpr double kRates_hz[] = {25.0, 100.0, 250.0, 1000.0};
constexpr double kDuration_s = 40.96;
constexpr int kRuns = 500;  // times three axes
constexpr double kWindows_s[] = {0.08, 0.64, 2.56, 10.24};

/// The errors that one link adds to the gyroscope over a run, in rad, sample by sample.
class LinkRun {
 public:
  LinkRun(const char* name, const TriadFigures& figures, std::uint64_t seed, double rate_hz) {
    LinkSetup setup;
    setup.figures.gyro = figures;
    setup.seed = seed;
    setup.dt_s = 1.0 / rate_hz;
    for (const auto& row : error_links()) {
      if (std::string_view(row.name) == name) link_ = row.make(setup);
    }
    EXPECT_NE(link_, nullptr) << name;
  }
  /// axis-major: three series of `count` samples from `first` on.
  std::array<std::vector<double>, 3> errors(std::int64_t first, std::int64_t count) {
    std::array<std::vector<double>, 3> out;
    while (count > 0) {
      block_.first = first;
      block_.count = std::min<std::size_t>(static_cast<std::size_t>(count), kImuBlock - block_.offset());
      for (auto& axis : block_.triads[0].output) axis.fill(0.0);
      link_->apply(block_);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto& x = block_.triads[0].output[axis];
        out[axis].insert(out[axis].end(), x.begin(), x.begin() + static_cast<std::ptrdiff_t>(block_.count));
      }
      first += static_cast<std::int64_t>(block_.count);
      count -= static_cast<std::int64_t>(block_.count);
    }
    return out;
  }

 private:
  std::unique_ptr<ErrorLink> link_;
  ImuBlock block_{};
};

/// Of the continuous process.
double gauss_markov_variance(double sigma, double correlation_s, double tau_s) {
  return allan_variance(kGaussMarkov, sigma, correlation_s, tau_s, 0.0);
}

/// Allan variance at tau of the rate, from the two windows of length tau in the middle of each run: independent from
/// run to run and axis to axis, so that the estimate has 3 kRuns degrees of freedom.
double allan_variance_of_runs(const char* name, const TriadFigures& figures, double rate_hz, double tau_s) {
  const std::int64_t samples = std::llround(kDuration_s * rate_hz), m = std::llround(tau_s * rate_hz);
  const std::int64_t first = (samples / 2) - m;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    LinkRun link(name, figures, static_cast<std::uint64_t>(run), rate_hz);
    for (const auto& x : link.errors(first, 2 * m)) {
      double difference = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) difference += i < static_cast<std::size_t>(m) ? -x[i] : x[i];
      sum += 0.5 * difference * difference / (tau_s * tau_s);
    }
  }
  return sum / (3 * kRuns);
}

/// A chi-square with n degrees of freedom over n: five standard deviations (false alarm 6e-7 each, 48 comparisons).
double band() {
  return 5.0 * std::sqrt(2.0 / (3 * kRuns));
}

template <class Expected>
void expect_at_all_rates(const char* name, const TriadFigures& figures, Expected expected) {
  for (const double rate_hz : kRates_hz) {
    for (const double tau_s : kWindows_s) {
      const double ratio = allan_variance_of_runs(name, figures, rate_hz, tau_s) / expected(tau_s);
      EXPECT_NEAR(ratio, 1.0, band()) << name << " at " << rate_hz << " Hz, tau " << tau_s << " s";
    }
  }
}

TriadFigures one(double TriadFigures::*figure, double value) {
  TriadFigures f;
  f.*figure = value;
  return f;
}

TEST(ContinuousTerms, WhiteNoiseAtAnyRate) {
  const double n = 3e-4;
  expect_at_all_rates("white_noise", one(&TriadFigures::white_per_sqrt_hz, n),
                      [&](double tau_s) { return n * n / tau_s; });
}

TEST(ContinuousTerms, GaussMarkovAtAnyRate) {
  TriadFigures f = one(&TriadFigures::in_run_bias, 2e-3);
  f.in_run_bias_tau_s = 0.7;
  expect_at_all_rates("in_run_bias", f,
                      [&](double tau_s) { return gauss_markov_variance(f.in_run_bias, f.in_run_bias_tau_s, tau_s); });
}

/// Corners inside and outside what the slowest rate can show (Nyquist at 12.5 Hz).
TEST(ContinuousTerms, FlickerBetweenStatedCornersAtAnyRate) {
  for (const double high_hz : {2.0, 40.0}) {
    TriadFigures f = one(&TriadFigures::bias_instability, 1e-3);
    f.flicker_low_hz = 0.005;
    f.flicker_high_hz = high_hz;
    const auto parts = flicker_parts(f.bias_instability, f.flicker_low_hz, f.flicker_high_hz);
    expect_at_all_rates("flicker", f, [&](double tau_s) {
      double sum = 0.0;
      for (const FlickerPart& part : parts) sum += gauss_markov_variance(part.sigma, part.tau_s, tau_s);
      return sum;
    });
  }
}

TEST(ContinuousTerms, RateRandomWalkAtAnyRate) {
  const double k = 2e-4;
  expect_at_all_rates("rate_random_walk", one(&TriadFigures::rate_random_walk, k),
                      [&](double tau_s) { return k * k * tau_s / 3.0; });
}

/// Not random but for its sign: exact to rounding of the sums (N eps, N <= 20480).
TEST(ContinuousTerms, RampAtAnyRate) {
  const double r = 1e-5;
  for (const double rate_hz : kRates_hz) {
    for (const double tau_s : kWindows_s) {
      const double ratio = allan_variance_of_runs("ramp", one(&TriadFigures::ramp, r), rate_hz, tau_s);
      EXPECT_NEAR(ratio / (r * r * tau_s * tau_s / 2.0), 1.0, 1e-10) << rate_hz << " " << tau_s;
    }
  }
}

/// The sum of the parts is 1/f: the density of each Gauss-Markov part is 4 s^2 tau / (1 + (2 pi f tau)^2) one-sided,
/// that of flicker noise B^2 / (pi f), and a continuum of parts between two corners gives (2 / pi) (atan(high / f) -
/// atan(low / f)) of it. Parts in steps of h = ln 4 ripple about that by 2 / cosh(pi^2 / h), and the ends of the row,
/// as with any midpoint rule, cost h^2 / 24 times the slope there, (1 / pi) / cosh(ln(f / corner)).
TEST(ContinuousTerms, FlickerIsOneOverF) {
  const double floor = 1e-3, b2 = floor * floor * kPi / (2.0 * std::log(2.0));
  const double low_hz = 1e-4, high_hz = 10.0;
  const auto density = [&](double f_hz) {
    double sum = 0.0;
    for (const FlickerPart& p : flicker_parts(floor, low_hz, high_hz)) {
      const double x = 2.0 * kPi * f_hz * p.tau_s;
      sum += 4.0 * p.sigma * p.sigma * p.tau_s / (1.0 + x * x);
    }
    return sum;
  };
  double variance = 0.0;
  for (const FlickerPart& p : flicker_parts(floor, low_hz, high_hz)) variance += p.sigma * p.sigma;
  EXPECT_NEAR(variance / (b2 / kPi * std::log(high_hz / low_hz)), 1.0, 1e-12);
  const double h = std::log(4.0), ripple = 2.0 / std::cosh(kPi * kPi / h);
  for (double f_hz = 2.0 * low_hz; f_hz < 0.5 * high_hz; f_hz *= 1.3) {
    const double law = (std::atan(high_hz / f_hz) - std::atan(low_hz / f_hz)) * 2.0 / kPi;
    const double ends =
        h * h / 24.0 / kPi * (1.0 / std::cosh(std::log(f_hz / low_hz)) + 1.0 / std::cosh(std::log(high_hz / f_hz)));
    EXPECT_NEAR(density(f_hz) / (b2 / (kPi * f_hz)), law, ripple + ends) << f_hz;
  }
  // The floor of the Allan deviation, in the middle of the decades.
  double avar = 0.0;
  for (const FlickerPart& p : flicker_parts(floor, low_hz, high_hz)) {
    avar += gauss_markov_variance(p.sigma, p.tau_s, 5.0);
  }
  EXPECT_NEAR(std::sqrt(avar) / floor, 1.0, 0.01);
}

/// Shards of any length, each made by a link of its own, put together: the same bits as one run.
TEST(ContinuousTerms, ShardsMakeTheSameRun) {
  TriadFigures f;
  f.white_per_sqrt_hz = f.in_run_bias = f.bias_instability = f.rate_random_walk = f.ramp = f.quantization_noise = 1e-3;
  f.in_run_bias_tau_s = 5.0;
  for (const char* name : {"white_noise", "in_run_bias", "flicker", "rate_random_walk", "ramp", "quantization_noise"}) {
    const auto whole = LinkRun(name, f, 3, 100.0).errors(0, 3000);
    std::int64_t first = 0;
    for (const std::int64_t length : {1, 700, 255, 1024, 1020}) {
      const auto shard = LinkRun(name, f, 3, 100.0).errors(first, length);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < shard[axis].size(); ++i) {
          ASSERT_EQ(shard[axis][i], whole[axis][static_cast<std::size_t>(first) + i]) << name << " " << first + 1;
        }
      }
      first += length;
    }
    ASSERT_EQ(first, 3000);
  }
}

/// A sigma per sample, taken over unchanged from one rate to twice that rate, halves the density: outside the bands.
TEST(ContinuousTerms, TheBandsNoticeASigmaPerSample) {
  const double n = 3e-4, tau_s = 0.64;
  const TriadFigures halved = one(&TriadFigures::white_per_sqrt_hz, n / std::sqrt(2.0));
  EXPECT_LT(allan_variance_of_runs("white_noise", halved, 25.0, tau_s) / (n * n / tau_s), 1.0 - band());
}

}  // namespace
}  // namespace canyon::inertial

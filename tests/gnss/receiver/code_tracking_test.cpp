#include "canyon/gnss/receiver/code_tracking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

CorrelatorDesign design(Modulation modulation, double spacing_chips, bool coherent = true) {
  CorrelatorDesign d;
  d.modulation = modulation;
  d.spacing_chips = spacing_chips;
  d.coherent = coherent;
  return d;
}

/// Error of a direct signal of amplitude 1 beside echoes.
std::optional<double> error_m(const CodeTracking& tracking, std::vector<EchoSignal> echoes) {
  echoes.insert(echoes.begin(), EchoSignal{0.0, 1.0, 0.0, 0.0});
  const auto lock = tracking.track(echoes);
  if (!lock) return std::nullopt;
  return lock->delay_m;
}

/// One echo of signed relative amplitude (negative = opposite phase), in chips of 293 m.
double error_chips(const CodeTracking& tracking, double a, double delay_chips) {
  const double chip_m = tracking.correlation().chip_m();
  const auto e = error_m(tracking, {{delay_chips * chip_m, std::abs(a), a > 0.0 ? 0.0 : kPi, 0.0}});
  EXPECT_TRUE(e.has_value()) << a << " " << delay_chips;
  return e.value_or(kNaN) / chip_m;
}

/// Closed form of the coherent early-minus-late multipath error for BPSK, infinite bandwidth, in chips (Braasch 1996;
/// van Nee 1993): `a` is the signed relative amplitude, d the early-late spacing, x the delay.
double bpsk_envelope(double a, double d, double x) {
  if (x <= 0.5 * d * (1.0 + a)) return a * x / (1.0 + a);
  if (x <= 1.0 + 0.5 * d * (a - 1.0)) return 0.5 * a * d;
  if (x <= 1.0 + 0.5 * d) return a / (2.0 - a) * (1.0 + 0.5 * d - x);
  return 0.0;
}

/// The same for BOC(1,1), from its correlation's pieces (slopes -3 and 1), for d < 1/2: the direct discriminator is 6
/// t; the echo's runs through -3 d, back over 4 (x - t - 1/2) to d, and down to 0 at 1 + d/2.
double boc_envelope(double a, double d, double x) {
  if (x <= 0.5 * d * (1.0 + a)) return a * x / (1.0 + a);
  if (x <= 0.5 - 0.5 * d + 0.5 * a * d) return 0.5 * a * d;
  if (x <= 0.5 + 0.5 * d - a * d / 6.0) return a * (d + 2.0 - 4.0 * x) / (6.0 - 4.0 * a);
  if (x <= 1.0 - 0.5 * d - a * d / 6.0) return -a * d / 6.0;
  if (x <= 1.0 + 0.5 * d) return -a * (1.0 + 0.5 * d - x) / (6.0 + a);
  return 0.0;
}

// Half amplitude, at rest, infinite bandwidth, coherent: the whole envelope, both phases, equals the closed form; its
// peaks are 73.3 and 7.33 m.
TEST(CodeTracking, EnvelopeAgainstTheClosedForm) {
  struct Case {
    Modulation modulation;
    double spacing;
    double (*closed_form)(double, double, double);
    double peak_m;
  };
  for (const Case& c : {Case{Modulation::kBpsk1, 1.0, bpsk_envelope, 73.263},
                        {Modulation::kBpsk1, 0.5, bpsk_envelope, 36.631},
                        {Modulation::kBpsk1, 0.1, bpsk_envelope, 7.326},
                        {Modulation::kBoc11, 0.1, boc_envelope, 7.326},
                        {Modulation::kBpsk10, 0.5, bpsk_envelope, 3.6631}}) {
    for (const bool coherent : {true, false}) {  // with real signals |E|^2 - |L|^2 = (E - L) (E + L) has the same zero
      const CodeTracking tracking(design(c.modulation, c.spacing, coherent));
      const double chip_m = tracking.correlation().chip_m();
      double peak_m = 0.0, worst_m = 0.0;
      for (const double a : {0.5, -0.5}) {
        for (double x = 0.0; x <= 1.7; x += 0.003) {
          const double e = error_chips(tracking, a, x);
          worst_m = std::max(worst_m, std::abs(e - c.closed_form(a, c.spacing, x)) * chip_m);
          if (a > 0.0) peak_m = std::max(peak_m, e * chip_m);
        }
      }
      EXPECT_NEAR(peak_m, c.peak_m, 1e-3) << c.spacing;
      EXPECT_LT(worst_m, coherent ? 1e-9 : 1e-6) << c.spacing << " of a peak of " << peak_m << " m";
    }
  }
}

TEST(CodeTracking, OtherAmplitudes) {
  const CodeTracking tracking(design(Modulation::kBpsk1, 0.1));
  for (const double a : {0.1, -0.1, 0.9, -0.9})
    for (double x = 0.0; x <= 1.2; x += 0.007)
      EXPECT_NEAR(error_chips(tracking, a, x), bpsk_envelope(a, 0.1, x), 1e-12) << a << " " << x;
}

// What the strobe correlator is made for: no error at all for echoes between about one and a half spacings and one chip
// less than that.
TEST(CodeTracking, DoubleDeltaShedsMediumDelays) {
  CorrelatorDesign d = design(Modulation::kBpsk1, 0.1);
  const CodeTracking narrow(d);
  d.double_delta = true;
  const CodeTracking strobe(d);
  double peak = 0.0;
  for (double x = 0.0; x <= 1.3; x += 0.002) {
    const double e = error_chips(strobe, 0.5, x);
    peak = std::max(peak, std::abs(e));
    if (x > 0.16 && x < 0.89) {
      EXPECT_NEAR(e, 0.0, 1e-12) << x;
      EXPECT_NEAR(error_chips(narrow, 0.5, x), 0.025, 1e-12);
    }
  }
  EXPECT_NEAR(peak, 0.025, 1e-3);  // within a spacing of the peak it does as badly as the narrow one
}

// A front end of finite width rounds the peak: a narrow spacing gains less than in the infinite band, a wide one
// nothing but rounded corners; as the band grows the error tends to the closed form as 1 / B.
TEST(CodeTracking, FiniteBandTendsToTheClosedForm) {
  const auto worst = [&](double front_end_hz, double spacing) {
    CorrelatorDesign d = design(Modulation::kBpsk1, spacing);
    d.front_end_hz = front_end_hz;
    const CodeTracking tracking(d);
    double most = 0.0;
    for (const double a : {0.5, -0.5})
      for (double x = 0.0; x <= 1.3; x += 0.01)
        most = std::max(most, std::abs(error_chips(tracking, a, x) - bpsk_envelope(a, spacing, x)));
    return most;
  };
  const double at_8 = worst(8e6, 1.0), at_16 = worst(16e6, 1.0), at_64 = worst(64e6, 1.0);
  EXPECT_LT(at_16, at_8);
  EXPECT_LT(at_64, 0.35 * at_16);
  EXPECT_LT(at_64, 0.01 * 0.25);              // 1 % of the peak
  EXPECT_GT(worst(2.2e6, 0.1), 1.0 * 0.025);  // 2 MHz cannot use a narrow spacing: it errs by more than the whole peak
}

TEST(CodeTracking, NoEchoesQuadratureAndFarEchoes) {
  const CodeTracking tracking(design(Modulation::kBpsk1, 0.5));
  EXPECT_EQ(error_m(tracking, {}), 0.0);
  EXPECT_FALSE(tracking.track({}).has_value());
  EXPECT_NEAR(*error_m(tracking, {{3.0 * kCaChipM, 0.9, 0.0, 0.0}}), 0.0, 1e-12);
}

// Zero of the composite's discriminator, evaluated anew here by brute force on a fine grid, with the carrier phase of
// the composite at the direct signal's peak.
TEST(CodeTracking, SeveralEchoes) {
  const std::vector<EchoSignal> echoes = {{10.0, 0.3, 0.4, 0.0}, {60.0, 0.4, 2.9, 0.0}, {200.0, 0.2, -1.0, 0.0}};
  const double d = 0.5;
  const auto triangle = [](double x) { return std::max(0.0, 1.0 - std::abs(x)); };
  const auto sum = [&](double t) {
    std::complex<double> s = triangle(t);
    for (const auto& e : echoes) s += std::polar(e.amplitude, e.phase_rad) * triangle(t - e.delay_m / kCaChipM);
    return s;
  };
  for (const bool coherent : {true, false}) {
    const std::complex<double> carrier = std::conj(sum(0.0)) / std::abs(sum(0.0));
    const auto value = [&](double t) {
      const auto early = sum(t - d / 2), late = sum(t + d / 2);
      return coherent ? (carrier * (early - late)).real() : std::norm(early) - std::norm(late);
    };
    const double step = 1e-6;
    double zero = 10.0;
    for (double t = -0.5; t < 0.5; t += step)
      if (value(t) < 0.0 && value(t + step) >= 0.0 && std::abs(t) < std::abs(zero)) zero = t + 0.5 * step;
    const CodeTracking tracking(design(Modulation::kBpsk1, d, coherent));
    EXPECT_NEAR(*error_m(tracking, echoes), zero * kCaChipM, step * kCaChipM) << coherent;
  }
}

TEST(CodeTracking, CancelledSignalHasNoZero) {
  for (const bool coherent : {true, false})
    EXPECT_FALSE(error_m(CodeTracking(design(Modulation::kBpsk1, 0.5, coherent)), {{0.0, 1.0, kPi, 0.0}}).has_value());
}

TEST(CodeTracking, AmplitudeAndPhaseOfTheComposite) {
  const CodeTracking tracking(design(Modulation::kBpsk1, 0.1));
  const std::vector<EchoSignal> in_phase = {{0.0, 1.0, 0.3, 0.0}, {0.5 * kCaChipM, 0.4, 0.3, 0.0}};
  const auto lock = tracking.track(in_phase);
  // The code stands at a d / 2 = 0.02 chips: there the direct signal correlates by 0.98, the echo by 0.52.
  EXPECT_NEAR(lock->amplitude, 0.98 + 0.4 * 0.52, 1e-12);
  EXPECT_NEAR(lock->phase_rad, 0.3, 1e-12);
  // In quadrature the carrier turns by atan(a R(delay)) at most (van Nee 1993), 26.6 deg for half amplitude.
  const std::vector<EchoSignal> quadrature = {{0.0, 1.0, 0.0, 0.0}, {1e-6, 0.5, kPi / 2, 0.0}};
  EXPECT_NEAR(tracking.track(quadrature)->phase_rad, std::atan(0.5), 1e-6);
}

// Where the direct signal is much weaker than an echo the receiver locks on to the echo.
TEST(CodeTracking, TheStrongestSignalIsTracked) {
  const CodeTracking tracking(design(Modulation::kBpsk1, 0.1));
  const std::vector<EchoSignal> signals = {{0.0, 0.01, 0.0, 0.0}, {80.0, 0.5, 1.0, 3.0}};
  const auto lock = tracking.track(signals);
  EXPECT_EQ(lock->reference, 1u);
  EXPECT_NEAR(lock->delay_m, 80.0, 0.02 * 0.05 * kCaChipM + 1e-9);
  EXPECT_NEAR(lock->doppler_hz, 3.0, 0.1);
}

/// Mean code error of a first-order loop of noise bandwidth B that follows the discriminator in time, with the echo's
/// phase turning: integrated here in small steps over whole turns after the start has decayed.
double simulated_mean_chips(const CorrelatorDesign& d, double a, double delay_chips, double phase_rad, double f_hz) {
  const double K = 4.0 * d.code_loop_hz, h = d.spacing_chips / 2;
  const auto triangle = [](double x) { return std::max(0.0, 1.0 - std::abs(x)); };
  const double dt = 1e-4, period = 1.0 / f_hz;
  const double settle = 8.0 / K;
  const double turns = std::ceil(settle / period);
  double t = 0.0, sum = 0.0;
  const auto steps = static_cast<int>(std::lround((turns + 4.0) * period / dt));
  int n = 0;
  for (int k = 0; k < steps; ++k) {
    const std::complex<double> echo = std::polar(a, phase_rad + 2.0 * kPi * f_hz * dt * k);
    const auto s = [&](double x) { return triangle(x) + echo * triangle(x - delay_chips); };
    const double value = d.coherent ? (s(t - h) - s(t + h)).real() / 2.0
                                    : (std::norm(s(t - h)) - std::norm(s(t + h))) / (4.0 * (1.0 - h));
    t -= K * value * dt;
    if (k * dt >= turns * period) {
      sum += t;
      ++n;
    }
  }
  return sum / n;
}

// As the vehicle moves the echo's phase turns and its pull averages down with the loop; at rest it stands. The mean of
// a simulated loop over whole turns is the mean of track() over the phase, to the second order of the echo's amplitude.
TEST(CodeTracking, FadingAveragesDown) {
  for (const bool coherent : {true, false}) {
    CorrelatorDesign d = design(Modulation::kBpsk1, 0.5, coherent);
    d.code_loop_hz = 0.5;
    const CodeTracking tracking(d);
    const auto swing = [&](double f_hz, double* mean) {
      double low = 1.0, high = -1.0, sum = 0.0;
      constexpr int kPhases = 72;
      for (int i = 0; i < kPhases; ++i) {
        const double e = *error_m(tracking, {{0.3 * kCaChipM, 0.1, 2.0 * kPi * i / kPhases, f_hz}}) / kCaChipM;
        low = std::min(low, e);
        high = std::max(high, e);
        sum += e / kPhases;
      }
      if (mean) *mean = sum;
      return high - low;
    };
    // First-order loop: the swing falls by 1 / sqrt(1 + (2 pi f / 4 B)^2); f = 5 Hz, B = 0.5 Hz: 15.7 times, and the
    // carrier, which also follows the echo, changes that in the second order of 0.1.
    double mean = 0.0;
    const double still = swing(0.0, nullptr), moving = swing(5.0, &mean);
    EXPECT_NEAR(still, 2.0 * 0.025, 0.1 * 0.05);
    const double x = kPi * 5.0 * 0.02;
    EXPECT_NEAR(moving / still, std::sin(x) / x / std::hypot(1.0, 2.0 * kPi * 5.0 / 2.0), 0.15 / 15.7);
    // Powers keep the echo's own pull a^2 (E^2 - L^2); the coherent loop none.
    EXPECT_NEAR(mean, simulated_mean_chips(d, 0.1, 0.3, 0.0, 5.0), 2e-4) << coherent;
  }
}

// Thermal noise against the textbook form for BPSK in an infinite band.
TEST(CodeTracking, NoiseOfBpskIsTheTextbooks) {
  for (const double d : {1.0, 0.5, 0.1}) {
    for (const double cn0_dbhz : {30.0, 45.0}) {
      for (const bool coherent : {true, false}) {
        CorrelatorDesign c = design(Modulation::kBpsk1, d, coherent);
        c.code_loop_hz = 1.0;
        const double cn0_hz = std::pow(10.0, cn0_dbhz / 10.0);
        double chips2 = (1.0 - 0.01) * d / (2.0 * cn0_hz);
        if (!coherent) chips2 *= 1.0 + 2.0 / (0.02 * cn0_hz * (2.0 - d));
        EXPECT_NEAR(CodeTracking(c).noise_m(cn0_dbhz), std::sqrt(chips2) * kCaChipM, 1e-9);
      }
    }
  }
  // 45 dB-Hz, half a chip, 0.13 Hz: 0.3 m, as a carrier-aided C/A receiver has.
  CorrelatorDesign c = design(Modulation::kBpsk1, 0.5, false);
  c.code_loop_hz = 0.13;
  EXPECT_NEAR(CodeTracking(c).noise_m(45.0), 0.30, 0.005);
}

/// Power spectral densities as published (Betz 2001), chips = 1.
double psd(Modulation m, double f) {
  if (std::abs(f) < 1e-9) return m == Modulation::kBoc11 ? 0.0 : 1.0;
  const double s = std::sin(kPi * f) / (kPi * f);
  return m == Modulation::kBoc11 ? std::pow(s * std::tan(kPi * f / 2.0), 2) : s * s;
}

double integral(double b, const std::function<double(double)>& f) {
  constexpr int kSteps = 20000;  // midpoint rule: error of the order of (b / kSteps)^2
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += f((i + 0.5) * 0.5 * b / kSteps);
  return 2.0 * sum * 0.5 * b / kSteps;
}

// Correlation and noise in a finite band against integrals over the spectrum, which the code does not use.
TEST(CodeTracking, FiniteBandAgainstTheSpectrum) {
  for (const Modulation m : {Modulation::kBpsk1, Modulation::kBoc11}) {
    for (const double b : {2.0, 8.0, 20.0}) {
      CorrelatorDesign c = design(m, 0.2, true);
      c.front_end_hz = b * chip_rate_hz(m);
      c.code_loop_hz = 1.0;
      const CodeTracking tracking(c);
      for (const double x : {0.0, 0.05, 0.31, 0.5, 0.99, 1.7, 3.9, 5.2})
        EXPECT_NEAR(tracking.correlation().at(x),
                    integral(b, [&](double f) { return psd(m, f) * std::cos(2 * kPi * f * x); }), 2e-6)
            << b << " " << x;
      // Betz & Kolodziejski: B (1 - B T / 2) int S sin^2(pi f d) / (C/N0 (2 pi int f S sin(pi f d))^2).
      const double top = integral(b, [&](double f) { return psd(m, f) * std::pow(std::sin(kPi * f * 0.2), 2); });
      const double slope = 2 * kPi * integral(b, [&](double f) { return f * psd(m, f) * std::sin(kPi * f * 0.2); });
      EXPECT_NEAR(tracking.noise_m(40.0), kCaChipM * std::sqrt(0.99 * top / (1e4 * slope * slope)), 1e-4);
    }
  }
}

// A narrower spacing helps only down to the inverse bandwidth.
TEST(CodeTracking, NoiseHasAFloorInAFiniteBand) {
  CorrelatorDesign c = design(Modulation::kBpsk1, 0.1, false);
  c.front_end_hz = 4e6;
  const double at_01 = CodeTracking(c).noise_m(45.0);
  c.spacing_chips = 0.02;
  EXPECT_NEAR(CodeTracking(c).noise_m(45.0), at_01, 0.02 * at_01);
  c.modulation = Modulation::kBoc11;
  c.spacing_chips = 0.1;
  EXPECT_LT(CodeTracking(c).noise_m(45.0), 0.7 * at_01);  // the sharper peak
}

TEST(CodeCorrelation, SineIntegral) {
  // Abramowitz & Stegun, table 5.1 and 5.3.
  EXPECT_NEAR(sine_integral(1.0), 0.946083070367183, 1e-14);
  EXPECT_NEAR(sine_integral(-1.0), -0.946083070367183, 1e-14);
  EXPECT_NEAR(sine_integral(kPi), 1.851937051982466, 1e-14);
  EXPECT_NEAR(sine_integral(10.0), 1.658347594218874, 1e-14);
  EXPECT_NEAR(sine_integral(4.0 - 1e-9), sine_integral(4.0 + 1e-9), 2e-9);
  EXPECT_EQ(sine_integral(0.0), 0.0);
}

TEST(CodeCorrelation, NamesAndChips) {
  const std::array<const char*, kModulations> names{"bpsk0.5", "bpsk1", "bpsk2", "bpsk10", "boc11"};
  for (std::size_t i = 0; i < kModulations; ++i) EXPECT_EQ(modulation_of(names[i]), static_cast<Modulation>(i));
  EXPECT_EQ(modulation_of(GnssSystem::kGps, 1), Modulation::kBpsk1);
  EXPECT_EQ(modulation_of(GnssSystem::kGps, 5), Modulation::kBpsk10);
  EXPECT_EQ(modulation_of(GnssSystem::kGalileo, 1), Modulation::kBoc11);
  EXPECT_EQ(modulation_of(GnssSystem::kBeidou, 2), Modulation::kBpsk2);
  EXPECT_EQ(modulation_of(GnssSystem::kBeidou, 6), Modulation::kBpsk10);
  EXPECT_EQ(modulation_of(GnssSystem::kBeidou, 7), Modulation::kBpsk2);
  EXPECT_EQ(modulation_of("boc11"), Modulation::kBoc11);
  EXPECT_NEAR(CodeCorrelation(Modulation::kBpsk10, 0.0).chip_m(), 29.305, 1e-3);
  const CodeCorrelation boc(Modulation::kBoc11, 0.0);
  EXPECT_EQ(boc.at(0.5), -0.5);
  EXPECT_EQ(boc.at(-0.25), 0.25);
  EXPECT_EQ(boc.at(1.5), 0.0);
}

}  // namespace
}  // namespace canyon::gnss

// What a channel locks on and how noisy it is, against the definitions written out.
#include <cmath>
#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/carrier_noise.h"
#include "canyon/gnss/receiver/code_correlation.h"
#include "canyon/gnss/receiver/code_tracking.h"
#include "canyon/gnss/receiver/multipath_rule.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;
using stress::Looks;
using Phasor = std::complex<double>;

constexpr Modulation kAllModulations[] = {Modulation::kBpsk05, Modulation::kBpsk1, Modulation::kBpsk2,
                                          Modulation::kBpsk10, Modulation::kBoc11};

double sinc(double x) {
  return x == 0.0 ? 1.0 : std::sin(kPi * x) / (kPi * x);
}

/// Power spectrum by the chip's shape, f in chip rates.
double spectrum(bool boc, double f) {
  const double shape = boc ? sinc(0.5 * f) * std::sin(0.5 * kPi * f) : sinc(f);
  return shape * shape;
}

/// The correlation and its slope as the spectrum's cosine transform over the band, by Simpson's rule in 2000 steps: of
/// phases of up to 2 pi 4 B the step is 0.06 rad, error h^4 / 180 of the fourth derivative, below 1e-7.
struct Transformed {
  double value = 0.0, slope = 0.0;
};
Transformed transformed(bool boc, double bandwidth, double x) {
  constexpr int kSteps = 2000;
  Transformed out;
  const double h = 0.5 * bandwidth / kSteps;
  for (int k = 0; k <= kSteps; ++k) {
    const double f = h * k, weight = (k == 0 || k == kSteps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) * h / 3.0;
    out.value += 2.0 * weight * spectrum(boc, f) * std::cos(2.0 * kPi * f * x);
    out.slope -= 2.0 * weight * spectrum(boc, f) * 2.0 * kPi * f * std::sin(2.0 * kPi * f * x);
  }
  return out;
}

StressFigure correlations_by_spectrum() {
  Looks looks;
  for (const Modulation modulation : kAllModulations)
    for (const double bandwidth : {2.0, 4.3, 20.0}) {
      const CodeCorrelation R(modulation, bandwidth * chip_rate_hz(modulation));
      looks.close(R.chip_m(), 299792458.0 / chip_rate_hz(modulation), 2.0);
      looks.close(R.bandwidth_per_chip_rate(), bandwidth, 2.0);
      for (double x = -2.2; x < 4.4; x += 0.1307) {
        const Transformed exact = transformed(modulation == Modulation::kBoc11, bandwidth, x);
        // The table's documented 1e-6.
        looks.near(R.at(x), exact.value, 1e-6 + 1e-7);
        looks.near(R.slope(x), exact.slope, 1e-6 * bandwidth);
      }
    }
  return looks.figure();
}

struct Tap {
  double at, weight;
};
std::vector<Tap> taps_of(const CorrelatorDesign& d) {
  const double half = 0.5 * d.spacing_chips;
  if (!d.double_delta) return {{half, 1.0}, {-half, -1.0}};
  return {{half, 1.0}, {-half, -1.0}, {2.0 * half, -0.5}, {-2.0 * half, 0.5}};
}

/// sinc(f T) / (1 + j 2 pi f / (4 B)).
Phasor response(double f_hz, double loop_hz, double integration_s) {
  return sinc(f_hz * integration_s) / Phasor(1.0, 2.0 * kPi * f_hz / (4.0 * loop_hz));
}

/// The channel's definition (code_tracking.h): the composite of these signals, and the discriminator at a delay.
struct ByDefinition {
  const CorrelatorDesign& design;
  const CodeCorrelation& R;
  std::span<const EchoSignal> signals;
  std::size_t main;
  std::vector<double> at_chips{};
  std::vector<Phasor> phasor{};
  Phasor frame = 1.0;  ///< turns the carrier loop's composite to the real axis

  void prepare() {
    for (const EchoSignal& s : signals) {
      at_chips.push_back((s.delay_m - signals[main].delay_m) / R.chip_m());
      phasor.push_back(std::polar(s.amplitude, s.phase_rad));
    }
    Phasor carrier = 0.0;
    for (std::size_t i = 0; i < signals.size(); ++i) carrier += prompt(i) * R.at(at_chips[i]);
    frame = std::conj(carrier) / std::abs(carrier);
  }
  double beat_hz(std::size_t i, std::size_t j) const { return signals[i].doppler_hz - signals[j].doppler_hz; }
  Phasor prompt(std::size_t i) const {
    return phasor[i] * response(beat_hz(i, main), design.carrier_loop_hz, design.integration_s);
  }
  double power(double t, double loop_hz) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < signals.size(); ++i)
      for (std::size_t j = 0; j < signals.size(); ++j)
        sum += (phasor[i] * std::conj(phasor[j]) * response(beat_hz(i, j), loop_hz, design.integration_s)).real() *
               R.at(t - at_chips[i]) * R.at(t - at_chips[j]);
    return sum;
  }
  double discriminator(double t) const {
    double sum = 0.0;
    for (const Tap& tap : taps_of(design)) {
      if (!design.coherent) {
        sum += tap.weight * power(t - tap.at, design.code_loop_hz);
        continue;
      }
      for (std::size_t i = 0; i < signals.size(); ++i)
        sum += tap.weight *
               (frame * phasor[i] * response(beat_hz(i, main), design.code_loop_hz, design.integration_s)).real() *
               R.at(t - tap.at - at_chips[i]);
    }
    return sum;
  }
  /// The rising zero nearest to the main signal, of those that steps of 1/500 chip tell.
  std::optional<double> zero() const {
    constexpr double kStep = 2e-3;
    for (int k = 0; k < 700; ++k)
      for (const double from : {k * kStep + 1e-5, -(k + 1) * kStep + 1e-5}) {
        double low = from, high = from + kStep;
        if (!(discriminator(low) < 0.0 && discriminator(high) > 0.0)) continue;
        for (int halving = 0; halving < 45; ++halving) {
          const double middle = 0.5 * (low + high);
          (discriminator(middle) < 0.0 ? low : high) = middle;
        }
        return 0.5 * (low + high);
      }
    return std::nullopt;
  }
};

CorrelatorDesign some_design(const RandomStream& draws, std::uint64_t k) {
  CorrelatorDesign d;
  d.modulation = kAllModulations[k % 5];
  d.spacing_chips = draws.uniform(0.08, 0.5, 0, k);
  d.double_delta = k % 4 >= 2;
  d.coherent = k % 2 == 1;
  d.front_end_hz = k % 3 == 0 ? 0.0 : draws.uniform(4.2, 12.0, 1, k) * chip_rate_hz(d.modulation);
  d.code_loop_hz = draws.uniform(0.1, 2.0, 2, k);
  d.carrier_loop_hz = draws.uniform(5.0, 18.0, 3, k);
  d.integration_s = draws.uniform(0.001, 0.03, 4, k);
  return d;
}

/// A strong signal somewhere in a list of up to three echoes, at rest or with beats of up to 8 Hz.
std::vector<EchoSignal> some_signals(const RandomStream& draws, std::uint64_t k, double chip_m, std::size_t& main) {
  const std::size_t n = 2 + k % 3;
  main = (k / 3) % n;
  std::vector<EchoSignal> out;
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::uint64_t at = 8 * k + i;
    EchoSignal s;
    s.delay_m = 40.0 + draws.uniform(0.02, 0.9, 5, at) * chip_m;
    s.amplitude = draws.uniform(0.02, 0.35, 6, at);
    s.phase_rad = draws.uniform(-kPi, kPi, 7, at);
    s.doppler_hz = k % 5 == 0 ? 3.0 : draws.uniform(-4.0, 4.0, 8, at);
    if (i == main) s.delay_m = 40.0, s.amplitude = 1.3;
    out.push_back(s);
  }
  return out;
}

/// Zeros are refined to 1e-9 chips as documented; correlations have slopes of up to 3 times the modulation's, and the
/// prompt is not below a third: 1e-8 of amplitude and phase, and of a beat of 8 Hz 1e-7 Hz.
StressFigure locks_by_definition() {
  Looks looks;
  const RandomStream draws(1, "stress.tracking");
  int locked = 0;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const CorrelatorDesign design = some_design(draws, k);
    const CodeTracking loop(design);
    const CodeCorrelation& R = loop.correlation();
    std::size_t main = 0;
    const auto signals = some_signals(draws, k, R.chip_m(), main);
    ByDefinition exact{design, R, signals, main};
    exact.prepare();
    const auto zero = exact.zero();
    const auto lock = loop.track(signals);
    looks.right(lock.has_value() == zero.has_value());
    if (!lock || !zero) continue;
    ++locked;
    looks.right(lock->reference == main);
    looks.near(lock->delay_m, 40.0 + *zero * R.chip_m(), 2e-9 * R.chip_m());
    looks.near(lock->amplitude, std::sqrt(exact.power(*zero, 0.25)) / R.at(0.0), 3e-8);
    Phasor carrier = 0.0, turning = 0.0;
    for (std::size_t i = 0; i < signals.size(); ++i) {
      const Phasor part = exact.prompt(i) * R.at(*zero - exact.at_chips[i]);
      carrier += part, turning += part * signals[i].doppler_hz;
    }
    looks.near(std::remainder(lock->phase_rad - std::arg(carrier), 2.0 * kPi), 0.0, 3e-8);
    looks.near(lock->doppler_hz, (turning / carrier).real(), 3e-7);
    // As a receiver's rule has it: its amplitudes are 20 lg, its carrier's error says the same phase.
    MultipathParameters p;
    p.threshold_dbhz = 20.0, p.design = design;
    std::vector<ReceivedSignal> echoes;
    for (const EchoSignal& s : signals)
      echoes.push_back({s.delay_m, 35.0 + 20.0 * std::log10(s.amplitude), s.phase_rad, s.doppler_hz});
    const double wave_m = draws.uniform(0.18, 0.26, 9, k);
    const auto rule = model_row(multipath_rules(), "correlator").make({}, p);
    const bool hidden = k % 2 == 0;
    std::optional<ReceivedSignal> direct;
    if (!hidden) direct = echoes.front(), echoes.erase(echoes.begin());
    const Reception r = rule->receive(direct, echoes, wave_m);
    looks.right(r.tracked && r.source == static_cast<int>(main) - (hidden ? 0 : 1));
    looks.near(r.error_m, lock->delay_m, 4e-9 * R.chip_m());
    looks.near(r.cn0_dbhz, 35.0 + 20.0 * std::log10(lock->amplitude), 1e-6);
    looks.near(std::remainder(2.0 * kPi * r.carrier_error_m / wave_m + lock->phase_rad, 2.0 * kPi), 0.0, 1e-6);
    looks.right(std::abs(r.carrier_error_m - 40.0) <= wave_m);
    looks.near(r.range_rate_error_m_s, -wave_m * lock->doppler_hz, 1e-6);
    p.threshold_dbhz = r.cn0_dbhz + 0.01;
    looks.right(!model_row(multipath_rules(), "correlator").make({}, p)->receive(direct, echoes, wave_m).tracked);
    p.threshold_dbhz = r.cn0_dbhz - 0.01;
    looks.right(model_row(multipath_rules(), "correlator").make({}, p)->receive(direct, echoes, wave_m).tracked);
  }
  looks.right(locked > 50);
  return looks.figure();
}

/// What does not matter changes no bit, what is just not as faint does: 60 dB down, or three chips off in a narrow
/// band; one signal alone is tracked as it is, and of none there is no lock.
StressFigure what_counts() {
  int wrong = 0;
  for (const bool coherent : {false, true}) {
    CorrelatorDesign d;
    d.coherent = coherent, d.front_end_hz = 5e6;
    const CodeTracking loop(d);
    const double chip_m = loop.correlation().chip_m();
    const EchoSignal main{5.0, 2.0, 0.4, 1.5}, other{5.0 + 0.4 * chip_m, 0.6, 1.2, 1.5};
    const auto with = [&](const EchoSignal& more) {
      return loop.track(std::vector<EchoSignal>{other, main, more})->delay_m;
    };
    const double without = loop.track(std::vector<EchoSignal>{other, main})->delay_m;
    for (const double share : {0.9e-3, 1e-9, 0.0})
      wrong += with({5.0 + 0.2 * chip_m, 2.0 * share, 0.9, 1.5}) == without ? 0 : 1;
    wrong += with({5.0 + 0.2 * chip_m, 2.0 * 1.1e-3, 0.9, 1.5}) != without ? 0 : 1;
    for (const double side : {-1.0, 1.0}) {
      wrong += with({5.0 + 3.01 * side * chip_m, 1.5, 0.9, 1.5}) == without ? 0 : 1;
      wrong += with({5.0 + 2.99 * side * chip_m, 1.5, 0.9, 1.5}) != without ? 0 : 1;
    }
    const auto alone = loop.track(std::vector<EchoSignal>{main});
    wrong += alone && alone->delay_m == 5.0 && alone->amplitude == 2.0 && alone->phase_rad == 0.4 &&
                     alone->doppler_hz == 1.5 && alone->reference == 0
                 ? 0
                 : 1;
    wrong += loop.track({}) ? 1 : 0;
    for (const double amplitude : {0.0, -1.0, std::nan("")})
      wrong += loop.track(std::vector<EchoSignal>{{5.0, amplitude, 0.0, 0.0}}) ? 1 : 0;
  }
  return {1.0 * wrong, 0.0};
}

StressFigure designs_refused() {
  int passed = 0;
  const auto tried = [&](auto change) {
    CorrelatorDesign d;
    change(d);
    passed += stress::not_refused([&] { return CodeTracking(d); });
  };
  for (const double bad : {0.0, -0.1, 1.0001, std::nan("")}) tried([&](CorrelatorDesign& d) { d.spacing_chips = bad; });
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    tried([&](CorrelatorDesign& d) { d.code_loop_hz = bad; });
    tried([&](CorrelatorDesign& d) { d.carrier_loop_hz = bad; });
    tried([&](CorrelatorDesign& d) { d.integration_s = bad; });
  }
  tried([](CorrelatorDesign& d) { d.code_loop_hz = 50.0; });  // B T = 1
  tried([](CorrelatorDesign& d) { d.front_end_hz = 1e6; });   // less than the chip rate
  tried([](CorrelatorDesign& d) { d.front_end_hz = -3e6; });
  for (const char* name : {"bpsk", "boc", ""}) passed += stress::not_refused([&] { return modulation_of(name); });
  return {1.0 * passed, 0.0};
}

/// B (1 - B T / 2) u'Ru / (C/N0 slope^2) [1 + (R(0) + R(d)) / (2 T C/N0 R(d/2)^2)], the slope as the discriminator's
/// difference over 1e-6 chips either side: 1e-6 of the curvature in a narrow band, where the table's errors of 1e-6 of
/// the correlations are larger; exact corners of an infinite band, whose slopes are the mean of both sides.
StressFigure noise_by_definition() {
  Looks looks;
  const RandomStream draws(6, "stress.tracking");
  for (std::uint64_t k = 0; k < 120; ++k) {
    const CorrelatorDesign d = some_design(draws, k);
    const CodeTracking loop(d);
    const CodeCorrelation& R = loop.correlation();
    const double cn0_dbhz = draws.uniform(10.0, 55.0, 10, k), cn0 = std::pow(10.0, 0.1 * cn0_dbhz), h = 1e-4;
    const auto taps = taps_of(d);
    const auto weight = [&](const Tap& tap) { return d.coherent ? tap.weight : tap.weight * R.at(tap.at); };
    double slope = 0.0, variance = 0.0;
    for (const Tap& a : taps) {
      slope -= weight(a) * (R.at(a.at + h) - R.at(a.at - h)) / (2.0 * h);
      for (const Tap& b : taps) variance += weight(a) * weight(b) * R.at(a.at - b.at);
    }
    const double BT = d.code_loop_hz * d.integration_s;
    double chips2 = d.code_loop_hz * (1.0 - 0.5 * BT) * variance / (cn0 * slope * slope);
    const double half_peak = R.at(0.5 * d.spacing_chips);
    if (!d.coherent)
      chips2 *= 1.0 + (R.at(0.0) + R.at(d.spacing_chips)) / (2.0 * d.integration_s * cn0 * half_peak * half_peak);
    // h^2 / 6 of a third derivative of (2 pi B)^2 / 3 at B = 6 (half the band, in chip rates), slopes near 1: 5e-6; and
    // the table's cubic, 1e-6 of the peak over steps of 1 / 256 chips: 3e-4 of a slope.
    const bool corners = d.front_end_hz == 0.0;
    looks.near(loop.noise_m(cn0_dbhz) / (std::sqrt(chips2) * R.chip_m()), 1.0, corners ? 1e-9 : 1e-3);
    // Of the carrier: arctangent loop, and the difference of two phases of an integration (Kaplan & Hegarty, 5.6.1-2).
    const double T = d.integration_s, B = d.carrier_loop_hz;
    looks.close(carrier_phase_noise_rad(cn0_dbhz, B, T), std::sqrt(B / cn0 * (1.0 + 1.0 / (2.0 * T * cn0))), 32.0);
    looks.close(doppler_noise_hz(cn0_dbhz, B, T), std::sqrt(4.0 * B / cn0 * (1.0 + 1.0 / (T * cn0))) / (2.0 * kPi * T),
                32.0);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> tracking_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "the lock of a channel on several signals",
           .why = "a beat that turns backwards, a loop's lag for the carrier's, a zero that falls, powers for fields",
           .expected = "the discriminator's definition searched in steps of 1/500 chip: 1e-9 chips as documented",
           .unit = "of the bound",
           .loose = "roots are found nearer than documented"});
  rows.add("tracking/locks_by_definition", locks_by_definition);
  rows.of({StressGroup::kData, "the correlation of a band-limited code",
           "a kink's weight or place, a table's slope per step in the place of per chip",
           "the cosine transform of the chip's spectrum over the band: the table's documented 1e-6", "of the bound"});
  rows.add("tracking/correlations_by_spectrum", correlations_by_spectrum);
  rows.of({StressGroup::kData, "noise of channels of any design",
           "taps of a pair with the outer one's weight, a slope per metre, squaring loss of a coherent loop",
           "the formula from correlations and their differences, to those differences", "of the bound"});
  rows.add("tracking/noise_by_definition", noise_by_definition);
  rows.of({StressGroup::kData, "signals that do not matter, and those that just do",
           "a threshold in power, a reach to one side only", "the same bits, or not: exact", "locks"});
  rows.add("tracking/what_counts", what_counts);
  rows.of(
      {StressGroup::kData, "channels that cannot be", "a guard the wrong way round", "each is refused", "let through"});
  rows.add("tracking/designs_refused", designs_refused);
  return rows.take();
}

}  // namespace canyon::gnss

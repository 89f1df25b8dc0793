#include "canyon/gnss/receiver/code_tracking.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

using Complex = std::complex<double>;

constexpr double kFaintest = 1e-3;         // relative to the strongest: -60 dB pull the code by centimetres at most
constexpr double kPowerLoopHz = 0.25;      // first-order average over 1 s
constexpr double kReachOfBandChips = 3.0;  // beyond, a band-limited correlation is below 1e-3

/// Steady-state response of predetection integration and a first-order loop to a phasor that turns at `f_hz`.
Complex averaged(double f_hz, double loop_hz, double integration_s) {
  if (f_hz == 0.0) return 1.0;
  const double x = kPi * f_hz * integration_s;
  return std::sin(x) / x / Complex(1.0, 2.0 * kPi * f_hz / (4.0 * loop_hz));
}

/// Real part of a phasor that turns at `f_hz`, averaged by a loop; `integrated` is what predetection integration
/// leaves.
double averaged_part(const Complex& phasor, double f_hz, double loop_hz, double integrated) {
  const double lag = 2.0 * kPi * f_hz / (4.0 * loop_hz);
  return integrated * (phasor.real() + phasor.imag() * lag) / (1.0 + lag * lag);
}

}  // namespace

/// The signals that matter, in chips after the reference.
struct CodeTracking::Composite {
  std::vector<double> delay_chips;
  std::vector<Complex> prompt;  ///< phasors through the carrier loop, reference at phase 0
  std::vector<double> doppler_hz;
  std::vector<double> in_phase;    ///< coherent: weight of each signal
  std::vector<double> pair_code;   ///< powers: weight of each pair in the code loop, row-major
  std::vector<double> pair_power;  ///< in the power average

  std::size_t size() const { return delay_chips.size(); }
};

CodeTracking::CodeTracking(const CorrelatorDesign& design)
    : design_(design), correlation_(design.modulation, design.front_end_hz) {
  CANYON_CHECK(design.spacing_chips > 0.0 && design.spacing_chips <= 1.0, "spacing_chips = ", design.spacing_chips);
  CANYON_CHECK(design.code_loop_hz > 0.0 && design.carrier_loop_hz > 0.0 && design.integration_s > 0.0, "loops of ",
               design.code_loop_hz, " and ", design.carrier_loop_hz, " Hz, integration of ", design.integration_s,
               " s");
  CANYON_CHECK(design.code_loop_hz * design.integration_s < 1.0, "loop of ", design.code_loop_hz,
               " Hz, integration of ", design.integration_s, " s");
  const double d = design.spacing_chips;
  taps_ = {{0.5 * d, 1.0}, {-0.5 * d, -1.0}};
  if (design.double_delta) taps_.insert(taps_.end(), {{d, -0.5}, {-d, 0.5}});
  noise_ = noise_shape();
}

CodeTracking::Composite CodeTracking::composite(std::span<const EchoSignal> signals, std::size_t reference) const {
  const EchoSignal& main = signals[reference];
  const double reach_chips =
      correlation_.band_limited() ? kReachOfBandChips : 2.0 + 2.0 * std::abs(taps_.back().offset_chips);
  Composite c;
  std::vector<Complex> phasors;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const EchoSignal& s = signals[i];
    const double delay_chips = (s.delay_m - main.delay_m) / correlation_.chip_m();
    if (i != reference && (s.amplitude < kFaintest * main.amplitude || std::abs(delay_chips) >= reach_chips)) continue;
    c.delay_chips.push_back(delay_chips);
    c.doppler_hz.push_back(s.doppler_hz - main.doppler_hz);
    phasors.push_back(s.amplitude * std::polar(1.0, s.phase_rad - main.phase_rad));
    c.prompt.push_back(phasors.back() * averaged(c.doppler_hz.back(), design_.carrier_loop_hz, design_.integration_s));
  }
  const std::size_t n = c.size();
  if (n == 1) return c;
  if (design_.coherent) {
    // The carrier loop follows the composite at the reference's delay.
    Complex carrier = 0.0;
    for (std::size_t i = 0; i < n; ++i) carrier += c.prompt[i] * correlation_.at(c.delay_chips[i]);
    const Complex turn = std::abs(carrier) > 0.0 ? std::conj(carrier) / std::abs(carrier) : Complex(1.0);
    for (std::size_t i = 0; i < n; ++i)
      c.in_phase.push_back(
          (turn * phasors[i] * averaged(c.doppler_hz[i], design_.code_loop_hz, design_.integration_s)).real());
  }
  c.pair_code.resize(n * n);
  c.pair_power.resize(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {  // the other half is the same: a pair the other way round turns backwards
      const Complex pair = phasors[i] * std::conj(phasors[j]);
      const double f_hz = c.doppler_hz[i] - c.doppler_hz[j], x = kPi * f_hz * design_.integration_s;
      const double integrated = x == 0.0 ? 1.0 : std::sin(x) / x;
      c.pair_code[i * n + j] = c.pair_code[j * n + i] = averaged_part(pair, f_hz, design_.code_loop_hz, integrated);
      c.pair_power[i * n + j] = c.pair_power[j * n + i] = averaged_part(pair, f_hz, kPowerLoopHz, integrated);
    }
  }
  return c;
}

double CodeTracking::discriminator(const Composite& c, double t_chips) const {
  const std::size_t n = c.size();
  double sum = 0.0;
  if (design_.coherent) {
    for (std::size_t i = 0; i < n; ++i)
      for (const Tap& tap : taps_)
        sum += c.in_phase[i] * tap.weight * correlation_.at(t_chips - tap.offset_chips - c.delay_chips[i]);
  } else {
    thread_local std::vector<double> at;
    at.resize(n);
    for (const Tap& tap : taps_) {
      for (std::size_t i = 0; i < n; ++i) at[i] = correlation_.at(t_chips - tap.offset_chips - c.delay_chips[i]);
      double power = 0.0;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) power += c.pair_code[i * n + j] * at[i] * at[j];
      sum += tap.weight * power;
    }
  }
  // Exact zeros come out as rounding noise.
  const double scale = std::abs(c.prompt[0]) + 1e-300;
  return std::abs(sum) < 1e-13 * (design_.coherent ? scale : scale * scale) ? 0.0 : sum;
}

/// Where the discriminator is looked at: in an infinite band at its corners (and, for powers, between them), else on a
/// grid finer than the correlation's features.
void CodeTracking::scan_points(const Composite& c, std::vector<double>& points) const {
  if (correlation_.band_limited()) {
    const double step =
        std::min(0.25 * design_.spacing_chips, 0.25 / std::max(correlation_.bandwidth_per_chip_rate(), 1.0));
    const int half = static_cast<int>(std::ceil(1.5 / step));
    for (int i = -half; i < half; ++i) points.push_back((i + 0.5) * step);
    return;
  }
  for (const double delay : c.delay_chips)
    for (const Tap& tap : taps_)
      for (const auto& kink : correlation_.kinks()) points.push_back(delay + tap.offset_chips + kink.at_chips);
  std::sort(points.begin(), points.end());
  if (design_.coherent) return;
  const std::size_t corners = points.size();
  for (std::size_t i = 0; i + 1 < corners; ++i) points.push_back(0.5 * (points[i] + points[i + 1]));
  std::sort(points.begin(), points.end());
}

/// The root between two points of opposite sign. One step of false position is exact where the discriminator is linear.
double CodeTracking::refine(const Composite& c, double low, double low_value, double high, double high_value) const {
  double t = low - low_value * (high - low) / (high_value - low_value);
  if (design_.coherent && !correlation_.band_limited()) return t;
  int side = 0;
  for (int i = 0; i < 60 && high - low > 1e-11; ++i) {
    const double value = discriminator(c, t);
    if (value == 0.0) return t;
    // Illinois: the end that stays twice is halved, so that both close in.
    if (value < 0.0) {
      low = t;
      low_value = value;
      if (side == -1) high_value *= 0.5;
      side = -1;
    } else {
      high = t;
      high_value = value;
      if (side == 1) low_value *= 0.5;
      side = 1;
    }
    const double next = low - low_value * (high - low) / (high_value - low_value);
    if (std::abs(next - t) < 1e-10) return next;
    t = next;
  }
  return t;
}

std::optional<double> CodeTracking::stable_zero(const Composite& c) const {
  std::vector<double> points;
  scan_points(c, points);
  std::optional<double> best;
  const auto keep_nearest = [&](double root) {
    if (!best || std::abs(root) < std::abs(*best)) best = root;
  };
  // From the reference outwards, to where no root that is left can be nearer to it: a few points of a hundred, in most
  // cases. Roots lie between neighbours, where no point is exactly a zero.
  const auto outwards = [&] {
    if (points.size() < 2) return false;
    auto high = static_cast<std::size_t>(std::lower_bound(points.begin(), points.end(), 0.0) - points.begin());
    high = std::clamp<std::size_t>(high, 1, points.size() - 1);
    std::size_t low = high - 1;
    double low_value = discriminator(c, points[low]), high_value = discriminator(c, points[high]);
    const auto look_between = [&](std::size_t at, double value, double next_value) {
      if (value < 0.0 && next_value > 0.0) keep_nearest(refine(c, points[at], value, points[at + 1], next_value));
    };
    look_between(low, low_value, high_value);
    while (low_value != 0.0 && high_value != 0.0) {
      constexpr double kNone = std::numeric_limits<double>::infinity();
      const double below = low > 0 ? std::abs(points[low]) : kNone;
      const double above = high + 1 < points.size() ? std::abs(points[high]) : kNone;
      const double least = std::min(below, above);
      if (least == kNone || (best && std::abs(*best) < least)) return true;
      if (below <= above) {
        const double value = discriminator(c, points[low - 1]);
        look_between(low - 1, value, low_value);
        --low;
        low_value = value;
      } else {
        const double value = discriminator(c, points[high + 1]);
        look_between(high, high_value, value);
        ++high;
        high_value = value;
      }
    }
    return false;
  };
  if (outwards()) return best;
  best.reset();
  double negative_at = 0.0, negative_value = 0.0;  // last point with a value below zero
  double zero_from = 0.0, zero_to = 0.0;           // zeros since then
  bool armed = false, zeros = false;
  for (const double t : points) {
    const double value = discriminator(c, t);
    if (value < 0.0) {
      armed = true;
      zeros = false;
      negative_at = t;
      negative_value = value;
    } else if (armed && value == 0.0) {
      if (!zeros) zero_from = t;
      zeros = true;
      zero_to = t;
    } else if (armed && value > 0.0) {
      keep_nearest(zeros ? 0.5 * (zero_from + zero_to) : refine(c, negative_at, negative_value, t, value));
      armed = zeros = false;
    }
  }
  return best;
}

std::optional<CodeLock> CodeTracking::track(std::span<const EchoSignal> signals) const {
  std::size_t reference = 0;
  for (std::size_t i = 1; i < signals.size(); ++i)
    if (signals[i].amplitude > signals[reference].amplitude) reference = i;
  if (signals.empty() || !(signals[reference].amplitude > 0.0)) return std::nullopt;
  const EchoSignal& main = signals[reference];
  const Composite c = composite(signals, reference);
  CodeLock lock{main.delay_m, main.amplitude, main.phase_rad, main.doppler_hz, reference};
  const std::size_t n = c.size();
  if (n == 1) return lock;

  const auto zero = stable_zero(c);
  if (!zero) return std::nullopt;
  std::vector<double> at(n);
  for (std::size_t i = 0; i < n; ++i) at[i] = correlation_.at(*zero - c.delay_chips[i]);
  double power = 0.0;
  Complex carrier = 0.0, turning = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) power += c.pair_power[i * n + j] * at[i] * at[j];
    carrier += c.prompt[i] * at[i];
    turning += c.prompt[i] * at[i] * c.doppler_hz[i];
  }
  const double alone = correlation_.at(0.0);
  if (!(power > 1e-20 * main.amplitude * main.amplitude)) return std::nullopt;
  lock.delay_m += *zero * correlation_.chip_m();
  lock.amplitude = std::sqrt(power) / alone;
  if (std::abs(carrier) > 1e-6 * main.amplitude) {
    lock.phase_rad += std::arg(carrier);
    lock.doppler_hz += (turning / carrier).real();
  }
  return lock;
}

CodeTracking::NoiseShape CodeTracking::noise_shape() const {
  NoiseShape shape;
  const auto weight = [&](const Tap& tap) {
    return design_.coherent ? tap.weight : tap.weight * correlation_.at(tap.offset_chips);
  };
  for (const Tap& a : taps_) {
    shape.slope -= weight(a) * correlation_.slope(a.offset_chips);
    for (const Tap& b : taps_)
      shape.variance += weight(a) * weight(b) * correlation_.at(a.offset_chips - b.offset_chips);
  }
  const double d = design_.spacing_chips;
  shape.squaring_power = correlation_.at(0.0) + correlation_.at(d);
  shape.half_peak = correlation_.at(0.5 * d);
  return shape;
}

double CodeTracking::noise_m(double cn0_dbhz) const {
  const double cn0_hz = std::pow(10.0, cn0_dbhz / 10.0);
  const double B = design_.code_loop_hz, T = design_.integration_s;
  double chips2 = B * (1.0 - 0.5 * B * T) * noise_.variance / (cn0_hz * noise_.slope * noise_.slope);
  if (!design_.coherent)
    chips2 *= 1.0 + noise_.squaring_power / (2.0 * T * cn0_hz * noise_.half_peak * noise_.half_peak);
  return std::sqrt(chips2) * correlation_.chip_m();
}

}  // namespace canyon::gnss

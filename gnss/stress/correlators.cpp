// Code correlation and the loops that stand on it, from delay 0 to far beyond the chip.
#include <cmath>
#include <limits>

#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/code_correlation.h"
#include "canyon/gnss/receiver/code_tracking.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;

/// Piecewise linear: 1 at 0, -1/2 of BOC(1,1) at half a chip, nothing from one chip on, whatever the distance.
StressFigure infinite_band(Modulation modulation) {
  const CodeCorrelation R(modulation, 0.0);
  StressFigure out{0.0, 8.0 * kEpsilon};
  const bool boc = modulation == Modulation::kBoc11;
  take_worst(out, std::abs(R.at(0.0) - 1.0));
  take_worst(out, std::abs(R.at(0.5) - (boc ? -0.5 : 0.5)));
  take_worst(out, std::abs(R.slope(0.0)));
  for (const double x :
       {1.0, std::nextafter(1.0, 2.0), 1.5, 1e3, 1e9, 1e300, std::numeric_limits<double>::infinity()}) {
    take_worst(out, std::abs(R.at(x)));
    take_worst(out, std::abs(R.at(-x)));
  }
  for (double x = 0.0; x < 1.0; x += 1e-3) {
    const double exact = !boc ? 1.0 - x : x < 0.5 ? 1.0 - 3.0 * x : x - 1.0;
    take_worst(out, std::abs(R.at(x) - exact));
  }
  return out;
}

/// The tail of a band-limited correlation: sum |w| / (pi^3 B^2 (x - 1)), the leading term of what the sine integrals
/// leave; and the digits of what cancels, 16 eps x.
StressFigure tail(Modulation modulation, double bandwidth_chips, double x) {
  const CodeCorrelation R(modulation, bandwidth_chips * chip_rate_hz(modulation));
  double weights = 0.0;
  for (const auto& kink : R.kinks()) weights += std::abs(kink.slope_change);
  StressFigure out{0.0, weights / (std::pow(kPi, 3) * bandwidth_chips * bandwidth_chips * (x - 1.0)) +
                            16.0 * kEpsilon * x * weights};
  for (int k = 0; k < 100; ++k) {
    take_worst(out, std::abs(R.at(x + 0.01 * k)));
    take_worst(out, std::abs(R.at(x + 0.01 * k) - R.at(-x - 0.01 * k)));
  }
  return out;
}

/// The table ends at 4 chips; at its end it must meet the formula beyond: table 1e-6 as documented.
StressFigure table_end(double bandwidth_chips) {
  const CodeCorrelation R(Modulation::kBpsk1, bandwidth_chips * 1.023e6);
  StressFigure out{0.0, 1e-6};
  for (const double x : {4.0, -4.0}) take_worst(out, std::abs(R.at(std::nextafter(x, 0.0)) - R.at(x)));
  // And inside: the correlation of a wide band is the triangle but for 2 / (pi^2 B) at its peak (Si's remainder).
  take_worst(out, beyond(std::abs(R.at(0.0) - 1.0), 2.0 / (kPi * kPi * bandwidth_chips)));
  return out;
}

/// Si by a trapezoid of long doubles with the ends' derivatives (Euler and Maclaurin), h = x / 4096: h^4 / 720 of the
/// third derivative, below 1e-13; the documented 1e-14 above that, and the quadrature.
StressFigure sine_integrals() {
  StressFigure out{0.0, 1e-13};
  for (const double x : {1e-300, 1e-8, 0.5, 3.999999, 4.0, 4.000001, 7.0, 20.0}) {
    const auto f = [](long double t) { return t == 0.0L ? 1.0L : sinl(t) / t; };
    const auto df = [](long double t) { return t == 0.0L ? 0.0L : (cosl(t) - sinl(t) / t) / t; };
    constexpr int n = 4096;
    const long double h = static_cast<long double>(x) / n;
    long double sum = 0.5L * (f(0.0L) + f(x));
    for (int k = 1; k < n; ++k) sum += f(k * h);
    sum = sum * h - h * h / 12.0L * df(x);  // df(0) = 0
    if (x < 1e-3) sum = x - static_cast<long double>(x) * x * x / 18.0L;
    take_worst(out, std::abs(sine_integral(x) - static_cast<double>(sum)));
    take_worst(out, std::abs(sine_integral(-x) + static_cast<double>(sum)));
  }
  for (const double x : {1e6, 1e12, 1e300}) take_worst(out, beyond(std::abs(sine_integral(x) - 0.5 * kPi), 1.0 / x));
  return out;
}

CorrelatorDesign coherent(double spacing) {
  CorrelatorDesign d;
  d.spacing_chips = spacing;
  d.coherent = true;
  d.integration_s = 0.02;
  return d;
}

/// An echo in phase, a of the direct amplitude, `delay` chips later. Coherent early minus late in an infinite band errs
/// by a delay / (1 + a) up to (1 + a) d / 2, then by a d / 2 up to 1 - d / 2, falls, and by nothing from 1 + d / 2 on
/// (van Nee 1993). Exact to rounding: 16 eps of where the corners lie, spacing and delay, and 2 eps of four
/// correlations near 1, by a slope of 2 (1 + a).
StressFigure echo(double spacing, double amplitude, double delay_chips) {
  const CodeTracking loop(coherent(spacing));
  const double chip_m = loop.correlation().chip_m();
  const std::vector<EchoSignal> signals{{.amplitude = 1.0}, {.delay_m = delay_chips * chip_m, .amplitude = amplitude}};
  const auto lock = loop.track(signals);
  const double half = 0.5 * spacing;
  double exact = 0.0;
  if (delay_chips <= (1.0 + amplitude) * half)
    exact = amplitude * delay_chips / (1.0 + amplitude);
  else if (delay_chips <= 1.0 - half)
    exact = amplitude * half;
  if (!lock) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  return {std::abs(lock->delay_m / chip_m - exact),
          2.0 * kEpsilon + 16.0 * kEpsilon * (spacing + std::min(delay_chips, 2.0))};
}

/// Two signals that cancel: no lock, or the amplitude of what is left; a figure counts locks of more than that.
StressFigure cancelled(double rest) {
  const CodeTracking loop(coherent(0.5));
  const std::vector<EchoSignal> signals{{.amplitude = 1.0}, {.amplitude = 1.0 - rest, .phase_rad = kPi}};
  const auto lock = loop.track(signals);
  return {lock && !(lock->amplitude <= rest * 1.001 + 1e-9) ? 1.0 : 0.0, 0.0};
}

/// Noise of BPSK in an infinite band: B (1 - B T / 2) d / (2 C/N0) [1 + 2 / (T C/N0 (2 - d))] chips^2 (Kaplan & Hegarty
/// 2006, eq. 5.20), to 64 eps.
StressFigure noise(double spacing, double cn0_dbhz, double loop_hz, double integration_s) {
  CorrelatorDesign d;
  d.spacing_chips = spacing, d.code_loop_hz = loop_hz, d.integration_s = integration_s;
  const CodeTracking loop(d);
  const double cn0 = std::pow(10.0, 0.1 * cn0_dbhz);
  const double exact =
      loop.correlation().chip_m() * std::sqrt(loop_hz * (1.0 - 0.5 * loop_hz * integration_s) * spacing / (2.0 * cn0) *
                                              (1.0 + 2.0 / (integration_s * cn0 * (2.0 - spacing))));
  return {std::abs(loop.noise_m(cn0_dbhz) / exact - 1.0), 64.0 * kEpsilon / spacing};
}

/// An echo beyond the chip, or 80 dB down, or turning fast, must not count; a figure is how far the code moves, m.
StressFigure harmless(const EchoSignal& far, double front_end_hz, double bound_m) {
  CorrelatorDesign d = coherent(0.1);
  d.front_end_hz = front_end_hz;
  const CodeTracking loop(d);
  const std::vector<EchoSignal> signals{{.amplitude = 1.0}, far};
  const auto lock = loop.track(signals);
  return {lock ? std::abs(lock->delay_m) : std::numeric_limits<double>::quiet_NaN(), bound_m};
}

/// What a receiver's keys make of each of its channels: a front end of that width, but never narrower than the main
/// lobes of the signal, two chip rates or, of BOC(1,1), four; none where it is said to be infinite; and the rest as the
/// keys say. Rounding of the units.
StressFigure channels_of_a_receiver() {
  stress::Worst worst;
  struct Signal {
    Modulation modulation;
    double lobes_mhz;
  };
  for (const Signal& signal :
       {Signal{Modulation::kBpsk05, 1.022}, Signal{Modulation::kBpsk1, 2.046}, Signal{Modulation::kBpsk2, 4.092},
        Signal{Modulation::kBpsk10, 20.46}, Signal{Modulation::kBoc11, 4.092}})
    for (const double mhz : {0.0, 0.5, 3.0, 5.0, 21.0, 60.0})
      for (const bool other : {false, true}) {
        TrackingConfig keys;
        keys.front_end_mhz = mhz, keys.integration_ms = 4.0, keys.correlator_spacing_chips = 0.1,
        keys.code_loop_hz = 0.7;
        keys.correlator = other ? TrackingConfig::Correlator::kDoubleDelta : TrackingConfig::Correlator::kEarlyLate;
        keys.discriminator = other ? TrackingConfig::Discriminator::kCoherent : TrackingConfig::Discriminator::kPower;
        const CorrelatorDesign d = keys.channel(signal.modulation);
        const double expected_mhz = mhz == 0.0 ? 0.0 : worse(mhz, signal.lobes_mhz);
        worst.look(d.front_end_hz - 1e6 * expected_mhz, 4.0 * kEpsilon * 1e6 * (expected_mhz + 1.0));
        worst.look(d.integration_s - 0.004, 4.0 * kEpsilon * 0.004);
        const bool same = d.modulation == signal.modulation && d.spacing_chips == 0.1 && d.code_loop_hz == 0.7 &&
                          d.carrier_loop_hz == keys.carrier_loop_hz && d.double_delta == other && d.coherent == other;
        worst.look(same ? 0.0 : stress::kInfinity, 1.0);
      }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> correlator_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "a correlation at delay 0 and far beyond the chip",
           "a triangle written as 1 - |x| goes on below zero; sums of |x - x_k| lose all digits far away",
           "the closed form to 8 eps, and exactly nothing from one chip to infinity", ""});
  rows.add("correlators/bpsk_infinite_band", [] { return infinite_band(Modulation::kBpsk1); })
      .add("correlators/boc_infinite_band", [] { return infinite_band(Modulation::kBoc11); });

  rows.of({StressGroup::kGeometry, "a band-limited correlation far from its table",
           "differences of sine integrals that cancel, a table read beyond its end",
           "sum |w| / (pi^3 B^2 (x - 1)) + 16 eps x sum |w|; even", ""});
  rows.add("correlators/tail_at_4_chips", [] { return tail(Modulation::kBpsk1, 2.5, 4.0); })
      .add("correlators/tail_at_100_chips", [] { return tail(Modulation::kBpsk10, 2.5, 100.0); })
      .add("correlators/tail_at_10000_chips", [] { return tail(Modulation::kBoc11, 4.5, 1e4); });
  rows.of({StressGroup::kGeometry, "the end of a correlation's table", "a table and a formula that do not meet",
           "1e-6 as documented; at the peak 2 / (pi^2 B) is lost", ""});
  rows.add("correlators/table_end_of_2_chips", [] { return table_end(2.0); })
      .loose("the bound is the table's documented error; at its end a node is met exactly")
      .add("correlators/table_end_of_80_chips", [] { return table_end(80.0); })
      .loose("the bound is the table's documented error; at its end a node is met exactly");
  rows.of({StressGroup::kStiff, "the sine integral where its two forms meet, and at its end",
           "a series that cancels from 4 on, a continued fraction that does not converge below it",
           "quadrature to 1e-13; pi / 2 to 1 / x from 1e6 to 1e300", ""});
  rows.add("correlators/sine_integral", sine_integrals);

  rows.of({StressGroup::kGeometry, "an echo between the peak and the chip's end",
           "a zero found at the wrong corner; a plateau taken for a zero; an echo beyond the late arm that still pulls",
           "van Nee's envelope: a delay / (1 + a), a d / 2, nothing; 16 eps (d + delay) + 2 eps", "chips"});
  for (const double spacing : {0.01, 0.1, 1.0})
    for (const double amplitude : {0.002, 0.5, 0.999})
      for (const double share : {0.5, 0.999}) {
        rows.add(printed("correlators/echo_of_%g_spacing_%g_rising_%g", amplitude, spacing, share),
                 [=] { return echo(spacing, amplitude, share * (1.0 + amplitude) * 0.5 * spacing); })
            .loose("the zero of straight pieces between corners at short binary fractions hardly rounds");
      }
  rows.add("correlators/echo_of_0.5_spacing_0.1_plateau", [] { return echo(0.1, 0.5, 0.5); })
      .add("correlators/echo_of_0.5_spacing_0.1_beyond", [] { return echo(0.1, 0.5, 1.06); })
      .add("correlators/echo_of_0.5_spacing_0.1_far_beyond", [] { return echo(0.1, 0.5, 1e6); })
      .add("correlators/echo_at_no_delay", [] { return echo(0.1, 0.9, 0.0); });

  rows.of({StressGroup::kGeometry, "signals that cancel one another",
           "a quotient of zeros: a lock on nothing with a random delay",
           "no lock, or one of the amplitude that is left", "locks"});
  rows.add("correlators/cancelled_whole", [] { return cancelled(0.0); }).add("correlators/cancelled_but_for_1e-6", [] {
    return cancelled(1e-6);
  });

  rows.of({StressGroup::kStiff, "noise of a code loop at the ends of its design",
           "squaring loss at weak signals, 1 - B T / 2 of a loop as fast as its integration, a slope of a narrow pair",
           "Kaplan and Hegarty's closed form to 64 eps / d", ""});
  struct Design {
    double d, cn0, hz, s;
    const char* name;
  };
  for (const Design& k :
       {Design{0.01, 60.0, 0.001, 0.001, "narrow_strong_slow"}, Design{1.0, 0.0, 20.0, 0.04, "wide_weak_fast"},
        Design{0.5, 25.0, 0.13, 0.02, "usual"}, Design{0.01, 0.0, 20.0, 0.049, "narrow_weak_fast"}})
    rows.add(std::string("correlators/noise_") + k.name, [k] { return noise(k.d, k.cn0, k.hz, k.s); });

  rows.of({StressGroup::kStiff, "an echo that turns fast against the loops",
           "an average by sampling instead of sinc and loop: a fast echo aliases to a slow one",
           "a d / 2 Re H(f), H = sinc(f T) / (1 + j 2 pi f / 4 B), and Im H by which the carrier is turned", "m"});
  const double plateau_m = 0.5 * 0.05 * kSpeedOfLight / 1.023e6;
  rows.add("correlators/echo_turning_at_990_hz",
           [=] {
             const double f = 990.0, sinc = 1.0 / (kPi * f * 0.02), x = 2.0 * kPi * f / 2.0,
                          carrier = 0.5 * sinc * 60.0 / (2.0 * kPi * f);
             const double h = sinc / (x * x) + sinc / x * carrier;
             return harmless({.delay_m = 100.0, .amplitude = 0.5, .doppler_hz = f}, 0.0, 1.01 * plateau_m * h);
           })
      .add("correlators/echo_turning_at_half_a_hertz", [=] {
        const double f = 0.5, h = 1.0 / std::hypot(1.0, 2.0 * kPi * f / 2.0);
        return harmless({.delay_m = 100.0, .amplitude = 0.5, .doppler_hz = f}, 0.0, 1.001 * plateau_m * h);
      });
  rows.of({StressGroup::kData, "channels of a receiver by its keys",
           "a front end that cuts off the signal's own lobes, megahertz for hertz",
           "the lobes at least, and what the keys say: roundings", "of the bound"});
  rows.add("correlators/channels_of_a_receiver", channels_of_a_receiver);
  return rows.take();
}

}  // namespace canyon::gnss

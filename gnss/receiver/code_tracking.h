#pragma once

#include <optional>
#include <span>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/gnss/receiver/code_correlation.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {

/// One of the signals of a satellite that reach the correlators together: the direct one or an echo. Delays, phases and
/// frequencies are relative to a common zero, usually the free direct signal.
struct EchoSignal {
  double delay_m = 0.0;
  double amplitude = 0.0;
  double phase_rad = 0.0;
  double doppler_hz = 0.0;  ///< rate of the phase / 2 pi
};

/// A receiver channel.
struct CorrelatorDesign {
  Modulation modulation = Modulation::kBpsk1;
  double spacing_chips = 0.5;  ///< early to late, (0, 1]
  /// Early minus late from two pairs, E1 - L1 - (E2 - L2) / 2, the outer pair twice as wide: strobe or high-resolution
  /// correlator.
  bool double_delta = false;
  bool coherent = false;    ///< in-phase early minus late; else powers, |E|^2 - |L|^2
  double front_end_hz = 0;  ///< two-sided bandwidth; 0 = infinite
  double code_loop_hz = 0.5;
  double carrier_loop_hz = 15.0;
  double integration_s = 0.020;  ///< predetection
};

/// What becomes of satellites whose direct path is blocked; all but the first are cuts for studies of what errs.
enum class HiddenSignals {
  kAsReceived,  ///< they are tracked by their echoes where these are strong enough
  kDropped,     ///< they are not tracked
  /// They are tracked by their echoes where these are strong enough; else, as any satellite that is not tracked, as if
  /// the sky were clear: with the free direct signal's C/N0 and without multipath
  kInSight,
};

/// Keys of a receiver's channels, alike for all signals.
struct TrackingConfig {
  enum class Correlator { kEarlyLate, kDoubleDelta };
  enum class Discriminator { kPower, kCoherent };

  std::optional<Modulation> modulation;  ///< of all signals; none: each system's open signal
  SecondFrequency second_frequency = SecondFrequency::kL2;
  Correlator correlator = Correlator::kEarlyLate;
  Discriminator discriminator = Discriminator::kPower;
  double correlator_spacing_chips = 0.5;
  double front_end_mhz = 0.0;     ///< 0 = infinite; a channel is given at least the main lobes of its signal
  double code_loop_hz = 0.13;     ///< carrier-aided: 0.3 m of noise at 45 dB-Hz and half a chip
  bool code_loop_memory = false;  ///< multipath goes through the code loop; else it is there at once
  double carrier_loop_hz = 15.0;
  double integration_ms = 20.0;
  double thermal_noise_scale = 1.0;  ///< of code, carrier and Doppler, 1 = physical
  double multipath_scale = 1.0;      ///< of what echoes make of code, carrier and Doppler, 1 = physical
  HiddenSignals hidden_signals = HiddenSignals::kAsReceived;

  CorrelatorDesign channel(Modulation modulation_of_channel) const;
};
void visit(FieldVisitor& f, TrackingConfig& c);

/// Where the loops settle.
struct CodeLock {
  double delay_m = 0.0;    ///< of the tracked code
  double amplitude = 0.0;  ///< RMS prompt correlation over about 1 s, relative to a lone signal of amplitude 1
  double phase_rad = 0.0;  ///< of the tracked carrier, within half a turn of the reference signal's phase
  double doppler_hz = 0.0;
  std::size_t reference = 0;  ///< the strongest signal, whose peak is tracked
};

/// Code and carrier tracking of the composite of several signals.
///
/// The code loop settles at the stable zero (rising through zero) of its discriminator that is nearest to the strongest
/// signal. With a coherent discriminator each signal enters linearly, as a phasor in the carrier loop's frame; with
/// powers, each pair of signals enters with its difference of phase. Phases turn: predetection integration T and the
/// first-order loop of noise bandwidth B average a term of frequency f (for coherent: against the reference signal; for
/// powers: between the two of the pair) by
///
///   H(f) = sinc(f T) / (1 + j 2 pi f / (4 B)).
///
/// So with antenna and reflector at rest (f = 0) the multipath error stands whole, and it averages down as the vehicle
/// moves; with powers what remains is the pull of the echoes' own power. The carrier loop sees the same phasors through
/// its own, wider, bandwidth; the prompt power is averaged over 1 s.
///
/// At rest, infinitely wide band, coherent, the zeros are exact to rounding: all is piecewise linear. Otherwise they
/// are refined to 1e-9 chips.
class CodeTracking {
 public:
  /// Throws for values out of range.
  explicit CodeTracking(const CorrelatorDesign& design);

  /// nullopt: no stable zero within reach, the signals have cancelled the correlation peak, or there are none.
  std::optional<CodeLock> track(std::span<const EchoSignal> signals) const;

  /// 1-sigma thermal noise of the code loop, m (Betz & Kolodziejski 2000; Kaplan & Hegarty 2006, section 5.6.3):
  ///
  ///   sigma^2 = B (1 - B T / 2) u'Ru / (C/N0 slope^2) [1 + (R(0) + R(d)) / (2 T C/N0 R(d/2)^2)]
  ///
  /// u the taps' weights, R their correlations, slope that of the discriminator; the bracket, the squaring loss, only
  /// for powers. For BPSK in an infinite band it is the familiar B d / (2 C/N0) [1 + 2 / (T C/N0 (2 - d))] chips^2.
  double noise_m(double cn0_dbhz) const;

  const CorrelatorDesign& design() const { return design_; }
  const CodeCorrelation& correlation() const { return correlation_; }

 private:
  struct Tap {
    double offset_chips, weight;
  };
  struct Composite;
  /// What thermal noise depends on beside C/N0: sine integrals of the design alone, in a band-limited front end.
  struct NoiseShape {
    double variance = 0.0, slope = 0.0;            ///< u'Ru, and of the discriminator
    double squaring_power = 0.0, half_peak = 0.0;  ///< R(0) + R(d), R(d/2)
  };

  NoiseShape noise_shape() const;
  Composite composite(std::span<const EchoSignal> signals, std::size_t reference) const;
  double discriminator(const Composite& c, double t_chips) const;
  void scan_points(const Composite& c, std::vector<double>& points) const;
  std::optional<double> stable_zero(const Composite& c) const;
  double refine(const Composite& c, double low, double low_value, double high, double high_value) const;

  CorrelatorDesign design_;
  CodeCorrelation correlation_;
  std::vector<Tap> taps_;
  NoiseShape noise_;
};

}  // namespace canyon::gnss

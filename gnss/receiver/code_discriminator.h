#pragma once

#include <optional>
#include <span>

namespace canyon::gnss {

/// A reflected signal beside a direct one of amplitude 1, delay 0, phase 0.
struct EchoSignal {
  double delay_m = 0.0;
  double amplitude = 0.0;
  double phase_rad = 0.0;
};

/// Code tracking error, m, of a coherent early-minus-late delay lock loop at rest: BPSK(1), infinite bandwidth
/// (triangular correlation of one C/A chip), carrier tracked on the direct signal. `spacing_chips` early to late, (0,
/// 1].
///
/// The discriminator sum_i a_i cos(phase_i) [R(t - d/2 - delay_i) - R(t + d/2 - delay_i)] is piecewise linear; its
/// zeros are found exactly, interval by interval, and the stable one (rising through zero) nearest to the direct signal
/// is returned. nullopt if there is none: reflections have cancelled the correlation peak.
std::optional<double> coherent_early_late_error_m(std::span<const EchoSignal> echoes, double spacing_chips);

/// Amplitude of direct plus reflected signals at the direct signal's prompt correlator, relative to the direct one
/// alone.
double composite_amplitude(std::span<const EchoSignal> echoes);

}  // namespace canyon::gnss

#pragma once

#include <optional>

#include "canyon/gnss/rinex/observation/observation_file.h"

namespace canyon::gnss {

/// A pseudorange of an observation file with what belongs to the same signal; NaN where it is missing.
struct SignalObservation {
  ObservationCode code;
  double pseudorange_m = kNaN, phase_cycles = kNaN, doppler_hz = kNaN, cn0_dbhz = kNaN;
  bool loss_of_lock = false;
};

/// The signal of one satellite that a single-frequency user takes: the system's first band (BeiDou: B1I, else B1C), the
/// civil code before the encrypted one; of several, the first that has a pseudorange. nullopt: none.
std::optional<SignalObservation> single_frequency_signal(const std::vector<ObservationCode>& codes,
                                                         const SatelliteObservations& satellite);

/// The two signals of the ionosphere-free combination that the broadcast clocks are made for, where they are there: GPS
/// and QZSS L1 P(Y) and L2 P(Y), else civil ones; Galileo E1 and E5a, else E5b; BeiDou B1I and B3I, else B2I; GLONASS
/// G1 and G2.
struct SignalPair {
  SignalObservation first, second;
};
std::optional<SignalPair> dual_frequency_signals(const std::vector<ObservationCode>& codes,
                                                 const SatelliteObservations& satellite);

}  // namespace canyon::gnss

#pragma once

#include <array>

#include "canyon/core/messages.h"

namespace canyon::gnss {

/// The two RINEX bands whose ionosphere-free combination a system's precise clocks refer to: GPS, GLONASS and QZSS 1
/// and 2, Galileo 1 and 5 (E1, E5a), BeiDou 2 and 6 (B1I, B3I), the conventions of the IGS multi-GNSS products.
struct BandPair {
  int first, second;
};
BandPair precise_clock_bands(GnssSystem system);

/// Weights of the ionosphere-free combination of two bands: first + second = 1. They are the same for all channels of
/// GLONASS, whose two carriers keep the ratio 9 : 7.
struct CombinationWeights {
  double first, second;
};
CombinationWeights ionosphere_free(GnssSystem system, BandPair bands);

/// Delay of that combination, from delays by band (SatelliteState::group_delay_s): what to subtract from a broadcast
/// clock to compare it with a precise one. 0 for GLONASS, whose messages do not say what their clock refers to.
double delay_of_precise_clock_s(GnssSystem system, const std::array<double, 10>& group_delay_s);

}  // namespace canyon::gnss

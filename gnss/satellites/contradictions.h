#pragma once

#include <vector>

#include "canyon/gnss/satellites/ephemerides/glonass_ephemeris.h"
#include "canyon/gnss/satellites/ephemerides/kepler_ephemeris.h"

namespace canyon::gnss {

/// A record that stands against all its neighbours.
struct Contradiction {
  std::size_t index = 0;    ///< in the vector given
  double distance_m = 0.0;  ///< to the nearest of them
};

/// Healthy records whose orbit is more than 5 km away, at their own toe, from that of each of the two records before
/// and the two after it of the same satellite and message (within 4 h, GLONASS 1 h), while two of those agree with one
/// another. Merged daily files contain such records: another satellite's orbit under this one's number, an epoch a
/// quarter of an hour off. Honest extrapolation over these times stays below 1 km, manoeuvres leave the records on
/// one side in agreement. Ascending by index.
std::vector<Contradiction> contradictions(const std::vector<KeplerEphemeris>& records);
std::vector<Contradiction> contradictions(const std::vector<GlonassEphemeris>& records);

}  // namespace canyon::gnss

#pragma once

#include "canyon/gnss/satellites/ephemerides/kepler_ephemeris.h"

/// What the numbers of an ephemeris may be at most, in size, before its record counts as damaged: no less than any
/// system's messages can hold where the orbit stays sane (IS-GPS-200N tables 20-III and 30-I, OS SIS ICD 2.1,
/// BDS-SIS-ICD-B1I 3.0). A number beyond would not be an orbit but overflow in its evaluation.
namespace canyon::gnss::ephemeris_limits {

inline constexpr double kAngleRad = 10.0;          ///< of the elements; writers differ in where they cut the circle
inline constexpr double kRateRadS = 1e-6;          ///< delta n, OMEGA DOT, IDOT
inline constexpr double kRateOfRateRadS2 = 1e-10;  ///< delta n dot of CNAV: 2^-35 semicircles/s^2
inline constexpr double kHarmonicM = 32768.5;      ///< Crs, Crc: CNAV's 24 bits of 2^-8 m
inline constexpr double kHarmonicRad = 1e-3;       ///< Cuc to Cis: CNAV's 21 bits of 2^-30
inline constexpr double kGrowthMS = 10.0;          ///< A DOT: 25 bits of 2^-21 m/s
inline constexpr double kClockS = 1.0;
inline constexpr double kClockRate = 1e-7;                  ///< Galileo: 2^-26
inline constexpr double kClockRateOfRate = 1e-12;           ///< GPS: 2^-48 /s
inline constexpr double kLowestM = 6.3e6, kHighestM = 1e8;  ///< distance from the Earth's centre at toe

/// Distance from the Earth's centre at toe, m. The record's numbers must be within the limits above.
inline double radius_at_toe_m(const KeplerEphemeris& r) {
  return r.at(r.toe).p_E.norm();
}
inline bool is_sane_radius(double radius_m) {
  return radius_m >= kLowestM && radius_m <= kHighestM;
}

}  // namespace canyon::gnss::ephemeris_limits

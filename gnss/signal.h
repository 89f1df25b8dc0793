#pragma once

#include "canyon/core/messages.h"
#include "canyon/core/units.h"

/// Constants of the GPS signal and of its user algorithms (IS-GPS-200). They differ from core/earth/earth.h in the last
/// digits on purpose: a broadcast ephemeris is fitted with exactly these values and must be evaluated with them.
namespace canyon::gnss {

inline constexpr double kGpsMu = 3.986005e14;               ///< m^3/s^2, IS-GPS-200 table 20-IV
inline constexpr double kGpsEarthRate = 7.2921151467e-5;    ///< rad/s, IS-GPS-200 table 20-IV
inline constexpr double kGpsRelativity = -4.442807633e-10;  ///< F of IS-GPS-200 20.3.3.3.3.1, s/sqrt(m)
inline constexpr double kL1Hz = 1575.42e6;
inline constexpr double kL1WavelengthM = kSpeedOfLight / kL1Hz;
inline constexpr double kCaChipM = kSpeedOfLight / 1.023e6;  ///< length of a C/A code chip, 293.05 m

/// GLONASS frequency number of a satellite whose channel nobody tells.
inline constexpr int kUnknownChannel = 99;

/// Carrier frequency, Hz, of a RINEX band digit (RINEX 4.01, tables 10 to 16); NaN for a band the system does not have.
/// `channel`: GLONASS frequency number, -7..6; kUnknownChannel gives NaN for its FDMA bands.
double carrier_hz(GnssSystem system, int band, int channel = 0);
/// Band of the system's first open single-frequency signal: 1 (L1, E1, G1), but 2 (B1I) for BeiDou.
int first_band(GnssSystem system);
/// The other band that a dual-frequency receiver measures: L2 and its like (Galileo E5b, BeiDou B3I), or L5, E5a, B2a.
enum class SecondFrequency { kL2, kL5 };
int second_band(GnssSystem system, SecondFrequency second);

}  // namespace canyon::gnss

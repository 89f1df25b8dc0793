#pragma once

#include <array>
#include <optional>

#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/navigation_message.h"

namespace canyon::gnss {

/// One broadcast ephemeris and clock record of GPS, QZSS, Galileo or BeiDou: all of them are an ellipse with secular
/// and second-harmonic corrections. SI and radians, names as in IS-GPS-200N tables 20-III and 30-I. All instants are
/// GPS time, also where the message counts in BDT.
struct KeplerEphemeris {
  SatelliteId sv;
  NavigationMessage message = NavigationMessage::kLnav;
  GpsTime toc, toe;
  std::optional<GpsTime> transmitted;  ///< of the message; nullopt where the record does not tell
  double af0_s = 0.0, af1 = 0.0, af2_per_s = 0.0;
  double sqrt_a = 0.0;     ///< sqrt(m), at toe
  double a_dot_m_s = 0.0;  ///< CNAV and its relatives; 0 in the others, as is delta_n_dot
  double e = 0.0;          ///< [0, 1)
  double i0_rad = 0.0, idot_rad_s = 0.0;
  double omega0_rad = 0.0, omega_dot_rad_s = 0.0;
  double argument_of_perigee_rad = 0.0;
  double m0_rad = 0.0, delta_n_rad_s = 0.0, delta_n_dot_rad_s2 = 0.0;
  double cuc_rad = 0.0, cus_rad = 0.0, crc_m = 0.0, crs_m = 0.0, cic_rad = 0.0, cis_rad = 0.0;
  /// GPS, QZSS: TGD. Galileo: BGD(E1, E5a). BeiDou: TGD1 (B1I to B3I), with B-CNAV TGD_B1Cp.
  double tgd_s = 0.0;
  /// Galileo: BGD(E1, E5b). BeiDou: TGD2 (B2I to B3I), with B-CNAV TGD_B2ap.
  double tgd2_s = 0.0;
  /// Inter-signal corrections by RINEX band digit: CNAV 1 = L1 C/A, 2 = L2C, 5 = L5I; B-CNAV 1 = B1C data, 5 = B2a
  /// data.
  std::array<double, 10> isc_s{};
  int iode = 0;
  int health = 0;                                                      ///< as in the record; healthy() reads it
  double valid_before_s = 2.0 * 3600.0, valid_after_s = 2.0 * 3600.0;  ///< of toe; default_validity()
  double accuracy_m = 0.0;  ///< URA, SISA; negative: no accuracy prediction; NaN: not told in metres

  /// 0 in the health field of the record. Not counted: in QZSS LNAV the lowest bit, which speaks of L1 C/B
  /// (IS-QZSS-PNT-005), in CNAV the lowest of the three, which speaks of L5 (IS-GPS-200N 30.3.3.1.1.2) and was set on
  /// every satellite while L5 was pre-operational. Galileo's SISA must also be predicted (OS SDD 1.3: else "marginal").
  bool healthy() const;
  /// t lies inside the time for which the orbit was fitted: toe - valid_before_s <= t <= toe + valid_after_s.
  bool valid_at(GpsTime t) const;
  /// In the geostationary belt and described by a D2 message, whose frame is inclined by 5 deg.
  bool geostationary_frame() const;
  /// What a user of each band alone subtracts from the clock, as in SatelliteState. BeiDou's B1C and B1I, 14 MHz
  /// apart, lend one another their delay where the message tells one of them: the two differ by 3.3 ns RMS, where each
  /// is 16 ns (27 satellites with both messages on 2023-03-12).
  std::array<double, 10> group_delay_s() const;
  /// Bit b: group_delay_s() of band b is lent by another.
  unsigned borrowed_delay_bands() const;
  /// Position, velocity and clock by the user algorithm (IS-GPS-200N tables 20-IV and 30-II; BDS-SIS-ICD-B1I 3.0 table
  /// 5-11 for the geostationary frame), with the system's own constants. Evaluates outside the fit interval too; the
  /// caller checks valid_at().
  SatelliteState at(GpsTime t) const;
};

/// For how long before and after toe a record without a fit interval of its own is used.
struct Validity {
  double before_s, after_s;
};

/// GPS LNAV 2 h to either side (IS-GPS-200N 20.3.4.4) unless the record has a longer fit interval, CNAV 1.5 h
/// (30.3.3.1: fit interval of three hours). QZSS 1 h to either side (IS-QZSS-PNT-005; LNAV's flag doubles it). Galileo
/// from 1 h before to 4 h after: the OS SDD forbids data older than 4 h, and toe lies before the transmission. BeiDou
/// from 1 h before to 2 h after: its ICD gives no fit interval, toe comes every hour. Measured on all records of
/// 2023-03-12 against the fresh one: 95 % of the orbits are within 7 m at these limits except for QZSS with the flag,
/// 11 m; one hour beyond them, Galileo 19 m before and BeiDou 6 m before and after.
Validity default_validity(GnssSystem system, NavigationMessage message);

}  // namespace canyon::gnss

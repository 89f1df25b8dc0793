#pragma once

#include <cstdint>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/navigation_data.h"

/// Kinds of navigation messages with the constants of their documents, and drawn records of each.
namespace canyon::gnss::made {

inline const GpsTime kSentWeek = GpsTime::from_week_sow(2253, 0.0);

struct Kind {
  GnssSystem system;
  NavigationMessage message;
  double mu, rate, ahead_s;
};
/// Constants as the interface documents print them: IS-GPS-200N 20-IV, OS SIS ICD 2.1 5.1.1, BDS-SIS-ICD-B1I 3.0.
inline constexpr Kind kKinds[] = {
    {GnssSystem::kGps, NavigationMessage::kLnav, 3.986005e14, 7.2921151467e-5, 0.0},
    {GnssSystem::kGps, NavigationMessage::kCnav, 3.986005e14, 7.2921151467e-5, 0.0},
    {GnssSystem::kQzss, NavigationMessage::kCnav2, 3.986005e14, 7.2921151467e-5, 0.0},
    {GnssSystem::kGalileo, NavigationMessage::kInav, 3.986004418e14, 7.2921151467e-5, 0.0},
    {GnssSystem::kGalileo, NavigationMessage::kFnav, 3.986004418e14, 7.2921151467e-5, 0.0},
    {GnssSystem::kBeidou, NavigationMessage::kD1, 3.986004418e14, 7.2921150e-5, 14.0},
    {GnssSystem::kBeidou, NavigationMessage::kD2, 3.986004418e14, 7.2921150e-5, 14.0},
    {GnssSystem::kBeidou, NavigationMessage::kBcnav1, 3.986004418e14, 7.2921150e-5, 14.0},
    {GnssSystem::kBeidou, NavigationMessage::kBcnav2, 3.986004418e14, 7.2921150e-5, 14.0}};

/// With every term that a message may have.
inline KeplerEphemeris some_record(const Kind& kind, const RandomStream& draws, std::uint64_t k) {
  const auto u = [&](std::uint32_t i, double most) { return draws.uniform(-most, most, i, k); };
  KeplerEphemeris r;
  r.sv = {kind.system, static_cast<std::uint8_t>(1 + k % 30)};
  r.message = kind.message;
  r.toe = kSentWeek + 7200.0 * static_cast<double>(1 + k % 80);
  r.toc = r.toe - 960.0;
  r.af0_s = u(0, 4e-4), r.af1 = u(1, 1e-11), r.af2_per_s = u(2, 1e-17);
  r.sqrt_a = 5153.7 + u(3, 3.0), r.e = draws.uniform(0.0, 0.03, 4, k);
  r.a_dot_m_s = u(5, 0.02), r.delta_n_dot_rad_s2 = u(6, 1e-13);
  r.i0_rad = kind.message == NavigationMessage::kD2 ? 0.1 + u(7, 0.02) : 0.96 + u(7, 0.05), r.idot_rad_s = u(8, 5e-10);
  r.omega0_rad = u(9, kPi), r.omega_dot_rad_s = u(10, 9e-9);
  r.argument_of_perigee_rad = u(11, kPi), r.m0_rad = u(12, kPi), r.delta_n_rad_s = u(13, 5e-9);
  r.cuc_rad = u(14, 1e-5), r.cus_rad = u(15, 1e-5), r.cic_rad = u(16, 1e-6), r.cis_rad = u(17, 1e-6);
  r.crc_m = u(18, 400.0), r.crs_m = u(19, 400.0);
  r.tgd_s = u(20, 2e-8), r.tgd2_s = u(21, 2e-8);
  for (std::uint32_t b = 0; b < 10; ++b) r.isc_s[b] = u(30 + b, 5e-9);
  r.accuracy_m = 2.0;
  return r;
}

}  // namespace canyon::gnss::made

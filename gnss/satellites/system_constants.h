#pragma once

#include "canyon/core/messages.h"

namespace canyon::gnss {

/// Constants with which a system's broadcast ephemerides are fitted, and must therefore be evaluated. They differ from
/// core/earth/earth.h and from one another in the last digits on purpose.
struct SystemConstants {
  double mu_m3_s2;          ///< gravitational constant of the Earth
  double earth_rate_rad_s;  ///< rotation rate of the Earth
  double ahead_s;           ///< GPS time minus the time of the system's own messages; GLONASS's UTC is not constant: 0
  /// -2 sqrt(mu) / c^2, s / sqrt(m): times e sqrt(A) sin E, the periodic relativity of the satellite's clock.
  double relativity_s_per_sqrt_m;
};

/// GPS: IS-GPS-200N table 20-IV; QZSS the same (IS-QZSS-PNT-005); Galileo: OS SIS ICD 2.1, 5.1.1 (GST = GPS time but
/// for nanoseconds); BeiDou: BDS-SIS-ICD-B1I 3.0, 5.2.4.12 (BDT = GPS time - 14 s); GLONASS: ICD L1, L2 edition 5.1,
/// table 3.2 (PZ-90).
const SystemConstants& constants_of(GnssSystem system);

}  // namespace canyon::gnss

#include "canyon/gnss/satellites/system_constants.h"

#include "canyon/gnss/signal.h"

namespace canyon::gnss {

const SystemConstants& constants_of(GnssSystem system) {
  static constexpr SystemConstants kGps{kGpsMu, kGpsEarthRate, 0.0, kGpsRelativity};
  static constexpr SystemConstants kGalileo{3.986004418e14, 7.2921151467e-5, 0.0, -4.442807309e-10};
  static constexpr SystemConstants kBeidou{3.986004418e14, 7.2921150e-5, 14.0, -4.442807309e-10};
  static constexpr SystemConstants kGlonass{3.9860044e14, 7.292115e-5, 0.0, 0.0};
  switch (system) {
    case GnssSystem::kGalileo:
      return kGalileo;
    case GnssSystem::kBeidou:
      return kBeidou;
    case GnssSystem::kGlonass:
      return kGlonass;
    default:
      return kGps;
  }
}

}  // namespace canyon::gnss

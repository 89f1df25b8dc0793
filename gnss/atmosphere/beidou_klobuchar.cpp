#include "canyon/gnss/atmosphere/beidou_klobuchar.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/satellites/system_constants.h"

namespace canyon::gnss {
namespace {

constexpr double kEarthM = 6378e3, kShellM = kEarthM + 375e3;
constexpr double kNightS = 5e-9;

}  // namespace

double beidou_klobuchar_delay_m(const KlobucharCoefficients& c, const SkyView& v) {
  const double s = kEarthM / kShellM * std::cos(v.elevation_rad);
  const double psi = 0.5 * kPi - v.elevation_rad - std::asin(s);
  const double lat_rad = std::asin(std::sin(v.receiver.lat_rad) * std::cos(psi) +
                                   std::cos(v.receiver.lat_rad) * std::sin(psi) * std::cos(v.azimuth_rad));
  const double lon_rad = v.receiver.lon_rad +
                         std::asin(std::clamp(std::sin(psi) * std::sin(v.azimuth_rad) / std::cos(lat_rad), -1.0, 1.0));

  // Local time at the pierce point, of the day of BDT.
  const double beidou_s = (v.t - constants_of(GnssSystem::kBeidou).ahead_s).sow_s();
  double local_s = std::fmod(beidou_s + lon_rad / kPi * 43200.0, 86400.0);
  if (local_s < 0.0) local_s += 86400.0;

  const double x = std::abs(lat_rad / kPi);
  const auto cubic = [x](const std::array<double, 4>& k) { return k[0] + x * (k[1] + x * (k[2] + x * k[3])); };
  const double amplitude_s = std::max(cubic(c.alpha), 0.0);
  const double period_s = std::clamp(cubic(c.beta), 72000.0, 172800.0);
  const double from_peak_s = local_s - 50400.0;
  const double day_s =
      std::abs(from_peak_s) < 0.25 * period_s ? amplitude_s * std::cos(2.0 * kPi * from_peak_s / period_s) : 0.0;
  return kSpeedOfLight * (kNightS + day_s) / std::sqrt(1.0 - s * s);
}

}  // namespace canyon::gnss

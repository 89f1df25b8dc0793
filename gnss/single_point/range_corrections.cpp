#include "gnss/single_point/range_corrections.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "gnss/atmosphere/troposphere.h"
#include "gnss/signal.h"
#include "gnss/single_point/group_delay.h"

namespace canyon::gnss {
namespace {

constexpr double kLowestRad = 5.0 * kDegree;

/// Saastamoinen (1972) with both zenith delays over the cosine of the zenith angle; atmosphere and constants as RTKLIB
/// 2.4.3 has them, heights below the ellipsoid as 0.
double saastamoinen_cosecant_m(const SkyView& v) {
  const double h_m = std::clamp(v.receiver.h_m, 0.0, 1e4);
  const double pressure_hpa = 1013.25 * std::pow(1.0 - 2.2557e-5 * h_m, 5.2568);
  const double temperature_k = 15.0 - 6.5e-3 * h_m + 273.16;
  constexpr double kHumidity = 0.7;
  const double vapour_hpa = 6.108 * kHumidity * std::exp((17.15 * temperature_k - 4684.0) / (temperature_k - 38.45));
  const double dry_m =
      0.0022768 * pressure_hpa / (1.0 - 0.00266 * std::cos(2.0 * v.receiver.lat_rad) - 0.00028e-3 * h_m);
  const double wet_m = 0.002277 * (1255.0 / temperature_k + 0.05) * vapour_hpa;
  return (dry_m + wet_m) / std::sin(v.elevation_rad);
}

int digit(char band) {
  return band - '0';
}

}  // namespace

std::vector<std::string> ionosphere_corrections_of_observations() {
  return {"none", "klobuchar", "klobuchar_own", "ionex"};
}

double ionosphere_correction_m(const std::string& model, const KlobucharCoefficients& klobuchar, const SkyView& view) {
  if (model == "none") return 0.0;
  return klobuchar_delay_m(klobuchar, view.t, view.receiver.lat_rad, view.receiver.lon_rad, view.azimuth_rad,
                           std::max(view.elevation_rad, kLowestRad));
}

std::vector<std::string> troposphere_corrections_of_observations() {
  return {"none", "saastamoinen_niell", "saastamoinen_cosecant"};
}

double troposphere_correction_m(const std::string& model, const SkyView& view) {
  if (model == "none") return 0.0;
  SkyView held = view;
  held.elevation_rad = std::max(held.elevation_rad, kLowestRad);
  return model == "saastamoinen_cosecant" ? saastamoinen_cosecant_m(held) : standard_troposphere_m(held);
}

CodeMeasurement single_measurement(const SignalObservation& signal, SatelliteId sv, int frequency_channel) {
  const double hz = carrier_hz(sv.system, digit(signal.code.band), frequency_channel);
  return {signal.pseudorange_m, signal.phase_cycles * kSpeedOfLight / hz, hz, 1.0};
}

CodeMeasurement ionosphere_free_measurement(const SignalPair& pair, SatelliteId sv, int frequency_channel) {
  const double hz1 = carrier_hz(sv.system, digit(pair.first.code.band), frequency_channel);
  const double hz2 = carrier_hz(sv.system, digit(pair.second.code.band), frequency_channel);
  const double a = first_weight(hz1, hz2), b = a - 1.0;
  return {a * pair.first.pseudorange_m - b * pair.second.pseudorange_m,
          kSpeedOfLight * (a * pair.first.phase_cycles / hz1 - b * pair.second.phase_cycles / hz2), hz1,
          std::hypot(a, b)};
}

}  // namespace canyon::gnss

#include "canyon/gnss/single_point/range_corrections.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/beidou_klobuchar.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/products/clock_datum.h"
#include "canyon/gnss/signal.h"

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

double no_troposphere_m(const SkyView&) {
  return 0.0;
}

/// At no lower elevation than kLowestRad.
template <auto Delay_m>
double not_below(const SkyView& view) {
  SkyView above = view;
  above.elevation_rad = std::max(above.elevation_rad, kLowestRad);
  return Delay_m(above);
}

}  // namespace

ModelTable<IonosphereCorrection> ionosphere_corrections() {
  static constexpr ModelRow<IonosphereCorrection> kRows[] = {
      {"none", IonosphereCorrection::kNone, "nothing"},
      {"klobuchar", IonosphereCorrection::kKlobuchar, "GPS's coefficients for all"},
      {"klobuchar_own", IonosphereCorrection::kKlobucharOwn, "each system's own where it sends some"},
      {"ionex", IonosphereCorrection::kIonex, "maps"},
  };
  return kRows;
}

bool is_klobuchar(IonosphereCorrection model) {
  return model == IonosphereCorrection::kKlobuchar || model == IonosphereCorrection::kKlobucharOwn;
}

double klobuchar_correction_m(GnssSystem system, const KlobucharCoefficients& coefficients, const SkyView& view) {
  SkyView held = view;
  held.elevation_rad = std::max(held.elevation_rad, kLowestRad);
  if (system == GnssSystem::kBeidou) {
    const double to_l1 = carrier_hz(GnssSystem::kBeidou, 2) / kL1Hz;
    return to_l1 * to_l1 * beidou_klobuchar_delay_m(coefficients, held);
  }
  return klobuchar_delay_m(coefficients, held.t, held.receiver.lat_rad, held.receiver.lon_rad, held.azimuth_rad,
                           held.elevation_rad);
}

ModelTable<TroposphereCorrection> troposphere_corrections() {
  static constexpr ModelRow<TroposphereCorrection> kRows[] = {
      {"none", no_troposphere_m, "nothing"},
      {"saastamoinen_niell", not_below<standard_troposphere_m>, "standard atmosphere, ladder of gnss/atmosphere"},
      {"saastamoinen_cosecant", not_below<saastamoinen_cosecant_m>,
       "zenith delays of a standard atmosphere with 70 % humidity over sin(elevation), as RTKLIB has it"},
  };
  return kRows;
}

CodeMeasurement single_measurement(const SignalObservation& signal, SatelliteId sv, int frequency_channel) {
  const double hz = carrier_hz(sv.system, digit(signal.code.band), frequency_channel);
  return {signal.pseudorange_m, signal.phase_cycles * kSpeedOfLight / hz, hz, 1.0};
}

CodeMeasurement ionosphere_free_measurement(const SignalPair& pair, SatelliteId sv, int frequency_channel) {
  const BandPair bands{digit(pair.first.code.band), digit(pair.second.code.band)};
  const double hz1 = carrier_hz(sv.system, bands.first, frequency_channel);
  const double hz2 = carrier_hz(sv.system, bands.second, frequency_channel);
  const CombinationWeights w = ionosphere_free(sv.system, bands);
  return {w.first * pair.first.pseudorange_m + w.second * pair.second.pseudorange_m,
          kSpeedOfLight * (w.first * pair.first.phase_cycles / hz1 + w.second * pair.second.phase_cycles / hz2), hz1,
          std::hypot(w.first, w.second)};
}

}  // namespace canyon::gnss

// Ionosphere and troposphere at the horizon, at the poles, at the ends of their heights and times.
#include <cmath>
#include <cstdio>
#include <limits>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/beidou_klobuchar.h"
#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/ionosphere_map.h"
#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;
const GpsTime kNoon = GpsTime::from_calendar(2010, 7, 1, 12, 0, 0.0);

/// Every place and direction; an answer that is not finite, or outside [least, most], counts.
template <class Delay>
StressFigure outside(const Delay& delay_m, double least_m, double most_m) {
  StressFigure out;
  for (const double lat : {-90.0, -89.999999, -75.0, -15.0, 0.0, 45.0, 75.0, 90.0})
    for (const double lon : {-180.0, -90.0, 0.0, 179.999999, 180.0})
      for (const double h : {-500.0, -400.0, 0.0, 11000.0, 20000.0})
        for (const double e : {0.0, 1e-12, 0.05, 0.5 * kPi - 1e-9, 0.5 * kPi})
          for (const double a : {0.0, 0.5 * kPi, kPi, 2.0 * kPi}) {
            const double d = delay_m(SkyView{kNoon + 3600.0 * lon / 15.0, {lat * kDegree, lon * kDegree, h}, e, a});
            out.figure += std::isfinite(d) && d >= least_m && d <= most_m ? 0.0 : 1.0;
          }
  return out;
}

/// A pierce point at the pole itself: there the sine of its latitude is a sum that may round above 1.
StressFigure pierce_points_at_the_pole() {
  StressFigure out;
  const auto pierce_lat = [](double lat, double e) {
    return lat + 0.5 * kPi - e - std::asin(6378.0 / 6753.0 * std::cos(e));
  };
  for (int k = 0; k < 400; ++k) {
    const double lat = (75.0 + 0.03 * k) * kDegree;
    double low = 0.0, high = 0.5 * kPi;  // at low the point lies beyond the pole
    for (int i = 0; i < 60; ++i) (pierce_lat(lat, 0.5 * (low + high)) > 0.5 * kPi ? low : high) = 0.5 * (low + high);
    for (int i = -3; i <= 3; ++i) {
      const double e = std::clamp(low + i * 1e-16, 0.0, 0.5 * kPi);
      for (const double sense : {1.0, -1.0}) {
        const SkyView view{kNoon, {sense * lat, 0.3, 0.0}, e, sense > 0.0 ? 0.0 : kPi};
        out.figure += std::isfinite(beidou_klobuchar_delay_m(kBuiltInKlobuchar, view)) ? 0.0 : 1.0;
      }
    }
  }
  return out;
}

/// The broadcast model's own series is 0.0207 of its amplitude where it is cut off at 1.57 rad; beside that nothing may
/// jump over a day and over the border of a week, where a second changes the phase by 7e-5 rad.
StressFigure over_the_day(GpsTime midnight) {
  const double lat = 0.56, lon = 3.1, e = 0.3, a = 2.0, step_s = 10.0;
  const auto delay = [&](GpsTime t) { return klobuchar_delay_m(kBuiltInKlobuchar, t, lat, lon, a, e); };
  double largest = 0.0, most = 0.0;
  for (double s = -43200.0; s < 43200.0; s += step_s) {
    const double d0 = delay(midnight + s), d1 = delay(midnight + (s + step_s));
    largest = worse(largest, std::abs(d1 - d0));
    most = worse(most, d1);
  }
  const double night = kSpeedOfLight * 5e-9 * klobuchar_obliquity(e), amplitude = most - night;
  // The step of the phase is 2 pi 10 s / 72000 s; the slope of the series is below 1.
  return {largest, amplitude * (0.0208 + 2.0 * kPi * step_s / 72000.0)};
}

/// One pierce point seen from its west, east, south and north, at any hour: as far off as the specification says of an
/// elevation, in semicircles, and east by the cosine of the latitude there. The same electrons: sixteen roundings of 20
/// m.
StressFigure one_pierce_point() {
  StressFigure out{0.0, 1.0};
  double most = 0.0, least = 1e9;
  for (const double elevation : {0.1, 0.4, 1.0})
    for (const double lat : {-0.5, 0.0, 0.7})
      for (double lon = -3.0; lon < 3.1; lon += 0.7) {
        const double away = kPi * (0.0137 / (elevation / kPi + 0.11) - 0.022), east = away / std::cos(lat);
        const auto from = [&](double by_lat, double by_lon, double azimuth) {
          return klobuchar_delay_m(kBuiltInKlobuchar, kNoon, lat + by_lat, lon + by_lon, azimuth, elevation);
        };
        const double west = from(0.0, -east, 0.5 * kPi),
                     others[] = {from(0.0, east, -0.5 * kPi), from(-away, 0.0, 0.0), from(away, 0.0, kPi)};
        for (const double other : others) take_worst(out, std::abs(other - west) / (16.0 * kEpsilon * 20.0));
        most = worse(most, west), least = std::min(least, west);
      }
  out.figure = most > 2.0 * least ? out.figure : stress::kInfinity;
  return out;
}

/// The coefficients of an ionosphere at an instant: of that system, the last that were given by then, else its first;
/// of a system without any, none. A figure counts what differs.
StressFigure coefficients_by_time() {
  NavigationData data;
  StressFigure out;
  const auto right = [&](bool holds) { out.figure += holds ? 0.0 : 1.0; };
  const auto first_alpha = [&](GnssSystem system, double hours) -> double {
    const auto found = data.klobuchar_at(system, kNoon + 3600.0 * hours);
    return found ? found->alpha[0] : -1.0;
  };
  right(first_alpha(GnssSystem::kGps, 0.0) == -1.0);
  for (const double hours : {4.0, 0.0, 8.0}) {
    BroadcastKlobuchar one{GnssSystem::kBeidou, kNoon + 3600.0 * hours, {}};
    one.coefficients.alpha[0] = hours;
    data.klobuchar.push_back(one);
  }
  for (const double hours : {-5.0, 0.0, 3.9, 4.0, 7.0, 8.0, 90.0})
    right(first_alpha(GnssSystem::kBeidou, hours) == (hours < 4.0 ? 0.0 : hours < 8.0 ? 4.0 : 8.0));
  right(first_alpha(GnssSystem::kGps, 5.0) == -1.0 && first_alpha(GnssSystem::kQzss, 5.0) == -1.0);
  return out;
}

/// Of zero electrons by day there is still the night's 5 ns, times the obliquity.
StressFigure night() {
  StressFigure out{0.0, 4.0 * kEpsilon * 10.0};
  for (double e = 0.0; e <= 0.5 * kPi; e += 0.01) {
    const double x = 0.53 - e / kPi, exact = kSpeedOfLight * 5e-9 * (1.0 + 16.0 * x * x * x);
    take_worst(out, std::abs(klobuchar_delay_m({}, kNoon, 0.5, 0.0, 1.0, e) - exact));
  }
  return out;
}

/// A shell's obliquity: 1 at the zenith, 1 / sqrt(1 - (R / (R + h))^2) at the horizon; in between it falls. At the
/// horizon the root of a small difference enlarges rounding by 1 / (1 - s^2) = 10.
StressFigure shell() {
  StressFigure out{0.0, 64.0 * kEpsilon};
  const double s = 6378.137 / 6728.137;
  take_worst(out, std::abs(single_layer_obliquity(0.5 * kPi) - 1.0));
  take_worst(out, std::abs(single_layer_obliquity(0.0) * std::sqrt((1.0 - s) * (1.0 + s)) - 1.0));
  for (int k = 0; k < 1000; ++k)
    if (!(single_layer_obliquity(k * kPi / 2000.0) > single_layer_obliquity((k + 1) * kPi / 2000.0))) out.figure = 1.0;
  return out;
}

/// dp/dh = -rho g: central differences over 20 m, with the gas constant of dry air. ICAO's rounded exponents (5.25588,
/// 2.25577e-5) hold it to 2e-5, the truncation h^2 / 6 / (8 km)^2 to 3e-7; the kink of temperature at 11 km is inside.
StressFigure hydrostatic() {
  StressFigure out{0.0, 5e-5};
  for (double h = -480.0; h <= 19980.0; h += 20.0) {
    if (std::abs(h - 11000.0) < 10.0) continue;
    const Weather below = standard_weather(h - 10.0), above = standard_weather(h + 10.0), here = standard_weather(h);
    const double slope = (above.pressure_hpa - below.pressure_hpa) / 20.0;
    const double exact = -here.pressure_hpa * 9.80665 / (287.053 * (here.temperature_c + 273.15));
    take_worst(out, std::abs(slope / exact - 1.0));
  }
  return out;
}

/// Across the tropopause, and where heights are held: no jump beyond what 1e-6 m makes (1e-10 of the pressure).
StressFigure no_jump() {
  StressFigure out{0.0, 1e-9};
  for (const double h : {-500.0, 11000.0, 20000.0}) {
    const Weather a = standard_weather(h - 1e-6), b = standard_weather(h + 1e-6);
    take_worst(out, std::abs(a.pressure_hpa / b.pressure_hpa - 1.0));
    take_worst(out, std::abs(a.temperature_c - b.temperature_c) / 273.15);
  }
  return out;
}

/// A mapping is 1 at the zenith by its construction, to a few roundings, and falls all the way from the horizon.
StressFigure mapping() {
  StressFigure out{0.0, 16.0 * kEpsilon};
  for (const double lat : {-90.0, -75.0, -40.0, -15.0, 0.0, 15.0, 50.0, 75.0, 90.0})
    for (const double day : {1.0, 28.0, 210.5, 366.99}) {
      take_worst(out, std::abs(niell_wet(0.5 * kPi, lat * kDegree) - 1.0));
      take_worst(out, std::abs(niell_hydrostatic(0.5 * kPi, lat * kDegree, 0.0, day) - 1.0));
      for (int k = 0; k < 500; ++k) {
        const double low = k * kPi / 1000.0, high = (k + 1) * kPi / 1000.0;
        if (!(niell_wet(low, lat * kDegree) > niell_wet(high, lat * kDegree))) out.figure = 1.0;
        if (!(niell_hydrostatic(low, lat * kDegree, 0.0, day) > niell_hydrostatic(high, lat * kDegree, 0.0, day)))
          out.figure = 1.0;
      }
    }
  return out;
}

/// A world of one value, on a grid of the usual kind.
IonexMaps maps_of(double tecu, bool whole_turn) {
  IonexMaps maps;
  maps.lat_first_deg = 87.5, maps.lat_step_deg = -2.5, maps.latitudes = 71;
  maps.lon_first_deg = -180.0, maps.lon_step_deg = 5.0, maps.longitudes = whole_turn ? 73 : 72;
  for (int k = 0; k < 3; ++k)
    maps.maps.push_back({kNoon + 7200.0 * k, std::vector<double>(maps.latitudes * maps.longitudes, tecu)});
  return maps;
}

/// Of a world of one value every point has that value: weights sum to 1 to 8 eps, at any longitude and over the poles.
StressFigure one_value() {
  StressFigure out{0.0, 8.0 * kEpsilon * 12.5};
  for (const bool whole : {true, false}) {
    const IonexMaps maps = maps_of(12.5, whole);
    for (double lat = -90.0; lat <= 90.0; lat += 7.5)
      for (const double lon :
           {-540.0, -180.0, -179.99999999999997, -177.5, 0.0, 175.0, 179.99999999999997, 180.0, 361.0})
        for (const double s : {0.0, 1e-9, 3599.5, 7200.0, 14399.999999999, 14400.0})
          take_worst(out, std::abs(maps.vtec_tecu(lat * kDegree, lon * kDegree, kNoon + s) - 12.5));
  }
  return out;
}

/// Beside the maps' time there is none; a figure counts values.
StressFigure beside_the_maps() {
  const IonexMaps maps = maps_of(12.5, true);
  StressFigure out;
  for (const double s : {-1e9, -1e-9, 14400.000000001, 1e9})
    out.figure += std::isnan(maps.vtec_tecu(0.5, 1.0, kNoon + s)) ? 0.0 : 1.0;
  return out;
}

/// A map that rises with longitude all around and jumps back at the antimeridian must be met there from either side: a
/// step of 1e-9 deg changes a value by its slope, 360 / 5 columns of 1 TECU over 1e-9 / 5, and rounding.
StressFigure antimeridian() {
  IonexMaps maps = maps_of(0.0, true);
  for (auto& map : maps.maps)
    for (std::size_t i = 0; i < map.vtec_tecu.size(); ++i)
      map.vtec_tecu[i] = 20.0 + 5.0 * std::cos(2.0 * kPi * static_cast<double>(i % 73) / 72.0);
  StressFigure out{0.0, 2e-9 / 5.0 * 0.5 + 64.0 * kEpsilon * 25.0};
  for (const double s : {0.0, 1234.5, 7200.0, 9999.0}) {
    const auto at = [&](double lon) { return maps.vtec_tecu(0.4, lon * kDegree, kNoon + s); };
    take_worst(out, std::abs(at(180.0 - 1e-9) - at(-180.0 + 1e-9)));
    take_worst(out, std::abs(at(180.0) - at(-180.0)));
  }
  return out;
}

}  // namespace

std::vector<StressCase> atmosphere_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "delays at the ends of sky and Earth",
           "secants at the horizon, a cosine of latitude at the poles, arguments a rounding beyond 1",
           "finite and within what air can do: 800 places, heights and directions, none outside", "outside"});
  const MeasuredWeather weather{{1022.0, 12.8, 0.80}, 0.0};
  rows.add("atmosphere/klobuchar_everywhere",
           [] {
             return outside(
                 [](const SkyView& v) {
                   return klobuchar_delay_m(kBuiltInKlobuchar, v.t, v.receiver.lat_rad, v.receiver.lon_rad,
                                            v.azimuth_rad, v.elevation_rad);
                 },
                 1.0, 150.0);
           })
      .add("atmosphere/beidou_klobuchar_everywhere",
           [] {
             return outside([](const SkyView& v) { return beidou_klobuchar_delay_m(kBuiltInKlobuchar, v); }, 1.0,
                            150.0);
           })
      .add("atmosphere/single_layer_everywhere",
           [] { return outside([](const SkyView& v) { return make_single_layer(200.0)->delay_m(v); }, 30.0, 110.0); })
      .add("atmosphere/ionosphere_map_everywhere",
           [] {
             return outside(
                 [maps = maps_of(100.0, true)](SkyView v) {
                   v.t = kNoon + 60.0;
                   return ionosphere_map_delay_m(maps, v);
                 },
                 15.0, 60.0);
           })
      .add("atmosphere/saastamoinen_niell_everywhere",
           [weather] {
             return outside([model = std::shared_ptr(make_saastamoinen_niell(weather))](
                                const SkyView& v) { return model->delay_m(v); },
                            0.0, 150.0);
           })
      .add("atmosphere/standard_everywhere",
           [] { return outside([](const SkyView& v) { return standard_troposphere_m(v); }, 0.0, 150.0); });

  rows.of({StressGroup::kGeometry, "a pierce point at the pole",
           "the sine of its latitude is a sum of products that rounds above 1: asin gives NaN",
           "finite: 400 latitudes of either sense, seven elevations a rounding apart", "not finite"});
  rows.add("atmosphere/beidou_pierce_point_at_the_pole", pierce_points_at_the_pole);

  rows.of({StressGroup::kLong, "local time around the day and the week",
           "a remainder of a negative time, or a week's last second, makes noon of midnight",
           "nothing jumps but the series' own 0.0208 of the amplitude at its end", "m"});
  rows.add("atmosphere/klobuchar_over_a_day", [] { return over_the_day(kNoon); })
      .add("atmosphere/klobuchar_over_the_week", [] { return over_the_day(GpsTime::from_week_sow(1617, 0.0)); });

  rows.of({StressGroup::kGeometry, "obliquity from the horizon to the zenith",
           "a shell below the receiver, an angle in degrees", "closed forms at both ends", ""});
  rows.add("atmosphere/night_of_no_electrons", night).add("atmosphere/shell_obliquity", shell);

  rows.of({StressGroup::kGeometry, "the standard atmosphere at its seams",
           "two laws that do not meet at the tropopause, a height that is not held, a scale height of the wrong air",
           "hydrostatic balance to 5e-5 (rounded constants of ICAO: 2e-5), no jump at the seams", ""});
  rows.add("atmosphere/hydrostatic_balance", hydrostatic).add("atmosphere/no_jump_at_the_seams", no_jump);
  rows.of({StressGroup::kGeometry, "a mapping function at both ends", "a season or latitude outside of the table",
           "1 at the zenith to 16 eps, falling all the way; any latitude and day", ""});
  rows.add("atmosphere/niell_at_all_latitudes_and_days", mapping);

  rows.of({StressGroup::kGeometry, "a map's wrap-around and border",
           "the column after the last, the row beyond the pole, the instant after the last map",
           "a world of one value has it everywhere; the antimeridian is no seam; beside its time there is none",
           "TECU"});
  rows.add("atmosphere/map_of_one_value", one_value).add("atmosphere/map_across_the_antimeridian", antimeridian);
  rows.of({StressGroup::kLong, "an instant beside the maps", "extrapolation, or the wrong map at the border",
           "no value", "values"});
  rows.add("atmosphere/beside_the_maps_time", beside_the_maps);
  rows.of({StressGroup::kGeometry, "a pierce point from all sides of it",
           "a sign of an azimuth, or degrees of longitude for those of latitude",
           "the same electrons: 16 roundings of 20 m", "of the bound"});
  rows.add("atmosphere/klobuchar_of_one_pierce_point", one_pierce_point);
  rows.of({StressGroup::kData, "coefficients of an ionosphere by their time",
           "those of another system, the next ones, or of none", "the last by then of that system, else its first",
           "differences"});
  rows.add("atmosphere/coefficients_by_time", coefficients_by_time);
  return rows.take();
}

}  // namespace canyon::gnss

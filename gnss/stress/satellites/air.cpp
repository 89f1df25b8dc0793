// Delays of the air, the Sun, and errors of orbits and clocks, each against its source written out once more.
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/config/config.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/beidou_klobuchar.h"
#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/ionosphere_map.h"
#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/atmosphere/weather.h"
#include "canyon/gnss/atmosphere/zenith_delay.h"
#include "canyon/gnss/errors/ephemeris_error.h"
#include "canyon/gnss/errors/gauss_markov.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/receiver/loop_noise.h"
#include "canyon/gnss/receiver/receiver_clock.h"
#include "canyon/gnss/satellites/sun.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

SkyView some_view(const RandomStream& draws, std::uint64_t k) {
  SkyView v;
  v.t = GpsTime::from_week_sow(1800 + static_cast<int>(k % 300), draws.uniform(0.0, 604800.0, 0, k));
  v.receiver = {draws.uniform(-1.4, 1.4, 1, k), draws.uniform(-kPi, kPi, 2, k), draws.uniform(-300.0, 5000.0, 3, k)};
  v.elevation_rad = draws.uniform(0.02, 1.57, 4, k), v.azimuth_rad = draws.uniform(0.0, 2.0 * kPi, 5, k);
  return v;
}

KlobucharCoefficients some_coefficients(const RandomStream& draws, std::uint64_t k) {
  KlobucharCoefficients c;
  const double alpha[] = {2e-8, 3e-8, 1e-7, 1e-7}, beta[] = {1.8e5, 2e5, 4e5, 8e5};
  for (std::size_t i = 0; i < 4; ++i) {
    c.alpha[i] = alpha[i] * draws.uniform(i == 0 ? 0.0 : -1.0, 1.0, 10 + static_cast<std::uint32_t>(i), k);
    c.beta[i] = beta[i] * draws.uniform(i == 0 ? 0.2 : -1.0, 1.0, 20 + static_cast<std::uint32_t>(i), k);
  }
  return c;
}

/// Of a day, s; from its beginning.
double of_the_day(double s) {
  return s - 86400.0 * std::floor(s / 86400.0);
}

/// IS-GPS-200N 20.3.3.5.2.5 and BDS-SIS-ICD-B1I 3.0, 5.2.4.7, by their own letters: rounding of a second of week,
/// 1e-10 s of a phase that changes a delay of 100 m by 1e-4 m/s, and 32 eps of it.
StressFigure klobuchar_as_printed() {
  Looks looks;
  const RandomStream draws(1, "stress.air");
  int by_day = 0, short_ones = 0, long_ones = 0;
  for (std::uint64_t k = 0; k < 4000; ++k) {
    const SkyView v = some_view(draws, k);
    const KlobucharCoefficients c = some_coefficients(draws, k);
    const double E = v.elevation_rad / kPi, A = v.azimuth_rad, tow = v.t.sow_s();
    {
      const double psi = 0.0137 / (E + 0.11) - 0.022;
      double phi_i = v.receiver.lat_rad / kPi + psi * std::cos(A);
      phi_i = phi_i > 0.416 ? 0.416 : phi_i < -0.416 ? -0.416 : phi_i;
      const double lambda_i = v.receiver.lon_rad / kPi + psi * std::sin(A) / std::cos(kPi * phi_i);
      const double phi_m = phi_i + 0.064 * std::cos(kPi * (lambda_i - 1.617));
      const double t = of_the_day(43200.0 * lambda_i + tow), F = 1.0 + 16.0 * std::pow(0.53 - E, 3);
      double AMP = 0.0, PER = 0.0;
      for (int n = 3; n >= 0; --n)
        AMP += c.alpha[static_cast<std::size_t>(n)] * std::pow(phi_m, n),
            PER += c.beta[static_cast<std::size_t>(n)] * std::pow(phi_m, n);
      if (AMP < 0.0) AMP = 0.0;
      if (PER < 72000.0) PER = 72000.0;
      const double x = 2.0 * kPi * (t - 50400.0) / PER;
      double T = F * 5e-9;
      if (std::abs(x) < 1.57) T += F * AMP * (1.0 - x * x / 2.0 + std::pow(x, 4) / 24.0);
      if (std::abs(std::abs(x) - 1.57) > 1e-9)
        looks.near(klobuchar_delay_m(c, v.t, v.receiver.lat_rad, v.receiver.lon_rad, A, v.elevation_rad),
                   kSpeedOfLight * T, 1e-10);
      by_day += std::abs(x) < 1.57 && AMP > 0.0 ? 1 : 0;
      looks.close(klobuchar_obliquity(v.elevation_rad), F, 8.0);
    }
    const double z = std::asin(6378.0 / (6378.0 + 375.0) * std::cos(v.elevation_rad));
    const double psi = kPi / 2.0 - v.elevation_rad - z;
    // Along the great circle, as vectors: the pierce point.
    const Vector3d up(std::cos(v.receiver.lat_rad) * std::cos(v.receiver.lon_rad),
                      std::cos(v.receiver.lat_rad) * std::sin(v.receiver.lon_rad), std::sin(v.receiver.lat_rad));
    const Vector3d east(-std::sin(v.receiver.lon_rad), std::cos(v.receiver.lon_rad), 0.0), north = up.cross(east);
    const Vector3d M = std::cos(psi) * up + std::sin(psi) * (std::cos(A) * north + std::sin(A) * east);
    // The document's longitude is an arc sine, which over a pole is the other one.
    if (M.head<2>().dot(up.head<2>()) <= 0.0) continue;
    const double phi = std::abs(std::asin(M.z())) / kPi, lambda = std::atan2(M.y(), M.x());
    double A2 = 0.0, A4 = 0.0;
    for (int n = 0; n < 4; ++n)
      A2 += c.alpha[static_cast<std::size_t>(n)] * std::pow(phi, n),
          A4 += c.beta[static_cast<std::size_t>(n)] * std::pow(phi, n);
    if (A2 < 0.0) A2 = 0.0;
    short_ones += A4 < 72000.0 ? 1 : 0, long_ones += A4 > 172800.0 ? 1 : 0;
    A4 = A4 < 72000.0 ? 72000.0 : A4 > 172800.0 ? 172800.0 : A4;
    const double t = of_the_day(tow - 14.0 + 43200.0 * lambda / kPi), off = t - 50400.0;
    double I = 5e-9;
    if (std::abs(off) < A4 / 4.0) I += A2 * std::cos(2.0 * kPi * off / A4);
    looks.near(beidou_klobuchar_delay_m(c, v), kSpeedOfLight * I / std::cos(z), 1e-10);
  }
  looks.right(by_day > 500 && short_ones > 100 && long_ones > 50);
  return looks.figure();
}

/// Niell (1996), tables 3 and 4, latitude by latitude: average a, b, c, their amplitudes, and the wet ones.
constexpr double kNiell[5][9] = {
    {1.2769934e-3, 2.9153695e-3, 62.610505e-3, 0.0, 0.0, 0.0, 5.8021897e-4, 1.4275268e-3, 4.3472961e-2},
    {1.2683230e-3, 2.9152299e-3, 62.837393e-3, 1.2709626e-5, 2.1414979e-5, 9.0128400e-5, 5.6794847e-4, 1.5138625e-3,
     4.6729510e-2},
    {1.2465397e-3, 2.9288445e-3, 63.721774e-3, 2.6523662e-5, 3.0160779e-5, 4.3497037e-5, 5.8118019e-4, 1.4572752e-3,
     4.3908931e-2},
    {1.2196049e-3, 2.9022565e-3, 63.824265e-3, 3.4000452e-5, 7.2562722e-5, 84.795348e-5, 5.9727542e-4, 1.5007428e-3,
     4.4626982e-2},
    {1.2045996e-3, 2.9024912e-3, 64.258455e-3, 4.1202191e-5, 11.723375e-5, 170.37206e-5, 6.1641693e-4, 1.7599082e-3,
     5.4736038e-2}};

double niell_entry(double lat_rad, int column) {
  const double deg = std::abs(lat_rad) * 180.0 / kPi;
  if (deg <= 15.0) return kNiell[0][column];
  if (deg >= 75.0) return kNiell[4][column];
  const int row = static_cast<int>(std::floor(deg / 15.0)) - 1;
  const double part = deg / 15.0 - 1.0 - row;
  return (1.0 - part) * kNiell[row][column] + part * kNiell[row + 1][column];
}

double niell_fraction(double a, double b, double c, double elevation_rad) {
  const double s = std::sin(elevation_rad);
  return (1.0 + a / (1.0 + b / (1.0 + c))) / (s + a / (s + b / (s + c)));
}

/// Mappings, zenith delays and weather by their sources, and the models made of them: 64 eps of up to 60 m.
StressFigure troposphere_as_printed() {
  Looks looks;
  const RandomStream draws(2, "stress.air");
  for (std::uint64_t k = 0; k < 600; ++k) {
    const SkyView v = some_view(draws, k);
    const double lat = v.receiver.lat_rad, h = v.receiver.h_m, e = v.elevation_rad,
                 day = draws.uniform(1.0, 366.0, 6, k);
    const double season = std::cos(2.0 * kPi * ((day - 28.0) / 365.25 + (lat < 0.0 ? 0.5 : 0.0)));
    double abc[3];
    for (int i = 0; i < 3; ++i) abc[i] = niell_entry(lat, i) - niell_entry(lat, 3 + i) * season;
    const double held = worse(e, 3.0 * kPi / 180.0);
    const auto hydrostatic_on = [&](double of_day) {
      const double turned = std::cos(2.0 * kPi * ((of_day - 28.0) / 365.25 + (lat < 0.0 ? 0.5 : 0.0)));
      double now[3];
      for (int i = 0; i < 3; ++i) now[i] = niell_entry(lat, i) - niell_entry(lat, 3 + i) * turned;
      return niell_fraction(now[0], now[1], now[2], e) +
             (1.0 / std::sin(held) - niell_fraction(2.53e-5, 5.49e-3, 1.14e-3, held)) * h / 1000.0;
    };
    looks.close(niell_hydrostatic(e, lat, h, day), hydrostatic_on(day), 256.0);
    looks.close(niell_hydrostatic_coefficients(lat, day).b, abc[1], 64.0);
    const double wet = niell_fraction(niell_entry(lat, 6), niell_entry(lat, 7), niell_entry(lat, 8), e);
    looks.close(niell_wet(e, lat), wet, 256.0);
    // Saastamoinen (1972) with Davis's constants.
    const double P = draws.uniform(600.0, 1040.0, 7, k), T = draws.uniform(-30.0, 40.0, 8, k), U = draws.uniform(9, k);
    looks.close(zenith_hydrostatic_m(P, lat, h),
                2.2768e-3 * P / (1.0 - 2.66e-3 * std::cos(2.0 * lat) - 2.8e-4 * h / 1000.0), 16.0);
    const Weather air{P, T, U};
    const double vapour = U * 6.112 * std::exp(17.62 * T / (243.12 + T));
    looks.close(vapour_pressure_hpa(air), vapour, 16.0);
    looks.close(zenith_wet_m(T, vapour), 2.2768e-3 * (1255.0 / (T + 273.15) + 0.05) * vapour, 16.0);
    // Carried by the ICAO atmosphere from where it was measured to the receiver.
    const auto icao_hpa = [](double at_m) { return 1013.25 * std::pow(1.0 - 0.0065 * at_m / 288.15, 5.25588); };
    const double from_m = draws.uniform(-200.0, 3000.0, 30, k);
    const MeasuredWeather measured{air, from_m};
    const Weather here = measured.at(h);
    looks.near(here.pressure_hpa / (P * icao_hpa(h) / icao_hpa(from_m)), 1.0, 1e-5);
    looks.near(here.temperature_c, T - 0.0065 * (h - from_m), 1e-11);
    looks.right(here.relative_humidity == U);
    const double today = v.t.day_of_year();
    const double dry_m = zenith_hydrostatic_m(here.pressure_hpa, lat, h),
                 wet_m = zenith_wet_m(here.temperature_c, vapour_pressure_hpa(here));
    const auto check = [&](const TroposphereModel& model, double exact) {
      looks.close(model.delay_m(v), exact, 512.0);
    };
    check(*make_saastamoinen_niell(measured), dry_m * hydrostatic_on(today) + wet_m * wet);
    const double paper_m = 2.2779e-3 * here.pressure_hpa / (1.0 - 0.00266 * std::cos(2.0 * lat) - 2.8e-7 * h);
    check(*make_paper_corrected_troposphere(measured), wet_m * wet + paper_m * hydrostatic_on(today));
    check(*make_paper_printed_troposphere(measured),
          wet + 2.2779e-3 * P / (1.0 - 0.00266 * std::cos(2.0 * lat) - 2.8e-6 * h));
    const Weather standard = standard_weather(h);
    looks.close(standard_troposphere_m(v),
                zenith_hydrostatic_m(standard.pressure_hpa, lat, h) * hydrostatic_on(today) +
                    zenith_wet_m(standard.temperature_c, vapour_pressure_hpa(standard)) * wet,
                512.0);
  }
  // The ICAO atmosphere's own table: height, pressure, temperature; its last digits, and 5e-5 for the exponent's.
  for (const auto& [h, hpa, celsius] : {std::array{-500.0, 1074.78, 18.25},
                                        {0.0, 1013.25, 15.0},
                                        {1000.0, 898.745, 8.5},
                                        {5000.0, 540.199, -17.5},
                                        {10000.0, 264.363, -50.0},
                                        {11000.0, 226.321, -56.5},
                                        {15000.0, 120.445, -56.5},
                                        {20000.0, 54.749, -56.5}}) {
    const Weather w = standard_weather(h);
    looks.near(w.pressure_hpa / hpa, 1.0, 7e-5);
    looks.near(w.temperature_c, celsius, 1e-9);
    looks.right(w.relative_humidity == 0.5);
  }
  looks.right(standard_weather(-900.0).pressure_hpa == standard_weather(-500.0).pressure_hpa);
  looks.right(standard_weather(3e4).pressure_hpa == standard_weather(2e4).pressure_hpa);
  // Magnus's own points: 6.112 hPa at the ice point, 23.3 hPa at 20 degrees (WMO 2008).
  looks.near(vapour_pressure_hpa({1000.0, 0.0, 1.0}), 6.112, 1e-12);
  looks.near(vapour_pressure_hpa({1000.0, 20.0, 1.0}), 23.33, 0.05);
  const SiteWeather site;
  looks.right(site.measured.weather.pressure_hpa == 1022.0 && site.measured.weather.temperature_c == 12.8);
  looks.right(site.measured.weather.relative_humidity == 0.8 && site.measured.height_m == 0.0);
  return looks.figure();
}

/// Of every model the largest delay that its need states is what it gives at the lowest view, a hundredth more where
/// the day counts too; and thin shells and maps by vectors to their pierce points.
StressFigure needs_and_shells() {
  Looks looks;
  const RandomStream draws(3, "stress.air");
  SkyView lowest = some_view(draws, 5);
  lowest.elevation_rad = 0.12;
  for (const auto& row : troposphere_models()) {
    if (row.make.need == nullptr) continue;
    ModelParameters own;
    if (row.parameters != nullptr) row.parameters(own);
    const auto model = row.make.make(own);
    looks.close(row.make.need(*model, lowest), 1.01 * model->delay_m(lowest), 4.0);
  }
  for (const auto& row : ionosphere_models()) {
    if (row.make.need == nullptr) continue;
    ModelParameters own;
    if (row.parameters != nullptr) row.parameters(own);
    const auto model = row.make.make(own, {});
    looks.close(row.make.need(**model, lowest), (*model)->delay_m(lowest), 4.0);
  }
  const double per_tecu = 40.3e16 / (1575.42e6 * 1575.42e6);
  looks.close(vertical_ionosphere_m(7.5), 7.5 * per_tecu, 8.0);
  looks.right(ElectronContent{}.vtec_tecu == 12.0);
  IonexMaps maps;
  maps.base_radius_m = 6371e3, maps.shell_height_m = 506.7e3;
  maps.lat_first_deg = 87.5, maps.lat_step_deg = -2.5, maps.lon_first_deg = -180.0, maps.lon_step_deg = 5.0;
  maps.latitudes = 71, maps.longitudes = 73;
  for (int m = 0; m < 2; ++m) {
    IonexMaps::Map map{GpsTime::from_week_sow(1900, 7200.0 * m), {}};
    for (std::size_t i = 0; i < 71; ++i)
      for (std::size_t j = 0; j < 73; ++j)
        map.vtec_tecu.push_back(20.0 + 9.0 * std::sin(0.05 * static_cast<double>(i)) +
                                5.0 * std::cos(2.0 * kPi * static_cast<double>(j) / 72.0) + 3.0 * m);
    maps.maps.push_back(map);
  }
  const auto mapped = make_mapped_ionosphere(std::make_shared<const IonexMaps>(maps), 12.0);
  for (std::uint64_t k = 0; k < 400; ++k) {
    SkyView v = some_view(draws, k);
    v.t = GpsTime::from_week_sow(1900, draws.uniform(0.0, 7200.0, 40, k));
    const double lat = v.receiver.lat_rad, lon = v.receiver.lon_rad;
    const Vector3d up(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)),
        east(-std::sin(lon), std::cos(lon), 0.0), north = up.cross(east);
    const Vector3d way = std::sin(v.elevation_rad) * up +
                         std::cos(v.elevation_rad) * (std::cos(v.azimuth_rad) * north + std::sin(v.azimuth_rad) * east);
    // Where the ray from the sphere meets the shell, and how steeply.
    const auto meet = [&](double radius, double shell) {
      const Vector3d p = radius * up;
      const double b = p.dot(way), along = -b + std::sqrt(b * b + shell * shell - radius * radius);
      return Vector3d((p + along * way).normalized());
    };
    const Vector3d pierce = meet(6371e3, 6371e3 + 506.7e3);
    const double vtec = maps.vtec_tecu(std::asin(pierce.z()), std::atan2(pierce.y(), pierce.x()), v.t);
    // Places of 1e-15 rad; grids change by less than 1e3 TECU per radian.
    looks.near(ionosphere_map_delay_m(maps, v), per_tecu * vtec / pierce.dot(way), 1e-10);
    looks.near(mapped->delay_m(v), per_tecu * vtec / pierce.dot(way), 1e-10);
    looks.near(single_layer_obliquity(v.elevation_rad), 1.0 / meet(6378.137, 6378.137 + 350.0).dot(way), 1e-11);
    looks.near(make_single_layer(30.0)->delay_m(v), 30.0 * per_tecu * single_layer_obliquity(v.elevation_rad), 1e-12);
    v.t = v.t + 7200.0;  // beyond the maps
    looks.near(mapped->delay_m(v), 12.0 * per_tecu * single_layer_obliquity(v.elevation_rad), 1e-12);
  }
  return looks.figure();
}

/// The Sun by Meeus's lower accuracy (Astronomical Algorithms, chapter 25), without nutation: either is good to 0.01
/// degrees between 1950 and 2050.
StressFigure the_sun() {
  Looks looks;
  for (int k = 0; k < 500; ++k) {
    const GpsTime t = GpsTime::from_calendar(1990, 1, 1, 0, 0, 0.0) + 86400.0 * (43.37 * k);
    const double d = (t - GpsTime::from_calendar(2000, 1, 1, 12, 0, 0.0) - t.leap_seconds()) / 86400.0, T = d / 36525.0;
    const double L0 = 280.46646 + 36000.76983 * T, M = (357.52911 + 35999.05029 * T) * kPi / 180.0;
    const double C = (1.914602 - 0.004817 * T) * std::sin(M) + (0.019993 - 0.000101 * T) * std::sin(2.0 * M) +
                     0.000289 * std::sin(3.0 * M);
    const double longitude = (L0 + C) * kPi / 180.0, obliquity = (23.4392911 - 0.0130042 * T) * kPi / 180.0;
    const double gmst = (280.46061837 + 360.98564736629 * d) * kPi / 180.0;
    const Vector3d among_stars =
        Eigen::AngleAxisd(obliquity, Vector3d::UnitX()) * Vector3d(std::cos(longitude), std::sin(longitude), 0.0);
    const Vector3d exact = Eigen::AngleAxisd(-gmst, Vector3d::UnitZ()) * among_stars;
    const Vector3d found = sun_direction_E(t);
    // Aberration's 0.0057 degrees is in one of them, and 0.01 of either.
    looks.near((found - exact).norm(), 0.0, 0.026 * kPi / 180.0);
    looks.near(found.norm(), 1.0, 1e-14);
  }
  return looks.figure();
}

/// Processes by the sums that they are said to be, of the draws of their streams: 128 and more terms, 1e-12.
StressFigure processes_by_their_draws() {
  Looks looks;
  const double tau_s = 600.0;
  const GaussMarkov process(21, "stress.air.process", tau_s);
  const RandomStream draws(21, "stress.air.process"), at_times(4, "stress.air");
  double norm = 0.0;
  for (int j = 0; j < 128; ++j) norm += std::exp(-j / 4.0);
  for (std::uint64_t k = 0; k < 60; ++k) {
    const GpsTime t = GpsTime::from_week_sow(1500, at_times.uniform(0.0, 6e5, 0, k));
    const auto entity = static_cast<std::uint32_t>(k % 5);
    const double place = static_cast<double>(t.ns) / (tau_s / 8.0 * 1e9), s = place - std::floor(place);
    const auto first = static_cast<std::uint64_t>(t.ns / static_cast<std::int64_t>(tau_s / 8.0 * 1e9));
    double now = 0.0, next = 0.0;
    for (std::uint64_t j = 0; j < 128; ++j) {
      const double weight = std::exp(-static_cast<double>(j) / 8.0) / std::sqrt(norm);
      now += weight * draws.normal(entity, first + 128 - j);
      next += weight * draws.normal(entity, first + 129 - j);
    }
    const double spread = std::sqrt((1 - s) * (1 - s) + s * s + 2.0 * s * (1 - s) * std::exp(-1.0 / 8.0));
    // Its place among 1e8 of them rounds by 1e-8 of a step.
    looks.near(process.at(entity, t), ((1.0 - s) * now + s * next) / spread, 3e-7);
  }
  const LoopNoise noise(5, "stress.air.loop", 2.0, 0.25);
  const RandomStream loop(5, "stress.air.loop");
  const double rho = std::exp(-2.0);
  looks.close(noise.correlation(), rho, 4.0);
  for (const std::int64_t index : {0, 1, 17, 5000}) {
    double sum = 0.0, squares = 0.0;
    // Weights down to 1e-8, the newest last.
    for (int j = 0; std::pow(rho, j) > 1e-8; ++j) squares += std::pow(rho, 2 * j);
    int count = 0;
    while (std::pow(rho, count) > 1e-8) ++count;
    for (int j = 0; j < count; ++j)
      sum += std::pow(rho, j) * loop.normal(3, static_cast<std::uint64_t>(index + count - 1 - j));
    looks.near(noise.at(3, index), sum / std::sqrt(squares), 1e-12);
  }
  // A clock by its two states: over many steps their covariances are the integrals of white and of walking frequency.
  for (const double dt : {0.1, 1.0, 30.0}) {
    double offset2 = 0.0, both = 0.0, rate2 = 0.0;
    constexpr int kSteps = 4000;
    const auto clock = make_tcxo({.seed = 8, .interval_s = dt});
    double x = clock->offset_m(0), y = clock->rate_m_s(0);
    for (std::int64_t k = 1; k <= kSteps; ++k) {
      const double next = clock->offset_m(k), rate = clock->rate_m_s(k);
      const double off = (next - x - y * dt) / 299792458.0, turned = (rate - y) / 299792458.0;
      offset2 += off * off / kSteps, both += off * turned / kSteps, rate2 += turned * turned / kSteps;
      x = next, y = rate;
    }
    const double walk = 2.0 * kPi * kPi * 2e-20, white = 0.5 * 2e-19;
    const double a = white * dt + walk * dt * dt * dt / 3.0, b = walk * dt * dt / 2.0, c = walk * dt;
    // Differences of offsets of up to 100 km round by 1e-11 m, of 1e-2 m and more.
    looks.near(offset2 / a, 1.0, 5.0 * std::sqrt(2.0 / kSteps) + 1e-6);
    looks.near(rate2 / c, 1.0, 5.0 * std::sqrt(2.0 / kSteps) + 1e-6);
    looks.near(both / std::sqrt(a * c), b / std::sqrt(a * c), 5.0 * std::sqrt(2.0 / kSteps));
  }
  return looks.figure();
}

/// What errors of orbits are at most by their needs: 6.5 sigma of the widest, no more than a tenth above it; and keys
/// of one that has them, as they come.
StressFigure largest_orbit_errors() {
  Looks looks;
  for (const auto& [name, scale] : {std::pair{"orbit_clock_2010", 1.0}, {"orbit_clock_2021", 0.89 / 1.11}}) {
    const auto& row = model_row(ephemeris_error_models(), name);
    double widest = 0.0;
    // Off the radius by what its horizon allows: asin(6378 / 26560) of GPS, 13.9 degrees.
    for (double off = 0.0; off <= 0.2425; off += 0.0025) {
      const double radial = 0.506 * 1.13 - 1.07 * std::cos(off);
      widest = worse(widest, radial * radial + (1.0 - 0.506 * 0.506) * 1.13 * 1.13 + std::pow(1.48 * std::sin(off), 2));
    }
    const double need = row.make.need({}) / (6.5 * scale * std::sqrt(widest));
    looks.right(need >= 1.0 && need < 1.1);
  }
  const auto& row = model_row(ephemeris_error_models(), "gauss_markov");
  ModelParameters own;
  row.parameters(own);
  looks.near(row.make.need(own), 6.5, 1e-12);
  const auto sv = SatelliteId{GnssSystem::kGps, 9};
  for (const auto& [keys, sigma, tau_s] :
       {std::tuple{"", 1.0, 3600.0}, {"ephemeris_sigma_m = 2.5\nephemeris_tau_s = 90.0\n", 2.5, 90.0}}) {
    const auto node = ConfigNode::parse(keys, "stress");
    looks.right(node && read_fields(&*node, "gnss", [&own](FieldVisitor& f) { own.visit_all(f); }).ok());
    const auto model = row.make.make(own, {.seed = 77});
    const GaussMarkov process(77, "gnss.ephemeris", tau_s);
    for (int k = 0; k < 20; ++k) {
      const GpsTime t = GpsTime::from_week_sow(1700, 777.0 * k);
      looks.near((*model)->range_m(sv, {}, Vector3d::Zero(), t), sigma * process.at(sv.entity(), t), 1e-14);
    }
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> air_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "delays of the air by their sources",
           .why = "a semicircle for a radian, a coefficient of the next latitude, an hour of the other meridian",
           .expected = "the documents' own formulas and tables written out, pierce points by vectors: roundings",
           .unit = "of the bound"});
  rows.add("air/klobuchar_as_printed", klobuchar_as_printed)
      .add("air/troposphere_as_printed", troposphere_as_printed)
      .add("air/needs_and_shells", needs_and_shells)
      .add("air/the_sun", the_sun);
  rows.of({.group = StressGroup::kData,
           .mechanism = "processes and the largest of them",
           .why = "a draw of the epoch beside, a weight's square, a bound that is none",
           .expected = "sums of their streams' draws, integrals of a clock's noise, 6.5 sigma of the widest",
           .unit = "of the bound"});
  rows.add("air/processes_by_their_draws", processes_by_their_draws)
      .add("air/largest_orbit_errors", largest_orbit_errors);
  return rows.take();
}

}  // namespace canyon::gnss

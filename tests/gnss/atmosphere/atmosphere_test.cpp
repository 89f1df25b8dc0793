#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/ionosphere_map.h"
#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/atmosphere/zenith_delay.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

// Vicksburg, 17 November 2010 13:00 GPS time: day of year 321.54. Reference figures were computed independently and are
// given to the digits shown, so the tolerance is half a unit of the last digit.
constexpr double kLat = 32.35 * kDegree;
constexpr double kHeight_m = 60.0;
constexpr double kDay = 321.0 + 13.0 / 24.0;

SkyView view_at(double elevation_deg, double azimuth_deg = 0.0) {
  return {GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0),
          {kLat, -90.88 * kDegree, kHeight_m},
          elevation_deg * kDegree,
          azimuth_deg * kDegree};
}

TEST(Niell, CoefficientsAtVicksburg) {
  const auto h = niell_hydrostatic_coefficients(kLat, kDay);
  EXPECT_NEAR(h.a, 1.259989e-3, 0.5e-9);
  EXPECT_NEAR(h.b, 2.909824e-3, 0.5e-9);
  EXPECT_NEAR(h.c, 6.294854e-2, 0.5e-8);
  const auto w = niell_wet_coefficients(kLat);
  EXPECT_NEAR(w.a, 5.700214e-4, 0.5e-10);
  EXPECT_NEAR(w.b, 1.504997e-3, 0.5e-9);
  EXPECT_NEAR(w.c, 4.628762e-2, 0.5e-8);
}

TEST(Niell, MappingAtVicksburg) {
  const double elevation_deg[] = {5.0, 10.0, 30.0, 90.0};
  const double hydrostatic[] = {10.117, 5.550, 1.993, 1.000};
  const double wet[] = {10.765, 5.659, 1.997, 1.000};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(niell_hydrostatic(elevation_deg[i] * kDegree, kLat, kHeight_m, kDay), hydrostatic[i], 0.5e-3);
    EXPECT_NEAR(niell_wet(elevation_deg[i] * kDegree, kLat), wet[i], 0.5e-3);
  }
}

// Every latitude node of every table is reached, the seasons are opposite in the two hemispheres, and beyond 15 and 75
// deg the functions are constant in latitude (Niell 1996).
TEST(Niell, LatitudeAndSeason) {
  for (const double lat_deg : {15.0, 30.0, 45.0, 60.0, 75.0}) {
    const auto north = niell_hydrostatic_coefficients(lat_deg * kDegree, 28.0);
    const auto south = niell_hydrostatic_coefficients(-lat_deg * kDegree, 28.0 + 0.5 * 365.25);
    EXPECT_NEAR(north.a, south.a, 1e-15);
    EXPECT_NEAR(north.c, south.c, 1e-13);
  }
  EXPECT_EQ(niell_wet_coefficients(0.0).a, 5.8021897e-4);
  EXPECT_EQ(niell_wet_coefficients(90.0 * kDegree).c, 5.4736038e-2);
  EXPECT_EQ(niell_hydrostatic_coefficients(80.0 * kDegree, 28.0).a, 1.2045996e-3 - 4.1202191e-5);
  EXPECT_EQ(niell_hydrostatic_coefficients(0.0, 200.0).b, 2.9153695e-3);  // no seasons in the tropics
}

TEST(Niell, FiniteAtTheHorizon) {
  for (const double height_m : {-400.0, 0.0, 20000.0})
    EXPECT_TRUE(std::isfinite(niell_hydrostatic(0.0, kLat, height_m, kDay)));
  EXPECT_TRUE(std::isfinite(niell_wet(0.0, kLat)));
}

TEST(Troposphere, ZenithDelaysAtVicksburg) {
  EXPECT_NEAR(zenith_hydrostatic_m(1022.0, kLat, kHeight_m), 2.3296, 0.5e-4);
  EXPECT_NEAR(zenith_wet_m(12.8, vapour_pressure_hpa({1022.0, 12.8, 0.80})), 0.12, 0.005);
  EXPECT_EQ(zenith_wet_m(12.8, 0.0), 0.0);
}

TEST(Troposphere, SaastamoinenNiellIsTheSumOfItsParts) {
  const MeasuredWeather measured{{1022.0, 12.8, 0.80}, kHeight_m};
  const auto model = make_saastamoinen_niell(measured);
  const double wet_m = zenith_wet_m(12.8, vapour_pressure_hpa(measured.weather));
  EXPECT_DOUBLE_EQ(model->delay_m(view_at(10.0)),
                   zenith_hydrostatic_m(1022.0, kLat, kHeight_m) *
                           niell_hydrostatic(10.0 * kDegree, kLat, kHeight_m, view_at(10).t.day_of_year()) +
                       wet_m * niell_wet(10.0 * kDegree, kLat));
}

// As printed the wet term is a mapping read as metres: 10.765 m at 5 deg where 0.12 m x 10.765 is meant; the dry one
// has no mapping.
TEST(Troposphere, PaperAsPrintedAndCorrected) {
  const MeasuredWeather weather{{1022.0, 12.8, 0.80}, kHeight_m};
  const double dry_mm = 2.2779 * 1022.0 / (1.0 - 0.00266 * std::cos(2.0 * kLat) - 0.0028 * 0.060);
  EXPECT_NEAR(make_paper_printed_troposphere(weather)->delay_m(view_at(5.0)), 10.765 + 1e-3 * dry_mm, 0.5e-3);
  // The two dry constants, 2.2779 and 2.2768 mm/hPa, differ by 5e-4.
  const double good_m = make_saastamoinen_niell(weather)->delay_m(view_at(30.0));
  EXPECT_NEAR(make_paper_corrected_troposphere(weather)->delay_m(view_at(30.0)), good_m, 5e-4 * good_m);
  // With h in metres the printed height term would make the denominator vanish near 357 m; in km it is harmless.
  EXPECT_NEAR(paper_dry_delay_m(1022.0, kLat, 357.0, 0.0028), 2.33, 0.01);
  // 0.0028 per metre: more than a kilometre of delay at 356 m, and less than none at 357 m.
  EXPECT_GT(paper_dry_delay_m(1022.0, kLat, 356.0, 2.8), 1000.0);
  EXPECT_LT(paper_dry_delay_m(1022.0, kLat, 357.0, 2.8), -1000.0);
}

TEST(Troposphere, StandardAtmosphere) {
  EXPECT_DOUBLE_EQ(standard_weather(0.0).pressure_hpa, 1013.25);
  EXPECT_NEAR(standard_weather(5000.0).pressure_hpa, 540.2, 0.1);   // ICAO: 540.2 hPa
  EXPECT_NEAR(standard_weather(11000.0).pressure_hpa, 226.3, 0.1);  // and 226.3, 54.7
  EXPECT_NEAR(standard_weather(20000.0).pressure_hpa, 54.75, 0.1);
  EXPECT_EQ(standard_weather(15000.0).temperature_c, -56.5);
  EXPECT_TRUE(std::isfinite(standard_weather(1e9).pressure_hpa));
  EXPECT_TRUE(std::isfinite(standard_weather(-6.4e6).pressure_hpa));
}

TEST(Ionosphere, MappingsAndZenithDelay) {
  EXPECT_NEAR(vertical_ionosphere_m(12.0), 1.948, 0.5e-3);
  const double elevation_deg[] = {5.0, 10.0, 30.0};
  const double lear[] = {5.413, 4.078, 1.902}, layer[] = {3.041, 2.790, 1.751}, klobuchar[] = {3.027, 2.709, 1.767};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(lear_mapping(elevation_deg[i] * kDegree), lear[i], 0.5e-3);
    EXPECT_NEAR(single_layer_obliquity(elevation_deg[i] * kDegree), layer[i], 0.5e-3);
    EXPECT_NEAR(klobuchar_obliquity(elevation_deg[i] * kDegree), klobuchar[i], 0.5e-3);
  }
  EXPECT_NEAR(lear_mapping(kPi / 2), 0.9999, 0.5e-4);
  EXPECT_NEAR(single_layer_obliquity(kPi / 2), 1.0, 1e-15);
}

TEST(Ionosphere, Ladder) {
  const auto find = [&](const char* name) {  // of 12 TECU, the default
    const auto model = ModelChoice<ionosphere_models>(name).make("", IonosphereSetup{.klobuchar = kBuiltInKlobuchar});
    return (*model)->delay_m(view_at(30.0));
  };
  EXPECT_EQ(find("none"), 0.0);
  EXPECT_NEAR(find("single_layer"), 1.948 * 1.751, 2e-3);
  EXPECT_NEAR(find("paper"), 1.948 * 1.902, 2e-3);
  EXPECT_NEAR(find("paper_printed"), 1.902, 0.5e-3);  // no zenith delay: metres by name only
}

// Worked example of the algorithm, step by step from IS-GPS-200 figure 20-4, for a receiver at 40 N 100 W that looks at
// a satellite at azimuth 210, elevation 20, at 20:45:00 on a Saturday, with the coefficients of the much-copied example
// (J. Klobuchar).
TEST(Ionosphere, KlobucharWorkedExample) {
  const KlobucharCoefficients c{{0.3820e-7, 0.1490e-7, -0.1790e-6, 0.0}, {0.1430e6, 0.0, -0.3280e6, 0.1130e6}};
  const GpsTime t = GpsTime::from_week_sow(1042, 593100.0);
  const double delay_m = klobuchar_delay_m(c, t, 40.0 * kDegree, 260.0 * kDegree, 210.0 * kDegree, 20.0 * kDegree);
  // Published result: 77.6 ns, 23.784 m (Gao, "Ionospheric correction using Klobuchar model").
  EXPECT_NEAR(delay_m, 23.784, 0.5e-3);
}

TEST(Ionosphere, KlobucharAtNightIsFiveNanosecondsTimesObliquity) {
  const auto view = view_at(40.0, 75.0);  // 13 UT = 7 h local
  const double delay_m = klobuchar_delay_m(kBuiltInKlobuchar, view.t + -7.0 * 3600.0, view.receiver.lat_rad,
                                           view.receiver.lon_rad, view.azimuth_rad, view.elevation_rad);
  EXPECT_NEAR(delay_m, kSpeedOfLight * 5e-9 * klobuchar_obliquity(view.elevation_rad), 1e-12);
}

/// Maps of the same content everywhere.
std::shared_ptr<const IonexMaps> even_maps(double tecu) {
  auto maps = std::make_shared<IonexMaps>();
  maps->lat_first_deg = 87.5;
  maps->lat_step_deg = -2.5;
  maps->lon_first_deg = -180.0;
  maps->lon_step_deg = 5.0;
  maps->latitudes = 71;
  maps->longitudes = 73;
  for (const double at_s : {-7200.0, 7200.0})
    maps->maps.push_back({view_at(0.0).t + at_s, std::vector<double>(71 * 73, tecu)});
  return maps;
}

// Even maps are a thin shell at 450 km over a sphere of 6371 km; outside their time vtec_tecu stands in.
TEST(Ionosphere, IonexOfAnEvenSky) {
  const auto model = make_mapped_ionosphere(even_maps(20.0), 5.0);
  for (const double e : {0.0, 10.0, 45.0, 90.0}) {
    const double sin_zenith = 6371.0 / 6821.0 * std::cos(e * kDegree);
    EXPECT_NEAR(model->delay_m(view_at(e, 200.0)), vertical_ionosphere_m(20.0) / std::sqrt(1 - sin_zenith * sin_zenith),
                1e-9);
  }
  SkyView later = view_at(90.0);
  later.t = later.t + 86400.0;
  EXPECT_NEAR(model->delay_m(later), vertical_ionosphere_m(5.0), 1e-12);
}

// A content that grows by 1 TECU per degree of latitude shows where the line pierces the shell: looking north at 30 deg
// from Vicksburg, psi = 90 - 30 - asin(6371/6821 cos 30) = 6.012 deg further north.
TEST(Ionosphere, IonexPiercePoint) {
  auto maps = std::make_shared<IonexMaps>(*even_maps(0.0));
  for (auto& map : maps->maps)
    for (std::size_t row = 0; row < 71; ++row)
      for (std::size_t k = 0; k < 73; ++k) map.vtec_tecu[row * 73 + k] = 100.0 + 87.5 - 2.5 * static_cast<double>(row);
  const auto model = make_mapped_ionosphere(maps, 0.0);
  const double sin_zenith = 6371.0 / 6821.0 * std::cos(30 * kDegree);
  const double psi_deg = 60.0 - std::asin(sin_zenith) / kDegree;
  EXPECT_NEAR(psi_deg, 6.012, 0.01);
  EXPECT_NEAR(model->delay_m(view_at(30.0, 0.0)),
              vertical_ionosphere_m(100.0 + 32.35 + psi_deg) / std::sqrt(1 - sin_zenith * sin_zenith), 1e-9);
}

TEST(Ionosphere, RealMapsOverVicksburg) {
  CANYON_REAL_DATA(path, "gnss/orbit_2010_182/igrg3380.10i");
  auto maps = read_ionex_file(path);
  ASSERT_TRUE(maps.ok()) << maps.error().str();
  const auto model = make_mapped_ionosphere(std::make_shared<const IonexMaps>(*std::move(maps)), 0.0);
  SkyView view = view_at(90.0);
  // The four grid points around 32.35 N 90.88 W, read off the file in 0.1 TECU: 89, 87 at 30 N and 88, 86 at 32.5 N at
  // 12 UTC, 131, 135 and 124, 129 at 14 UTC; 95 W and 90 W. UTC is 15 s behind GPS time.
  const double north = 2.35 / 2.5, east = 4.12 / 5.0;
  const auto tecu = [&](double sw, double se, double nw, double ne) {
    return 0.1 * ((1 - north) * ((1 - east) * sw + east * se) + north * ((1 - east) * nw + east * ne));
  };
  view.t = GpsTime::from_calendar(2010, 12, 4, 12, 0, 15.0);
  EXPECT_NEAR(model->delay_m(view), vertical_ionosphere_m(tecu(89, 87, 88, 86)), 1e-9);
  view.t = GpsTime::from_calendar(2010, 12, 4, 14, 0, 15.0);
  EXPECT_NEAR(model->delay_m(view), vertical_ionosphere_m(tecu(131, 135, 124, 129)), 1e-9);
}

// Every model, at heights from the Dead Sea to 20 km, anywhere, any elevation from the horizon up: finite, not
// negative, and never longer for a higher satellite.
TEST(Atmosphere, ExtremesAreFiniteAndMonotone) {
  for (const double height_m : {-400.0, 0.0, 357.1, 8848.0, 20000.0}) {
    const Weather air = standard_weather(height_m);
    for (const double lat_deg : {-90.0, -45.0, 0.0, 14.9, 90.0}) {
      for (const double lon_deg : {-180.0, 0.0, 180.0}) {
        SkyView view = view_at(0.0, 123.0);
        view.receiver = {lat_deg * kDegree, lon_deg * kDegree, height_m};
        const auto check = [&](const char* name, const auto& model) {
          double before_m = std::numeric_limits<double>::infinity();
          for (double e = 0.0; e <= 90.0; e += 0.25) {
            view.elevation_rad = e * kDegree;
            const double delay_m = model.delay_m(view);
            ASSERT_TRUE(std::isfinite(delay_m)) << name << " " << height_m << " " << lat_deg << " " << e;
            ASSERT_GE(delay_m, 0.0) << name << " " << height_m << " " << lat_deg << " " << e;
            // Klobuchar's pierce point moves with the elevation, and with it the vertical delay.
            if (std::string(name) != "klobuchar") {
              ASSERT_LE(delay_m, before_m * (1 + 1e-12)) << name << " " << height_m << " " << lat_deg << " " << e;
            }
            before_m = delay_m;
          }
        };
        for (const auto& row : ionosphere_models()) {
          if (row.name == std::string("ionex")) continue;  // needs a file
          check(row.name,
                **ModelChoice<ionosphere_models>(row.name).make("", IonosphereSetup{.klobuchar = kBuiltInKlobuchar}));
        }
        check("ionex", *make_mapped_ionosphere(even_maps(12.0), 12.0));
        for (const auto& row : troposphere_models()) {
          ModelChoice<troposphere_models> model(row.name);
          model.own.get<SiteWeather>().measured = {air, height_m};
          check(row.name, **model.make(""));
        }
      }
    }
  }
}

// Weather measured on the ground is carried to a receiver that climbs: what a standard receiver leaves stays below the
// weather's own difference from the standard, 2.3 mm per hPa and a wet part of 0.2 m, at every height.
TEST(Troposphere, WeatherIsCarriedToTheReceiversHeight) {
  const MeasuredWeather weather{{1022.0, 12.8, 0.80}, 60.0};
  EXPECT_NEAR(weather.at(60.0).pressure_hpa, 1022.0, 1e-9);
  EXPECT_NEAR(weather.at(5060.0).pressure_hpa / 1022.0,
              standard_weather(5060.0).pressure_hpa / standard_weather(60.0).pressure_hpa, 1e-12);
  EXPECT_NEAR(weather.at(2060.0).temperature_c, -0.2, 1e-9);
  for (const double height_m : {-400.0, 0.0, 3000.0, 8848.0, 20000.0}) {
    SkyView view = view_at(90.0);
    view.receiver.h_m = height_m;
    EXPECT_LT(std::abs(make_saastamoinen_niell(weather)->delay_m(view) - standard_troposphere_m(view)), 0.15)
        << height_m;
    EXPECT_EQ((*ModelChoice<troposphere_models>("standard").make(""))->delay_m(view), standard_troposphere_m(view));
  }
}

// The standard troposphere's zenith delay falls steadily with height, to the 5 % of the air that lies above 20 km.
TEST(Atmosphere, ZenithDelayFallsWithHeight) {
  double before_m = 10.0;
  for (double height_m = -400.0; height_m <= 20000.0; height_m += 100.0) {
    SkyView view = view_at(90.0);
    view.receiver.h_m = height_m;
    const double delay_m = standard_troposphere_m(view);
    EXPECT_LT(delay_m, before_m) << height_m;
    before_m = delay_m;
  }
  EXPECT_NEAR(before_m, 0.0022768 * 54.75, 0.01 * 0.125);
}

}  // namespace
}  // namespace canyon::gnss

// The sensor as a whole, and the horizon it stands on, at the ends of the Earth.
#include <cmath>
#include <limits>

#include "canyon/core/earth/earth.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/gnss/sky_view.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;
using stress::kInfinity;
const GpsTime kWeekEndsSoon = GpsTime::from_week_sow(1617, 604790.0);  // the week ends in ten seconds

std::unique_ptr<scene::Scene> empty_scene(const Geodetic& origin) {
  scene::SceneParts parts;
  parts.name = "nothing";
  parts.frame = LocalFrame(origin);
  parts.materials = scene::builtin_materials();
  return std::make_unique<scene::Scene>(std::move(parts));
}

/// Every error off; clocks, light time and the turning Earth on.
GnssConfig errors_off() {
  GnssConfig c;
  c.mode.name = "single_uncorrected";
  c.ionosphere.name = c.troposphere.name = c.ephemeris_error.name = "none";
  c.propagation.paths.name = c.reception.multipath_rule.name = "none";
  c.tracking.thermal_noise_scale = 0.0;
  c.mask_deg = 5.0;
  return c;
}

/// Fix of a receiver at rest, ten epochs over the end of a week, at 2 Hz. The light time is solved to 1e-5 m as
/// documented, and the time of transmission is a whole nanosecond (0.5 ns at 900 m/s): GDOP of both.
StressFigure fix_at(double lat_deg, double lon_deg, double h_m) {
  const Geodetic origin{lat_deg * kDegree, lon_deg * kDegree, h_m};
  const auto scene = empty_scene(origin);
  auto sensor = make_gnss_sensor(errors_off(), 1, kWeekEndsSoon, kWeekEndsSoon + 60.0, *scene);
  if (!sensor.ok()) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  StressFigure out{0.0, 1.0};
  for (std::int64_t k = 0; k < 30; ++k) {
    const GnssOutput got = (*sensor)->measure(k, tick(kWeekEndsSoon, k, 2.0), Eigen::Vector3d::Zero(),
                                              Eigen::Vector3d::Zero(), scene::SceneAt(*scene));
    if (got.fix.status == FixStatus::kNone) return {kInfinity, 1.0};
    const double error_m = (got.fix.p_A_E - scene->frame().origin_E()).norm();
    take_worst(out, error_m / (got.fix.dop.gdop * 2.0 * (1e-5 + 0.5e-9 * 900.0)));
  }
  return out;
}

/// With every error on, a receiver anywhere has finite messages and truth; a figure counts what is not.
StressFigure all_errors_at(double lat_deg, double lon_deg, double h_m) {
  const Geodetic origin{lat_deg * kDegree, lon_deg * kDegree, h_m};
  const auto scene = empty_scene(origin);
  GnssConfig c;
  c.mask_deg = 0.0;
  c.mode.name = "dual";
  c.ionosphere.name = "klobuchar";
  c.reception.multipath_rule.name = "correlator";
  auto sensor = make_gnss_sensor(c, 1, kWeekEndsSoon, kWeekEndsSoon + 60.0, *scene);
  if (!sensor.ok()) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  StressFigure out;
  const auto finite = [&](double x) { out.figure += std::isfinite(x) ? 0.0 : 1.0; };
  for (std::int64_t k = 0; k < 20; ++k) {
    const GnssOutput got = (*sensor)->measure(k, tick(kWeekEndsSoon, k, 2.0), Eigen::Vector3d::Zero(),
                                              Eigen::Vector3d(50.0, -50.0, 5.0), scene::SceneAt(*scene));
    out.figure += got.fix.status == FixStatus::kNone || got.fix.p_A_E.allFinite() ? 0.0 : 1.0;
    for (const auto& t : got.truth.satellites) {
      for (const double x :
           {t.elevation_rad, t.azimuth_rad, t.range_m, t.range_rate_m_s, t.ionosphere_m, t.troposphere_m, t.ephemeris_m,
            t.noise_m, t.ionosphere_delay_m, t.troposphere_delay_m, t.multipath_m})
        finite(x);
    }
    for (const auto& o : got.epoch.observations)
      for (const double x : {o.pseudorange_m, o.sigma_m, o.clock_m, o.correction_m, o.cn0_dbhz}) finite(x);
  }
  return out;
}

/// Heights that no model covers, and what is no height, are refused; those at the borders are not. A figure counts.
StressFigure heights() {
  StressFigure out;
  const auto refused = [&](const Status& s) { return !s.ok() && !s.error().what.empty(); };
  for (const double h :
       {-500.1, -6378137.0, 20000.1, 1e7, kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()})
    out.figure += refused(check_antenna_height(h, Error{})) ? 0.0 : 1.0;
  for (const double h : {-500.0, -400.0, 0.0, 8848.0, 20000.0})
    out.figure += refused(check_antenna_height(h, Error{})) ? 1.0 : 0.0;
  for (const double lat : {-90.0, 0.0, 45.0, 90.0})
    for (const double h : {-500.0, 20000.0})
      out.figure += refused(check_antenna_height(ecef_from_geodetic({lat * kDegree, 0.3, h}), Error{})) ? 1.0 : 0.0;
  out.figure += refused(check_antenna_height(Eigen::Vector3d::Zero().eval(), Error{})) ? 0.0 : 1.0;
  out.figure += refused(check_antenna_height(Eigen::Vector3d(1e-300, 0.0, 0.0), Error{})) ? 0.0 : 1.0;
  out.figure += refused(check_antenna_height(Eigen::Vector3d(kNaN, 6.4e6, 0.0), Error{})) ? 0.0 : 1.0;
  out.figure += refused(check_antenna_height(Eigen::Vector3d(kInfinity, 6.4e6, 0.0), Error{})) ? 0.0 : 1.0;
  return out;
}

/// A satellite at an elevation, seen from the horizon at a place: what is put in comes back. Elevation by its sine
/// loses half its digits at the zenith: sqrt(2 eps (1 + R / d)); elsewhere 16 eps R / d / cos(e).
StressFigure horizon(double lat_deg) {
  StressFigure out{0.0, 1.0};
  const Geodetic g{lat_deg * kDegree, 3.1, 100.0};
  const Eigen::Vector3d p = ecef_from_geodetic(g);
  const Horizon here(p);
  const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(p));
  for (const double e : {0.0, 1e-12, 0.3, 1.5, 0.5 * kPi})
    for (const double a : {0.0, 0.5 * kPi, kPi, 6.28}) {
      const Eigen::Vector3d enu(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
      const SkyView v = here.view(kWeekEndsSoon, p + 2e7 * (R * enu));
      const double rounding = 16.0 * kEpsilon;
      take_worst(out, std::abs(v.elevation_rad - e) /
                          std::min(rounding / std::max(std::cos(e), 1e-300), std::sqrt(2.0 * rounding)));
      if (!(v.azimuth_rad >= 0.0 && v.azimuth_rad < 2.0 * kPi)) out.figure = kInfinity;
      if (e < 1.0) take_worst(out, std::abs(std::remainder(v.azimuth_rad - a, 2.0 * kPi)) / (rounding / std::cos(e)));
    }
  return out;
}

/// A place or velocity that is not finite is refused by the check of the antenna, by every sensor; a figure counts what
/// is let through.
StressFigure no_number_placed() {
  const auto scene = empty_scene({0.5, 1.0, 50.0});
  StressFigure out;
  for (const char* model : {"pseudorange", "truth_plus_isotropic", "truth_plus_white", "satellite_count"})
    for (const double bad : {kNaN, kInfinity, -kInfinity})
      for (int field = 0; field < 6; ++field) {
        GnssConfig c = errors_off();
        c.model.name = model;
        auto sensor = make_gnss_sensor(c, 1, kWeekEndsSoon, kWeekEndsSoon + 60.0, *scene);
        if (!sensor.ok()) return {kNaN, 0.0};
        Eigen::Vector3d p = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero();
        (field < 3 ? p : v)[field % 3] = bad;
        const auto measure = [&] { (*sensor)->measure(0, kWeekEndsSoon, p, v, scene::SceneAt(*scene)); };
        out.figure += stress::not_refused(measure, "antenna at ");
      }
  return out;
}

}  // namespace

std::vector<StressCase> place_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "a whole receiver at poles, antimeridian and all heights, over a week's end",
           "frames that are singular at the poles, longitudes that jump, seconds of week that go backwards",
           "with every error off the true place: GDOP * 2 (1e-5 m + 0.5 ns * 900 m/s)", "of the bound"});
  struct Place {
    double lat, lon, h;
    const char* name;
  };
  const Place places[] = {{90.0, 0.0, 0.0, "north_pole"},      {-90.0, 77.0, 2800.0, "south_pole"},
                          {0.0, 180.0, 0.0, "antimeridian"},   {-17.0, -179.9999999, 20000.0, "20_km"},
                          {31.5, 35.5, -400.0, "minus_400_m"}, {89.9999999, -180.0, 100.0, "beside_the_pole"},
                          {0.0, 0.0, -500.0, "minus_500_m"}};
  for (const Place& p : places)
    rows.add(std::string("places/fix_at_") + p.name, [p] { return fix_at(p.lat, p.lon, p.h); });
  rows.of({StressGroup::kGeometry, "every model of a receiver at the ends of the Earth",
           "mappings at the horizon, a pierce point beyond the pole, weather beyond its table",
           "finite messages and truth", "not finite"});
  for (const Place& p : places)
    rows.add(std::string("places/all_errors_at_") + p.name, [p] { return all_errors_at(p.lat, p.lon, p.h); });
  rows.of({StressGroup::kGeometry, "heights that no model covers",
           "ten satellites seen through the Earth, 0.70 m of error (2026-11-22)",
           "refused beyond -500 m and 20 km, at the Earth's centre, and where there is no number", "wrong"});
  rows.add("places/heights_beyond_the_models_refused", heights);
  rows.of({StressGroup::kGeometry, "elevation 0 and 90 degrees from poles and equator",
           "a sine a rounding above 1, an azimuth of 2 pi, a frame of the wrong pole",
           "16 eps / cos(e), and at the zenith the root of 32 eps", "of the bound"});
  for (const double lat : {-90.0, -45.0, 0.0, 89.9999999, 90.0}) {
    rows.add(printed("places/horizon_at_latitude_%s%.9g", lat < 0 ? "minus_" : "", std::abs(lat)),
             [lat] { return horizon(lat); });
  }
  rows.of({StressGroup::kData, "a place or velocity that is not finite",
           "NaN compares false everywhere and ends as a fix", "refused by every sensor, field by field",
           "let through"});
  rows.add("places/not_finite_field_by_field", no_number_placed);
  return rows.take();
}

}  // namespace canyon::gnss

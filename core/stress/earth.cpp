#include "canyon/core/earth/earth.h"

#include <tuple>
#include <vector>

#include "canyon/core/earth/gravity.h"
#include "canyon/core/earth/local_frame.h"
#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Worst;

const double kHeights_m[] = {-400.0, 0.0, 100.0, 20000.0};
const double kPolar_deg[] = {90.0, -90.0, 90.0 - 1e-12, 1e-9 - 90.0, 89.9999};
const double kOrdinary_deg[] = {-45.0, -1e-12, 0.0, 32.35, 60.0};
const double kLongitudes_deg[] = {0.0, 1e-12, 90.0, 179.9999999999, 180.0, -180.0, -179.9999999999, -90.0};

/// Place to E and back, and to E again. A rounding of a degree or radian is an epsilon of Earth's radius; there are two
/// conversions each way, sine and cosine, and the sums: 8 of them.
template <class Latitudes>
StressFigure there_and_back(const Latitudes& latitudes_deg) {
  Worst worst;
  for (const double h_m : kHeights_m)
    for (const double lat : latitudes_deg)
      for (const double lon : kLongitudes_deg) {
        const Geodetic g{lat * kDegree, lon * kDegree, h_m};
        const Vector3d p_E = ecef_from_geodetic(g);
        const Geodetic back = geodetic_from_ecef(p_E);
        const double bound_m = 8.0 * kEpsilon * (Wgs84::a_m + h_m);
        worst.look((ecef_from_geodetic(back) - p_E).norm(), bound_m);
        worst.look(back.h_m - h_m, bound_m);
        worst.look((back.lat_rad - g.lat_rad) * Wgs84::a_m, bound_m);
      }
  return worst.figure();
}

/// A place in W, 100 km off, over geodetic coordinates: as above, with R_EW's roundings both ways, 8 more of Earth's
/// radius.
StressFigure local_frames(double lat_deg, double lon_deg) {
  Worst worst;
  const LocalFrame frame(Geodetic{lat_deg * kDegree, lon_deg * kDegree, 100.0});
  for (const double east_m : {-1e5, -1e-3, 0.0, 1e5})
    for (const double north_m : {-1e5, 0.0, 1e-3, 1e5}) {
      const Vector3d p_W(east_m, north_m, -50.0);
      worst.look((frame.from_geodetic(frame.to_geodetic(p_W)) - p_W).norm(), 16.0 * kEpsilon * Wgs84::a_m);
    }
  const Eigen::Matrix3d& R = frame.R_EW();
  worst.look((R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
             4.0 * kEpsilon);
  return worst.figure();
}

/// NIMA TR8350.2, table 3.4: normal gravity of WGS84 at the equator and the poles, to ten decimals;
/// the pole's, 9.832184937863, is cut off there, not rounded: a unit of the last one.
StressFigure printed_gravity() {
  Worst worst;
  for (const double lon : kLongitudes_deg) {
    for (const double pole : {-90.0, 90.0}) {
      const Vector3d g_E = gravity_E(ecef_from_geodetic({pole * kDegree, lon * kDegree, 0.0}));
      worst.look(g_E.norm() - 9.8321849378, 1e-10);
      worst.look(g_E.head<2>().norm(), 8.0 * kEpsilon * 9.8);  // a rounding of the place turns it by as much
    }
    worst.look(gravity_E(ecef_from_geodetic({0.0, lon * kDegree, 0.0})).norm() - 9.7803253359, 1e-10);
  }
  return worst.figure();
}

/// Outside of all mass the gradient's trace is that of the centrifugal part, 2 w^2, and it is symmetric.
StressFigure gravity_gradient() {
  Worst worst;
  for (const double h_m : kHeights_m)
    for (const double lat : {-90.0, -45.0, 0.0, 1e-9, 32.0, 90.0}) {
      const Eigen::Matrix3d G = gravity_gradient_E(ecef_from_geodetic({lat * kDegree, 3.0, h_m}));
      constexpr double kStep_m = 100.0;
      // Each column: truncation 1.5e-15 (24 g / a^3 h^2 / 6), and two values with ten roundings of g each over 200 m.
      const double bound = 1.5e-15 + 20.0 * kEpsilon * 9.8 / (2.0 * kStep_m);
      worst.look(G.trace() - 2.0 * Wgs84::rate_rad_s * Wgs84::rate_rad_s, 3.0 * bound);
      worst.look((G - G.transpose()).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 2.0 * bound);
    }
  return worst.figure();
}

/// From Earth's centre to a hundred radii: something that can be reckoned with, even where it means nothing.
StressFigure everywhere() {
  int broken = 0;
  for (double r_m = 0.0; r_m < 1e9; r_m = r_m == 0.0 ? 1e-9 : r_m * 1.7)
    for (const Vector3d& way : {Vector3d(1, 0, 0), Vector3d(0, 0, -1), Vector3d(1, 1, 1e-9), Vector3d(-1, 1e-9, 1)}) {
      const Geodetic g = geodetic_from_ecef(r_m * way);
      broken += std::isfinite(g.lat_rad + g.lon_rad + g.h_m) ? 0 : 1;
      broken += gravity_E(r_m * way).allFinite() ? 0 : 1;
    }
  return {1.0 * broken, 0.0};
}

/// Height to pressure and back over the whole table, and clamped beside it. A rounding of the power is one of the
/// pressure, and of T0 / L = 44 km in height; there are eight.
StressFigure atmosphere() {
  Worst worst;
  constexpr double kRounding_m = 8.0 * kEpsilon * 288.15 / 0.0065;
  for (double h_m = -2000.0; h_m <= 11000.0; h_m += 17.3)
    worst.look(standard_height_m(standard_pressure_pa(h_m)) - h_m, kRounding_m);
  for (const double beyond_m : {-1e9, -2000.1, -stress::kInfinity})
    worst.look(standard_pressure_pa(beyond_m) - standard_pressure_pa(-2000.0), kRounding_m);
  for (const double beyond_m : {11000.1, 44330.0, 1e9, stress::kInfinity})
    worst.look(standard_pressure_pa(beyond_m) - standard_pressure_pa(11000.0), kRounding_m);
  for (const double pressure_pa : {0.0, 1e-300, 1e9})
    worst.look(std::isfinite(standard_height_m(pressure_pa)) ? 0.0 : stress::kInfinity, 1.0);
  return worst.figure();
}

/// Places by the ellipse's own normal, 8 epsilons of Earth's radius, and as many on the way back; axes as the
/// directions in which longitude, latitude and height move them: differences over 1e-6 rad (12.8 m) and 10 m, straight
/// to 3e-13. A place of this case is six roundings, 4.3e-9 m, off, so that two over 10 m turn an axis by 8.6e-10. Local
/// frames by those axes: the origin's 8 epsilons and two roundings of a sum.
StressFigure ellipse_and_axes() {
  Worst worst;
  const auto place = [](double lat, double lon, double h_m) {
    const double e2 = 2.0 / 298.257223563 - 1.0 / (298.257223563 * 298.257223563), s = std::sin(lat);
    const double N = 6378137.0 / std::sqrt(1.0 - e2 * s * s);
    return Vector3d((N + h_m) * std::cos(lat) * std::cos(lon), (N + h_m) * std::cos(lat) * std::sin(lon),
                    (N * (1.0 - e2) + h_m) * s);
  };
  for (double lat = -1.5; lat < 1.55; lat += 0.271)
    for (double lon = -3.1; lon < 3.2; lon += 0.577)
      for (const double h_m : kHeights_m) {
        const Geodetic g{lat, lon, h_m};
        const Vector3d p_E = place(lat, lon, h_m);
        worst.look((ecef_from_geodetic(g) - p_E).norm(), 8.0 * kEpsilon * 6.4e6);
        const Geodetic back = geodetic_from_ecef(p_E);
        worst.look((place(back.lat_rad, back.lon_rad, back.h_m) - p_E).norm(), 16.0 * kEpsilon * 6.4e6);
        const Eigen::Matrix3d R = rotation_E_from_enu(g);
        constexpr double d = 1e-6;
        worst.look((R.col(0) - (place(lat, lon + d, h_m) - place(lat, lon - d, h_m)).normalized()).norm(),
                   1e-9 / std::cos(lat));
        worst.look((R.col(1) - (place(lat + d, lon, h_m) - place(lat - d, lon, h_m)).normalized()).norm(), 1e-9);
        worst.look((R.col(2) - (place(lat, lon, h_m + 10.0) - p_E) / 10.0).norm(), 1e-9);
        const LocalFrame frame(g);
        const Vector3d p_W(123.0, -45.0, 67.0), exact_E = p_E + 123.0 * R.col(0) - 45.0 * R.col(1) + 67.0 * R.col(2);
        worst.look((frame.to_E(p_W) - exact_E).norm(), 10.0 * kEpsilon * 6.4e6);
        worst.look((frame.to_W(exact_E) - p_W).norm(), 10.0 * kEpsilon * 6.4e6);
        worst.look((frame.X_EW() * p_W - exact_E).norm(), 10.0 * kEpsilon * 6.4e6);
        worst.look((frame.origin_E() - p_E).norm(), 8.0 * kEpsilon * 6.4e6);
      }
  return worst.figure();
}

/// Gravity on the ellipsoid by Somigliana's formula, of which ten decimals are printed, downwards. Above it by Bruns'
/// gradient, g (1 / M + 1 / N) + 2 w^2, which is exact there, and 3 g (h / a)^2: that is by a sphere, of which r^2 is
/// 0.7 % off and J2's part, with r^-4, 10 J2 = 1.1 %; 6 flattenings. The next term is 4 g (h / a)^3. Gravity has no
/// curl, so that it leans to the south by h / M dg / dlat, up to 8.4e-10 g h, with a next term of 6 h / a of that; the
/// direction itself is 45 epsilons off. The other model's series is within the 1e-6 that it states, along the normal,
/// and the 1.44e-6 that GRS80's gravity is off.
StressFigure gravity_by_formulas() {
  Worst worst;
  const auto series = gravity_by_name("grs80_series");
  for (double lat = -1.57; lat < 1.58; lat += 0.043)
    for (const double h_m : {0.0, 200.0, 1000.0, 5000.0}) {
      const double s2 = std::pow(std::sin(lat), 2), a = 6378137.0, f = 1.0 / 298.257223563;
      const double g0 = 9.7803253359 * (1.0 + 0.00193185265241 * s2) / std::sqrt(1.0 - 0.00669437999014 * s2);
      const double e2 = 0.00669437999014, k = 0.00193185265241, w = std::sqrt(1.0 - e2 * s2), up_m = h_m / a;
      const double N = a / w, M = N * (1.0 - e2) / (w * w);
      const double gradient = g0 * (1.0 / M + 1.0 / N) + 2.0 * 7.292115e-5 * 7.292115e-5;
      const double g = g0 - gradient * h_m + 3.0 * g0 * up_m * up_m;
      const double slope = 9.7803253359 * std::sin(2.0 * lat) * (k / w + 0.5 * e2 * (1.0 + k * s2) / (w * w * w));
      const Geodetic at{lat, 0.7, h_m};
      const Eigen::Matrix3d axes = rotation_E_from_enu(at);
      const Vector3d p_E = ecef_from_geodetic(at), found = axes.transpose() * gravity_E(p_E);
      const double direction = 45.0 * kEpsilon * 9.81, bent = 9.81 * 8.4e-10 * h_m;
      worst.look(-found.z() - g, 1e-10 + g0 * up_m * up_m * (6.0 * f * 3.0 + 4.0 * up_m));
      worst.look(found.x(), direction);
      worst.look(found.y() + slope * h_m / M, direction + 6.0 * up_m * bent);
      worst.look((series(p_E) - gravity_E(p_E)).norm(), 2.44e-6 + bent);
    }
  return worst.figure();
}

/// ISO 2533's own table, to half a unit of the last digit that is printed; heights by that over the weight of air.
StressFigure atmosphere_as_printed() {
  Worst worst;
  for (const auto& [h_m, pa, half_pa] : {std::tuple{-1000.0, 113931.0, 0.5},
                                         {0.0, 101325.0, 0.5},
                                         {500.0, 95461.3, 0.05},
                                         {1000.0, 89876.3, 0.05},
                                         {2000.0, 79501.4, 0.05},
                                         {5000.0, 54048.3, 0.05},
                                         {8000.0, 35651.6, 0.05},
                                         {10000.0, 26499.9, 0.05},
                                         {11000.0, 22699.9, 0.05}}) {
    // The table is by geometric height: geopotential is r h / (r + h).
    const double geopotential_m = 6356766.0 * h_m / (6356766.0 + h_m);
    worst.look(standard_pressure_pa(geopotential_m) - pa, half_pa);
    // dh = R T / g dp / p, of air at the height's temperature.
    const double per_pa = 287.05287 * (288.15 - 0.0065 * geopotential_m) / 9.80665 / pa;
    worst.look(standard_height_m(pa) - geopotential_m, 1.001 * per_pa * half_pa);
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> earth_cases() {
  const auto group = StressGroup::kGeometry;
  const StressMechanism pole{
      group, "the poles and the antimeridian of geodetic coordinates",
      "longitude is 0 / 0 at a pole, the height p / cos(latitude) - N loses all digits there, 180 "
      "and -180 degrees differ",
      "places at -400 m to 20 km come back to 8 epsilons of Earth's radius (1e-8 m)", "of the bound"};
  const StressMechanism frame{group, "a local frame where directions end",
                              "east and north are undefined at a pole, and flip with the longitude",
                              "places 100 km off come back over geodetic coordinates to 16 epsilons of "
                              "Earth's radius; the axes stay orthonormal",
                              "of the bound"};
  const StressMechanism printed{
      group, "gravity at the ends of its formula", "a series in latitude that is wrong by 1e-6 m/s^2 at its ends",
      "what the standard prints at poles and equator, to a unit of its last decimal, where it is cut off",
      "of the bound"};
  const StressMechanism difference{
      group, "differences of a nearly constant vector",
      "a step that is too short leaves the rounding of g, one too long the third derivative",
      "the gradient has the trace 2 w^2 and is symmetric, to truncation and ten roundings of g", "of the bound"};
  const StressMechanism centre{group, "places where the formula means nothing",
                               "1 / r at Earth's centre, or a negative root within the focal disc",
                               "finite from the centre to a hundred radii", "places"};
  const StressMechanism table{group, "the ends of the standard atmosphere",
                              "beyond 44 km the base of the power is negative, and the pressure no number",
                              "height and back to eight roundings, clamped to its ends beside them", "of the bound"};
  StressRows rows;
  rows.of(pole).add("earth/place_and_back_at_the_poles", [] { return there_and_back(kPolar_deg); });
  rows.of(pole).add("earth/place_and_back_at_the_antimeridian", [] { return there_and_back(kOrdinary_deg); });
  rows.of(frame).add("earth/local_frame_at_the_north_pole", [] { return local_frames(90.0, 17.0); });
  rows.of(frame).add("earth/local_frame_at_the_south_pole", [] { return local_frames(-90.0, 180.0); });
  rows.of(frame).add("earth/local_frame_at_the_antimeridian", [] { return local_frames(-16.0, 180.0); });
  rows.of(printed).add("earth/gravity_at_poles_and_equator", printed_gravity);
  rows.of(difference).add("earth/gravity_gradient", gravity_gradient);
  rows.of(centre).add("earth/from_the_centre_to_a_hundred_radii", everywhere);
  rows.of(table).add("earth/standard_atmosphere_to_its_ends", atmosphere);
  rows.of({group, "the ellipsoid, its axes and its gravity everywhere",
           "north for east, a flattening that is taken once, a term of the series with the other sign",
           "the ellipse's normal, differences of places, Somigliana's formula: rounding and the next terms",
           "of the bound"});
  rows.add("earth/ellipse_and_axes", ellipse_and_axes).add("earth/gravity_by_formulas", gravity_by_formulas);
  rows.of({group, "the standard atmosphere as it is printed", "a lapse rate or exponent that is off",
           "ISO 2533's table to its last digit", "of the bound"});
  rows.add("earth/atmosphere_as_printed", atmosphere_as_printed);
  return rows.take();
}

}  // namespace canyon

#include "canyon/core/earth/earth.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <GeographicLib/NormalGravity.hpp>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
/// A few roundings of numbers of the Earth's size, m.
constexpr double kRoundingM = 8 * kEps * Wgs84::a_m;

TEST(Geodetic, AxesOfTheEllipsoid) {
  EXPECT_LT((ecef_from_geodetic({0, 0, 0}) - Eigen::Vector3d(Wgs84::a_m, 0, 0)).norm(), kRoundingM);
  EXPECT_LT((ecef_from_geodetic({0, kPi / 2, 10}) - Eigen::Vector3d(0, Wgs84::a_m + 10, 0)).norm(), kRoundingM);
  const double b = 6356752.3142;  // TR8350.2, table 3.1, four decimals
  EXPECT_NEAR(ecef_from_geodetic({kPi / 2, 0, 0}).z(), b, 0.5e-4);
  EXPECT_NEAR(ecef_from_geodetic({-kPi / 2, 1, 100}).z(), -b - 100, 0.5e-4);
}

TEST(Geodetic, ClosedFormOfTheForwardTransform) {
  for (const double lat : {-1.2, -0.3, 0.5646, 1.5}) {
    for (const double lon : {-3.0, -1.586, 0.1, 2.9}) {
      for (const double h : {-100.0, 0.0, 60.0, 2.02e7}) {
        const double N = Wgs84::a_m / std::sqrt(1 - Wgs84::e2 * std::sin(lat) * std::sin(lat));
        const Eigen::Vector3d expected((N + h) * std::cos(lat) * std::cos(lon), (N + h) * std::cos(lat) * std::sin(lon),
                                       (N * (1 - Wgs84::e2) + h) * std::sin(lat));
        EXPECT_LT((ecef_from_geodetic({lat, lon, h}) - expected).norm(), 8 * kEps * (Wgs84::a_m + h));
      }
    }
  }
}

TEST(Geodetic, RoundTrip) {
  for (double lat = -1.57; lat < 1.58; lat += 0.157) {
    for (double lon = -3.1; lon < 3.2; lon += 0.31) {
      for (const double h : {-400.0, 0.0, 80.0, 9e3, 2.02e7}) {
        const Geodetic g = geodetic_from_ecef(ecef_from_geodetic({lat, lon, h}));
        const double scale = 16 * kEps * (1 + h / Wgs84::a_m);
        EXPECT_NEAR(g.lat_rad, lat, scale * 2);
        EXPECT_NEAR(g.lon_rad, lon, scale * kPi / std::cos(lat));
        EXPECT_NEAR(g.h_m, h, scale * Wgs84::a_m);
      }
    }
  }
}

TEST(Geodetic, SingularPointsHaveAnswers) {
  const Geodetic pole = geodetic_from_ecef({0, 0, 6356752.314245179 + 5});
  EXPECT_NEAR(pole.lat_rad, kPi / 2, 4 * kEps);
  EXPECT_NEAR(pole.h_m, 5, kRoundingM);
  const Geodetic centre = geodetic_from_ecef({0, 0, 0});
  EXPECT_TRUE(std::isfinite(centre.lat_rad) && std::isfinite(centre.lon_rad) && std::isfinite(centre.h_m));
}

TEST(LocalFrame, AxesAreEastNorthUp) {
  for (const double lat : {-1.3, 0.0, 0.5646, 1.4}) {
    for (const double lon : {-2.5, -1.586, 0.0, 3.0}) {
      const LocalFrame frame(Geodetic{lat, lon, 100.0});
      EXPECT_LT((frame.R_EW().transpose() * frame.R_EW() - Eigen::Matrix3d::Identity()).norm(), 8 * kEps);
      EXPECT_GT(frame.R_EW().determinant(), 0.0);
      // Moving a little in one geodetic coordinate moves along one axis, to second order in the step (step^2 x 6.4e6
      // m).
      const double step = 1e-6;
      const Eigen::Vector3d east = frame.from_geodetic({lat, lon + step, 100.0});
      const Eigen::Vector3d north = frame.from_geodetic({lat + step, lon, 100.0});
      const Eigen::Vector3d up = frame.from_geodetic({lat, lon, 101.0});
      const double second_order_m = step * step * 6.5e6 + 4 * kRoundingM;
      EXPECT_GT(east.x(), 0.0);
      EXPECT_LT(east.tail<2>().norm(), second_order_m);
      EXPECT_GT(north.y(), 0.0);
      EXPECT_LT(std::hypot(north.x(), north.z()), second_order_m);
      EXPECT_LT((up - Eigen::Vector3d(0, 0, 1)).norm(), 4 * kRoundingM);
    }
  }
}

TEST(LocalFrame, RoundTripsAndPose) {
  const LocalFrame frame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
  const Eigen::Vector3d p_W(350.0, -480.0, 12.0);
  EXPECT_LT((frame.to_W(frame.to_E(p_W)) - p_W).norm(), 2 * kRoundingM);
  EXPECT_LT((frame.from_geodetic(frame.to_geodetic(p_W)) - p_W).norm(), 4 * kRoundingM);
  EXPECT_LT((frame.X_EW() * p_W - frame.to_E(p_W)).norm(), kRoundingM);
  EXPECT_LT(frame.to_W(frame.origin_E()).norm(), kRoundingM);
}

double gravity_at(double lat_rad) {
  return gravity_E(ecef_from_geodetic({lat_rad, 0.3, 0})).norm();
}

// NIMA TR8350.2 (2000), table 3.4: theoretical gravity at the equator and the poles, to one unit of the last digit
// printed (the polar value is printed cut, not rounded).
TEST(Gravity, PublishedValuesOnTheEllipsoid) {
  EXPECT_NEAR(gravity_at(0), 9.7803253359, 1e-10);
  EXPECT_NEAR(gravity_at(kPi / 2), 9.8321849378, 1e-10);
}

// Somigliana's closed form, TR8350.2 (4-1), from the same table's constants, whose ten decimals are the tolerance.
TEST(Gravity, SomiglianasFormula) {
  constexpr double gamma_e = 9.7803253359, k = 0.00193185265241;
  for (double lat = -1.5; lat <= 1.5; lat += 0.125) {
    const double sin2 = std::sin(lat) * std::sin(lat);
    EXPECT_NEAR(gravity_at(lat), gamma_e * (1 + k * sin2) / std::sqrt(1 - Wgs84::e2 * sin2), 1e-10) << lat;
  }
  EXPECT_NEAR(gravity_at(45 * kDegree), 9.806197769, 1e-9);
}

// The ellipsoid is a level surface: on it gravity is along its normal.
TEST(Gravity, PointsAlongTheNormalOnTheEllipsoid) {
  for (double lat = -1.5; lat <= 1.5; lat += 0.25) {
    const Geodetic g{lat, -1.5, 0};
    const Eigen::Vector3d g_W = rotation_E_from_enu(g).transpose() * gravity_E(ecef_from_geodetic(g));
    EXPECT_LT(g_W.head<2>().norm(), 64 * kEps * 9.8) << lat;
    EXPECT_LT(g_W.z(), 0.0);
  }
}

// From deep in the Earth to far out, poles and equator among it, and on both sides of where the closed form's series
// begins: that of GeographicLib to ten roundings of what the sum is made of.
TEST(Gravity, IsThatOfGeographicLib) {
  const RandomStream random(1, "test.gravity");
  std::uint64_t draw = 0;
  for (const double r_m :
       {1e5, 3e6, 6.19e6, 6.2e6, 6.21e6, 6.35e6, 6.3567e6, 6.37e6, 6.3782e6, 6.4e6, 1e7, 4.2e7, 1e9}) {
    for (int i = 0; i < 1000; ++i) {
      Eigen::Vector3d way = random.direction(0, draw++);
      if (i % 10 == 0) way = Eigen::Vector3d(1e-9 * way.x(), 0.0, way.z() < 0.0 ? -1.0 : 1.0).normalized();
      if (i % 10 == 1) way.z() *= 1e-12;
      const Eigen::Vector3d p_E = r_m * way;
      Eigen::Vector3d theirs;
      GeographicLib::NormalGravity::WGS84().U(p_E.x(), p_E.y(), p_E.z(), theirs.x(), theirs.y(), theirs.z());
      const double turning = Wgs84::rate_rad_s * Wgs84::rate_rad_s * p_E.head<2>().norm();
      EXPECT_LT((gravity_E(p_E) - theirs).norm(), 10 * kEps * (theirs.norm() + 2 * turning)) << p_E.transpose();
    }
  }
}

// Bruns (1878): on a level surface dg/dh = -g (1/M + 1/N) - 2 w^2, with the radii of curvature M and N. The second
// order is 3 (h/a)^2 up to the flattening, the third -4 (h/a)^3.
TEST(Gravity, DecreasesWithHeight) {
  for (const double h : {1000.0, 9000.0}) {
    for (const double lat : {0.0, 0.5646, 1.3}) {
      const double w2 = 1 - Wgs84::e2 * std::sin(lat) * std::sin(lat);
      const double N = Wgs84::a_m / std::sqrt(w2);
      const double M = N * (1 - Wgs84::e2) / w2;
      const double g = gravity_at(lat), q = h / Wgs84::a_m;
      const double ratio = 1 - (1 / M + 1 / N + 2 * Wgs84::rate_rad_s * Wgs84::rate_rad_s / g) * h + 3 * q * q;
      EXPECT_NEAR(gravity_E(ecef_from_geodetic({lat, 0, h})).norm() / g, ratio,
                  5 * q * q * q + 3 * q * q * 4 * Wgs84::f);
    }
  }
}

TEST(GravityGradient, IsSymmetricAndHasTheTraceOfRotation) {
  for (const double lat : {-1.1, 0.0, 0.5646, 1.5}) {
    const Eigen::Matrix3d G = gravity_gradient_E(ecef_from_geodetic({lat, -1.586, 150}));
    // Truncation h^2/6 times the third derivative (24 g/a^3), each of three terms, and rounding.
    const double tolerance = 3 * (100.0 * 100.0 / 6) * 24 * 9.8 / std::pow(Wgs84::a_m, 3) + 3 * 16 * kEps * 9.8 / 200;
    EXPECT_LT((G - G.transpose()).cwiseAbs().maxCoeff(), tolerance);
    // Outside the masses the potential of gravitation is harmonic; the centrifugal part adds 2 w^2.
    EXPECT_NEAR(G.trace(), 2 * Wgs84::rate_rad_s * Wgs84::rate_rad_s, tolerance);
  }
}

TEST(GravityGradient, PredictsGravityNearby) {
  const Eigen::Vector3d p = ecef_from_geodetic({0.5646, -1.586, 60});
  const Eigen::Vector3d d(300, -200, 400);
  // Second order: |d|^2 / 2 times the second derivative, 6 g / a^2.
  const double tolerance = 0.5 * d.squaredNorm() * 6 * 9.8 / (Wgs84::a_m * Wgs84::a_m) * 1.1;
  EXPECT_LT((gravity_E(p + d) - gravity_E(p) - gravity_gradient_E(p) * d).norm(), tolerance);
}

TEST(Earth, RotationRate) {
  EXPECT_EQ(earth_rate_E(), Eigen::Vector3d(0, 0, 7.292115e-5));
}

}  // namespace
}  // namespace canyon

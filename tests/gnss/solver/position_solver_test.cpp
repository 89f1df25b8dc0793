#include "canyon/gnss/solver/position_solver.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/tests/gnss/solver/solver_sky.h"

namespace canyon::gnss {
namespace {

using ::testing::HasSubstr;

const std::vector<Sky> kSky{{10, 70}, {80, 35}, {150, 20}, {200, 50}, {260, 12}, {330, 40}};

// Rounding: eps of 2.5e7 m, times a GDOP of 3 and a few operations, is below 1e-7 m.
constexpr double kRoundingM = 1e-6;

TEST(LeastSquares, ExactRangesGiveThePositionEverywhere) {
  const auto solver = make_least_squares({});
  for (const double lat_deg : {-90.0, -45.0, 0.0, 32.35, 89.9999, 90.0}) {
    for (const double lon_deg : {-180.0, -90.88, 0.0, 179.99999}) {
      for (const double h_m : {-400.0, 60.0, 20000.0}) {
        const Eigen::Vector3d truth = ecef_from_geodetic({lat_deg * kDegree, lon_deg * kDegree, h_m});
        const auto ranges = ranges_from(truth, kSky, 12345.678);
        for (const Eigen::Vector3d& guess : {Eigen::Vector3d::Zero().eval(), kVicksburg, Eigen::Vector3d(-truth)}) {
          const auto s = solver->solve(ranges, guess);
          ASSERT_TRUE(s.ok) << s.reason;
          EXPECT_LT((s.p_E - truth).norm(), kRoundingM) << lat_deg << " " << lon_deg << " " << h_m;
          EXPECT_NEAR(s.clock_m, 12345.678, kRoundingM);
        }
      }
    }
  }
}

TEST(LeastSquares, ExactlyFourSatellites) {
  const std::vector<Sky> four(kSky.begin(), kSky.begin() + 4);
  const auto s = make_least_squares({})->solve(ranges_from(kVicksburg, four, -3.0), Eigen::Vector3d::Zero());
  ASSERT_TRUE(s.ok) << s.reason;
  EXPECT_LT((s.p_E - kVicksburg).norm(), kRoundingM * s.dop.gdop);
  for (const double r : s.residuals_m) EXPECT_NEAR(r, 0.0, 1e-7);
}

TEST(LeastSquares, TooFewSatellitesWordForWord) {
  const auto solver = make_least_squares({});
  const auto solve = [&](std::size_t n) {
    return solver->solve(ranges_from(kVicksburg, {kSky.begin(), kSky.begin() + static_cast<std::ptrdiff_t>(n)}, 0.0),
                         kVicksburg);
  };
  EXPECT_EQ(solve(0).reason, "0 satellites, a fix needs 4");
  EXPECT_EQ(solve(1).reason, "1 satellite, a fix needs 4");
  EXPECT_EQ(solve(3).reason, "3 satellites, a fix needs 4");
  EXPECT_FALSE(solve(3).ok);
  EXPECT_TRUE(std::isnan(solve(3).dop.gdop));
  EXPECT_TRUE(std::isnan(solve(3).p_E.x()));
}

// All satellites at one elevation: height and clock cannot be told apart. Moving one of them by 1e-8 rad makes GDOP
// some 1e8.
TEST(LeastSquares, SingularGeometryIsAStatus) {
  const std::vector<Sky> cone{{0, 30}, {72, 30}, {144, 30}, {216, 30}, {288, 30}};
  const auto exact = make_least_squares({})->solve(ranges_from(kVicksburg, cone, 0.0), kVicksburg);
  EXPECT_FALSE(exact.ok);
  EXPECT_THAT(exact.reason, HasSubstr("satellite geometry is singular: GDOP"));
  auto nearly = cone;
  nearly[0].elevation_deg += 1e-8 / kDegree;
  const auto near = make_least_squares({})->solve(ranges_from(kVicksburg, nearly, 0.0), kVicksburg);
  EXPECT_FALSE(near.ok);
  EXPECT_GT(near.dop.gdop, 1e8);
  EXPECT_LT(near.dop.gdop, 1e9);
  EXPECT_THAT(near.reason, HasSubstr("exceeds 100"));
  // Two satellites in one place count as one.
  const std::vector<Sky> doubled{{10, 70}, {80, 35}, {150, 20}, {150, 20}};
  EXPECT_FALSE(make_least_squares({})->solve(ranges_from(kVicksburg, doubled, 0.0), kVicksburg).ok);
}

TEST(LeastSquares, PoorGeometryBelowTheLimitIsSolved) {
  const std::vector<Sky> narrow{{0, 85}, {90, 80}, {180, 85}, {270, 82}};
  const auto ranges = ranges_from(kVicksburg, narrow, 0.0);
  EXPECT_FALSE(make_least_squares({100.0})->solve(ranges, kVicksburg).ok);
  const auto s = make_least_squares({1e6})->solve(ranges, kVicksburg);
  ASSERT_TRUE(s.ok) << s.reason;
  EXPECT_LT((s.p_E - kVicksburg).norm(), kRoundingM * s.dop.gdop);
}

TEST(LeastSquares, WeightsFollowSigma) {
  auto ranges = ranges_from(kVicksburg, kSky, 0.0);
  ranges[2].range_m += 50.0;
  const double even_m = (make_least_squares({})->solve(ranges, kVicksburg).p_E - kVicksburg).norm();
  ranges[2].sigma_m = 1e6;
  const double weighted_m = (make_least_squares({})->solve(ranges, kVicksburg).p_E - kVicksburg).norm();
  EXPECT_GT(even_m, 10.0);
  EXPECT_LT(weighted_m, 1e-6 * even_m);  // its weight is 1e-12 of the others'
}

// A wrong common clock would put the difference of the systems' clocks into the position.
TEST(SystemClocks, EachSystemHasItsOwn) {
  auto ranges =
      ranges_from(kVicksburg, {{10, 70}, {80, 35}, {150, 20}, {200, 50}, {260, 12}, {330, 40}, {40, 25}}, 1000.0);
  ranges[1].system = ranges[4].system = GnssSystem::kGlonass;
  ranges[2].system = GnssSystem::kBeidou;
  ranges[5].system = GnssSystem::kQzss;  // shares the clock of GPS
  for (auto& r : ranges) {
    if (r.system == GnssSystem::kGlonass) r.range_m -= 250.0;
    if (r.system == GnssSystem::kBeidou) r.range_m += 33.0;
  }
  const auto s = make_least_squares({})->solve(ranges, Eigen::Vector3d::Zero());
  ASSERT_TRUE(s.ok) << s.reason;
  const auto clock = [&](GnssSystem system) { return s.system_clock_m[static_cast<std::size_t>(system)]; };
  EXPECT_LT((s.p_E - kVicksburg).norm(), kRoundingM * s.dop.gdop);
  EXPECT_NEAR(clock(GnssSystem::kGps), 1000.0, kRoundingM * s.dop.gdop);
  EXPECT_NEAR(clock(GnssSystem::kQzss), 1000.0, kRoundingM * s.dop.gdop);
  EXPECT_NEAR(clock(GnssSystem::kGlonass), 750.0, kRoundingM * s.dop.gdop);
  EXPECT_NEAR(clock(GnssSystem::kBeidou), 1033.0, kRoundingM * s.dop.gdop);
  EXPECT_TRUE(std::isnan(clock(GnssSystem::kGalileo)));
  EXPECT_EQ(s.clock_m, clock(GnssSystem::kGps));
  EXPECT_EQ(s.satellites_used(), 7);
  EXPECT_EQ(s.integrity.status, IntegrityTest::Status::kNotTested);
}

// Several clocks wherever on Earth, from the Earth's centre: poles, antimeridian, below the sea and high in the air.
TEST(SystemClocks, EverywhereFromTheEarthsCentre) {
  for (const double lat_deg : {-90.0, 0.0, 89.9999})
    for (const double lon_deg : {-180.0, 179.99999})
      for (const double h_m : {-400.0, 20000.0}) {
        const Eigen::Vector3d truth = ecef_from_geodetic({lat_deg * kDegree, lon_deg * kDegree, h_m});
        auto ranges = ranges_from(truth, kSky, 77.0);
        for (std::size_t i = 3; i < ranges.size(); ++i) {
          ranges[i].system = GnssSystem::kGalileo;
          ranges[i].range_m += 9.0;
        }
        const auto s = make_least_squares({})->solve(ranges, Eigen::Vector3d::Zero());
        ASSERT_TRUE(s.ok) << s.reason;
        EXPECT_LT((s.p_E - truth).norm(), kRoundingM * s.dop.gdop) << lat_deg << " " << lon_deg << " " << h_m;
      }
}

TEST(SystemClocks, TooFewSatellitesForTheClocksWordForWord) {
  auto ranges = ranges_from(kVicksburg, {{10, 70}, {80, 35}, {150, 20}, {200, 50}}, 0.0);
  ranges[3].system = GnssSystem::kGalileo;
  EXPECT_EQ(make_least_squares({})->solve(ranges, kVicksburg).reason, "4 satellites of 2 systems, a fix needs 5");
}

// The only satellite of its system tells nothing of the position: with or without it, the same fix.
TEST(SystemClocks, ALoneSatelliteOfASystemChangesNothing) {
  auto ranges = ranges_from(kVicksburg, kSky, 0.0);
  ranges[0].range_m += 3.0;  // no exact fit
  const auto without = make_least_squares({})->solve(ranges, kVicksburg);
  auto extra = ranges_from(kVicksburg, {{111, 33}}, 4000.0).front();
  extra.system = GnssSystem::kGlonass;
  ranges.push_back(extra);
  const auto with = make_least_squares({})->solve(ranges, kVicksburg);
  EXPECT_LT((with.p_E - without.p_E).norm(), kRoundingM);
  EXPECT_NEAR(with.dop.pdop, without.dop.pdop, 1e-9);
  EXPECT_NEAR(with.dop.gdop, without.dop.gdop, 1e-9);
}

// An error that all ranges share with a known signature: where it is as large as its prior allows, the unknown takes up
// most of it; with an infinitely tight prior (signature 0) it goes into the position. Its covariance is that of the
// closed form with correlated ranges.
TEST(SharedError, CovarianceEqualsThatOfCorrelatedRanges) {
  auto ranges = ranges_from(kVicksburg, kSky, 0.0);
  const auto n = static_cast<Eigen::Index>(ranges.size());
  Eigen::VectorXd signature(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    ranges[static_cast<std::size_t>(i)].sigma_m = 0.5 + 0.1 * static_cast<double>(i);
    signature[i] = 2.0 / std::sin(kSky[static_cast<std::size_t>(i)].elevation_deg * kDegree + 0.1);
  }
  const auto plain = make_least_squares({})->solve(ranges, kVicksburg);
  Eigen::MatrixXd H(n, 4), W(n, n);
  W = signature * signature.transpose();
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& r = ranges[static_cast<std::size_t>(i)];
    const double range_m = r.range_m;
    H.block<1, 3>(i, 0) = -(turned_by_earth(r.p_E, range_m / kSpeedOfLight) - kVicksburg).normalized().transpose();
    H(i, 3) = 1.0;
    W(i, i) += r.sigma_m * r.sigma_m;
  }
  const Eigen::Matrix4d want = (H.transpose() * W.inverse() * H).inverse();
  for (Eigen::Index i = 0; i < n; ++i) {
    ranges[static_cast<std::size_t>(i)].shared_m = signature[i];
    ranges[static_cast<std::size_t>(i)].range_m += signature[i];  // one sigma of it
  }
  const auto s = make_least_squares({})->solve(ranges, kVicksburg);
  ASSERT_TRUE(s.ok);
  // The lines of sight are those of the solution, some 10 m away: they turn by 10 / 2.2e7.
  EXPECT_LT((s.covariance_E - want.topLeftCorner<3, 3>()).norm(), 5e-6 * want.norm());
  // The weighted fit with the full covariance gives the same position.
  const Eigen::Vector4d dx = want * H.transpose() * W.inverse() * signature;
  EXPECT_LT((s.p_E - kVicksburg - dx.head<3>()).norm(), 1e-5);  // linearisation: 2nd order in 10 m / 2e7 m
  EXPECT_GT(s.covariance_E.trace(), plain.covariance_E.trace());
}

// Predicted against sampled covariance; 2000 trials, relative sigma of a variance sqrt(2/N) = 3.2 %, 5 sigma.
TEST(LeastSquares, CovarianceIsTheScatter) {
  const auto solver = make_least_squares({});
  const RandomStream noise(1, "test.solver");
  auto clean = ranges_from(kVicksburg, kSky, 0.0);
  for (std::size_t i = 0; i < clean.size(); ++i) clean[i].sigma_m = 0.5 + 0.3 * static_cast<double>(i);
  constexpr int kN = 2000;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d predicted;
  for (int k = 0; k < kN; ++k) {
    auto ranges = clean;
    for (std::size_t i = 0; i < ranges.size(); ++i)
      ranges[i].range_m +=
          ranges[i].sigma_m * noise.normal(static_cast<std::uint32_t>(i), static_cast<std::uint64_t>(k));
    const auto s = solver->solve(ranges, kVicksburg);
    const Eigen::Vector3d e = s.p_E - kVicksburg;
    scatter += e * e.transpose() / kN;
    predicted = s.covariance_E;
  }
  const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(kVicksburg));
  const Eigen::Vector3d want = (R.transpose() * predicted * R).diagonal(),
                        got = (R.transpose() * scatter * R).diagonal();
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], 5.0 * std::sqrt(2.0 / kN) * want[i]);
}

// One satellite overhead and three at elevation e, 120 deg apart. East and north: sum of cos^2 e sin^2 az = 1.5 cos^2
// e. Up and clock: the 2 x 2 block has determinant 3 (1 - sin e)^2.
TEST(Dop, ClosedForm) {
  for (const double e_deg : {5.0, 19.47, 40.0}) {
    const double s = std::sin(e_deg * kDegree), c = std::cos(e_deg * kDegree);
    std::vector<Eigen::Vector3d> lines{Eigen::Vector3d::UnitZ()};
    for (const double az : {0.0, 120.0, 240.0})
      lines.emplace_back(c * std::sin(az * kDegree), c * std::cos(az * kDegree), s);
    const Dop dop = dilution_of_precision(lines, Eigen::Matrix3d::Identity(), true);
    const double det = 3.0 * (1.0 - s) * (1.0 - s);
    EXPECT_NEAR(dop.hdop, std::sqrt(2.0 / (1.5 * c * c)), 1e-12);
    EXPECT_NEAR(dop.vdop, std::sqrt(4.0 / det), 1e-11);
    EXPECT_NEAR(dop.tdop, std::sqrt((1.0 + 3.0 * s * s) / det), 1e-11);
    EXPECT_NEAR(dop.pdop, std::hypot(dop.hdop, dop.vdop), 1e-12);
    EXPECT_NEAR(dop.gdop, std::hypot(dop.pdop, dop.tdop), 1e-12);
  }
}

// 2026-11-27: four satellites of one system and one of another, two of them in one place in the sky, had a GDOP of 2e16
// and not none; twenty runs were lost to it when their largest could not be read back from the results.
TEST(Dop, OfNoGeometryIsNoNumber) {
  for (const double turn_deg : {0.0, 17.0, 123.0}) {
    const Eigen::Matrix3d R = so3_exp({0.3 * turn_deg * kDegree, 0.1, turn_deg * kDegree}).toRotationMatrix();
    const Eigen::Vector3d up = R * Eigen::Vector3d(0.3, 0.2, 0.9).normalized();
    const std::vector<Eigen::Vector3d> lines{up, R * Eigen::Vector3d(0.8, 0.0, 0.6), R * Eigen::Vector3d(0.0, 0.8, 0.6),
                                             up, R * Eigen::Vector3d(-0.6, 0.0, 0.8)};
    const std::vector<GnssSystem> systems{GnssSystem::kGps, GnssSystem::kGps, GnssSystem::kGps, GnssSystem::kGps,
                                          GnssSystem::kGlonass};
    EXPECT_EQ(dilution_of_precision(lines, systems, R).gdop, std::numeric_limits<double>::infinity()) << turn_deg;
  }
}

TEST(Dop, WithoutAClock) {
  const std::vector<Eigen::Vector3d> axes{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  const Dop dop = dilution_of_precision(axes, Eigen::Matrix3d::Identity(), false);
  EXPECT_NEAR(dop.pdop, std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(dop.gdop, std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(dop.hdop, std::sqrt(2.0), 1e-15);
  EXPECT_TRUE(std::isnan(dop.tdop));
  EXPECT_TRUE(std::isnan(dilution_of_precision(axes, Eigen::Matrix3d::Identity(), true).gdop));
}

TEST(Trilateration, ThreeSatellitesAreEnough) {
  const auto solver = make_trilateration({});
  const std::vector<Sky> three(kSky.begin() + 1, kSky.begin() + 4);
  const auto s = solver->solve(ranges_from(kVicksburg, three, 0.0), kVicksburg + Eigen::Vector3d(300, -200, 100));
  ASSERT_TRUE(s.ok) << s.reason;
  EXPECT_LT((s.p_E - kVicksburg).norm(), kRoundingM * s.dop.gdop);
  EXPECT_TRUE(std::isnan(s.clock_m));
  EXPECT_EQ(solver->solve({}, kVicksburg).reason, "0 satellites, a fix needs 3");
}

// An error common to all ranges vanishes into the clock of the four-unknown solver and moves the paper's three-unknown
// one.
TEST(Trilateration, CommonErrorsGoIntoThePosition) {
  auto ranges = ranges_from(kVicksburg, kSky, 5.0);
  EXPECT_LT((make_least_squares({})->solve(ranges, kVicksburg).p_E - kVicksburg).norm(), kRoundingM);
  EXPECT_GT((make_trilateration({})->solve(ranges, kVicksburg).p_E - kVicksburg).norm(), 5.0);
}

}  // namespace
}  // namespace canyon::gnss

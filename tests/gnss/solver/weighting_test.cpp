#include "canyon/gnss/solver/weighting.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

double sigma_m(const char* model, const RangeQuality& q, double size_m = 0.5) {
  return find_model(range_weightings(), model)->make({}, {size_m})->sigma_m(q);
}

RangeQuality at(double elevation_deg, double cn0_dbhz) {
  RangeQuality q;
  q.elevation_rad = elevation_deg * kDegree;
  q.cn0_dbhz = cn0_dbhz;
  return q;
}

TEST(Weighting, ClosedForms) {
  EXPECT_DOUBLE_EQ(sigma_m("uniform", at(7, 30)), 0.5);
  EXPECT_DOUBLE_EQ(sigma_m("elevation", at(30, 30)), 1.0);
  EXPECT_DOUBLE_EQ(sigma_m("elevation", at(1, 30)), sigma_m("elevation", at(5, 30)));  // held at 5 deg
  EXPECT_DOUBLE_EQ(sigma_m("cn0", at(30, 35)), 0.5 * std::sqrt(10.0));
  EXPECT_DOUBLE_EQ(sigma_m("elevation_cn0", at(30, 35)), 0.5 * std::sqrt(0.5 * 4.0 + 0.5 * 10.0));
  // C/N0 not known: what a clear satellite of that elevation has, so at the zenith all agree.
  for (const char* model : {"elevation", "cn0", "elevation_cn0"}) EXPECT_DOUBLE_EQ(sigma_m(model, at(90, kNaN)), 0.5);
}

// Whatever the model, a satellite lower or weaker, or a combination of signals, is not trusted more.
TEST(Weighting, NeverFallsWithElevationNorRisesWithStrength) {
  for (const auto& row : range_weightings()) {
    for (double e = -10.0; e < 90.0; e += 5.0) {
      EXPECT_LE(sigma_m(row.name, at(e + 5.0, 40)), sigma_m(row.name, at(e, 40))) << row.name;
      EXPECT_LE(sigma_m(row.name, at(e, 45)), sigma_m(row.name, at(e, 30))) << row.name;
    }
    RangeQuality two = at(40, 40);
    two.code_factor = 2.98;
    EXPECT_GT(sigma_m(row.name, two), sigma_m(row.name, at(40, 40))) << row.name;
  }
}

// RTKLIB 2.4.3's error model by hand: GPS at 30 deg, URA 2 m (class 0, limit 2.4 m), 4 m of ionosphere.
TEST(Weighting, RtklibByHand) {
  RangeQuality q = at(30, 40);
  q.accuracy_m = 2.0;
  q.ionosphere_m = 4.0;
  EXPECT_NEAR(sigma_m("rtklib", q), std::sqrt(0.09 * 3.0 + 0.09 + 4.0 + 0.25 + 5.76), 1e-12);
  q.system = GnssSystem::kGlonass;
  EXPECT_NEAR(sigma_m("rtklib", q), std::sqrt(2.25 * 0.09 * 3.0 + 0.09 + 4.0 + 0.25 + 25.0), 1e-12);
  q.system = GnssSystem::kGalileo;
  q.accuracy_m = 3.12;
  EXPECT_NEAR(sigma_m("rtklib", q), std::sqrt(0.09 * 3.0 + 0.09 + 4.0 + 0.25 + 3.12 * 3.12), 1e-12);
}

}  // namespace
}  // namespace canyon::gnss

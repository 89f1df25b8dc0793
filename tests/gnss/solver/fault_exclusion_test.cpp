#include "canyon/gnss/solver/fault_exclusion.h"

#include <gtest/gtest.h>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"
#include "canyon/tests/gnss/solver/solver_sky.h"

namespace canyon::gnss {
namespace {

using Status = IntegrityTest::Status;

const std::vector<Sky> kTenSatellites{{10, 70},  {80, 35},  {150, 20}, {200, 50}, {260, 12},
                                      {330, 40}, {120, 60}, {300, 25}, {40, 15},  {230, 30}};

PositionSolverParameters with(const char* model) {
  PositionSolverParameters p;
  p.fault_exclusion = model;
  return p;
}

std::vector<RangeMeasurement> noisy(const std::vector<RangeMeasurement>& clean, const RandomStream& noise,
                                    std::uint64_t k) {
  auto out = clean;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i].range_m += out[i].sigma_m * noise.normal(static_cast<std::uint32_t>(i), k);
  return out;
}

std::vector<RangeMeasurement> clean_ranges() {
  auto ranges = ranges_from(kVicksburg, kTenSatellites, 17.0);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    ranges[i].sigma_m = 0.5 + 0.2 * static_cast<double>(i);
    if (i % 3 == 0) ranges[i].system = GnssSystem::kGalileo;
  }
  return ranges;
}

// Without faults the test fails with the stated probability: 5000 epochs at p = 0.05, binomial sigma 0.0031, 4 sigma
// (false alarm of this test: 6e-5).
TEST(FaultExclusion, FalseAlarmRateIsTheStatedOne) {
  auto p = with("detect");
  p.false_alarm = 0.05;
  const auto solver = make_least_squares(p);
  const RandomStream noise(7, "test.raim");
  const auto clean = clean_ranges();
  constexpr int kN = 5000;
  int alarms = 0;
  for (int k = 0; k < kN; ++k) {
    const auto s = solver->solve(noisy(clean, noise, static_cast<std::uint64_t>(k)), kVicksburg);
    EXPECT_EQ(s.integrity.degrees_of_freedom, 5);
    alarms += s.integrity.status == Status::kFailed;
  }
  EXPECT_NEAR(static_cast<double>(alarms) / kN, p.false_alarm, 4.0 * std::sqrt(p.false_alarm * 0.95 / kN));
}

// A fault b on range i has the noncentrality b^2 redundancy / sigma^2; taken at 100, a miss of the largest w is beyond
// 5 sigma.
TEST(FaultExclusion, InjectedFaultsAreFoundAndLeftOut) {
  const RandomStream noise(8, "test.raim");
  const auto clean = clean_ranges();
  const auto all = fit_ranges(clean, kVicksburg, true, 100.0);
  for (const char* model : {"greedy", "leave_one_out"}) {
    const auto solver = make_least_squares(with(model));
    for (std::size_t faulty = 0; faulty < clean.size(); ++faulty) {
      for (const double sign : {-1.0, 1.0}) {
        auto ranges = noisy(clean, noise, faulty);
        ranges[faulty].range_m += sign * 14.0 * clean[faulty].sigma_m / std::sqrt(all.redundancy[faulty]);
        const auto s = solver->solve(ranges, kVicksburg);
        ASSERT_TRUE(s.ok) << model << " " << faulty << ": " << s.reason;
        EXPECT_EQ(s.integrity.status, Status::kRepaired);
        EXPECT_LE(s.integrity.statistic, s.integrity.threshold);
        EXPECT_FALSE(s.used[faulty]);
        EXPECT_EQ(s.satellites_used(), 9);
        EXPECT_GT(std::abs(s.residuals_m[faulty]), 5.0 * clean[faulty].sigma_m);
      }
    }
  }
}

TEST(FaultExclusion, TwoLargeFaultsAtOnce) {
  const auto solver = make_least_squares(with("greedy"));
  auto ranges = clean_ranges();
  ranges[1].range_m += 150.0;
  ranges[6].range_m += 4000.0;
  const auto s = solver->solve(ranges, Eigen::Vector3d::Zero());
  ASSERT_TRUE(s.ok) << s.reason;
  EXPECT_EQ(s.satellites_used(), 8);
  EXPECT_FALSE(s.used[1] || s.used[6]);
  EXPECT_LT((s.p_E - kVicksburg).norm(), 1e-5);
}

TEST(FaultExclusion, DetectOnlyGivesNoFixWordForWord) {
  auto ranges = clean_ranges();
  ranges[1].range_m += 150.0;
  const auto s = make_least_squares(with("detect"))->solve(ranges, kVicksburg);
  EXPECT_FALSE(s.ok);
  EXPECT_EQ(s.integrity.status, Status::kFailed);
  char want[160];
  std::snprintf(want, sizeof want, "ranges are inconsistent: chi-square %.4g of 5 degrees of freedom exceeds 20.52",
                s.integrity.statistic);
  EXPECT_EQ(s.reason, want);
  EXPECT_TRUE(std::isnan(s.p_E.x()));
  EXPECT_TRUE(make_least_squares(with("none"))->solve(ranges, kVicksburg).ok);
}

// Five ranges and four unknowns: the fault shows, but every range explains it equally well.
TEST(FaultExclusion, OneDegreeOfFreedomDetectsButCannotExclude) {
  auto ranges = ranges_from(kVicksburg, {kTenSatellites.begin(), kTenSatellites.begin() + 5}, 0.0);
  ranges[2].range_m += 500.0;
  const auto s = make_least_squares(with("greedy"))->solve(ranges, kVicksburg);
  EXPECT_FALSE(s.ok);
  EXPECT_EQ(s.integrity.status, Status::kFailed);
  EXPECT_EQ(s.integrity.degrees_of_freedom, 1);
}

TEST(FaultExclusion, NoRedundancyIsNotTested) {
  auto ranges = ranges_from(kVicksburg, {kTenSatellites.begin(), kTenSatellites.begin() + 4}, 0.0);
  ranges[2].range_m += 5.0;
  const auto s = make_least_squares(with("greedy"))->solve(ranges, kVicksburg);
  EXPECT_TRUE(s.ok);
  EXPECT_EQ(s.integrity.status, Status::kNotTested);
  EXPECT_TRUE(std::isnan(s.integrity.threshold));
}

// The only Galileo satellite cannot be checked, and is not blamed for another's fault.
TEST(FaultExclusion, AnUncheckableRangeIsNotBlamed) {
  auto ranges = ranges_from(kVicksburg, kTenSatellites, 0.0);
  ranges[0].system = GnssSystem::kGalileo;
  ranges[5].range_m += 80.0;
  for (const char* model : {"greedy", "leave_one_out"}) {
    const auto s = make_least_squares(with(model))->solve(ranges, kVicksburg);
    ASSERT_TRUE(s.ok) << s.reason;
    EXPECT_TRUE(s.used[0]);
    EXPECT_FALSE(s.used[5]);
  }
}

}  // namespace
}  // namespace canyon::gnss

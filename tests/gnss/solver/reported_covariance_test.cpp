#include "canyon/gnss/solver/reported_covariance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/gnss/solver/pvt_filter.h"
#include "canyon/tests/gnss/solver/solver_sky.h"

namespace canyon::gnss {
namespace {

const std::vector<Sky> kEightSatellites{{10, 70},  {60, 25},  {120, 40}, {190, 15},
                                        {230, 55}, {300, 30}, {340, 12}, {90, 80}};

std::vector<RangeSignal> same_signals(std::size_t n, double cn0_dbhz) {
  std::vector<RangeSignal> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back({static_cast<std::uint32_t>(i), cn0_dbhz, 1.0});
  return out;
}

std::unique_ptr<RangeErrorReport> row_of_report(const std::string& row) {
  ModelChoice<reported_covariances> choice(row);
  return *choice.make("reported_covariance");
}

std::vector<RangeMeasurement> with_errors(const RandomStream& draws, std::uint64_t k, double sigma_m) {
  auto ranges = ranges_from(kVicksburg, kEightSatellites, 300.0);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    ranges[i].range_m += sigma_m * draws.normal(static_cast<std::uint32_t>(i), k);
    ranges[i].sigma_m = 1.0 + 0.2 * static_cast<double>(i);
  }
  return ranges;
}

// The fit's own covariance and (G S G') are one formula computed in two ways: n eps scale, condition number below 1e3.
TEST(ReportedCovariance, OfTheAssumedSigmasIsTheFitsOwn) {
  for (const double shared : {0.0, 0.7}) {
    auto ranges = with_errors(RandomStream(1, "test.reported"), 0, 1.0);
    for (std::size_t i = 0; i < ranges.size(); ++i) ranges[i].shared_m = shared * (1.0 + 0.3 * static_cast<double>(i));
    const PositionSolution s = make_least_squares({})->solve(ranges, kVicksburg);
    ASSERT_TRUE(s.ok);
    const RangeEvidence evidence = evidence_of(ranges, same_signals(ranges.size(), 45.0), s);
    const auto sigma = row_of_report("geometry")->sigma_m(evidence);
    EXPECT_LT((covariance_of_fit(ranges, sigma, s) - s.covariance_E).norm(), 1e-9 * s.covariance_E.norm());
  }
}

// The parity of errors in a known geometry: what is left of any position and clock is nothing, and its squares by the
// assumed sigmas are the fit's chi-square, to rounding of ranges of 2.5e7 m (1e-8 m) over sigmas of 1.
TEST(ReportedCovariance, ParityIsWhatAFitCannotTakeUp) {
  const auto ranges = with_errors(RandomStream(1, "test.reported"), 3, 2.0);
  PositionSolverParameters tested;
  tested.fault_exclusion = "detect";
  tested.false_alarm = 1e-9;
  const PositionSolution s = make_least_squares(tested)->solve(ranges, kVicksburg);
  ASSERT_TRUE(s.ok) << s.reason;
  const RangeEvidence e = evidence_of(ranges, same_signals(ranges.size(), 45.0), s);
  ASSERT_EQ(e.z.size(), 4);
  Eigen::VectorXd sigma(8);
  for (int i = 0; i < 8; ++i) sigma[i] = e.assumed_m[static_cast<std::size_t>(i)];
  const Eigen::MatrixXd S = e.B * sigma.cwiseAbs2().asDiagonal() * e.B.transpose();
  EXPECT_NEAR(e.z.dot(S.ldlt().solve(e.z)), s.integrity.statistic, 1e-6);
}

// 800 epochs whose errors are three times as large as assumed: the normalised error squared of the inflated covariance,
// of 3 degrees, has its mean where a t-distribution's has it, between 3 and 3 nu / (nu - 2) = 6 of nu = 4; by the
// assumed geometry it is 27. Factor of 2 about the middle.
TEST(ReportedCovariance, ResidualsInflateWhatWasAssumedTooSmall) {
  const auto inflated = row_of_report("residual_inflated");
  const RandomStream draws(2, "test.reported");
  int within = 0, within_assumed = 0;
  constexpr int kEpochs = 800;
  for (std::uint64_t k = 0; k < kEpochs; ++k) {
    auto ranges = with_errors(draws, k, 3.0);
    for (auto& r : ranges) r.sigma_m = 1.0;
    const PositionSolution s = make_least_squares({})->solve(ranges, kVicksburg);
    const Eigen::Matrix3d P =
        covariance_of_fit(ranges, inflated->sigma_m(evidence_of(ranges, same_signals(8, 45.0), s)), s);
    const Eigen::Vector3d e = s.p_E - kVicksburg;
    within += e.dot(P.ldlt().solve(e)) < 7.815;  // 95 % of chi-square with 3 degrees
    within_assumed += e.dot(s.covariance_E.ldlt().solve(e)) < 7.815;
  }
  // F(3, 4) at 7.815 / 3 is 81.2 %, 17.1 % of N(0, 9 I) lie within the assumed one: 4 sigma of a share of 800.
  EXPECT_NEAR(within / double(kEpochs), 0.812, 4.0 * std::sqrt(0.812 * 0.188 / kEpochs));
  EXPECT_LT(within_assumed / double(kEpochs), 0.25);
}

// In a clear sky with small residuals the environment is open; ranges tens of metres apart make it a heavily degraded
// one, and weaker signals are worse.
TEST(ReportedCovariance, TheEpochTellsItsEnvironment) {
  const auto environment = row_of_report("environment");
  const RandomStream draws(4, "test.reported");
  const auto mean_sigma = [&](double error_m, double cn0_dbhz) {
    auto ranges = with_errors(draws, 9, error_m);
    const PositionSolution s = make_least_squares({})->solve(ranges, kVicksburg);
    double sum = 0.0;
    for (const double m : environment->sigma_m(evidence_of(ranges, same_signals(8, cn0_dbhz), s))) sum += m / 8.0;
    return sum;
  };
  EXPECT_LT(mean_sigma(0.5, 45.0), 3.5);
  EXPECT_GT(mean_sigma(40.0, 45.0), 20.0);
  EXPECT_GT(mean_sigma(40.0, 27.0), 1.5 * mean_sigma(40.0, 45.0));
}

/// A report of errors that last, of assumed size.
class Lasting final : public RangeErrorReport {
 public:
  std::vector<double> sigma_m(const RangeEvidence& e) const override { return e.assumed_m; }
  double correlation_s() const override { return 20.0; }
};

// Errors of ranges last 20 s (Gauss-Markov), rates are white: the filter, which takes them for white, believes in less
// than it errs by; the covariance with consider states is that of the errors. 100 runs of 40 epochs, the last one of
// each: normalised error squared of the position, 3 degrees, mean 3 within 4 sqrt(6 / 100) = 0.98.
TEST(ReportedCovariance, AFiltersIsThatOfErrorsThatLast) {
  const RandomStream draws(6, "test.reported");
  const Lasting lasting;
  const GpsTime start = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
  double reported = 0.0, believed = 0.0;
  constexpr int kRuns = 100, kEpochs = 40;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    PvtFilterParameters p;
    p.acceleration_m_s2 = 0.05;
    p.gate_probability = 1e-9;
    PvtFilter with(p), without(p);
    std::vector<double> error(kEightSatellites.size());
    Eigen::Vector3d e_with;
    Eigen::Matrix3d P_with, P_without;
    for (std::uint64_t k = 0; k < kEpochs; ++k) {
      auto ranges = ranges_from(kVicksburg, kEightSatellites, 300.0);
      std::vector<RateMeasurement> rates;
      const double kept = std::exp(-1.0 / 20.0);
      for (std::size_t i = 0; i < ranges.size(); ++i) {
        const auto entity = static_cast<std::uint32_t>(i) + 100 * run;
        const double fresh = 2.0 * draws.normal(entity, k, 0);
        error[i] = k == 0 ? fresh : kept * error[i] + std::sqrt(1.0 - kept * kept) * fresh;
        ranges[i].range_m += error[i];
        ranges[i].sigma_m = 2.0;
        RateMeasurement rate{ranges[i].p_E, Eigen::Vector3d::Zero(), 0.0, 0.3};
        rate.rate_m_s = range_rate_m_s(rate, kVicksburg, Eigen::Vector3d::Zero()) + 0.3 * draws.normal(entity, k, 1);
        rates.push_back(rate);
      }
      const auto s = same_signals(ranges.size(), 45.0);
      const PvtFilter::Report r{lasting, s};
      const auto a = with.update(start + static_cast<double>(k), ranges, rates, kVicksburg, &r);
      const auto b = without.update(start + static_cast<double>(k), ranges, rates, kVicksburg);
      ASSERT_TRUE(a.ok && b.ok);
      ASSERT_EQ(a.p_E, b.p_E);  // what is said changes no estimate
      e_with = a.p_E - kVicksburg;
      P_with = a.covariance.topLeftCorner<3, 3>();
      P_without = b.covariance.topLeftCorner<3, 3>();
    }
    reported += e_with.dot(P_with.ldlt().solve(e_with)) / kRuns;
    believed += e_with.dot(P_without.ldlt().solve(e_with)) / kRuns;
  }
  EXPECT_NEAR(reported, 3.0, 4.0 * std::sqrt(6.0 / kRuns));
  EXPECT_GT(believed, 6.0);
}

}  // namespace
}  // namespace canyon::gnss

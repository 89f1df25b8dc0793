#include "canyon/study/drive_check/drive_figures.h"

#include <cmath>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/study/drive_check/drive_distributions.h"
#include "canyon/study/drive_check/drive_satellites.h"

namespace canyon::study {
namespace {

const GpsTime kFiguresStart = GpsTime::from_week_sow(1900, 126700.0);
const SatelliteId kOne{GnssSystem::kGps, 1}, kTwo{GnssSystem::kGps, 2};

DriveSignal signal(SatelliteId sv, bool in_sight, double cn0_dbhz, double error_m, double rate_m_s = kNaN) {
  return {.sv = sv, .in_sight = in_sight, .cn0_dbhz = cn0_dbhz, .error_m = error_m, .rate_error_m_s = rate_m_s};
}

TEST(DriveFigures, QuantilesAreLinearBetweenRanksAndTheMissingComeLast) {
  EXPECT_EQ(drive_quantile({4.0, 1.0, 2.0, 3.0}, 0.5), 2.5);
  EXPECT_EQ(drive_quantile({4.0, 1.0, 2.0, 3.0}, 1.0), 4.0);
  EXPECT_TRUE(std::isnan(drive_quantile({}, 0.5)));
  EXPECT_EQ(drive_quantile({1.0, INFINITY}, 0.5), INFINITY);
  // Three fixes of four instants: the half is between the second and the third, the 95 % is not there.
  const DriveFigures f = drive_figures({}, {{1.0, 0.0}, {2.0, 0.0}, {}, {3.0, 0.0}});
  EXPECT_EQ(f.fix_h50_m, 2.5);
  EXPECT_EQ(f.fix_h95_m, INFINITY);
  EXPECT_EQ(f.fixes, 3);
  EXPECT_EQ(f.instants, 4);
}

TEST(DriveFigures, CountsByHandOfTwoEpochs) {
  std::vector<DriveEpoch> epochs(2);
  epochs[0] = {kFiguresStart, {signal(kOne, true, 50.0, -1.0), signal(kTwo, false, 30.0, 40.0, -2.0)}};
  epochs[1] = {kFiguresStart + 1.0, {signal(kOne, true, 40.0, 3.0), signal(kTwo, false, 40.0, -10.0, 1.0)}};
  const DriveFigures f = drive_figures(epochs, {});
  EXPECT_EQ(f.tracked_in_sight, 1.0);
  EXPECT_EQ(f.tracked_hidden, 1.0);
  EXPECT_EQ(f.cn0_auc, (1.0 + 1.0 + 1.0 + 0.5) / 4.0);  // 50 > 30, 50 > 40, 40 > 30, 40 = 40
  EXPECT_EQ(f.hidden_error_m[0], 25.0);
  EXPECT_EQ(f.hidden_signed_m[1], 15.0);
  EXPECT_EQ(f.hidden_positive_share, 0.5);
  EXPECT_EQ(f.hidden_rate_m_s[0], 1.5);
  EXPECT_EQ(f.cn0_in_sight_dbhz[1], 45.0);
}

TEST(DriveFigures, DistributionsAreWhatTheQuantilesAreOf) {
  std::vector<DriveEpoch> epochs(2);
  epochs[0] = {kFiguresStart, {signal(kOne, true, 50.0, -1.0), signal(kTwo, false, 30.0, 40.0, -2.0)}};
  epochs[1] = {kFiguresStart + 1.0, {signal(kOne, true, 40.0, kNaN), signal(kTwo, false, 41.0, -10.0, 1.0)}};
  const auto one = drive_distributions(epochs, {{3.0, 0.0}, {}, {1.0, 0.0}});
  const auto none = drive_distributions({}, {});
  const Json out = drive_distributions_json(one, none);
  EXPECT_EQ(out["cn0_in_sight_dbhz"]["simulated"]["count"], 2);
  EXPECT_EQ(out["in_sight_error_m"]["simulated"]["count"], 1) << "what is no number is not counted";
  const Json& hidden = out["hidden_error_m"]["simulated"]["percentiles"];
  ASSERT_EQ(hidden.size(), 101U);
  for (const int percent : {0, 5, 50, 95, 100})
    EXPECT_DOUBLE_EQ(hidden[static_cast<std::size_t>(percent)].get<double>(),
                     drive_quantile({40.0, -10.0}, 0.01 * percent));
  const Json& fixes = out["fix_horizontal_error_m"]["simulated"]["percentiles"];
  EXPECT_EQ(fixes[50], 3.0);
  EXPECT_TRUE(fixes[51].is_null() && fixes[100].is_null()) << "an instant without a fix is the worst";
  EXPECT_EQ(out["hidden_error_m"]["measured"]["count"], 0);
  EXPECT_TRUE(out["hidden_error_m"]["measured"]["percentiles"].empty());
}

TEST(DriveSatellites, EachStandsOverTimeOnBothSides) {
  std::vector<DriveEpoch> simulated(2), measured(1);
  simulated[0] = {kFiguresStart, {signal(kOne, true, 50.0, -1.0), signal(kTwo, false, 30.0, 40.1236, -2.0)}};
  simulated[1] = {kFiguresStart + 1.0, {signal(kOne, false, 40.0, kNaN)}};
  measured[0] = {kFiguresStart, {signal(kOne, true, 44.0, 2.0)}};
  const Json out = drive_satellites_json(simulated, measured);
  EXPECT_EQ(out.size(), 2U);
  const Json& one = out[kOne.str()];
  EXPECT_EQ(one["simulated"]["sow"][1].get<double>() - one["simulated"]["sow"][0].get<double>(), 1.0);
  EXPECT_EQ(one["simulated"]["in_sight"], Json({true, false}));
  EXPECT_EQ(one["simulated"]["cn0_dbhz"], Json({50.0, 40.0}));
  EXPECT_TRUE(one["simulated"]["error_m"][1].is_null());
  EXPECT_EQ(one["measured"]["error_m"], Json::array({2.0}));
  EXPECT_EQ(out[kTwo.str()]["simulated"]["error_m"], Json::array({40.124}));
  EXPECT_FALSE(out[kTwo.str()].contains("measured"));
}

// A first-order Gauss-Markov process of 4 s in each of 60 satellites: the estimate is within 4 sigma of exp(-lag / 4
// s), sigma after Bartlett, sqrt((1 + rho1^2) / (1 - rho1^2) / n) <= 0.021 for n = 60 x 400 (false alarms 6e-5 each).
TEST(DriveFigures, AutocorrelationOfAGaussMarkovProcess) {
  const RandomStream draws(1, "test.drive_figures");
  const double rho = std::exp(-0.25);
  std::vector<DriveEpoch> epochs(400);
  for (std::uint32_t s = 0; s < 60; ++s) {
    double x = draws.normal(s, 0);
    for (std::size_t k = 0; k < epochs.size(); ++k) {
      epochs[k].t = kFiguresStart + static_cast<double>(k);
      epochs[k].signals.push_back(signal({GnssSystem::kGps, static_cast<std::uint8_t>(s + 1)}, false, 30.0, 30.0 + x));
      x = rho * x + std::sqrt(1.0 - rho * rho) * draws.normal(s, k + 1);
    }
  }
  const DriveFigures f = drive_figures(epochs, {});
  EXPECT_NEAR(f.hidden_autocorrelation[0], std::exp(-0.25), 4.0 * 0.021);
  EXPECT_NEAR(f.hidden_autocorrelation[1], std::exp(-1.25), 4.0 * 0.021);
  EXPECT_NEAR(f.hidden_autocorrelation[2], std::exp(-2.50), 4.0 * 0.021);
  EXPECT_TRUE(std::isnan(f.in_sight_autocorrelation[0]));
}

// Of honest covariances 0.27 % lie beyond; 40,000 draws, 4 sigma (false alarm 6e-5).
TEST(DriveFigures, HonestCovarianceIsLeftByOneFixIn370) {
  const RandomStream draws(2, "test.drive_fixes");
  std::vector<DriveFix> fixes;
  for (std::uint32_t i = 0; i < 40000; ++i) {
    const double x = draws.normal(0, 2 * i), y = draws.normal(0, 2 * i + 1);
    fixes.push_back({std::hypot(x, y), x * x + y * y});
  }
  const double p = 0.0026997960632601866;
  EXPECT_NEAR(drive_figures({}, fixes).beyond_3_sigma, p, 4.0 * std::sqrt(p / 40000.0));
}

}  // namespace
}  // namespace canyon::study

#include "canyon/study/drive_check/drive_score.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/study/drive_check/drive_resampling.h"

namespace canyon::study {
namespace {

const GpsTime kBegin = GpsTime::from_week_sow(1900, 100000.0);

/// Two satellites, one at 20 degrees with errors of 30 m and 5 m about it, one at 60 of 0 and 1 m; 5 epochs a second.
std::vector<DriveEpoch> drive(std::uint64_t seed, double length_s, double error_m = 30.0) {
  const RandomStream noise(seed, "test.drive");
  std::vector<DriveEpoch> out;
  for (int k = 0; k < static_cast<int>(5.0 * length_s); ++k) {
    DriveEpoch epoch{kBegin + 0.2 * k, {}};
    const auto sample = static_cast<std::uint64_t>(k);
    epoch.signals.push_back({.sv = {GnssSystem::kGps, 5},
                             .in_sight = false,
                             .elevation_rad = 20.0 * kDegree,
                             .cn0_dbhz = 30.0,
                             .error_m = error_m + 5.0 * noise.normal(0, sample)});
    epoch.signals.push_back({.sv = {GnssSystem::kGps, 9},
                             .in_sight = true,
                             .elevation_rad = 60.0 * kDegree,
                             .cn0_dbhz = 45.0,
                             .error_m = 1.0 * noise.normal(1, sample)});
    out.push_back(epoch);
  }
  return out;
}

// By hand: draws 1, 2, 4 and what came, 3: mean distance 4/3, half the mean distance of pairs (1 + 2 + 3) / 3 / 2 = 1.
TEST(DriveScore, CrpsByHand) {
  EXPECT_NEAR(crps({4.0, 1.0, 2.0}, 3.0), 4.0 / 3.0 - 1.0, 1e-15);
  EXPECT_NEAR(crps({4.0, 1.0, 2.0}, 0.0), 7.0 / 3.0 - 1.0, 1e-15);
  EXPECT_NEAR(crps({4.0, 1.0, 2.0}, 9.0), 20.0 / 3.0 - 1.0, 1e-15);
}

// Of draws from the law itself the score is sigma / sqrt(pi), however many; mean over 600 of each kind within 4 of its
// standard deviations (0.4 sigma a signal, draws of 10 a little more).
TEST(DriveScore, OfTheRightLawIsSigmaOverRootPi) {
  std::vector<std::vector<DriveEpoch>> draws;
  for (std::uint64_t k = 1; k <= 10; ++k) draws.push_back(drive(k, 120.0));
  const DriveScore score = drive_score(drive(99, 120.0), draws, 1);
  EXPECT_EQ(score.signals, 1200);
  EXPECT_EQ(score.draws, 10);
  EXPECT_EQ(score.foretold_share, 1.0);
  EXPECT_NEAR(score.simulation_m, 0.5 * 6.0 / std::sqrt(kPi), 4.0 * 0.5 * 5.0 * 0.5 / std::sqrt(600.0));
  // Elevation tells these two apart as well; blind draws of both do not: sqrt(2 / pi) x 15 and more.
  EXPECT_NEAR(score.elevation_m, score.simulation_m, 0.2);
  EXPECT_GT(score.blind_m, 5.0);
  EXPECT_LT(score.against_blind_m[1], 0.0);
  EXPECT_LT(score.against_elevation_m[0], 0.0);
  EXPECT_GT(score.against_elevation_m[1], -0.2);
}

// A simulation that is wrong by 40 m is worse than elevation alone, and the interval says so.
TEST(DriveScore, AWrongSimulationIsSeen) {
  std::vector<std::vector<DriveEpoch>> draws;
  for (std::uint64_t k = 1; k <= 5; ++k) draws.push_back(drive(k, 120.0, 70.0));
  const DriveScore score = drive_score(drive(99, 120.0), draws, 1);
  EXPECT_GT(score.against_elevation_m[0], 5.0);
}

TEST(DriveScore, SaysNothingWithoutDrawsOrOtherBlocks) {
  EXPECT_EQ(drive_score(drive(1, 60.0), {}, 1).signals, 0);
  EXPECT_TRUE(std::isnan(drive_score(drive(1, 15.0), {drive(2, 15.0)}, 1).blind_m));
}

// Every drawn drive has as many blocks; figures vary about those of the drive, and the mean error's spread is that of
// blocks: all alike here, so none beyond the noise of 500 values, 5 m / sqrt(500) and the median's 1.25.
TEST(DriveResampling, BlocksKeepTheirEpochs) {
  const auto epochs = drive(7, 100.0);
  std::vector<DriveFix> fixes;
  for (const DriveEpoch& e : epochs) fixes.push_back({.horizontal_m = 12.0, .normalised2 = 1.0, .t = e.t});
  const auto figures = resampled_figures(epochs, fixes, 50, 3);
  ASSERT_EQ(figures.size(), 50u);
  double least = 1e9, most = -1e9;
  for (const DriveFigures& f : figures) {
    EXPECT_EQ(f.instants, 500);
    EXPECT_EQ(f.tracked_hidden, 1.0);
    EXPECT_EQ(f.fix_h50_m, 12.0);
    EXPECT_NEAR(f.hidden_error_m[0], 30.0, 6.0 * 1.25 * 5.0 / std::sqrt(500.0));
    // White errors: correlations of 5 x 95 pairs, and of blocks drawn twice the same.
    EXPECT_LT(std::abs(f.hidden_autocorrelation[0]), 6.0 / std::sqrt(95.0));
    least = std::min(least, f.hidden_error_m[0]);
    most = std::max(most, f.hidden_error_m[0]);
  }
  EXPECT_LT(least, most);
  EXPECT_EQ(resampled_figures(epochs, fixes, 3, 3)[2].hidden_error_m, figures[2].hidden_error_m);
  EXPECT_TRUE(resampled_figures({}, {}, 3, 3).empty());
}

}  // namespace
}  // namespace canyon::study

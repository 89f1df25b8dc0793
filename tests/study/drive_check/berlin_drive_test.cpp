// A real street: what a u-blox logged at Potsdamer Platz, Berlin, beside what is simulated there. Nothing is fitted
// here.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/drive_check/drive_check.h"
#include "canyon/study/drive_check/drive_resampling.h"
#include "canyon/tests/gnss/paths/berlin_street.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::study {
namespace {

constexpr double kStart_sow = 126641.7;  // of the reference's time 0, week 1900

std::vector<StampedPlace> read_reference(const std::string& file) {
  std::vector<StampedPlace> out;
  std::ifstream in(file);
  std::string line, word;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    double t = 0.0;
    Eigen::Vector3d p_E;
    if (fields >> word >> t >> p_E.x() >> p_E.y() >> p_E.z())
      out.push_back({GpsTime::from_week_sow(1900, kStart_sow + t), p_E, 0});
  }
  return out;
}

/// The drive, and the receiver `as` simulated along it.
class BerlinDrive : public ::testing::Test {
 protected:
  void check(gnss::GnssConfig as, int draws = 1) {
    const std::string folder = "gnss/urban_berlin/";
    CANYON_REAL_DATA(obs, folder + "Berlin_Potsdamer_Platz.obs.gz");
    CANYON_REAL_DATA(gps, folder + "brdc1580.16n");
    CANYON_REAL_DATA(glonass, folder + "brdc1580.16g");
    CANYON_REAL_DATA(sp3, folder + "gbm19001.sp3.gz");
    CANYON_REAL_DATA(prisms, folder + "potsdamer_platz_lod2_prisms.txt");
    CANYON_REAL_DATA(track, folder + "Berlin_Potsdamer_Platz_GT.txt");
    CANYON_REAL_DATA(derived, folder + "derived_residuals_and_LOS.csv");
    const auto street = gnss::testing::read_street(prisms, track, derived, false);
    const auto reference = read_reference(track);
    gnss::SinglePointConfig solver;
    solver.systems = "GR";
    gnss::RecordedFiles files{
        .observations = obs, .navigation = {gps, glonass}, .sp3 = {sp3}, .antex = "", .ionex = ""};
    const auto data = *gnss::read_recorded_data(files, solver);
    as.satellites.systems = "GR";
    as.satellites.nav_files = files.navigation;
    const auto checked = check_drive({.data = data,
                                      .reference = reference,
                                      .reference_name = track,
                                      .scene_name = prisms,
                                      .scene = *street.scene,
                                      .receiver = as,
                                      .solver = solver,
                                      .draws = draws,
                                      .from_sow = street.observations.front().sow,
                                      .to_sow = street.observations.back().sow});
    ASSERT_TRUE(checked) << checked.error().str();
    std::printf("%s", drive_check_text(*checked).c_str());
    checked_ = *checked;
  }
  const DriveCheck& checked() const { return *checked_; }

 private:
  std::optional<DriveCheck> checked_;
};

// The measured side against what was found of the same log by another program, when this comparison was first asked for
// (in sight 7.4, hidden 6.3 per epoch; C/N0 35/44/50 and 27/32/40; AUC 0.90; 32.4/121 m hidden; 25.9 m in sight; fixes
// 26/72 m; of 258 epochs, here of the 641 of the same stretch): its rounding, and two block-bootstrap sigmas of 8 % for
// medians of metres, 10 % for counts.
TEST_F(BerlinDrive, MeasuredSideIsWhatOthersFound) {
  gnss::GnssConfig receiver;
  receiver.propagation.paths.name = "visibility";  // the measured side does not depend on it
  check(receiver);
  if (IsSkipped() || HasFatalFailure()) return;
  const DriveFigures& f = checked().measured.figures;
  EXPECT_NEAR(f.tracked_in_sight, 7.4, 0.74);
  EXPECT_NEAR(f.tracked_hidden, 6.3, 0.63);
  EXPECT_NEAR(f.cn0_in_sight_dbhz[1], 44.0, 1.0);
  EXPECT_NEAR(f.cn0_hidden_dbhz[1], 32.0, 1.0);
  EXPECT_NEAR(f.cn0_auc, 0.90, 0.02);
  EXPECT_NEAR(f.hidden_error_m[0], 32.4, 0.16 * 32.4);
  EXPECT_NEAR(f.hidden_error_m[1], 121.0, 0.16 * 121.0);
  EXPECT_NEAR(f.in_sight_error_p95_m, 25.9, 0.16 * 25.9);
  EXPECT_GT(f.hidden_positive_share, 0.95);
  EXPECT_NEAR(f.fix_h50_m, 26.0, 0.16 * 26.0);
  EXPECT_NEAR(f.fix_h95_m, 72.0, 0.16 * 72.0);
}

/// C/N0 reported of satellites above an elevation, dB-Hz, but for a block of the drive and 5 s on either side of it.
std::vector<double> reported_cn0_without_block(const std::vector<DriveEpoch>& drive, double above_deg, GpsTime block) {
  constexpr double kBesideBlock_s = 5.0;
  std::vector<double> out;
  for (const DriveEpoch& epoch : drive) {
    const double since_s = epoch.t - block;
    if (since_s >= -kBesideBlock_s && since_s < kDriveBlock_s + kBesideBlock_s) continue;
    for (const DriveSignal& s : epoch.signals)
      if (s.elevation_rad > above_deg * kDegree && std::isfinite(s.cn0_dbhz)) out.push_back(s.cn0_dbhz);
  }
  return out;
}

// What docs/gnss.md says of this drive: the weakest signal above the mask of 10 degrees (below it the log has weaker
// ones), and what is reported of the one satellite near the zenith, at 85 degrees. Neither hangs on a piece of it: the
// one is the same, the other to the 1 dB in which C/N0 is logged, without 20 s from any epoch on and 5 s about them.
TEST_F(BerlinDrive, WeakestSignalAndZenithReadingHangOnNoPieceOfTheDrive) {
  gnss::GnssConfig receiver;
  receiver.propagation.paths.name = "visibility";  // as above
  check(receiver);
  if (IsSkipped() || HasFatalFailure()) return;
  const std::vector<DriveEpoch>& drive = checked().measured.epochs;
  ASSERT_EQ(drive.size(), 641U);
  const GpsTime elsewhere = drive.front().t - 3600.0;
  const auto zenith_dbhz = [&](GpsTime block) {
    return drive_quantile(reported_cn0_without_block(drive, 80.0, block), 0.5);
  };
  // 2 dB above the gain that the receiver is simulated with.
  EXPECT_EQ(zenith_dbhz(elsewhere), 51.0);
  for (const DriveEpoch& from : drive) {
    const std::vector<double> all = reported_cn0_without_block(drive, 0.0, from.t);
    ASSERT_FALSE(all.empty());
    EXPECT_EQ(*std::min_element(all.begin(), all.end()), 21.0) << from.t.sow_s();
    EXPECT_NEAR(zenith_dbhz(from.t), 51.0, 1.0) << from.t.sow_s();
  }
}

using BerlinDriveNightly = BerlinDrive;

// The street of `high`, and the catalogue's u-blox of that time with the two figures of it that the log tells: what
// docs/gnss.md says is met there, within what was asked for. What it says is missed is not asserted.
TEST_F(BerlinDriveNightly, SimulatedSideIsMetWhereTheDocumentsSaySo) {
  const auto file = mission::MissionFile::parse(
      "base = \"vicksburg\"\n[gnss]\nreceiver = \"m8\"\ntracking_threshold_dbhz = 21.0\ncn0_zenith_dbhz = 49.0\n",
      "street.toml");
  ASSERT_TRUE(file) << file.error().str();
  const auto config = file->resolve("high");
  ASSERT_TRUE(config) << config.error().str();
  check(config->gnss);
  if (IsSkipped() || HasFatalFailure()) return;
  const DriveFigures &f = checked().simulated.figures, &real = checked().measured.figures;
  EXPECT_NEAR(f.tracked_hidden, real.tracked_hidden, 0.2 * real.tracked_hidden);
  EXPECT_GT(f.cn0_in_sight_dbhz[2] - f.cn0_in_sight_dbhz[0], 10.0);
  EXPECT_NEAR(f.cn0_in_sight_dbhz[1], real.cn0_in_sight_dbhz[1], 3.0);
  EXPECT_NEAR(f.cn0_hidden_dbhz[1], real.cn0_hidden_dbhz[1], 3.0);
  EXPECT_GT(f.hidden_error_m[0], 20.0);
  EXPECT_LT(f.hidden_error_m[0], 45.0);
  EXPECT_GT(f.hidden_positive_share, 0.93);
  EXPECT_NEAR(f.hidden_autocorrelation[0], real.hidden_autocorrelation[0], 0.2);
}

}  // namespace
}  // namespace canyon::study

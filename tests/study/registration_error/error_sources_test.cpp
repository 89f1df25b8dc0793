#include "canyon/study/registration_error/error_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/tests/study/registration_error/taped_start.h"

namespace canyon::study {
namespace {

/// Sits by, and keeps the scans that it is shown.
class ScanKeeper final : public mission::Autonomy {
 public:
  explicit ScanKeeper(std::vector<LidarScan>& scans) : scans_(scans) {}
  void see(const LidarScan& scan, const Pose&, const NavEstimate&) override { scans_.push_back(scan); }
  DriveCommand drive(const NavEstimate&) override { return {}; }
  mission::AutonomyState state() const override { return mission::AutonomyState::kDriving; }
  int next_waypoint() const override { return 0; }

 private:
  std::vector<LidarScan>& scans_;
};

struct ScannedRun : mission::testing::RecordedRun {
  std::vector<LidarScan> scans;  ///< deskewed
};

ScannedRun drive_scanned(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                         const Tape& tape) {
  ScannedRun run;
  auto record = mission::run_mission(
      config, mission, nullptr, {.tape = &tape, .recorder = &run, .autonomy = std::make_unique<ScanKeeper>(run.scans)});
  EXPECT_TRUE(record.ok()) << (record.ok() ? "" : record.error().str());
  static_cast<mission::RunRecord&>(run) = *std::move(record);
  return run;
}

mission::MissionConfig config_without(const mission::MissionConfig& config, const std::string& source) {
  for (std::size_t i = 0; i < error_sources().size(); ++i)
    if (error_sources()[i].name == source) return without_sources(config, 1u << i, HiddenRemoval::kHealed);
  ADD_FAILURE() << source;
  return config;
}

/// Whatever no scan has a part in: the same bits.
void expect_same_but_for_scans(const ScannedRun& a, const ScannedRun& b, const char* what) {
  ASSERT_EQ(a.imu_samples.size(), b.imu_samples.size()) << what;
  for (std::size_t i = 0; i < a.imu_samples.size(); ++i) {
    ASSERT_EQ(a.imu_samples[i].dtheta_U, b.imu_samples[i].dtheta_U) << what << ' ' << i;
    ASSERT_EQ(a.imu_samples[i].dv_U, b.imu_samples[i].dv_U) << what << ' ' << i;
  }
  ASSERT_EQ(a.gnss_rows.size(), b.gnss_rows.size()) << what;
  for (std::size_t i = 0; i < a.gnss_rows.size(); ++i) {
    ASSERT_EQ(a.gnss_rows[i].fix.status, b.gnss_rows[i].fix.status) << what << ' ' << i;
    if (a.gnss_rows[i].fix.status == FixStatus::kNone) continue;
    ASSERT_EQ(a.gnss_rows[i].fix.p_A_E, b.gnss_rows[i].fix.p_A_E) << what << ' ' << i;
  }
  ASSERT_EQ(a.nav.size(), b.nav.size()) << what;
  for (std::size_t i = 0; i < a.nav.size(); ++i) {
    ASSERT_EQ(a.nav[i].estimate.X_WB.p, b.nav[i].estimate.X_WB.p) << what << ' ' << i;
    ASSERT_EQ(a.nav[i].estimate.X_WB.R.coeffs(), b.nav[i].estimate.X_WB.R.coeffs()) << what << ' ' << i;
  }
}

/// Largest distance between returns of the same beams, m; infinite where they are not of the same ones.
double apart_m(const LidarScan& a, const LidarScan& b) {
  if (a.t != b.t || a.points.size() != b.points.size()) return std::numeric_limits<double>::infinity();
  double out = 0.0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const LidarPoint &p = a.points[i], &q = b.points[i];
    if (p.ring != q.ring || p.return_index != q.return_index) return std::numeric_limits<double>::infinity();
    out = std::max(out, std::hypot(double{p.x} - q.x, double{p.y} - q.y, double{p.z} - q.z));
  }
  return out;
}

/// By how much the change of one return's range differs from that of the next in azimuth, the median, m.
double change_of_range_to_the_next_m(const LidarScan& a, const LidarScan& b) {
  const auto range_m = [](const LidarPoint& p) { return std::hypot(double{p.x}, double{p.y}, double{p.z}); };
  std::vector<std::pair<double, double>> changes;  // azimuth, change
  for (std::size_t i = 0; i < a.points.size(); ++i)
    changes.emplace_back(std::atan2(a.points[i].y, a.points[i].x), range_m(b.points[i]) - range_m(a.points[i]));
  std::sort(changes.begin(), changes.end());
  std::vector<double> steps;
  for (std::size_t i = 1; i < changes.size(); ++i) steps.push_back(std::abs(changes[i].second - changes[i - 1].second));
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
}

double registered_apart_m(const ScannedRun& a, const ScannedRun& b) {
  EXPECT_EQ(a.keyframes.size(), b.keyframes.size());
  double out = 0.0;
  for (std::size_t i = 0; i < std::min(a.keyframes.size(), b.keyframes.size()); ++i) {
    EXPECT_EQ(a.keyframes[i].X_WL_prior.p, b.keyframes[i].X_WL_prior.p) << i;
    out = std::max(out, (a.keyframes[i].X_WL_registered.p - b.keyframes[i].X_WL_registered.p).norm());
  }
  return out;
}

/// The vehicle where the tape begins, all the time.
Tape standing_still(const Tape& tape) {
  Tape out = tape;
  for (TapeNode& node : out.nodes) {
    const GpsTime t = node.motion.t;
    node = TapeNode{};
    node.motion.t = t;
    node.motion.X_WB = tape.nodes.front().motion.X_WB;
  }
  return out;
}

/// The first seconds of the short mission, with scans that are stamped late.
struct LateScans : testing::TapedStart {
  LateScans() : testing::TapedStart(testing::taped_start("high", 8.0)) { config.lidar.latency_s = 0.05; }
};

TEST(ErrorSources, WithoutErrorsOfTheGuessEveryScanIsTheSame) {
  const LateScans on;
  const ScannedRun whole = drive_scanned(on.config, on.mission, on.tape),
                   without = drive_scanned(config_without(on.config, "guess"), on.mission, on.tape);
  expect_same_but_for_scans(without, whole, "guess");
  ASSERT_EQ(without.scans.size(), whole.scans.size());
  for (std::size_t k = 0; k < whole.scans.size(); ++k) EXPECT_EQ(apart_m(without.scans[k], whole.scans[k]), 0.0) << k;
  ASSERT_GT(whole.keyframes.size(), 3U);
  EXPECT_GT(registered_apart_m(without, whole), 0.0) << "the guess acts";
}

// The same returns, which another motion puts straight: both move what is fired at one moment alike, so that of two
// returns side by side the ranges change by the same, to the tilt of their beams. Ranges with 0.02 m of noise that was
// drawn anew would change by 27 mm more or less than their neighbours (0.67 of 2 x 0.02 m).
TEST(ErrorSources, WithoutErrorsOfDeskewingTheReturnsAreTheSame) {
  const LateScans on;
  ASSERT_GE(on.config.lidar.range_noise_m, 0.02);
  const ScannedRun whole = drive_scanned(on.config, on.mission, on.tape),
                   without = drive_scanned(config_without(on.config, "deskewing"), on.mission, on.tape);
  expect_same_but_for_scans(without, whole, "deskewing");
  ASSERT_EQ(without.scans.size(), whole.scans.size());
  double most_m = 0.0;
  for (std::size_t k = 0; k < whole.scans.size(); ++k) {
    const double moved_m = apart_m(without.scans[k], whole.scans[k]);
    ASSERT_TRUE(std::isfinite(moved_m)) << k << ": other returns";
    ASSERT_GT(whole.scans[k].points.size(), 1000U) << k;
    most_m = std::max(most_m, moved_m);
    EXPECT_LT(change_of_range_to_the_next_m(without.scans[k], whole.scans[k]), 0.005) << k;
    for (std::size_t i = 0; i < whole.scans[k].points.size(); ++i)
      ASSERT_EQ(without.scans[k].points[i].intensity, whole.scans[k].points[i].intensity) << k << ' ' << i;
  }
  EXPECT_GT(most_m, 1e-5) << "the motion within a sweep acts";
  EXPECT_GT(registered_apart_m(without, whole), 0.0);
}

// Scans that are stamped late are measured somewhere else, but for a vehicle that stands: there they are the same to
// the rounding of single precision, 1e-5 m at 100 m, with room.
TEST(ErrorSources, WithoutLatencyTheDrawsAreTheSame) {
  const LateScans on;
  const mission::MissionConfig in_time = config_without(on.config, "time_offset");
  ASSERT_EQ(in_time.lidar.latency_s, 0.0);
  const auto scan_of = [](const ScannedRun& run, GpsTime t) {
    return std::find_if(run.scans.begin(), run.scans.end(), [t](const LidarScan& scan) { return scan.t == t; });
  };
  const Tape still = standing_still(on.tape);
  const ScannedRun late = drive_scanned(on.config, on.mission, still),
                   without = drive_scanned(in_time, on.mission, still);
  expect_same_but_for_scans(without, late, "standing");
  ASSERT_GT(late.scans.size(), 20U);
  for (const LidarScan& scan : late.scans) {
    const auto same = scan_of(without, scan.t);
    ASSERT_NE(same, without.scans.end()) << scan.t - late.start;
    ASSERT_GT(scan.points.size(), 1000U);
    EXPECT_LT(apart_m(scan, *same), 1e-4) << scan.t - late.start;
  }

  const ScannedRun driven_late = drive_scanned(on.config, on.mission, on.tape),
                   driven = drive_scanned(in_time, on.mission, on.tape);
  expect_same_but_for_scans(driven, driven_late, "driving");
  const auto same = scan_of(driven, driven_late.scans.back().t);
  ASSERT_NE(same, driven.scans.end());
  EXPECT_GT(apart_m(driven_late.scans.back(), *same), 0.05) << "latency acts";
}

}  // namespace
}  // namespace canyon::study

// A fix that corrects the estimate by metres moves neither the points of a scan against one another nor the guess from
// which a keyframe's alignment begins.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/fusion/observers/predicted_motion.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/mission/localizer.h"
#include "canyon/tests/fusion/driven_truth.h"
#include "canyon/tests/fusion/tactical_noise.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

using canyon::testing::DrivenTruth;

/// Drives along a bend whatever it is told, and keeps the scans that it is shown.
class Onlooker final : public Autonomy {
 public:
  explicit Onlooker(std::vector<LidarScan>& scans) : scans_(scans) {}
  void see(const LidarScan& scan, const Pose&, const NavEstimate&) override { scans_.push_back(scan); }
  DriveCommand drive(const NavEstimate&) override { return {.speed_m_s = 8.0, .curvature_1_m = 0.02}; }
  AutonomyState state() const override { return AutonomyState::kDriving; }
  int next_waypoint() const override { return 0; }

 private:
  std::vector<LidarScan>& scans_;
};

/// The first fix comes 3.15 s after the start, in the middle of a sweep of a tenth of a second; the filter knows its
/// place to 60 m until then, and the fix is some metres off.
constexpr double kFix_s = 3.15;
constexpr const char* kOneFix = R"(
[time]
limit_s = 3.4
[gnss]
model = "truth_plus_white"
white_sigma_m = 7.0
white_sigma_up_m = 1.0
rate_hz = 0.31746
[fusion]
initial_position_sigma_m = 60.0
)";

struct Driven : RecordedRun {
  std::vector<LidarScan> scans;
  /// The one in whose sweep the fix comes.
  const LidarScan& over_the_fix() const {
    return *std::find_if(scans.begin(), scans.end(), [&](const LidarScan& s) { return s.t - start > kFix_s; });
  }
  /// By which the fix moved the estimate, m.
  double corrected_m() const {
    const auto after = std::find_if(nav.begin(), nav.end(), [&](const NavRow& r) { return r.t - start > kFix_s; });
    const auto moved = [](const NavRow& r) -> Eigen::Vector3d { return r.estimate.X_WB.p - r.X_WB_true.p; };
    return (moved(*after) - moved(*(after - 1))).norm();
  }
};

Driven drive_deskewed_by(const std::string& deskew, const std::string& extra) {
  const MissionConfig config =
      short_config("low", "low", kOneFix + extra + "\n[lidar]\ndeskew = \"" + deskew + "\"\nrate_hz = 10.0\n");
  auto mission = prepare(config, scenes());
  EXPECT_TRUE(mission.ok()) << (mission.ok() ? "" : mission.error().str());
  Driven run;
  auto record = run_mission(config, *mission, nullptr,
                            {.tape = nullptr, .recorder = &run, .autonomy = std::make_unique<Onlooker>(run.scans)});
  EXPECT_TRUE(record.ok()) << (record.ok() ? "" : record.error().str());
  static_cast<RunRecord&>(run) = *std::move(record);
  return run;
}

/// Largest distance between the same returns of two scans, m.
double largest_m(const LidarScan& a, const LidarScan& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.points.size(), b.points.size());
  EXPECT_GT(a.points.size(), 10000U);
  double out = 0.0;
  for (std::size_t i = 0; i < std::min(a.points.size(), b.points.size()); ++i) {
    const LidarPoint &p = a.points[i], &q = b.points[i];
    EXPECT_EQ(p.ring, q.ring);
    out = std::max(out, std::hypot(double{p.x} - q.x, double{p.y} - q.y, double{p.z} - q.z));
  }
  return out;
}

struct Start {
  const char* name;
  const char* keys;  ///< of [fusion]
  bool absolutely;   ///< within 5 mm of the truth too
};
class ScanOverACorrection : public ::testing::TestWithParam<Start> {};

/// The same drive once more without the fix says what of it is the correction's: the rest is the unit's noise within a
/// sweep, at returns 100 m away, and what the filter does not know of its velocity. 5 mm are what is asked.
TEST_P(ScanOverACorrection, IsDeskewedAsByTruth) {
  const std::string keys = GetParam().keys;
  const Driven truth = drive_deskewed_by("truth", keys), prediction = drive_deskewed_by("prediction", keys),
               estimate = drive_deskewed_by("estimate", keys),
               uncorrected = drive_deskewed_by("prediction", keys + "[run]\nwithhold_fixes_after_s = 0.0\n");
  const double corrected_m = prediction.corrected_m();
  const double by_prediction_m = largest_m(truth.over_the_fix(), prediction.over_the_fix()),
               without_m = largest_m(truth.over_the_fix(), uncorrected.over_the_fix()),
               by_correction_m = largest_m(uncorrected.over_the_fix(), prediction.over_the_fix()),
               by_estimate_m = largest_m(truth.over_the_fix(), estimate.over_the_fix());
  const TapeNode& last = prediction.tape.back();
  std::printf(
      "%s: at %.1f m/s, corrected by %.2f m; returns off by %.2f mm at most (without the fix %.2f mm; between the two "
      "%.2f mm), by the estimate's way by %.2f m\n",
      GetParam().name, last.speed_m_s, corrected_m, 1e3 * by_prediction_m, 1e3 * without_m, 1e3 * by_correction_m,
      by_estimate_m);
  EXPECT_GT(last.speed_m_s, 3.0);
  EXPECT_GT(corrected_m, 4.0);
  EXPECT_LT(by_correction_m, 5e-3);
  if (GetParam().absolutely) {
    EXPECT_LT(by_prediction_m, 5e-3);
  }
  EXPECT_GT(by_estimate_m, 0.9 * corrected_m);
}

// A fix that states 7 m must count for enough to move the vehicle's filter by 4 m.
constexpr const char* kVehicle = "filter = \"vehicle\"\nfix_error_power = 1\n";

INSTANTIATE_TEST_SUITE_P(Filters, ScanOverACorrection,
                         ::testing::Values(Start{"naive", "", true}, Start{"vehicle", kVehicle, false}),
                         [](const auto& one) { return std::string(one.param.name); });

/// A localizer along a winding drive, its place known to 20 m, with one fix 4 m off in the middle of a sample. The
/// motion since half a second before it, from which an alignment begins, is what a copy that gets no fix predicts.
TEST(GuessBetweenKeyframes, IsThePredictedMotionOverACorrection) {
  DrivenTruth truth(21, 0.7);
  const ImuNoise noise = fusion::tactical_noise();
  truth.gyro_per_sqrt_hz = noise.gyro.white_per_sqrt_hz;
  truth.accel_per_sqrt_hz = noise.accel.white_per_sqrt_hz;
  const Boundaries boundaries(DrivenTruth::start());
  PartClock clock;
  fusion::ErrorStateFilter filter(
      fusion::configured("initial_position_sigma_m = 20\ninitial_velocity_sigma_m_s = 0.01"), noise,
      DrivenTruth::frame(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  Localizer localizer(filter, DrivenTruth::start(), boundaries, clock);
  localizer.initialize(truth.X_WB(), truth.v_W());
  filter.initialize(DrivenTruth::start(), truth.X_WB(), truth.v_W());

  constexpr int kKeyframe = 250, kFix = 300, kNext = 350;
  std::optional<fusion::PredictedMotion> predicted;
  Pose truly_before, estimated_before;
  for (int k = 1; k <= kNext; ++k) {
    if (k == kFix) {
      // In the middle of the sample that comes; where the truth is then, and 4 m beside it.
      const GpsTime half = localizer.at() + 0.005;
      GnssFix fix = truth.fix({2.4, -3.2, 0.0}, 1.0);
      fix.t = half;
      fix.p_A_E += 0.005 * truth.state().v_EU_E;
      ASSERT_TRUE(localizer
                      .once_at(half,
                               [&localizer, fix]() -> Status {
                                 CANYON_TRY(const fusion::UpdateReport report, localizer.update(fix));
                                 EXPECT_TRUE(report.accepted);
                                 return Ok{};
                               })
                      .ok());
    }
    const ImuSample sample = truth.step();
    ASSERT_TRUE(localizer.take(sample, sample.t).ok());
    if (predicted) {
      predicted->predict(sample);
    } else {
      filter.predict(sample);
    }
    if (k == kKeyframe) {
      localizer.begin_motion();
      predicted.emplace(filter);
      truly_before = truth.X_WB();
      estimated_before = localizer.estimate().X_WB;
    }
  }
  const Pose true_motion = truly_before.inverse() * truth.X_WB(), guess = localizer.motion().X_TS,
             by_estimates = estimated_before.inverse() * localizer.estimate().X_WB;
  const RelativePose alone = predicted->motion();
  const double off_m = (guess.p - true_motion.p).norm(), off_by_estimates_m = (by_estimates.p - true_motion.p).norm();
  std::printf(
      "guess %.1f mm off the true motion of %.2f m, %.1f mm off the prediction without the fix; estimates %.2f m\n",
      1e3 * off_m, true_motion.p.norm(), 1e3 * (guess.p - alone.X_TS.p).norm(), off_by_estimates_m);
  EXPECT_GT(off_by_estimates_m, 3.5);
  // Five sigma of the prediction on each axis: false alarm 3e-6 for all six.
  const Vector6d error = (alone.X_TS.inverse() * true_motion).log(), left = (guess.inverse() * true_motion).log();
  for (int i = 0; i < 6; ++i) {
    const double sigma = std::sqrt(alone.covariance(i, i));
    EXPECT_LT(std::abs(error[i]), 5.0 * sigma) << i;
    // What the fix has told since of velocity and tilt is no more than was unknown of them.
    EXPECT_LT(std::abs(left[i]), 5.0 * sigma) << i;
  }
}

}  // namespace
}  // namespace canyon::mission::testing

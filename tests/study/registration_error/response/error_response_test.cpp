#include "canyon/study/registration_error/response/error_response.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/lidar/scanner.h"
#include "canyon/tests/study/registration_error/taped_start.h"

namespace canyon::study {
namespace {

using testing::taped_start;
using testing::TapedStart;

/// The street once for all of these tests.
const TapedStart& street() {
  static const TapedStart on = taped_start("low", 14.0);
  return on;
}

ErrorResponse respond(std::vector<std::string> errors, std::vector<double> sizes,
                      std::vector<std::string> methods = {"gicp", "none"}) {
  ErrorResponseOptions how{.fidelity = "low",
                           .methods = std::move(methods),
                           .errors = std::move(errors),
                           .sizes = std::move(sizes),
                           .seeds = 1,
                           .stretch_m = 20.0,
                           .show_progress = false};
  auto response = measure_error_response(street().config, street().mission, street().tape, how);
  EXPECT_TRUE(response.ok()) << (response.ok() ? "" : response.error().str());
  return *std::move(response);
}

const ResponseCurve& curve_of(const ErrorResponse& response, const std::string& method, const std::string& kind,
                              const std::string& axis) {
  for (const ResponseCurve& curve : response.curves)
    if (!curve.from_m && curve.method == method && curve.kind == kind && curve.axis == axis) return curve;
  ADD_FAILURE() << method << " " << kind << " " << axis;
  return response.curves.front();
}

/// The estimate is the true pose but for the error, so that what is laid is what the filter's keyframes are off by.
TEST(ErrorResponse, PriorErrorsAreWhatWasLaid) {
  const ErrorResponse response = respond({"jump_m", "attitude_deg"}, {2.0}, {"none"});
  EXPECT_EQ(response.curves.size(), 6 * (1 + response.places_from_m.size()));
  for (const char* axis : {"forward", "left", "up"})
    EXPECT_NEAR(curve_of(response, "none", "jump_m", axis).keyframe[0].prior_m, 2.0, 1e-9) << axis;
  // A turned vehicle moves its sensor by 2 |sin(a / 2)| times its distance from the axis.
  const Eigen::Vector3d p = lidar::sensor_in_body(street().config.lidar).p;
  const double turned_m = 2.0 * std::sin(0.5 * 2.0 * kDegree) * std::hypot(p.x(), p.y());
  EXPECT_NEAR(curve_of(response, "none", "attitude_deg", "up").keyframe[0].prior_m, turned_m, 1e-9);
}

/// Keyframes half a second apart of a vehicle that turns, climbs and leans; a place that begins with the third.
RecordedKeyframes winding_way() {
  RecordedKeyframes out;
  for (int k = 0; k < 6; ++k)
    out.keyframes.push_back({.t = GpsTime{1'000'000'000'000'000'000} + 0.5 * k,
                             .X_WB_true = {rotation_from({.yaw_rad = 0.3 * k, .pitch_rad = -0.1, .roll_rad = 0.05}),
                                           {100.0 + k, -20.0 + 0.1 * k * k, 3.0 + 0.1 * k}},
                             .distance_m = 1.0 * k,
                             .scan = {},
                             .pose_covariance = Matrix6d::Identity(),
                             .motion_covariance = Matrix6d::Identity()});
  return out;
}

/// After t seconds in the place the estimate is off by rate times t along the axis, level as the vehicle stood where
/// the place began, and turned by nothing; before it by nothing at all. The prediction drifts as far.
TEST(ErrorResponse, ARampIsItsRateTimesTheTimeSinceThePlaceBegan) {
  const RecordedKeyframes recorded = winding_way();
  const Stretch place{.first = 0, .begin = 2, .end = 6, .from_m = 0.0};
  const double rate_m_s = 0.3, yaw = 0.3 * 2;
  const Eigen::Vector3d axes_W[] = {{std::cos(yaw), std::sin(yaw), 0}, {-std::sin(yaw), std::cos(yaw), 0}, {0, 0, 1}};
  constexpr double kRounding = 1e-13;  // some eps of 100 m
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const EstimateError ramp{&model_row(estimate_errors(), "ramp_m_s"), axis, rate_m_s};
    Pose before;
    for (std::size_t k = 0; k < recorded.keyframes.size(); ++k) {
      const DisturbedKeyframe given = disturbed_keyframe(recorded, place, k, ramp, 1);
      const Pose& truth = recorded.keyframes[k].X_WB_true;
      const double t_s = k < place.begin ? 0.0 : 0.5 * static_cast<double>(k - place.begin);
      const Eigen::Vector3d off = given.estimate.X_WB.p - truth.p - rate_m_s * t_s * axes_W[axis];
      EXPECT_LT(off.norm(), kRounding) << axis_name(axis) << ' ' << k;
      EXPECT_EQ(given.estimate.X_WB.R.coeffs(), truth.R.coeffs()) << axis_name(axis) << ' ' << k;
      if (k > 0) {
        EXPECT_LT((before * given.motion.X_TS.p - given.estimate.X_WB.p).norm(), 10 * kRounding)
            << axis_name(axis) << ' ' << k;
      }
      before = given.estimate.X_WB;
    }
  }
}

/// From where the place begins each keyframe is off along the axis by a normal draw of its own, of the size in the
/// mean square, and by nothing across it; the prediction knows nothing of that.
TEST(ErrorResponse, NoiseIsWhiteAndOfItsSizeAlongItsAxis) {
  const RecordedKeyframes recorded = winding_way();
  const Stretch place{.first = 0, .begin = 2, .end = 6, .from_m = 0.0};
  const double sigma_m = 0.4, yaw = 0.3 * 2;
  const Eigen::Vector3d axes_W[] = {{std::cos(yaw), std::sin(yaw), 0}, {-std::sin(yaw), std::cos(yaw), 0}, {0, 0, 1}};
  constexpr double kRounding = 1e-13;  // some eps of 100 m
  constexpr std::uint64_t kSeeds = 1000;
  std::vector<double> along;  // by axis, seed and keyframe, in sigma
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
      for (std::size_t k = 0; k < recorded.keyframes.size(); ++k) {
        const EstimateError noise{&model_row(estimate_errors(), "noise_m"), axis, sigma_m};
        const DisturbedKeyframe given = disturbed_keyframe(recorded, place, k, noise, seed);
        const Pose& truth = recorded.keyframes[k].X_WB_true;
        const Eigen::Vector3d off = given.estimate.X_WB.p - truth.p;
        const double this_far = off.dot(axes_W[axis]);
        ASSERT_LT((off - this_far * axes_W[axis]).norm(), kRounding) << axis_name(axis) << ' ' << k;
        ASSERT_EQ(given.estimate.X_WB.R.coeffs(), truth.R.coeffs()) << axis_name(axis) << ' ' << k;
        const Pose from = recorded.keyframes[k > 0 ? k - 1 : 0].X_WB_true;
        ASSERT_LT((from * given.motion.X_TS.p - truth.p).norm(), 10 * kRounding) << axis_name(axis) << ' ' << k;
        if (k < place.begin) {
          ASSERT_EQ(off.norm(), 0.0) << axis_name(axis) << ' ' << k;
        } else {
          along.push_back(this_far / sigma_m);
        }
      }
  // 4.5 sigma of the means of so many independent draws, squares (variance 2) and products; 7e-6 each.
  const auto n = static_cast<double>(along.size());
  const auto mean_product = [&](std::size_t apart) {
    double sum = 0.0;
    for (std::size_t i = 0; i < along.size(); ++i) sum += along[i] * along[(i + apart) % along.size()];
    return sum / n;
  };
  double mean = 0.0;
  for (const double one : along) mean += one / n;
  EXPECT_NEAR(mean, 0.0, 4.5 / std::sqrt(n));
  EXPECT_NEAR(mean_product(0), 1.0, 4.5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(mean_product(1), 0.0, 4.5 / std::sqrt(n)) << "keyframe after keyframe";
  EXPECT_NEAR(mean_product(4), 0.0, 4.5 / std::sqrt(n)) << "seed after seed";
  EXPECT_NEAR(mean_product(4 * kSeeds), 0.0, 4.5 / std::sqrt(n)) << "axis after axis";
}

/// A vehicle at constant speed along a line, turning at a constant rate: where it is at any time is known in closed
/// form. Keyframes half a second apart from 0.2 s on.
Pose evenly_moving(double t_s) {
  return {rotation_from({.yaw_rad = 0.4 + 0.3 * t_s}), {100.0 + 5.0 * t_s, -20.0 + 2.0 * t_s, 3.0 - 0.1 * t_s}};
}
RecordedKeyframes even_way() {
  constexpr GpsTime kStart{1'000'000'000'000'000'000};
  RecordedKeyframes out = winding_way();
  for (int i = 0; i <= 6; ++i)
    out.motion.append(
        {.t = kStart + 0.5 * i, .X_WB = evenly_moving(0.5 * i), .v_WB_W = {5.0, 2.0, -0.1}, .w_WB_B = {0.0, 0.0, 0.3}});
  for (std::size_t k = 0; k < out.keyframes.size(); ++k) {
    const double t_s = 0.2 + 0.5 * static_cast<double>(k);
    out.keyframes[k].t = kStart + t_s;
    out.keyframes[k].X_WB_true = evenly_moving(t_s);
  }
  return out;
}

/// The estimate is the true pose of so long ago, before the place too, and before the start that of the start; the
/// prediction is the motion between two such poses.
TEST(ErrorResponse, ALatencyIsTheTruePoseOfSoLongAgo) {
  const RecordedKeyframes recorded = even_way();
  const Stretch place{.first = 0, .begin = 2, .end = 6, .from_m = 0.0};
  constexpr double kRounding = 1e-12;  // polynomials of positions of 100 m, over some pieces
  for (const double late_s : {0.15, 0.3}) {
    const EstimateError latency{&model_row(estimate_errors(), "latency_s"), 0, late_s};
    Pose before;
    for (std::size_t k = 0; k < recorded.keyframes.size(); ++k) {
      const DisturbedKeyframe given = disturbed_keyframe(recorded, place, k, latency, 1);
      const Pose then = evenly_moving(std::max(0.0, 0.2 + 0.5 * static_cast<double>(k) - late_s));
      EXPECT_LT((given.estimate.X_WB.p - then.p).norm(), kRounding) << late_s << ' ' << k;
      EXPECT_LT(so3_log(given.estimate.X_WB.R.conjugate() * then.R).norm(), kRounding) << late_s << ' ' << k;
      if (k > 0) {
        const Pose on = before * given.motion.X_TS;
        EXPECT_LT((on.p - then.p).norm(), 2 * kRounding) << late_s << ' ' << k;
        EXPECT_LT(so3_log(on.R.conjugate() * then.R).norm(), 2 * kRounding) << late_s << ' ' << k;
      }
      before = given.estimate.X_WB;
    }
  }
}

/// Who believes the prior heals nothing, whatever the error.
TEST(ErrorResponse, WithoutRegistrationNothingIsHealed) {
  const ErrorResponse response = respond({"latency_s"}, {0.1, 1.0}, {"none"});
  for (const ResponseCurve& curve : response.curves)
    for (const auto* points : {&curve.keyframe, &curve.map})
      for (const ResponsePoint& point : *points) EXPECT_EQ(point.healed.value, 0.0);
  EXPECT_EQ(curve_of(response, "none", "latency_s", "").keyframe_half.value, 0.0);
  EXPECT_EQ(response.undisturbed.front().keyframe_m, 0.0);
}

/// A jump of the estimate is no motion and no surface: what is left of it right behind it is what the filter's claim
/// makes the mapper take over. The map that begins with a bias has nothing to tell it from the truth.
TEST(ErrorResponse, AJumpIsHealedMoreThanABias) {
  const ErrorResponse response = respond({"bias_m", "jump_m"}, {1.0}, {"gicp"});
  const double bias = curve_of(response, "gicp", "bias_m", "left").keyframe[0].healed.value;
  const double jump = curve_of(response, "gicp", "jump_m", "left").keyframe[0].healed.value;
  EXPECT_GT(jump, bias);
  EXPECT_LE(jump, 1.0);
  EXPECT_GT(curve_of(response, "gicp", "jump_m", "left").map[0].registered_m, 0.0);
}

TEST(ErrorResponse, SameBitsForAnyNumberOfThreads) {
  std::vector<std::string> tables;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    tables.push_back(error_response_csv(respond({"noise_m"}, {0.5})));
  }
  set_threads(0);
  EXPECT_EQ(tables[1], tables[0]);
  EXPECT_EQ(tables[2], tables[0]);
}

TEST(ErrorResponse, WhatIsUnknownIsNamed) {
  const auto refused = [](ErrorResponseOptions how) {
    const Status status = check_response(how);
    return status.ok() ? std::string() : status.error().str();
  };
  EXPECT_NE(refused({.methods = {"gicpp"}}).find("--methods: unknown name \"gicpp\""), std::string::npos);
  EXPECT_NE(refused({.errors = {"jump"}}).find("--errors: unknown name \"jump\""), std::string::npos);
  ErrorResponseOptions far{
      .methods = {"none"}, .errors = {"jump_m"}, .sizes = {1.0}, .stretch_m = 1e5, .show_progress = false};
  mission::MissionConfig config = street().config;
  config.registration.submap_keyframes = 1000;
  const auto response = measure_error_response(config, street().mission, street().tape, far);
  ASSERT_FALSE(response.ok());
  EXPECT_EQ(response.error().exit_code, 2);
  EXPECT_NE(response.error().str().find("--stretch"), std::string::npos);
}

}  // namespace
}  // namespace canyon::study

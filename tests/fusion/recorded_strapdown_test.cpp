#include <cmath>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>

#include "core/units.h"
#include "fusion/strapdown.h"
#include "tests/fusion/recorded_run.h"
#include "tests/support/test_data.h"

/// An ideal IMU made by others on a real car's path, integrated freely. Synthetic twin:
/// tests/inertial/closure_test.cpp.
namespace canyon::fusion {
namespace {

/// Gravity as the recording was made with it (KF-GINS, earth.h: GRS80 series in latitude, free-air terms in height).
/// WGS84 normal gravity differs by 1.4e-6 m/s^2, which alone are 0.28 m after 599 s.
Eigen::Vector3d kf_gins_gravity_E(const Eigen::Vector3d& p_E) {
  const Geodetic at = geodetic_from_ecef(p_E);
  const double s2 = std::sin(at.lat_rad) * std::sin(at.lat_rad);
  const double s4 = s2 * s2;
  const double g0 = 9.7803267715 * (1 + 0.0052790414 * s2 + 0.0000232718 * s4 + 1.262e-7 * s2 * s4 + 7e-10 * s4 * s4);
  const double g = g0 + (-3.0876910891e-6 + 4.3977311e-9 * s2) * at.h_m + 0.7211e-12 * at.h_m * at.h_m;
  return -g * rotation_E_from_enu(at).col(2);
}

/// Position error, m, at those whole seconds.
std::map<int, double> free_run(const testing::RecordedRun& run, const char* model, GravityFunction gravity,
                               std::initializer_list<int> seconds) {
  auto strapdown = make_strapdown(model, gravity);
  NavState state = run.truth.front().state;
  std::map<int, double> errors;
  std::size_t next = 1;
  for (const ImuSample& s : run.imu) {
    strapdown->advance(state, {.dt_s = s.dt_s, .dtheta_U = s.dtheta_U, .dv_U = s.dv_U});
    state.t = s.t;
    while (next < run.truth.size() && run.truth[next].t < s.t) ++next;
    if (next == run.truth.size() || run.truth[next].t != s.t) continue;
    for (int second : seconds) {
      if (s.t == run.truth.front().t + static_cast<double>(second)) {
        errors[second] = (state.p_EU_E - run.truth[next].state.p_EU_E).norm();
      }
    }
  }
  return errors;
}

TEST(RecordedStrapdown, IdealImuStaysWithinThePublicFiltersFigures) {
  CANYON_REAL_DATA(imu, "inertial/sim_leador_a15/imu_ideal_100hz.f64");
  CANYON_REAL_DATA(gnss, "inertial/sim_leador_a15/gnss_1hz.csv");
  CANYON_REAL_DATA(truth, "inertial/sim_leador_a15/truth_10hz.csv");
  const testing::RecordedRun run = testing::read_sim_leador(imu, gnss, truth);
  const auto errors = free_run(run, "two_sample", kf_gins_gravity_E, {60, 120, 300, 599});
  const std::map<int, double> kf_gins_m = {{60, 0.29e-3}, {120, 1.2e-3}, {300, 2.5e-3}, {599, 8.2e-3}};
  for (const auto& [second, limit_m] : kf_gins_m) {
    ASSERT_TRUE(errors.count(second)) << second;
    std::printf("ideal IMU, free for %d s: %.3f mm (KF-GINS %.2f mm)\n", second, 1e3 * errors.at(second),
                1e3 * limit_m);
    EXPECT_LT(errors.at(second), limit_m) << second;
  }
  // Without sculling the same path is lost by metres.
  EXPECT_GT(free_run(run, "euler", kf_gins_gravity_E, {599}).at(599), 1.0);
}

}  // namespace
}  // namespace canyon::fusion

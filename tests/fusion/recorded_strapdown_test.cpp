#include <cmath>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/tests/fusion/recorded_run.h"
#include "canyon/tests/support/test_data.h"

/// An ideal IMU made by others on a real car's path, integrated freely. Synthetic twin:
/// tests/inertial/closure_test.cpp.
namespace canyon::fusion {
namespace {

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
  const auto errors = free_run(run, "two_sample", gravity_by_name("grs80_series"), {60, 120, 300, 599});
  const std::map<int, double> kf_gins_m = {{60, 0.29e-3}, {120, 1.2e-3}, {300, 2.5e-3}, {599, 8.2e-3}};
  for (const auto& [second, limit_m] : kf_gins_m) {
    ASSERT_TRUE(errors.count(second)) << second;
    std::printf("ideal IMU, free for %d s: %.3f mm (KF-GINS %.2f mm)\n", second, 1e3 * errors.at(second),
                1e3 * limit_m);
    EXPECT_LT(errors.at(second), limit_m) << second;
  }
  // Without sculling the same path is lost by metres.
  EXPECT_GT(free_run(run, "euler", gravity_by_name("grs80_series"), {599}).at(599), 1.0);
}

}  // namespace
}  // namespace canyon::fusion

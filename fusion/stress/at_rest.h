#pragma once

#include "canyon/core/check.h"
#include "canyon/core/config/config.h"
#include "canyon/core/config/text.h"
#include "canyon/core/units.h"
#include "canyon/fusion/dead_reckoning.h"
#include "canyon/fusion/error_state_filter.h"

/// A unit that rests on the Earth, and what it measures: the stage of most cases of this room.
namespace canyon::fusion {

/// The configuration with these keys of [fusion].
inline FilterConfig configured(const std::string& toml) {
  FilterConfig config;
  const auto node = ConfigNode::parse(toml, "stress");
  CANYON_CHECK(node && read_config(&*node, "fusion", config).ok(), toml);
  return config;
}

/// At that place, z along `force_U`'s answer to gravity.
inline NavState resting_at(double lat_deg, double lon_deg, double height_m,
                           const Eigen::Vector3d& force_U = {0.07, -0.03, 1.0}) {
  NavState s = levelled({lat_deg * kDegree, lon_deg * kDegree, height_m}, 77.0 * kDegree, force_U);
  s.t = GpsTime::from_week_sow(1590, 1000.0);
  return s;
}

/// What an ideal unit measures in that state, over dt_s.
inline Increments rest_increments(const NavState& s, double dt_s) {
  return {.dt_s = dt_s,
          .dtheta_U = dt_s * (s.R_EU.conjugate() * earth_rate_E()),
          .dv_U = -dt_s * (s.R_EU.conjugate() * gravity_E(s.p_EU_E))};
}

/// Sample k of it from the state's time on.
inline ImuSample rest_sample(const NavState& s, std::int64_t k, double rate_hz) {
  const Increments in = rest_increments(s, 1.0 / rate_hz);
  ImuSample out;
  out.t = tick(s.t, k + 1, rate_hz);
  out.dt_s = in.dt_s;
  out.dtheta_U = in.dtheta_U;
  out.dv_U = in.dv_U;
  return out;
}

/// A filter that rests at W's origin, and its samples and fixes.
struct RestingFilter {
  LocalFrame frame{Geodetic{45.0 * kDegree, 7.0 * kDegree, 200.0}};
  ErrorStateFilter filter;
  NavState truth;
  double rate_hz;
  std::int64_t k = 0;

  RestingFilter(const FilterConfig& config, const ImuNoise& noise, double rate)
      : filter(config, noise, frame, Eigen::Vector3d::Zero(), {0.3, -0.1, 1.2}), rate_hz(rate) {
    filter.initialize(GpsTime::from_week_sow(1590, 1000.0), Pose{}, Eigen::Vector3d::Zero());
    truth = filter.nav_state();
  }
  ImuSample next_sample() { return rest_sample(truth, k, rate_hz); }
  void predict() {
    filter.predict(next_sample());
    ++k;
  }
  /// At the antenna's true place.
  GnssFix fix(double sigma_m) const {
    GnssFix f;
    f.t = filter.nav_state().t;
    f.status = FixStatus::kSingle;
    f.p_A_E = truth.p_EU_E + truth.R_EU * Eigen::Vector3d(0.3, -0.1, 1.2);
    f.covariance_E = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
    return f;
  }
};

/// Figures of a tactical unit.
inline ImuNoise usual_noise() {
  ImuNoise n;
  n.gyro = {
      .white_per_sqrt_hz = 3e-5, .turn_on_bias_sigma = 1e-4, .in_run_bias_sigma = 2e-5, .in_run_bias_tau_s = 300.0};
  n.accel = {
      .white_per_sqrt_hz = 5e-4, .turn_on_bias_sigma = 2e-2, .in_run_bias_sigma = 3e-4, .in_run_bias_tau_s = 300.0};
  return n;
}

}  // namespace canyon::fusion

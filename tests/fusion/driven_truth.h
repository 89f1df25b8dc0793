#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/imu_noise.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/fusion/error_state_filter.h"

namespace canyon::testing {

/// A vehicle that is driven by what it is told to do, and the IMU that feels it: truth is what the strapdown integrator
/// makes of the exact increments, so that an error-free filter follows it to rounding. Axes of IMU and vehicle are the
/// same, and their origins too.
class DrivenTruth {
 public:
  /// Rates of turn (rad/s) and acceleration over ground (m/s^2) along U's axes at a time since the start, s.
  struct Motion {
    Eigen::Vector3d w_EU_U = Eigen::Vector3d::Zero(), a_U = Eigen::Vector3d::Zero();
  };
  /// Bends to both sides, and speed that comes and goes.
  static Motion winding(double t_s) {
    const double w = 0.25 * std::sin(0.21 * t_s), speed = 8.0 + 2.0 * std::sin(0.13 * t_s);
    return {{0.0, 0.0, w}, {0.26 * std::cos(0.13 * t_s), w * speed, 0.0}};
  }

  DrivenTruth(std::uint64_t seed, double heading_rad, double rate_hz = 100.0,
              std::function<Motion(double)> motion = winding)
      : motion_(std::move(motion)),
        dt_s_(1.0 / rate_hz),
        gyro_(seed, "test.gyro"),
        accel_(seed, "test.accel"),
        strapdown_(fusion::make_strapdown("two_sample")) {
    const Pose X_WB{rotation_from({.yaw_rad = yaw_from_heading(heading_rad), .pitch_rad = 0.0, .roll_rad = 0.0}),
                    Eigen::Vector3d::Zero()};
    state_.t = start();
    state_.R_EU = Eigen::Quaterniond(frame().R_EW()) * X_WB.R;
    state_.p_EU_E = frame().to_E(X_WB.p);
    state_.v_EU_E = state_.R_EU * Eigen::Vector3d(8.0, 0.0, 0.0);
  }

  static GpsTime start() { return GpsTime::from_week_sow(1590, 396000.0); }
  static LocalFrame frame() { return LocalFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0}); }

  /// Biases of the unit: gyroscopes, rad/s, then accelerometers, m/s^2; constant.
  Vector6d bias = Vector6d::Zero();
  /// Its white noise.
  double gyro_per_sqrt_hz = 0.0, accel_per_sqrt_hz = 0.0;

  /// Begins at rest; before the first step.
  void stand() { state_.v_EU_E.setZero(); }

  const fusion::NavState& state() const { return state_; }
  double elapsed_s() const { return state_.t - start(); }
  Pose X_WB() const {
    return {Eigen::Quaterniond(frame().R_EW().transpose().eval()) * state_.R_EU, frame().to_W(state_.p_EU_E)};
  }
  Eigen::Vector3d v_W() const { return frame().R_EW().transpose() * state_.v_EU_E; }

  /// Drives one interval on; what the IMU says of it.
  ImuSample step() {
    const Motion m = motion_(elapsed_s());
    const Eigen::Matrix3d R_UE = state_.R_EU.toRotationMatrix().transpose();
    const Eigen::Vector3d w_U = m.w_EU_U + R_UE * earth_rate_E();
    const Eigen::Vector3d f_U = m.a_U + R_UE * (2.0 * earth_rate_E().cross(state_.v_EU_E) - gravity_E(state_.p_EU_E));
    ImuSample out;
    out.t = state_.t;
    out.t.ns += static_cast<std::int64_t>(std::llround(1e9 * dt_s_));
    out.dt_s = out.t - state_.t;
    strapdown_->advance(state_, {.dt_s = out.dt_s, .dtheta_U = w_U * out.dt_s, .dv_U = f_U * out.dt_s});
    state_.t = out.t;
    const double root = std::sqrt(out.dt_s);
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::uint32_t>(i);
      out.dtheta_U[i] = (w_U[i] + bias[i]) * out.dt_s + gyro_per_sqrt_hz * root * gyro_.normal(axis, k_);
      out.dv_U[i] = (f_U[i] + bias[3 + i]) * out.dt_s + accel_per_sqrt_hz * root * accel_.normal(axis, k_);
    }
    ++k_;
    return out;
  }

  /// A fix of the antenna at `lever_U`, with an error in W.
  GnssFix fix(const Eigen::Vector3d& error_W, double sigma_m, const Eigen::Vector3d& lever_U = {0, 0, 0}) const {
    GnssFix out;
    out.t = state_.t;
    out.status = FixStatus::kSingle;
    out.p_A_E = state_.p_EU_E + state_.R_EU * lever_U + frame().R_EW() * error_W;
    out.covariance_E = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
    return out;
  }

 private:
  std::function<Motion(double)> motion_;
  double dt_s_;
  RandomStream gyro_, accel_;
  std::uint64_t k_ = 0;
  fusion::NavState state_;
  std::unique_ptr<fusion::Strapdown> strapdown_;
};

}  // namespace canyon::testing

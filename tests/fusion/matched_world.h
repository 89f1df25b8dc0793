#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/driven_truth.h"

namespace canyon::testing {

using Eigen::Vector3d;
using fusion::ErrorStateFilter;
using fusion::NavState;

inline std::string matched_keys() {
  return R"(
states = ["turn_on_biases", "gains", "mounting", "antenna_lever", "time_offset", "wheel_scale", "fix_error",
          "barometer_bias", "hard_iron"]
measurements = ["position", "velocity", "odometer", "heading", "barometer", "magnetometer"]
acceptance = "accept_all"
initial_attitude_sigma_deg_roll_pitch = 0.2
initial_attitude_sigma_deg_heading = 0.5
initial_position_sigma_m = 1.0
initial_velocity_sigma_m_s = 0.2
mounting_sigma_deg = 0.3
mounting_walk_deg_per_sqrt_hr = 0.0
antenna_lever_sigma_m = 0.1
time_offset_sigma_s = 0.01
wheel_scale_sigma_percent = 1.0
fix_error_sigma_m = 2.0
fix_error_scale = 0.0
fix_error_tau_s = 10.0
barometer_bias_sigma_m = 5.0
barometer_bias_tau_s = 500.0
barometer_sigma_m = 0.3
hard_iron_sigma_ut = 3.0
magnetometer_sigma_ut = 0.5
odometer_wheel_m = [0.0, 0.8, 0.0]
odometer_tick_m = 1e-6
odometer_slip_percent = 0.5
heading_sigma_floor_deg = 1e-6
fix_velocity_floor_m_s = 1e-3
)";
}

inline ImuNoise matched_unit() {
  ImuNoise n;
  n.gyro = {.white_per_sqrt_hz = 5e-5, .turn_on_bias_sigma = 5e-5, .scale_sigma = 3e-4, .misalignment_sigma_rad = 3e-4};
  n.accel = {
      .white_per_sqrt_hz = 1e-3, .turn_on_bias_sigma = 5e-3, .scale_sigma = 3e-4, .misalignment_sigma_rad = 3e-4};
  return n;
}

/// The errors of one world, as a filter's blocks have them: what matched_keys() and matched_unit() say.
class MatchedWorld {
 public:
  explicit MatchedWorld(std::uint64_t seed)
      : stream_(seed, "test.matched"), truth_(seed, 0.3 + 0.05 * static_cast<double>(seed)) {
    const ImuNoise n = matched_unit();
    truth_.gyro_per_sqrt_hz = n.gyro.white_per_sqrt_hz;
    truth_.accel_per_sqrt_hz = n.accel.white_per_sqrt_hz;
    for (int i = 0; i < 3; ++i) {
      gyro_bias_[i] = n.gyro.turn_on_bias_sigma * draw();
      accel_bias_[i] = n.accel.turn_on_bias_sigma * draw();
      mounting_[i] = 0.3 * kDegree * draw();
      lever_[i] = 0.1 * draw();
      fix_error_[i] = 2.0 * draw();
      hard_iron_[i] = 3.0 * draw();
      for (int j = 0; j < 3; ++j) {
        gyro_gain_(i, j) = n.gyro.scale_sigma * draw();
        accel_gain_(i, j) = n.accel.scale_sigma * draw();
      }
    }
    offset_s_ = 0.01 * draw();
    wheel_scale_ = 0.01 * draw();
    barometer_m_ = 5.0 * draw();
    R_UB_ = so3_exp(mounting_).toRotationMatrix();
  }

  /// The filter, of matched_keys() and matched_unit() or of what is wrong in them.
  ErrorStateFilter filter(const std::string& keys = matched_keys(), const ImuNoise& unit = matched_unit()) {
    ErrorStateFilter out(fusion::configured(keys), unit, DrivenTruth::frame(), Vector3d::Zero(), lever());
    const Vector3d turned(0.2 * kDegree * draw(), 0.2 * kDegree * draw(), 0.5 * kDegree * draw());  // in W
    Pose X = truth_.X_WB();
    X.R = so3_exp(turned) * X.R;
    X.p += vector(1.0);
    out.initialize(truth_.state().t, X, truth_.v_W() + vector(0.2));
    return out;
  }

  /// Is told of every measurement that the filter has taken.
  std::function<void(const fusion::UpdateReport&)> told;

  /// One IMU sample, and what comes with it.
  void step(ErrorStateFilter& filter) {
    ImuSample s = truth_.step();  // in the vehicle's axes
    const Vector3d dtheta = R_UB_ * s.dtheta_U, dv = R_UB_ * s.dv_U;
    s.dtheta_U = dtheta + gyro_gain_ * dtheta + gyro_bias_ * s.dt_s;
    s.dv_U = dv + accel_gain_ * dv + accel_bias_ * s.dt_s;
    filter.predict(s);
    ++k_;
    const Vector3d v_B = truth_.state().R_EU.conjugate() * truth_.state().v_EU_E;
    wheel_sum_ += (v_B + rate_B().cross(wheel())).x();
    if (k_ % 20 == 0) odometer(filter);
    if (k_ % 50 == 0) receiver(filter);
    if (k_ % 30 == 0) rest(filter);
    if (told)
      for (const fusion::UpdateReport& report : filter.reports()) told(report);
  }

  const DrivenTruth& truth() const { return truth_; }

  /// Errors, truth minus estimate, by name.
  std::map<std::string, Eigen::VectorXd> errors(const ErrorStateFilter& filter) const {
    const NavState& n = filter.nav_state();
    const NavState& t = truth_.state();
    std::map<std::string, Eigen::VectorXd> out;
    const Eigen::Quaterniond R_EU = t.R_EU * Eigen::Quaterniond(R_UB_).conjugate();
    out["theta"] = so3_log(n.R_EU.conjugate() * R_EU);
    out["p"] = t.p_EU_E - n.p_EU_E;
    out["v"] = t.v_EU_E - n.v_EU_E;
    const auto block = [&](const char* name, const Eigen::VectorXd& value) {
      Eigen::VectorXd estimate(value.size());
      for (Eigen::Index i = 0; i < value.size(); ++i)
        estimate[i] = filter.value(filter.offset(name) + static_cast<int>(i));
      out[name] = value - estimate;
    };
    block("turn_on_biases", (Vector6d() << gyro_bias_, accel_bias_).finished());
    Eigen::VectorXd gains(18);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        gains[3 * i + j] = gyro_gain_(i, j);
        gains[9 + 3 * i + j] = accel_gain_(i, j);
      }
    block("gains", gains);
    block("mounting", mounting_);
    block("antenna_lever", lever_);
    block("time_offset", Eigen::VectorXd::Constant(1, offset_s_));
    block("wheel_scale", Eigen::VectorXd::Constant(1, wheel_scale_));
    block("fix_error", fix_error_);
    block("barometer_bias", Eigen::VectorXd::Constant(1, barometer_m_));
    block("hard_iron", hard_iron_);
    return out;
  }

 private:
  static Vector3d lever() { return {-0.4, 0.3, 1.5}; }
  static Vector3d wheel() { return {0.0, 0.8, 0.0}; }
  double draw() { return stream_.normal(0, n_++); }
  Vector3d vector(double sigma) { return sigma * Vector3d(draw(), draw(), draw()); }
  Vector3d rate_B() const { return DrivenTruth::winding(truth_.elapsed_s() - 0.01).w_EU_U; }

  void odometer(ErrorStateFilter& filter) {
    const double mean = (1.0 + wheel_scale_) * wheel_sum_ / 20.0;
    wheel_sum_ = 0.0;
    OdometerSample s{.t = truth_.state().t, .dt_s = 0.2, .speed_m_s = mean};
    s.speed_m_s += 0.005 * mean * draw();
    filter.update(fusion::AidingMessage(s));
  }

  void receiver(ErrorStateFilter& filter) {
    const double kept = std::exp(-0.5 / 10.0);
    fix_error_ = kept * fix_error_ + vector(2.0 * std::sqrt(1.0 - kept * kept));
    const NavState& t = truth_.state();
    const Eigen::Matrix3d R = t.R_EU.toRotationMatrix();
    const Vector3d lever_B = lever() + lever_, v_B = R.transpose() * t.v_EU_E + rate_B().cross(lever_B),
                   a = R * DrivenTruth::winding(truth_.elapsed_s()).a_U;
    GnssFix fix;
    fix.t = t.t;
    fix.status = FixStatus::kSingle;
    fix.p_A_E = t.p_EU_E + R * lever_B + offset_s_ * (R * v_B) + fix_error_ + vector(0.3);
    fix.covariance_E = 0.09 * Eigen::Matrix3d::Identity();
    fix.v_A_E = R * v_B + offset_s_ * a + vector(0.1);
    fix.velocity_covariance_E = 0.01 * Eigen::Matrix3d::Identity();
    const fusion::UpdateReport report = filter.update(fix);
    if (told) told(report);
  }

  void rest(ErrorStateFilter& filter) {
    const double kept = std::exp(-0.3 / 500.0);
    barometer_m_ = kept * barometer_m_ + 5.0 * std::sqrt(1.0 - kept * kept) * draw();
    const NavState& t = truth_.state();
    const Vector3d x_W = truth_.X_WB().R * Vector3d::UnitX();
    filter.update(fusion::AidingMessage(HeadingSample{
        .t = t.t, .heading_rad = std::atan2(x_W.x(), x_W.y()) + 0.5 * kDegree * draw(), .sigma_rad = 0.5 * kDegree}));
    const double h_m = geodetic_from_ecef(t.p_EU_E).h_m + barometer_m_ + 0.3 * draw();
    filter.update(fusion::AidingMessage(BarometerSample{.t = t.t, .pressure_pa = standard_pressure_pa(h_m)}));
    const Vector3d field_W = 50.0 * Vector3d(0.0, std::cos(60.0 * kDegree), -std::sin(60.0 * kDegree));
    const Vector3d field_U = R_UB_ * (truth_.X_WB().R.conjugate() * field_W) + hard_iron_ + vector(0.5);
    filter.update(fusion::AidingMessage(MagnetometerSample{.t = t.t, .field_U_t = 1e-6 * field_U}));
  }

  RandomStream stream_;
  std::uint64_t n_ = 0;
  DrivenTruth truth_;
  Vector3d gyro_bias_, accel_bias_, mounting_, lever_, fix_error_, hard_iron_;
  Eigen::Matrix3d gyro_gain_, accel_gain_, R_UB_;
  double offset_s_, wheel_scale_, barometer_m_, wheel_sum_ = 0.0;
  int k_ = 0;
};

}  // namespace canyon::testing

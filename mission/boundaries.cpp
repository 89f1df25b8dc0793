#include "canyon/mission/boundaries.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>

#include "canyon/core/config/text.h"
#include "canyon/core/process/parallel.h"

namespace canyon::mission {

namespace {

// Largest magnitudes, far beyond what the parts give when they work.
constexpr double kAnyFinite = std::numeric_limits<double>::max();
constexpr double kTruePlace_m = 1e5;     // the range of every key that is a place in W
constexpr double kTrueSpeed_m_s = 1e3;   // the vehicle's limit is 30 m/s
constexpr double kTrueForce_m_s2 = 1e5;  // 10 000 g: no body stays whole
constexpr double kTrueRate_rad_s = 1e3;  // gyroscopes of vehicles end at 35 rad/s
constexpr double kBelieved_m = 1e12;     // an unaided filter that starts upside down drifts g t^2: 1e11 m in a day
constexpr double kBelieved_m_s = 1e9;
constexpr double kLongestSample_s = 1e3;
constexpr double kReturn_m = 1e5;  // ten times the largest range that a LIDAR can be given

/// The values of one message; what is refused first is told.
class Gate {
 public:
  Gate(const char* producer, double t_s) : producer_(producer), t_s_(t_s) {}

  /// `what` names the values in the message.
  template <class Derived>
  Gate& pass(const char* what, const Eigen::MatrixBase<Derived>& values, double limit = kAnyFinite) {
    using Scalar = typename Derived::Scalar;
    const auto most = static_cast<Scalar>(std::min(limit, static_cast<double>(std::numeric_limits<Scalar>::max())));
    if ((values.array().abs() <= most).all()) return *this;  // not so for NaN
    for (const auto value : values.reshaped())
      if (!(std::abs(value) <= most)) return pass(what, static_cast<double>(value), limit);
    return *this;
  }
  Gate& pass(const char* what, double value, double limit = kAnyFinite) {
    if (std::abs(value) <= limit || !refused_.empty()) return *this;
    refused_ =
        std::string(producer_) + " gave " + what + " of " + number_text(value) + " at " + number_text(t_s_) + " s";
    return *this;
  }
  Gate& pass(const char* what, const Pose& pose, double limit) {
    return pass(what, pose.p, limit).pass("an attitude", pose.R.coeffs(), 2.0);
  }

  /// NaN means "not measured" and passes.
  Gate& pass_measured(const char* what, double value, double limit = kAnyFinite) {
    return std::isnan(value) ? *this : pass(what, value, limit);
  }
  Gate& pass_all(const char* what, std::initializer_list<double> values) {
    for (const double value : values) pass(what, value);
    return *this;
  }

  Status status() const {
    if (refused_.empty()) return Ok{};
    return Error{.what = "the computation could not finish: " + refused_, .exit_code = 1};
  }

 private:
  const char* producer_;
  double t_s_;
  std::string refused_;
};

}  // namespace

Status Boundaries::check(const KinematicState& motion) const {
  return Gate("the vehicle", motion.t - start_)
      .pass("a position", motion.X_WB, kTruePlace_m)
      .pass("a velocity", motion.v_WB_W, kTrueSpeed_m_s)
      .pass("an acceleration", motion.a_WB_W, kTrueForce_m_s2)
      .pass("a rotation rate", motion.w_WB_B, kTrueRate_rad_s)
      .pass("an angular acceleration", motion.alpha_WB_B)
      .status();
}

Status Boundaries::check(const ImuSample& sample) const {
  return Gate("the IMU", sample.t - start_)
      .pass("an interval", sample.dt_s, kLongestSample_s)
      .pass("a turn", sample.dtheta_U, kTrueRate_rad_s * sample.dt_s)
      .pass("a velocity increment", sample.dv_U, kTrueForce_m_s2 * sample.dt_s)
      .status();
}

Status Boundaries::check(const OdometerSample& sample) const {
  return Gate("the odometer", sample.t - start_)
      .pass("an interval", sample.dt_s, kLongestSample_s)
      .pass("a speed", sample.speed_m_s, kBelieved_m_s)
      .status();
}

Status Boundaries::check(const BarometerSample& sample) const {
  return Gate("the barometer", sample.t - start_).pass("a pressure", sample.pressure_pa).status();
}

Status Boundaries::check(const MagnetometerSample& sample) const {
  return Gate("the magnetometer", sample.t - start_).pass("a field", sample.field_U_t).status();
}

namespace {

void check_fix(Gate& gate, const GnssFix& fix) {
  if (fix.status == FixStatus::kNone) return;
  gate.pass("a position", fix.p_A_E, kBelieved_m).pass("a covariance", fix.covariance_E);
  if (!fix.v_A_E.array().isNaN().all()) gate.pass("a velocity", fix.v_A_E, kBelieved_m_s);
  if (!fix.velocity_covariance_E.array().isNaN().all()) gate.pass("a velocity's covariance", fix.velocity_covariance_E);
  gate.pass_measured("a clock", fix.clock_m);
  // A DOP may be of any size, and is infinite where the geometry determines nothing.
}

void check_observation(Gate& gate, const GnssObservation& o) {
  gate.pass("a pseudorange", o.pseudorange_m, kBelieved_m);
  gate.pass_measured("a Doppler shift", o.doppler_hz).pass_measured("a carrier phase", o.carrier_phase_cycles);
  gate.pass_measured("a C/N0", o.cn0_dbhz).pass_measured("a sigma", o.sigma_m);
  gate.pass_all("a correction", {o.clock_m, o.correction_m});
  for (const Eigen::Vector3d* satellite : {&o.p_E, &o.v_E})
    if (!satellite->array().isNaN().all()) gate.pass("a satellite's place", *satellite, kBelieved_m);
  const GnssSecondSignal& second = o.second;
  for (const double value : {second.pseudorange_m, second.doppler_hz, second.carrier_phase_cycles, second.cn0_dbhz})
    gate.pass_measured("a second signal", value);
}

void check_truth(Gate& gate, const GnssTruth& truth) {
  gate.pass("a true position", truth.p_A_E, kBelieved_m).pass("a true velocity", truth.v_A_E, kBelieved_m_s);
  gate.pass_all("a true clock", {truth.receiver_clock_m, truth.receiver_clock_rate_m_s});
  for (const GnssObservationTruth& t : truth.satellites) {
    gate.pass("a true range", t.range_m, kBelieved_m).pass("a true range rate", t.range_rate_m_s);
    gate.pass_all("a true direction", {t.elevation_rad, t.azimuth_rad});
    // NaN: left out, by a plan.
    for (const double error : {t.multipath_m, t.ionosphere_m, t.troposphere_m, t.ephemeris_m, t.noise_m, t.base_m,
                               t.phase_centre_m, t.ionosphere_delay_m, t.troposphere_delay_m, t.carrier_multipath_m,
                               t.range_rate_multipath_m_s, t.ambiguity_cycles})
      gate.pass_measured("a true error", error);
  }
}

}  // namespace

Status Boundaries::check(const gnss::GnssOutput& output) const {
  Gate gate("the GNSS receiver", output.fix.t - start_);
  check_fix(gate, output.fix);
  for (const GnssObservation& observation : output.epoch.observations)
    if (observation.used) check_observation(gate, observation);
  check_truth(gate, output.truth);
  return gate.status();
}

namespace {

/// Tens of thousands of returns, looked at together.
bool all_pass(const lidar::LidarOutput& output) {
  constexpr float kAnyReturn_m = static_cast<float>(kReturn_m), kAny = std::numeric_limits<float>::max();
  constexpr std::size_t kChunk = 8192;
  std::atomic<int> wrong = 0;
  parallel_for(output.scan.points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    int bad = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const LidarPoint& p = output.scan.points[k];
      for (const auto& [value, most] : {std::pair{p.x, kAnyReturn_m},
                                        {p.y, kAnyReturn_m},
                                        {p.z, kAnyReturn_m},
                                        {p.intensity, kAny},
                                        {p.time_s, kAny}})
        bad |= static_cast<int>(!(std::abs(value) <= most));  // NaN is wrong
    }
    wrong |= bad;
  });
  parallel_for(output.truth.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    int bad = 0;
    for (std::size_t k = begin; k < end; ++k)
      for (const float value : {output.truth[k].range_m, output.truth[k].cos_incidence})
        bad |= static_cast<int>(!(std::abs(value) <= kAny));
    wrong |= bad;
  });
  return wrong == 0;
}

}  // namespace

Status Boundaries::check(const lidar::LidarOutput& output) const {
  Gate gate("the LIDAR", output.scan.t - start_);
  gate.pass("a period", output.scan.period_s, kLongestSample_s);
  if (all_pass(output)) return gate.status();
  for (const LidarPoint& point : output.scan.points)
    gate.pass("a return", Eigen::Vector3f(point.x, point.y, point.z), kReturn_m)
        .pass("an intensity or a time", Eigen::Vector2f(point.intensity, point.time_s));
  for (const LidarPointTruth& truth : output.truth)
    gate.pass("a true range or incidence", Eigen::Vector2f(truth.range_m, truth.cos_incidence));
  return gate.status();
}

Status Boundaries::check(const NavEstimate& estimate) const {
  return Gate("the filter", estimate.t - start_)
      .pass("a position", estimate.X_WB, kBelieved_m)
      .pass("a velocity", estimate.v_WB_W, kBelieved_m_s)
      .pass("a bias", estimate.gyro_bias_U)
      .pass("a bias", estimate.accel_bias_U)
      .pass("a covariance", estimate.pose_covariance)
      .pass("a covariance", estimate.velocity_covariance_W)
      .status();
}

Status Boundaries::check(const Keyframe& keyframe) const {
  return Gate("the registration", keyframe.t - start_)
      .pass("a position", keyframe.X_WL_registered, kBelieved_m)
      .pass("a prior position", keyframe.X_WL_prior, kBelieved_m)
      .pass_measured("a residual", keyframe.rms_m)
      .status();
}

Status Boundaries::check(const NavRow& row) const {
  return Gate("the recorder", row.t - start_)
      .pass("a true position", row.X_WB_true, kTruePlace_m)
      .pass("a true speed", row.true_speed_m_s)
      .pass("a position", row.estimate.X_WB, kBelieved_m)
      .pass("a command", Eigen::Vector2d(row.command.speed_m_s, row.command.curvature_1_m))
      .status();
}

Status Boundaries::check(const GnssRow& row) const {
  return Gate("the recorder", row.fix.t - start_).pass("a true position", row.p_A_W_true, 2.0 * kTruePlace_m).status();
}

Status Boundaries::check(const KeyframeRow& row) const {
  return Gate("the recorder", row.t - start_)
      .pass("a true position", row.X_WL_true, 2.0 * kTruePlace_m)
      .pass("a position", row.X_WL_registered, kBelieved_m)
      .pass("a prior position", row.X_WL_prior, kBelieved_m)
      .pass_measured("a residual", row.rms_m)
      .status();
}

Status Boundaries::check(const lidar::MapCloud& map, double t_s) const {
  Gate gate("the recorder", t_s);
  for (std::size_t i = 0; i < map.size(); ++i)
    gate.pass("a map point", map[i].p_W).pass("an intensity", static_cast<double>(map[i].intensity));
  return gate.status();
}

Status Boundaries::check_end(double duration_s, double distance_m) const {
  return Gate("the recorder", duration_s).pass("a duration", duration_s).pass("a distance", distance_m).status();
}

bool is_finite(const DriveCommand& command) {
  return std::isfinite(command.speed_m_s) && std::isfinite(command.curvature_1_m);
}

}  // namespace canyon::mission

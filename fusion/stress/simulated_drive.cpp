#include "canyon/fusion/stress/simulated_drive.h"

#include <cmath>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/fusion/stress/at_rest.h"

namespace canyon::fusion {
namespace {

ImuNoise drive_noise(double scale) {
  ImuNoise n;
  n.gyro = {.white_per_sqrt_hz = 1e-4, .in_run_bias_sigma = 2e-4, .in_run_bias_tau_s = 100.0, .scale_sigma = 2e-3};
  n.accel = {.white_per_sqrt_hz = 2e-3, .in_run_bias_sigma = 2e-2, .in_run_bias_tau_s = 100.0, .scale_sigma = 2e-3};
  for (TriadNoise* triad : {&n.gyro, &n.accel}) {
    triad->white_per_sqrt_hz *= scale;
    triad->in_run_bias_sigma *= scale;
    triad->scale_sigma *= scale;
  }
  return n;
}

/// True increments of a body that winds its way, from where it is.
Increments true_increments(const NavState& s, double t, double dt) {
  const Eigen::Vector3d turn(0.05 * std::sin(0.7 * t), 0.04 * std::cos(0.9 * t), 0.25 * std::sin(0.3 * t));
  const Eigen::Vector3d push(1.5 * std::cos(0.4 * t), 0.8 * std::sin(0.5 * t), 0.3 * std::cos(1.1 * t));
  Increments in = rest_increments(s, dt);
  in.dtheta_U += dt * turn;
  in.dv_U += dt * push;
  return in;
}

/// Errors of one triad over the samples.
class TriadErrors {
 public:
  TriadErrors(const TriadNoise& noise, std::uint64_t seed, const char* name) : noise_(noise), stream_(seed, name) {
    bias_ = noise.in_run_bias_sigma * stream_.normal3(0, 1);
    scale_ = noise.scale_sigma * stream_.normal3(0, 2);
  }
  Eigen::Vector3d measured(const Eigen::Vector3d& increments, double dt, std::uint64_t k) {
    const double decay = std::exp(-dt / noise_.in_run_bias_tau_s);
    const Eigen::Vector3d before = bias_;
    bias_ = decay * bias_ + noise_.in_run_bias_sigma * std::sqrt(1.0 - decay * decay) * stream_.normal3(k + 1, 3);
    return increments + scale_.cwiseProduct(increments) + 0.5 * dt * (before + bias_) +
           noise_.white_per_sqrt_hz * std::sqrt(dt) * stream_.normal3(k + 1, 4);
  }

 private:
  TriadNoise noise_;
  RandomStream stream_;
  Eigen::Vector3d bias_, scale_;
};

void disturb_start(Drive& d, const NavState& truth, std::uint64_t seed) {
  const RandomStream stream(seed, "drive.start");
  const FilterConfig& c = d.config;
  const double tilt = c.initial_attitude_sigma_deg_roll_pitch * kDegree,
               heading = c.initial_attitude_sigma_deg_heading * kDegree;
  const Eigen::Vector3d turn_W = Eigen::Vector3d(tilt, tilt, heading).cwiseProduct(stream.normal3(0));
  const Eigen::Quaterniond R_WB = Eigen::Quaterniond(d.frame.R_EW().transpose().eval()) * truth.R_EU;
  d.X_WB.p = d.frame.to_W(truth.p_EU_E) - R_WB * d.lever_U_B + c.initial_position_sigma_m * stream.normal3(1);
  d.X_WB.R = (so3_exp(turn_W) * R_WB).normalized();
  d.v_WB_W = d.frame.R_EW().transpose() * truth.v_EU_E + c.initial_velocity_sigma_m_s * stream.normal3(2);
}

}  // namespace

SmootherInput Drive::input() const {
  return {.config = config,
          .noise = noise,
          .frame = frame,
          .lever_U_B = lever_U_B,
          .lever_A_B = lever_A_B,
          .start = start,
          .X_WB = X_WB,
          .v_WB_W = v_WB_W,
          .imu = imu,
          .fixes = fixes,
          .odometer = {}};
}

Drive simulated_drive(std::uint64_t seed, const DriveSetup& setup) {
  Drive d;
  d.config = configured(setup.keys);
  d.config.initial_attitude_sigma_deg_roll_pitch *= setup.noise_scale;
  d.config.initial_attitude_sigma_deg_heading *= setup.noise_scale;
  d.config.initial_position_sigma_m *= setup.noise_scale;
  d.config.initial_velocity_sigma_m_s *= setup.noise_scale;
  d.noise = drive_noise(setup.noise_scale);
  const double fix_sigma_m = setup.noise_scale * setup.fix_sigma_m;
  d.frame = LocalFrame(Geodetic{45.0 * kDegree, 7.0 * kDegree, 200.0});
  d.lever_U_B = {0.0, 0.0, 0.4};
  d.lever_A_B = {-0.3, 0.1, 1.2};
  NavState truth = resting_at(45.0, 7.0, 200.0);
  d.start = truth.t;
  disturb_start(d, truth, seed);
  d.truth.push_back(truth);

  TriadErrors gyro(d.noise.gyro, seed, "drive.gyro"), accel(d.noise.accel, seed, "drive.accel");
  const RandomStream fix_error(seed, "drive.fix");
  const auto strapdown = make_strapdown(d.config.integrator);
  const double dt = 1.0 / setup.rate_hz;
  const auto per_fix = static_cast<std::uint64_t>(std::lround(setup.rate_hz));
  for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(std::lround(setup.seconds * setup.rate_hz)); ++k) {
    const Increments in = true_increments(truth, static_cast<double>(k) * dt, dt);
    ImuSample& sample = d.imu.emplace_back();
    sample.t = tick(d.start, static_cast<std::int64_t>(k) + 1, setup.rate_hz);
    sample.dt_s = dt;
    sample.dtheta_U = gyro.measured(in.dtheta_U, dt, k);
    sample.dv_U = accel.measured(in.dv_U, dt, k);
    strapdown->advance(truth, in);
    truth.t = sample.t;
    d.truth.push_back(truth);
    if ((k + 1) % per_fix != 0) continue;
    const double t = truth.t - d.start;
    if (t > setup.outage_from_s && t < setup.outage_to_s) continue;
    GnssFix& fix = d.fixes.emplace_back();
    fix.t = truth.t;
    fix.status = FixStatus::kDifferential;
    fix.p_A_E = truth.p_EU_E + truth.R_EU * (d.lever_A_B - d.lever_U_B) + fix_sigma_m * fix_error.normal3(k);
    d.outlier.push_back(fix_error.uniform(4, k) < setup.outlier_share);
    if (d.outlier.back()) fix.p_A_E += setup.outlier_m * fix_error.direction(5, k);
    fix.covariance_E = fix_sigma_m * fix_sigma_m * Eigen::Matrix3d::Identity();
  }
  return d;
}

Eigen::Matrix<double, 9, 1> error_of(const NavState& truth, const NavState& estimate) {
  Eigen::Matrix<double, 9, 1> e;
  e << so3_log(estimate.R_EU.conjugate() * truth.R_EU), truth.p_EU_E - estimate.p_EU_E, truth.v_EU_E - estimate.v_EU_E;
  return e;
}

Smoothed smoothed_by(const char* smoother, const Drive& drive, const std::string& keys) {
  const auto& row = model_row(smoothers(), smoother);
  ModelParameters own;
  row.parameters(own);
  const auto node = ConfigNode::parse(keys, "keys");
  CANYON_CHECK(node.ok() && read_fields(&*node, "fusion", [&own](FieldVisitor& f) { own.visit_all(f); }).ok(), keys);
  return *row.make(own)->smooth(drive.input());
}

}  // namespace canyon::fusion

#include "canyon/tests/study/fuse/recorded_inputs.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/config/text.h"
#include "canyon/core/random/random.h"
#include "canyon/fusion/reference_track.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/tests/fusion/recorded_run.h"

namespace canyon::study::testing {
namespace {

FuseInputs inputs_of(const canyon::testing::RecordedRun& run, double interval_s) {
  FuseInputs out;
  out.imu.path = "imu";
  out.gnss_path = "gnss";
  out.imu.samples = run.imu;
  out.imu.interval_s = interval_s;
  out.fixes = run.fixes;
  out.truth.path = "truth";
  out.truth.has_attitude = out.truth.has_velocity = true;
  for (const auto& point : run.truth) out.truth.states.push_back(point.state);
  return out;
}

void add_velocities(const std::string& gnss, FuseInputs& in) {
  constexpr double kSigma_m_s = 0.0514;  // of the file's MANIFEST
  const auto rows = canyon::testing::read_number_csv(gnss);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    GnssFix& fix = in.fixes[i];
    const Eigen::Matrix3d R = canyon::testing::rotation_E_from_ned(geodetic_from_ecef(fix.p_A_E));
    fix.v_A_E = R * Eigen::Vector3d(rows[i][4], rows[i][5], rows[i][6]);
    fix.velocity_covariance_E = kSigma_m_s * kSigma_m_s * Eigen::Matrix3d::Identity();
  }
}

/// One triad's errors, axis by axis; the processes go on from sample to sample. Scale factors wander as the biases do,
/// as sim_leador_a15 was made and the filter of leador_config() is told.
class DrawnTriad {
 public:
  DrawnTriad(const TriadNoise& noise, std::uint64_t seed, const char* name) : noise_(noise), stream_(seed, name) {
    turn_on_ = noise.turn_on_bias_sigma * stream_.normal3(0, 1);
    in_run_ = noise.in_run_bias_sigma * stream_.normal3(0, 2);
    scale_ = noise.scale_sigma * stream_.normal3(0, 3);
  }
  Eigen::Vector3d measured(const Eigen::Vector3d& increment, double dt_s, std::uint64_t k) {
    const double decay = std::exp(-dt_s / noise_.in_run_bias_tau_s);
    const Eigen::Vector3d out = increment + increment.cwiseProduct(scale_) + dt_s * (turn_on_ + in_run_) +
                                noise_.white_per_sqrt_hz * std::sqrt(dt_s) * stream_.normal3(k, 0);
    const double driven = std::sqrt(1.0 - decay * decay);
    in_run_ = decay * in_run_ + noise_.in_run_bias_sigma * driven * stream_.normal3(k + 1, 2);
    if (noise_.scale_sigma > 0.0) scale_ = decay * scale_ + noise_.scale_sigma * driven * stream_.normal3(k + 1, 3);
    return out;
  }

 private:
  TriadNoise noise_;
  RandomStream stream_;
  Eigen::Vector3d turn_on_, in_run_, scale_;
};

Eigen::Vector3d draw(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& normals) {
  return covariance.llt().matrixL() * normals;
}

}  // namespace

const LeadorUnit kA15{"imu_a15_100hz.f32", 0.003, 0.03, 0.027, 15.0, 300.0, 14400.0};
const LeadorUnit kAdis16465{"imu_adis16465_100hz.f32", 0.1, 0.1, 25.0, 200.0, 1000.0, 3600.0};

FuseInputs leador_inputs(const std::string& imu, const std::string& gnss, const std::string& truth) {
  return inputs_of(canyon::testing::read_sim_leador(imu, gnss, truth), 0.01);
}

FuseInputs navego_inputs(const std::string& imu, const std::string& gnss, const std::string& truth) {
  FuseInputs out = inputs_of(canyon::testing::read_navego(imu, gnss, truth), 0.005);
  add_velocities(gnss, out);
  return out;
}

FuseInputs ideal_navego_inputs(const std::string& gnss, const std::string& truth) {
  constexpr double kRate_hz = 200.0;
  inertial::MotionConfig config;
  config.path = "recorded";
  config.file = truth;
  auto motion = inertial::make_motion(config, 1);
  CANYON_CHECK(motion.ok(), motion.error().str());
  // Of week 2200, as the recorded run; the file has none.
  const GpsTime start = GpsTime::from_week_sow(2200, 0.0);
  canyon::testing::RecordedRun run;
  for (const auto& row : canyon::testing::read_number_csv(gnss)) {
    GnssFix fix;
    fix.t = start + row[0];
    fix.status = FixStatus::kDifferential;
    const Geodetic at{row[1] * kDegree, row[2] * kDegree, row[3]};
    const Eigen::Matrix3d R = canyon::testing::rotation_E_from_ned(at);
    fix.p_A_E = ecef_from_geodetic(at);
    fix.covariance_E = R * Eigen::Vector3d(25.0, 25.0, 100.0).asDiagonal() * R.transpose();
    run.fixes.push_back(fix);
  }
  const auto samples = static_cast<std::int64_t>(std::floor(motion->motion->duration_s() * kRate_hz));
  for (std::int64_t k = 0; k < samples; ++k) {
    const double from_s = static_cast<double>(k) / kRate_hz, to_s = static_cast<double>(k + 1) / kRate_hz;
    ImuSample sample = inertial::motion_increments(*motion, from_s, to_s);
    sample.t = tick(start, k + 1, kRate_hz);
    sample.dt_s = 1.0 / kRate_hz;
    run.imu.push_back(sample);
  }
  FuseInputs out = inputs_of(run, 1.0 / kRate_hz);
  for (std::int64_t k = 0; k <= samples; k += 10) {
    const KinematicState at = motion->imu_at(static_cast<double>(k) / kRate_hz);
    const Eigen::Matrix3d& R = motion->frame.R_EW();
    out.truth.states.push_back({.t = tick(start, k, kRate_hz),
                                .R_EU = (Eigen::Quaterniond(R) * at.X_WB.R).normalized(),
                                .p_EU_E = motion->frame.to_E(at.X_WB.p),
                                .v_EU_E = R * at.v_WB_W});
  }
  add_velocities(gnss, out);
  return out;
}

FuseConfig leador_config(const LeadorUnit& u, double start_deg) {
  return config_of(join_values(
      "[fusion]\nimu_gain_tau_s = ", u.tau_s, "\ninitial_position_sigma_m = 0.05\n",
      "initial_attitude_sigma_deg_roll_pitch = ", start_deg, "\ninitial_attitude_sigma_deg_heading = ", start_deg,
      "\n[imu]\nsensor = \"ideal\"\narw_deg_per_sqrt_hr = ", u.arw_deg_per_sqrt_hr,
      "\ngyro_in_run_bias_deg_per_hr = ", u.gyro_bias_deg_per_hr, "\ngyro_in_run_bias_tau_s = ", u.tau_s,
      "\ngyro_scale_ppm = ", u.scale_ppm, "\nvrw_m_s_per_sqrt_hr = ", u.vrw_m_s_per_sqrt_hr,
      "\naccel_in_run_bias_mg = ", u.accel_bias_mgal * 1e-5 / kMilliG, "\naccel_in_run_bias_tau_s = ", u.tau_s,
      "\naccel_scale_ppm = ", u.scale_ppm, "\n[gnss]\nlever_m = [0.136, 0.301, 0.184]\n[score]\nskip_s = 60\n"));
}

FuseInputs drawn(const FuseInputs& ideal, const FusePlan& plan, std::uint64_t seed) {
  FuseInputs out = ideal;
  DrawnTriad gyro(plan.noise.gyro, seed, "test.fuse.gyro"), accel(plan.noise.accel, seed, "test.fuse.accel");
  for (std::size_t k = 0; k < out.imu.samples.size(); ++k) {
    ImuSample& sample = out.imu.samples[k];
    sample.dtheta_U = gyro.measured(sample.dtheta_U, sample.dt_s, k);
    sample.dv_U = accel.measured(sample.dv_U, sample.dt_s, k);
  }
  const RandomStream places(seed, "test.fuse.fix"), speeds(seed, "test.fuse.fix_velocity");
  std::vector<GnssFix> fixes;
  for (std::size_t i = 0; i < out.fixes.size(); ++i) {
    GnssFix fix = out.fixes[i];
    const auto truth = fusion::reference_at(out.truth.states, fix.t);
    if (!truth) continue;
    fix.p_A_E =
        truth->p_EU_E + truth->R_EU * (plan.lever_A_B - plan.lever_U_B) + draw(fix.covariance_E, places.normal3(i));
    if (fix.v_A_E.allFinite()) fix.v_A_E = truth->v_EU_E + draw(fix.velocity_covariance_E, speeds.normal3(i));
    fixes.push_back(fix);
  }
  out.fixes = std::move(fixes);
  return out;
}

FuseConfig config_of(const std::string& toml) {
  auto config = parse_fuse_config(toml, "test.toml");
  CANYON_CHECK(config.ok(), config.error().str());
  return *std::move(config);
}

Ratio ratio_over(const std::vector<double>& draws, double t) {
  Ratio out;
  const double n = static_cast<double>(draws.size());
  for (const double x : draws) out.mean += x / n;
  double square = 0.0;
  for (const double x : draws) square += (x - out.mean) * (x - out.mean);
  out.half_width = t * std::sqrt(square / (n - 1.0) / n);
  return out;
}

}  // namespace canyon::study::testing

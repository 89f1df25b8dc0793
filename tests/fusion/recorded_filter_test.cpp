#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/recorded_run.h"
#include "canyon/tests/support/test_data.h"

/// The filter on runs made by others, against truth and against the figures of a public filter (KF-GINS, 21 states) on
/// the same files. Synthetic twin: tests/inertial/filter_loop_test.cpp.
namespace canyon::fusion {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

struct Score {
  double position_rms_m = 0.0;
  Eigen::Vector3d velocity_rms = Eigen::Vector3d::Zero();      // NED, m/s
  Eigen::Vector3d attitude_rms_deg = Eigen::Vector3d::Zero();  // about N, E, D
  Vector9d each = Vector9d::Zero();  // mean (error / sigma)^2 of attitude, position, velocity along N, E, D
  double nees = 0.0, nis = 0.0;      // per state
  std::int64_t fixes = 0;
  double seconds = 0.0;
};

/// Errors in N, E, D and their covariance; attitude error in radians about these axes.
void add_epoch(Score& s, const testing::ReferencePoint& truth, const ErrorStateFilter& filter, ConsistencyMean& nees) {
  const NavState& estimate = filter.nav_state();
  Vector9d error;
  error << so3_log(estimate.R_EU.conjugate() * truth.state.R_EU), truth.state.p_EU_E - estimate.p_EU_E,
      truth.state.v_EU_E - estimate.v_EU_E;
  const Matrix9d P = filter.covariance().topLeftCorner<9, 9>();
  nees.add(normalized_squared(error, P), 9);

  Matrix9d to_ned = Matrix9d::Zero();
  to_ned.block<3, 3>(0, 0) = truth.R_E_ned.transpose() * estimate.R_EU.toRotationMatrix();
  to_ned.block<3, 3>(3, 3) = truth.R_E_ned.transpose();
  to_ned.block<3, 3>(6, 6) = truth.R_E_ned.transpose();
  const Vector9d ned = to_ned * error;
  const Matrix9d P_ned = to_ned * P * to_ned.transpose();
  s.each += (ned.array().square() / P_ned.diagonal().array()).matrix();
  s.attitude_rms_deg += (ned.head<3>() / kDegree).cwiseAbs2();
  s.position_rms_m += ned.segment<3>(3).squaredNorm();
  s.velocity_rms += ned.tail<3>().cwiseAbs2();
}

Score run_filter(const testing::RecordedRun& run, const FilterConfig& config, const ImuNoise& noise,
                 const Eigen::Vector3d& antenna, double skip_s) {
  const testing::ReferencePoint& first = run.truth.front();
  const LocalFrame frame(geodetic_from_ecef(first.state.p_EU_E));
  ErrorStateFilter filter(config, noise, frame, Eigen::Vector3d::Zero(), antenna);
  const Eigen::Matrix3d R_WE = frame.R_EW().transpose();
  filter.initialize(first.t, {Eigen::Quaterniond(R_WE) * first.state.R_EU, frame.to_W(first.state.p_EU_E)},
                    R_WE * first.state.v_EU_E);
  std::size_t fix = 0, ref = 1;
  while (run.fixes[fix].t <= first.t) ++fix;
  Score s;
  ConsistencyMean nees, nis;
  for (const ImuSample& imu : run.imu) {
    filter.predict(imu);
    const bool scored = imu.t - first.t >= skip_s;
    if (fix < run.fixes.size() && run.fixes[fix].t - imu.t < 1e-4) {
      const UpdateReport report = filter.update(run.fixes[fix++]);
      if (scored) nis.add(report.nis, report.dimension);
    }
    if (ref < run.truth.size() && std::abs(run.truth[ref].t - imu.t) < 1e-4) {
      if (scored) add_epoch(s, run.truth[ref], filter, nees);
      ++ref;
    }
  }
  const double n = static_cast<double>(nees.count());
  s.each /= n;
  s.attitude_rms_deg = (s.attitude_rms_deg / n).cwiseSqrt();
  s.velocity_rms = (s.velocity_rms / n).cwiseSqrt();
  s.position_rms_m = std::sqrt(s.position_rms_m / n);
  s.nees = nees.per_state();
  s.nis = nis.per_state();
  s.fixes = nis.count();
  s.seconds = run.imu.back().t - first.t - skip_s;
  return s;
}

void print(const char* what, const Score& s) {
  std::printf("%s: position %.4f m (3-D RMS), velocity %.1f %.1f %.1f mm/s, attitude %.4f %.4f %.4f deg;\n", what,
              s.position_rms_m, 1e3 * s.velocity_rms.x(), 1e3 * s.velocity_rms.y(), 1e3 * s.velocity_rms.z(),
              s.attitude_rms_deg.x(), s.attitude_rms_deg.y(), s.attitude_rms_deg.z());
  std::printf(
      "  NEES per state %.2f, NIS per dimension %.2f, (error/sigma)^2 attitude %.2f %.2f %.2f position %.2f %.2f %.2f "
      "velocity %.2f %.2f %.2f\n",
      s.nees, s.nis, s.each[0], s.each[1], s.each[2], s.each[3], s.each[4], s.each[5], s.each[6], s.each[7], s.each[8]);
}

/// One run is one draw of slowly varying errors. Counted as independent every 30 s (heading and biases vary no faster),
/// the mean NEES leaves this band with probability 1e-3; innovations are independent from fix to fix.
constexpr double kFalseAlarm = 1e-3;
constexpr double kCorrelation_s = 30.0;

Band nees_band(const Score& s, int dof) {
  const Band b = mean_chi_square_band(dof, static_cast<std::int64_t>(s.seconds / kCorrelation_s), kFalseAlarm);
  return {.low = b.low / dof, .high = b.high / dof};
}

void expect_consistent(const Score& s) {
  const Band all = nees_band(s, 9), one = nees_band(s, 1), nis = mean_chi_square_band(3, s.fixes, kFalseAlarm);
  EXPECT_TRUE(all.contains(s.nees)) << s.nees << " in " << all.low << " .. " << all.high;
  EXPECT_TRUE(nis.contains(3.0 * s.nis)) << s.nis << " in " << nis.low / 3 << " .. " << nis.high / 3;
  for (int i = 0; i < 9; ++i)
    EXPECT_TRUE(one.contains(s.each[i])) << i << ": " << s.each[i] << " in " << one.low << " .. " << one.high;
}

/// Noise as the recordings were made: Gauss-Markov biases with stationary start, scale factors likewise.
ImuNoise recorded_noise(double arw_deg_per_sqrt_hr, double vrw_m_s_per_sqrt_hr, double gyro_bias_deg_per_hr,
                        double accel_bias_mgal, double scale_ppm, double tau_s) {
  ImuNoise n;
  n.gyro.white_per_sqrt_hz = arw_deg_per_sqrt_hr * kDegree / 60.0;
  n.gyro.in_run_bias_sigma = gyro_bias_deg_per_hr * kDegree / kHour;
  n.accel.white_per_sqrt_hz = vrw_m_s_per_sqrt_hr / 60.0;
  n.accel.in_run_bias_sigma = accel_bias_mgal * 1e-5;
  n.gyro.in_run_bias_tau_s = n.accel.in_run_bias_tau_s = tau_s;
  n.gyro.scale_sigma = n.accel.scale_sigma = scale_ppm * 1e-6;
  return n;
}

struct Unit {
  const char* name;
  const char* file;
  ImuNoise noise;
  double kf_gins_position_rms_m;
};

void leador(const Unit& unit) {
  CANYON_REAL_DATA(gnss, "inertial/sim_leador_a15/gnss_1hz.csv");
  CANYON_REAL_DATA(truth, "inertial/sim_leador_a15/truth_10hz.csv");
  CANYON_REAL_DATA(imu, std::string("inertial/sim_leador_a15/") + unit.file);
  const auto run = testing::read_sim_leador(imu, gnss, truth);
  FilterConfig config = configured("imu_gain_tau_s = " + number_text(unit.noise.gyro.in_run_bias_tau_s));
  config.initial_attitude_sigma_deg_roll_pitch = 0.05;
  config.initial_attitude_sigma_deg_heading = 0.1;
  config.initial_position_sigma_m = 0.05;
  const Eigen::Vector3d antenna = testing::flu_from_frd({0.136, -0.301, -0.184});

  const Score s = run_filter(run, config, unit.noise, antenna, 60.0);
  print(unit.name, s);
  expect_consistent(s);
  // The public filter's figure on the same files. Both use the same information, so what differs is under 5 % of the
  // error.
  EXPECT_LT(s.position_rms_m, 1.05 * unit.kf_gins_position_rms_m);

  config.states = {"biases"};
  print("  strictly 15 states", run_filter(run, config, unit.noise, antenna, 60.0));
}

TEST(RecordedFilter, TacticalGrade) {
  leador({"Leador A15", "imu_a15_100hz.f32", recorded_noise(0.003, 0.03, 0.027, 15.0, 300.0, 4.0 * kHour), 0.0141});
}

TEST(RecordedFilter, IndustrialMems) {
  leador({"ADIS16465", "imu_adis16465_100hz.f32", recorded_noise(0.1, 0.1, 25.0, 200.0, 1000.0, kHour), 0.0218});
}

/// A turn-on bias of 3 deg/s and 50 mg beside an in-run process of tau = 100 s. Turn-on and in-run variance lumped into
/// one Gauss-Markov process of that tau make a filter that forgets the bias and is sure of it.
TEST(RecordedFilter, RemembersTheTurnOnBias) {
  CANYON_REAL_DATA(gnss, "inertial/navego_synthetic/gnss_5hz.csv");
  CANYON_REAL_DATA(truth, "inertial/navego_synthetic/truth_20hz.csv");
  CANYON_REAL_DATA(imu, "inertial/navego_synthetic/imu_adis16405_200hz.f32");
  const auto run = testing::read_navego(imu, gnss, truth);
  ImuNoise noise;
  noise.gyro.white_per_sqrt_hz = 2.0 * kDegree / 60.0;
  noise.gyro.turn_on_bias_sigma = 3.0 * kDegree;
  noise.gyro.in_run_bias_sigma = 0.007 * kDegree;
  noise.accel.white_per_sqrt_hz = 0.2 / 60.0;
  noise.accel.turn_on_bias_sigma = 50.0 * kMilliG;
  noise.accel.in_run_bias_sigma = 0.2 * kMilliG;
  noise.gyro.in_run_bias_tau_s = noise.accel.in_run_bias_tau_s = 100.0;
  FilterConfig config;
  config.initial_attitude_sigma_deg_roll_pitch = 1.0;
  config.initial_position_sigma_m = 5.0;
  config.initial_velocity_sigma_m_s = 0.5;

  const Score s = run_filter(run, config, noise, Eigen::Vector3d::Zero(), 200.0);
  print("NaveGo ADIS16405", s);
  expect_consistent(s);
  EXPECT_LT(s.position_rms_m, 1.05 * std::hypot(1.26, 1.33, 1.41));  // KF-GINS on the same files, well tuned

  ImuNoise trap = noise;
  for (TriadNoise* n : {&trap.gyro, &trap.accel}) {
    n->in_run_bias_sigma = std::hypot(n->turn_on_bias_sigma, n->in_run_bias_sigma);
    n->turn_on_bias_sigma = 0.0;
  }
  const Score trapped = run_filter(run, config, trap, Eigen::Vector3d::Zero(), 200.0);
  print("  turn-on bias within the process", trapped);
  EXPECT_GT(trapped.nees, nees_band(trapped, 9).high);
}

}  // namespace
}  // namespace canyon::fusion

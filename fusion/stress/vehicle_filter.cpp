#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using Vector9d = Eigen::Matrix<double, 9, 1>;

/// A vehicle that goes round a level ring, starts and stops every two minutes, without end: place, velocity and what a
/// unit at its origin feels in closed form, so that truth does not drift with the integrator.
struct Ring {
  static constexpr double kRadius_m = 100.0, kMean_m_s = 6.0, kRound_s = 120.0;

  LocalFrame frame{Geodetic{45.0 * kDegree, 7.0 * kDegree, 200.0}};
  Vector3d earth_W = frame.R_EW().transpose() * earth_rate_E();

  static double way_m(double t) {
    return kMean_m_s * (t - kRound_s / (2.0 * kPi) * std::sin(2.0 * kPi * t / kRound_s));
  }
  static double speed_m_s(double t) { return kMean_m_s * (1.0 - std::cos(2.0 * kPi * t / kRound_s)); }
  static double acceleration_m_s2(double t) {
    return kMean_m_s * (2.0 * kPi / kRound_s) * std::sin(2.0 * kPi * t / kRound_s);
  }
  static double yaw(double t) { return way_m(t) / kRadius_m; }
  static Vector3d along_W(double t) { return {std::cos(yaw(t)), std::sin(yaw(t)), 0.0}; }
  static Vector3d left_W(double t) { return {-std::sin(yaw(t)), std::cos(yaw(t)), 0.0}; }
  static Pose X_WB(double t) {
    return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw(t), Vector3d::UnitZ())), -kRadius_m * left_W(t)};
  }
  NavState at(double t) const {
    const Pose X = X_WB(t);
    return {.t = {},
            .R_EU = (Eigen::Quaterniond(frame.R_EW()) * X.R).normalized(),
            .p_EU_E = frame.to_E(X.p),
            .v_EU_E = frame.R_EW() * (speed_m_s(t) * along_W(t))};
  }
  Vector3d rate_B(double t) const {
    return X_WB(t).R.conjugate() * earth_W + Vector3d(0.0, 0.0, speed_m_s(t) / kRadius_m);
  }
  Vector3d force_B(double t) const {
    const Pose X = X_WB(t);
    const double v = speed_m_s(t);
    const Vector3d acceleration_W = acceleration_m_s2(t) * along_W(t) + v * v / kRadius_m * left_W(t);
    const Vector3d gravity_W = frame.R_EW().transpose() * gravity_E(frame.to_E(X.p));
    return X.R.conjugate() * (acceleration_W + 2.0 * earth_W.cross(v * along_W(t)) - gravity_W);
  }
  /// Integrals over (from, from + dt], by Simpson's rule: of a motion of two minutes over 10 ms exact to 1e-15.
  Increments increments(double from, double dt) const {
    const auto mean = [&](const auto& f) -> Vector3d {
      return (f(from) + 4.0 * f(from + 0.5 * dt) + f(from + dt)) / 6.0;
    };
    return {.dt_s = dt, .dtheta_U = dt * mean([&](double t) { return rate_B(t); }), .dv_U = dt * mean([&](double t) {
                                                                                              return force_B(t);
                                                                                            })};
  }
};

/// A process that keeps its size, and forgets over tau.
struct Wandering {
  double sigma, tau_s;
  Vector3d value = Vector3d::Zero();
  void step(double dt, const Vector3d& normals) {
    const double decay = std::exp(-dt / tau_s);
    value = decay * value + sigma * std::sqrt(1.0 - decay * decay) * normals;
  }
};

/// What the filter `vehicle` is told of its sensors, drawn once: a unit that sits askew with biases and gains, wheels
/// of another radius, fixes whose errors last, velocities, ticks.
class Sensors {
 public:
  /// `lasting_m`: 1-sigma of what lasts of a fix's error, per axis.
  Sensors(const Ring& ring, const ImuNoise& noise, double lasting_m = 3.0)
      : ring_(ring),
        noise_(noise),
        gyro_{noise.gyro.in_run_bias_sigma, noise.gyro.in_run_bias_tau_s,
              noise.gyro.in_run_bias_sigma * draw_.normal3(0, 0)},
        accel_{noise.accel.in_run_bias_sigma, noise.accel.in_run_bias_tau_s,
               noise.accel.in_run_bias_sigma * draw_.normal3(1, 0)},
        fix_error_{lasting_m, 10.0, lasting_m * draw_.normal3(2, 0)},
        gyro_bias_(noise.gyro.turn_on_bias_sigma * draw_.normal3(3, 0)),
        accel_bias_(noise.accel.turn_on_bias_sigma * draw_.normal3(4, 0)),
        gyro_gain_(gains(noise.gyro, 5)),
        accel_gain_(gains(noise.accel, 8)),
        mounting_(kDegree * draw_.normal3(11, 0)),
        R_UB_(so3_exp(mounting_)),
        wheel_scale_(0.01 * draw_.normal3(12, 0).x()) {}

  const Eigen::Quaterniond& R_UB() const { return R_UB_; }

  ImuSample sample(std::uint64_t k, double from, GpsTime t, double dt) {
    const Increments in = ring_.increments(from, dt);
    const Vector3d w = R_UB_ * in.dtheta_U, f = R_UB_ * in.dv_U;
    gyro_.step(dt, walk_gyro_.normal3(k));
    accel_.step(dt, walk_accel_.normal3(k));
    ImuSample out;
    out.t = t;
    out.dt_s = dt;
    out.dtheta_U = w + gyro_gain_ * w + dt * (gyro_bias_ + gyro_.value) +
                   noise_.gyro.white_per_sqrt_hz * std::sqrt(dt) * white_gyro_.normal3(k);
    out.dv_U = f + accel_gain_ * f + dt * (accel_bias_ + accel_.value) +
               noise_.accel.white_per_sqrt_hz * std::sqrt(dt) * white_accel_.normal3(k);
    return out;
  }
  GnssFix fix(std::uint64_t k, double t, GpsTime at, const Vector3d& antenna_B) {
    constexpr double kSigma_m = 1.0, kSigma_m_s = 0.05;
    fix_error_.step(1.0, lasting_.normal3(k));
    const Pose X = Ring::X_WB(t);
    const Vector3d v_B(Ring::speed_m_s(t), 0.0, 0.0), w_B(0.0, 0.0, Ring::speed_m_s(t) / Ring::kRadius_m);
    GnssFix out;
    out.t = at;
    out.status = FixStatus::kSingle;
    out.p_A_E = ring_.frame.to_E(X * antenna_B) + fix_error_.value + kSigma_m * fixes_.normal3(k);
    out.covariance_E = kSigma_m * kSigma_m * Eigen::Matrix3d::Identity();
    out.v_A_E = ring_.frame.R_EW() * (X.R * (v_B + w_B.cross(antenna_B))) + kSigma_m_s * speeds_.normal3(k);
    out.velocity_covariance_E = kSigma_m_s * kSigma_m_s * Eigen::Matrix3d::Identity();
    return out;
  }
  /// Of a wheel to the left of B's origin, over (t - dt, t].
  OdometerSample wheel(double t, GpsTime at, double dt) {
    constexpr double kTick_m = 0.02, kLeft_m = 0.8;
    const double share = (1.0 - kLeft_m / Ring::kRadius_m) * (1.0 + wheel_scale_);
    const double until = std::floor(share * Ring::way_m(t) / kTick_m);
    OdometerSample out;
    out.t = at;
    out.dt_s = dt;
    out.ticks = static_cast<std::int64_t>(until - ticks_);
    out.speed_m_s = kTick_m * (until - ticks_) / dt;
    ticks_ = until;
    return out;
  }

 private:
  Eigen::Matrix3d gains(const TriadNoise& n, std::uint64_t from) const {
    Eigen::Matrix3d out;
    for (int i = 0; i < 3; ++i) {
      const Vector3d row = draw_.normal3(from + static_cast<std::uint64_t>(i), 0);
      for (int j = 0; j < 3; ++j) out(i, j) = (i == j ? n.scale_sigma : n.misalignment_sigma_rad) * row[j];
    }
    return out;
  }

  const Ring& ring_;
  ImuNoise noise_;
  RandomStream draw_{7, "stress.vehicle.draw"}, white_gyro_{7, "stress.vehicle.gyro"},
      white_accel_{7, "stress.vehicle.accel"}, walk_gyro_{7, "stress.vehicle.gyro_bias"},
      walk_accel_{7, "stress.vehicle.accel_bias"}, lasting_{7, "stress.vehicle.fix_error"},
      fixes_{7, "stress.vehicle.fix"}, speeds_{7, "stress.vehicle.fix_velocity"};
  Wandering gyro_, accel_, fix_error_;
  Vector3d gyro_bias_, accel_bias_;
  Eigen::Matrix3d gyro_gain_, accel_gain_;
  Vector3d mounting_;
  Eigen::Quaterniond R_UB_;
  double wheel_scale_, ticks_ = 0.0;
};

/// The filter `vehicle` on that ring, fixes once a second, ticks ten times: every ten minutes its covariance must be
/// symmetric to the bit and definite to the rounding of n x n terms, and attitude, position and velocity as far off as
/// it says: nine squares below what chance exceeds once in 10^8. It may be surer than it says, not less: its wheels do
/// not slip here, though it reckons with it.
StressFigure round_and_round(double hours) {
  ImuNoise noise = usual_noise();
  noise.gyro.scale_sigma = 5e-4;
  noise.accel.scale_sigma = 3e-4;
  noise.gyro.misalignment_sigma_rad = noise.accel.misalignment_sigma_rad = 1e-3;
  const Vector3d antenna_B(-0.3, 0.1, 1.2);
  const Ring ring;
  Sensors sensors(ring, noise);
  ErrorStateFilter filter(configured("filter = \"vehicle\"\nfix_error_sigma_m = 3\nfix_error_scale = 0\n"
                                     "fix_error_tau_s = 10\nvelocity_error_scale = 0"),
                          noise, ring.frame, Vector3d::Zero(), antenna_B);
  const GpsTime start = GpsTime::from_week_sow(1590, 1000.0);
  filter.initialize(start, Ring::X_WB(0.0), Vector3d::Zero());

  constexpr double kRate_hz = 100.0;
  const double most = canyon::chi_square_threshold(1e-8, 9.0);
  stress::Worst worst;
  for (std::int64_t k = 1; k <= std::llround(3600.0 * kRate_hz * hours); ++k) {
    const double before = static_cast<double>(k - 1) / kRate_hz, t = static_cast<double>(k) / kRate_hz;
    const GpsTime at = tick(start, k, kRate_hz);
    const auto n = static_cast<std::uint64_t>(k);
    filter.predict(sensors.sample(n, before, at, 1.0 / kRate_hz));
    if (k % 10 == 0) filter.update(AidingMessage(sensors.wheel(t, at, 0.1)));
    if (k % 100 == 0) filter.update(sensors.fix(n, t, at, antenna_B));
    if (k % 60'000 != 0) continue;
    const Eigen::MatrixXd P = filter.covariance();
    worst.look(P.allFinite() && P == P.transpose() && (P.diagonal().array() > 0.0).all() ? 0.0 : stress::kInfinity,
               1.0);
    const Eigen::VectorXd scale = P.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd unit = scale.asDiagonal() * P * scale.asDiagonal();
    const auto size = static_cast<double>(P.rows());
    const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(unit, Eigen::EigenvaluesOnly)
                             .eigenvalues()
                             .minCoeff<Eigen::PropagateNaN>();
    worst.look(worse(0.0, -least), 2.0 * size * size * stress::kEpsilon);
    const NavState& s = filter.nav_state();
    NavState truth = ring.at(t);
    truth.R_EU = truth.R_EU * sensors.R_UB().conjugate();
    Vector9d error;
    error << so3_log(s.R_EU.conjugate() * truth.R_EU), truth.p_EU_E - s.p_EU_E, truth.v_EU_E - s.v_EU_E;
    worst.look(normalized_squared(error, Eigen::Matrix<double, 9, 9>(P.topLeftCorner<9, 9>())), most);
  }
  return worst.figure();
}

/// Fixes that wander off by 200 m at the pace of a walker for that long, and say that they are good to a metre; wheels
/// and velocities go on telling the truth. Ten seconds after good ones are back the filter is where they are: within
/// what chance exceeds once in a million of a fix's own error of 1 m on three axes; so it is a minute later, whatever
/// it was taught meanwhile. Without its way back it is not.
StressFigure led_astray(double bad_s, bool also_without) {
  const ImuNoise noise = usual_noise();
  const Vector3d antenna_B(-0.3, 0.1, 1.2);
  const double most_m = std::sqrt(canyon::chi_square_threshold(1e-6, 3.0));
  stress::Worst worst;
  const auto drive = [&](const std::string& keys) {
    const Ring ring;
    Sensors sensors(ring, noise, 0.0);
    ErrorStateFilter filter(configured("filter = \"vehicle\"\n" + keys), noise, ring.frame, Vector3d::Zero(),
                            antenna_B);
    const GpsTime start = GpsTime::from_week_sow(1590, 1000.0);
    filter.initialize(start, Ring::X_WB(0.0), Vector3d::Zero());
    constexpr double kRate_hz = 50.0;
    std::array<double, 3> off_m{};  // while they are bad at most, ten seconds and a minute later
    for (std::int64_t k = 1; k <= std::llround(kRate_hz * (bad_s + 60.0)); ++k) {
      const double t = static_cast<double>(k) / kRate_hz;
      const GpsTime at = tick(start, k, kRate_hz);
      const auto n = static_cast<std::uint64_t>(k);
      filter.predict(sensors.sample(n, t - 1.0 / kRate_hz, at, 1.0 / kRate_hz));
      if (k % 5 == 0) filter.update(AidingMessage(sensors.wheel(t, at, 0.1)));
      if (k % 25 != 0) continue;
      GnssFix fix = sensors.fix(n, t, at, antenna_B);
      if (t <= bad_s) fix.p_A_E += 200.0 * Vector3d(std::sin(0.01 * t), std::cos(0.013 * t), 0.5);
      filter.update(fix);
      const double error_m = (ring.at(t).p_EU_E - filter.nav_state().p_EU_E).norm();
      if (t <= bad_s) off_m[0] = worse(off_m[0], error_m);
      if (std::abs(t - bad_s - 10.0) < 0.1) off_m[1] = error_m;
      if (std::abs(t - bad_s - 60.0) < 0.1) off_m[2] = error_m;
    }
    return off_m;
  };
  const std::array<double, 3> off_m = drive("");
  worst.look(off_m[0] > 20.0 ? 0.0 : stress::kInfinity, 1.0);
  worst.look(off_m[1], most_m);
  worst.look(off_m[2], most_m);
  if (also_without) worst.look(drive("lost_after_s = 0")[1] > 5.0 * most_m ? 0.0 : stress::kInfinity, 1.0);
  return worst.figure();
}

}  // namespace

std::vector<StressCase> vehicle_filter_cases() {
  const StressMechanism day{
      StressGroup::kLong, "a vehicle's filter round the clock",
      "rounding of ten million steps and a million corrections turns P over; the errors outgrow it",
      "definite, and errors of nine states within what chance exceeds once in 10^8", "of the bound"};
  StressRows rows;
  rows.of(day).add("vehicle_filter/ring_10_min", [] { return round_and_round(1.0 / 6.0); });
  rows.of(day).add("vehicle_filter/ring_24_h", [] { return round_and_round(24.0); });
  rows.long_running();
  rows.of({StressGroup::kLong, "a vehicle's filter after bad fixes that last",
           "errors that last are what it knows; it follows them, and gives the good ones that come then little weight",
           "ten seconds of good ones later within a fix's own error, once in 10^6, and a minute later",
           "of the bound"});
  rows.add("vehicle_filter/a_quarter_hour_led_astray", [] { return led_astray(900.0, false); });
  rows.add("vehicle_filter/nine_minutes_led_astray", [] { return led_astray(540.0, false); });
  rows.add("vehicle_filter/an_hour_led_astray", [] { return led_astray(3660.0, true); });
  rows.long_running();
  return rows.take();
}

}  // namespace canyon::fusion

// Rows of measurements over several messages: when they measure, what noise they state, what they are told of errors
// that last; each by hand, with the parameters that stand where nobody gives any and with others.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include "canyon/core/earth/earth.h"
#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/fusion/states/fix_error.h"
#include "canyon/fusion/states/range_errors.h"
#include "canyon/fusion/states/receiver_clock.h"
#include "canyon/fusion/states/velocity_error.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;

using stress::Looks;

const LocalFrame kPlaceFrame(Geodetic{48.0 * kDegree, 11.0 * kDegree, 500.0});
const GpsTime kThen = GpsTime::from_week_sow(1700, 2000.0);

/// A filter's view without a filter: what it stands on may be changed between two messages.
class SeenState {
 public:
  explicit SeenState(const std::vector<std::string>& blocks, const std::string& keys = "")
      : config_(configured(keys)), state(blocks, config_.own, {.noise = noise}) {
    NavState nav;
    nav.t = kThen;
    nav.R_EU =
        Eigen::Quaterniond(kPlaceFrame.R_EW()) * rotation_from({.yaw_rad = 0.6, .pitch_rad = 0.0, .roll_rad = 0.0});
    nav.p_EU_E = kPlaceFrame.to_E({10.0, 20.0, 3.0});
    nav.v_EU_E = nav.R_EU * Vector3d(8.0, 0.0, 0.0);
    state.start(nav);
  }
  std::unique_ptr<MeasurementModel> model(const std::string& row) const {
    auto made = model_row(measurement_models(), row).make(config_.own, {.state = state, .noise = noise});
    made->start();
    return made;
  }
  FilterView view() const {
    return {.state = state,
            .frame = kPlaceFrame,
            .lever_U_B = lever_U,
            .lever_A_B = lever_A,
            .imu = imu,
            .w_EU_U = w,
            .f_U = f};
  }
  /// All states beside motion.
  void set(const std::string& block, const Eigen::VectorXd& values) {
    Eigen::VectorXd e = Eigen::VectorXd::Zero(state.padded_size());
    const int at = state.offset(block);
    e.segment(at, values.size()) = values - state.values(at, static_cast<int>(values.size()));
    state.inject(e);
  }

 private:
  FilterConfig config_;

 public:
  ImuNoise noise;
  ErrorState state;
  Calibration imu;
  Vector3d w = Vector3d::Zero(), f = Vector3d(0.0, 0.0, 9.81), lever_U = Vector3d::Zero(), lever_A = Vector3d::Zero();
};

/// Speeds of a wheel, sample by sample: their mean over the interval, as far as that has come; slip and ticks in its
/// noise, and the wheel's own scale where that is estimated.
StressFigure wheel_speeds() {
  Looks looks;
  for (const bool usual : {true, false}) {
    SeenState seen({"wheel_scale"}, usual ? ""
                                          : "odometer_wheel_m = [0.5, -0.4, 0.1]\nodometer_interval_s = "
                                            "0.5\nodometer_tick_m = 0.1\nodometer_slip_percent = 2");
    const Vector3d wheel = usual ? Vector3d(0.0, 0.8, 0.0) : Vector3d(0.5, -0.4, 0.1);
    const double tick = usual ? 0.02 : 0.1, slip = usual ? 0.003 : 0.02;
    const int count = usual ? 4 : 10;  // of 50 ms
    seen.lever_U = Vector3d(0.2, 0.1, 0.9), seen.w = Vector3d(0.02, -0.05, 0.3);
    seen.set("wheel_scale", Eigen::VectorXd::Constant(1, 0.04));
    const auto model = seen.model("odometer");
    const double true_m_s = 8.0 + seen.w.cross(wheel - seen.lever_U).x();
    const NavState& nav = seen.state.nav;
    const Vector3d v = nav.R_EU.conjugate() * nav.v_EU_E, earth = nav.R_EU.conjugate() * earth_rate_E();
    const double a =
        (seen.f + nav.R_EU.conjugate() * gravity_E(nav.p_EU_E) - 2.0 * earth.cross(v) - seen.w.cross(v)).x();
    const auto round = [&](int begun) {
      double sum = 0.0;
      for (int k = begun; k < count; ++k) {
        const double speed = 7.0 + 0.3 * k;
        sum += speed / count;
        const auto m =
            model->received(seen.view(), OdometerSample{.t = kThen, .dt_s = 0.05, .ticks = 1, .speed_m_s = speed}, 0);
        looks.right(m.has_value() == (k == count - 1));
        if (!m) continue;
        looks.near(m->residual[0], sum - 1.04 * (true_m_s - 0.5 * 0.05 * count * a), 1e-12);
        looks.close(m->R(0, 0), tick * tick / (6.0 * std::pow(0.05 * count, 2)) + std::pow(slip * sum, 2), 32.0);
        looks.near(m->H(0, seen.state.offset("wheel_scale")), true_m_s - 0.5 * 0.05 * count * a, 1e-12);
        looks.right(m->dimension() == 1 && m->about == ErrorIndex::kVelocity);
      }
    };
    round(0), round(0);
    // Half counted, and begun anew.
    model->received(seen.view(), OdometerSample{.t = kThen, .dt_s = 0.05, .ticks = 1, .speed_m_s = 100.0}, 0);
    model->start();
    round(0);
  }
  return looks.figure();
}

/// A vehicle's own constraint: as often as its rate says, whatever the samples, of the axle's speed sideways and up,
/// with a tyre's slip in the sideways noise.
StressFigure axle() {
  Looks looks;
  for (const bool usual : {true, false}) {
    SeenState seen(
        {}, usual ? "" : "non_holonomic_rate_hz = 4\nnon_holonomic_sigma_m_s = 0.3\nnon_holonomic_sideslip = 0.5");
    const double rate = usual ? 10.0 : 4.0, sigma = usual ? 0.1 : 0.3, slip = usual ? 0.02 : 0.5;
    seen.lever_U = Vector3d(0.3, 0.4, 0.5), seen.w = Vector3d(0.1, -0.2, 0.5);
    seen.state.nav.v_EU_E = seen.state.nav.R_EU * Vector3d(8.0, 0.4, -0.3);
    for (const double dt : {0.01, 0.005, 0.07}) {
      const auto model = seen.model("non_holonomic");
      int made = 0;
      for (int k = 1; k <= 400; ++k) {
        const auto m =
            model->stepped(seen.view(), {.dt_s = dt, .dtheta_U = Vector3d::Zero(), .dv_U = Vector3d::Zero()});
        made += m.has_value() ? 1 : 0;
        looks.right(made == static_cast<int>(std::floor(k * dt * rate + 1e-6)));
        if (!m) continue;
        const Vector3d v = Vector3d(8.0, 0.4, -0.3) + seen.w.cross(-seen.lever_U);
        looks.near((m->residual + v.tail<2>()).norm(), 0.0, 1e-13);
        looks.close(m->R(0, 0), sigma * sigma + std::pow(slip * 0.5 * v.x(), 2), 32.0),
            looks.close(m->R(1, 1), sigma * sigma, 8.0);
        looks.right(m->R(0, 1) == 0.0 && m->R(1, 0) == 0.0 && m->about == ErrorIndex::kVelocity);
      }
    }
  }
  return looks.figure();
}

/// Windows in which a vehicle stood: forces that scatter up to the limit beside twice the unit's own noise, mean rates
/// up to theirs beside three times it, an estimate that is slow; and none beyond any of these, whatever has gone
/// before; as noise what is stated.
StressFigure standing() {
  Looks looks;
  for (const bool usual : {true, false})
    for (const bool noisy : {false, true}) {
      SeenState seen({}, usual ? ""
                               : "standstill_window_s = 0.25\nstandstill_force_m_s2 = 0.2\nstandstill_rate_deg_s = "
                                 "2\nstandstill_speed_m_s = "
                                 "3\nstandstill_sigma_m_s = 0.1");
      const double window = usual ? 0.5 : 0.25, force = usual ? 0.05 : 0.2, rate = (usual ? 0.5 : 2.0) * kPi / 180.0,
                   speed = usual ? 0.5 : 3.0, sigma = usual ? 0.02 : 0.1, dt = 0.0125;
      if (noisy) seen.noise.accel.white_per_sqrt_hz = 0.01, seen.noise.gyro.white_per_sqrt_hz = 0.004;
      const double per_s = 1.0 / dt, most_force = std::sqrt(force * force + (noisy ? 4.0 * 1e-4 * per_s : 0.0)),
                   most_rate = std::sqrt(rate * rate + (noisy ? 9.0 * 1.6e-5 / window : 0.0));
      const int count = static_cast<int>(std::lround(window / dt));
      const auto model = seen.model("standstill");
      const auto goes_on = [&](double scatter, const Vector3d& turn, double moves) {
        seen.state.nav.v_EU_E = seen.state.nav.R_EU * Vector3d(0.0, 0.6 * moves, 0.8 * moves);
        std::optional<Measurement> made;
        for (int k = 0; k < count; ++k) {
          // Half of the samples either side, on one axis: that is the standard deviation.
          Vector3d push(0.3, -0.2, 9.7);
          push.y() += k % 2 == 0 ? scatter : -scatter;
          seen.w = turn;
          const auto m = model->stepped(seen.view(), {.dt_s = dt, .dtheta_U = Vector3d::Zero(), .dv_U = dt * push});
          looks.right(k == count - 1 || !m);
          if (m) made = m;
        }
        return made;
      };
      const Vector3d axis(0.48, -0.6, 0.64);
      for (int round = 0; round < 2; ++round)
        for (const double part : {0.98, 1.02}) {
          const bool stands = part < 1.0;
          const auto scattered = goes_on(part * most_force, 0.1 * rate * axis, 0.1 * speed),
                     turned = goes_on(0.1 * force, part * most_rate * axis, 0.1 * speed),
                     moved = goes_on(0.1 * force, 0.1 * rate * axis, part * speed);
          for (const auto* m : {&scattered, &turned, &moved}) looks.right(m->has_value() == stands);
          if (!moved) continue;
          looks.near((moved->residual + Vector3d(0.0, 0.6, 0.8) * part * speed).norm(), 0.0, 1e-13);
          looks.near((moved->R - sigma * sigma * Measurement::Square::Identity(3, 3)).norm(), 0.0,
                     8.0 * kEpsilon * sigma * sigma);
        }
    }
  // Fewer than four samples tell nothing.
  SeenState seen({});
  seen.state.nav.v_EU_E.setZero();
  const auto model = seen.model("standstill");
  for (int k = 0; k < 12; ++k)
    looks.right(
        !model->stepped(seen.view(), {.dt_s = 0.2, .dtheta_U = Vector3d::Zero(), .dv_U = Vector3d(0.0, 0.0, 2.0)}));
  return looks.figure();
}

/// Headings, fields and pressures: floors, scales and limits of what they are told, and angles that go round.
StressFigure single_readings() {
  Looks looks;
  for (const bool usual : {true, false}) {
    SeenState seen(
        {}, usual ? ""
                  : "heading_sigma_floor_deg = 1\nmagnetic_declination_deg = -30\nmagnetic_inclination_deg = "
                    "-10\nmagnetic_strength_ut = 33\n"
                    "magnetometer_sigma_ut = 2\nbarometer_sigma_m = 3\nmap_pose_scale = 3\nrelative_pose_scale = 2");
    const double floor = (usual ? 0.05 : 1.0) * kPi / 180.0;
    const auto heading = seen.model("heading");
    for (const double yaw : {0.6, 3.0, -2.0}) {
      seen.state.nav.R_EU =
          Eigen::Quaterniond(kPlaceFrame.R_EW()) * rotation_from({.yaw_rad = yaw, .pitch_rad = 0.2, .roll_rad = 0.1});
      for (const double off : {-3.0, 0.01, 3.1})
        for (const double sigma : {0.1 * floor, 3.0 * floor}) {
          const auto m =
              heading->received(seen.view(), HeadingSample{kThen, 0.5 * kPi - yaw + off + 4.0 * kPi, sigma}, 0);
          if (!m) return {kInfinity, 1.0};
          looks.near(m->residual[0], off, 1e-13),
              looks.close(m->R(0, 0), std::pow(sigma > floor ? sigma : floor, 2), 16.0);
        }
    }
    // Nose up to what leaves a tenth of it level: 84.26 degrees.
    for (const double up_deg : {84.0, 84.5, 90.0, -84.0, -84.5}) {
      seen.state.nav.R_EU = Eigen::Quaterniond(kPlaceFrame.R_EW()) *
                            rotation_from({.yaw_rad = 1.0, .pitch_rad = up_deg * kDegree, .roll_rad = 0.0});
      looks.right(heading->received(seen.view(), HeadingSample{kThen, 0.3, 0.01}, 0).has_value() ==
                  (std::abs(up_deg) < 84.26));
    }
    const auto compass = seen.model("magnetometer");
    seen.state.nav.R_EU = Eigen::Quaterniond(kPlaceFrame.R_EW());
    const auto field = compass->received(seen.view(), MagnetometerSample{kThen, Vector3d(2e-6, -3e-6, 5e-6)}, 0);
    const double down = (usual ? 60.0 : -10.0) * kDegree, east = (usual ? 0.0 : -30.0) * kDegree,
                 strength = usual ? 50.0 : 33.0;
    looks.near((field->residual - Vector3d(2.0, -3.0, 5.0) +
                strength * Vector3d(std::cos(down) * std::sin(east), std::cos(down) * std::cos(east), -std::sin(down)))
                   .norm(),
               0.0, 1e-12);
    looks.near((field->R - (usual ? 1.0 : 4.0) * Measurement::Square::Identity(3, 3)).norm(), 0.0, 1e-14);
    const auto air = seen.model("barometer");
    const double height_m = geodetic_from_ecef(seen.state.nav.p_EU_E).h_m;
    for (const double pa : {22699.0, 22701.0, 60000.0, 101325.0, 127699.0, 127701.0}) {
      const auto m = air->received(seen.view(), BarometerSample{kThen, pa}, 0);
      looks.right(m.has_value() == (pa > 22700.0 && pa < 127700.0));
      if (m)
        looks.near(m->residual[0], standard_height_m(pa) - height_m, 1e-8),
            looks.close(m->R(0, 0), usual ? 0.25 : 9.0, 8.0);
    }
    DrawnNumbers draw(2);
    const Matrix6d P = draw.positive(6, 0.5), skewed = P + 0.1 * (draw.any(6, 6) - Matrix6d::Identity());
    PoseInMap pose{.t = kThen, .X_WB = {Eigen::Quaterniond::Identity(), {10.0, 20.0, 3.0}}, .covariance = skewed};
    const auto in_map = seen.model("map_pose")->received(seen.view(), pose, 0);
    looks.near((in_map->R - (usual ? 1.0 : 9.0) * 0.5 * (skewed + skewed.transpose())).norm(), 0.0, 1e-12);
  }
  for (const double scale : {1.0, 2.0}) {
    SeenState seen({"clone"}, scale == 1.0 ? "" : "relative_pose_scale = 2");
    seen.state.take_clone();
    DrawnNumbers draw(3);
    const Matrix6d P = draw.positive(6, 0.5);
    RelativePose moved{
        .source = kThen, .target = kThen, .X_TS = {Eigen::Quaterniond::Identity(), {0.1, -0.2, 0.3}}, .covariance = P};
    const auto model = seen.model("relative_pose");
    const auto m = model->received(seen.view(), moved, 0);
    if (!m) return {kInfinity, 1.0};
    looks.near((m->R - scale * scale * P).norm(), 0.0, 1e-12 * P.norm()),
        looks.near((m->residual.tail<3>() - Vector3d(0.1, -0.2, 0.3)).norm(), 0.0, 1e-8);
  }
  return looks.figure();
}

GnssFix some_fix(const SeenState& seen) {
  GnssFix fix;
  fix.t = kThen;
  fix.status = FixStatus::kSingle;
  fix.p_A_E = seen.state.nav.p_EU_E + Vector3d(1.0, -2.0, 0.5);
  DrawnNumbers draw(5);
  fix.covariance_E = draw.positive(3, 0.2);
  fix.covariance_E(0, 1) += 0.02;  // not quite symmetric, as of text
  return fix;
}

/// What a fix counts for by each rule, its floor, its age and its own velocity; and what a way leaves of errors that
/// last.
StressFigure fixes() {
  Looks looks;
  const struct {
    const char* keys;
    int kind;  // of what is below
  } rules[] = {{"", 0},
               {"fix_covariance = \"inflated\"", 1},
               {"fix_covariance = \"inflated\"\nfix_sigma_scale = 3", 2},
               {"fix_covariance = \"constant\"", 3},
               {"fix_covariance = \"constant\"\nfix_sigma_m = 0.7", 4},
               {"fix_covariance = \"from_dop\"", 5},
               {"fix_sigma_floor_m = 2", 6}};
  for (const auto& rule : rules) {
    SeenState seen({}, rule.keys);
    GnssFix fix = some_fix(seen);
    fix.dop.hdop = 1.4, fix.dop.vdop = 2.5;
    const Matrix3d stated = 0.5 * (fix.covariance_E + fix.covariance_E.transpose()),
                   R_EN = rotation_E_from_enu(geodetic_from_ecef(fix.p_A_E));
    Matrix3d expected = stated;
    if (rule.kind == 1) expected = 4.0 * stated;
    if (rule.kind == 2) expected = 9.0 * stated;
    if (rule.kind == 3) expected = 9.0 * Matrix3d::Identity();
    if (rule.kind == 4) expected = 0.49 * Matrix3d::Identity();
    if (rule.kind == 5) expected = 9.0 * R_EN * Vector3d(0.98, 0.98, 6.25).asDiagonal() * R_EN.transpose();
    if (rule.kind == 6)
      for (int i = 0; i < 3; ++i) expected(i, i) = stated(i, i) > 4.0 ? stated(i, i) : 4.0;
    const auto m = seen.model("position")->received(seen.view(), fix, 0);
    looks.near((m->R - expected).norm() / expected.norm(), 0.0, 1e-13);
    if (rule.kind == 5) {
      fix.dop.vdop = kNaN;
      looks.near((seen.model("position")->received(seen.view(), fix, 0)->R - stated).norm() / stated.norm(), 0.0,
                 1e-13);
    }
  }
  SeenState seen({"fix_error", "velocity_error", "time_offset"},
                 "fix_error_way_m = 40\nfix_velocity_scale = 2\nfix_velocity_floor_m_s = 0.3");
  seen.set("time_offset", Eigen::VectorXd::Constant(1, 0.02));
  seen.set("fix_error", Vector3d(0.3, -0.2, 0.1)), seen.set("velocity_error", Vector3d(0.5, 0.1, -0.4));
  GnssFix fix = some_fix(seen);
  fix.t = kThen + 0.05;
  fix.v_A_E = seen.state.nav.v_EU_E + Vector3d(0.1, 0.2, -0.3);
  DrawnNumbers draw(8);
  fix.velocity_covariance_E = 0.02 * draw.positive(3, 0.1);
  const auto position = seen.model("position"), velocity = seen.model("velocity");
  const auto p = position->received(seen.view(), fix, 0), v = velocity->received(seen.view(), fix, 0);
  if (!p || !v) return {kInfinity, 1.0};
  const FixErrorParameters lasting{.fix_error_sigma_m = 0.3, .fix_error_scale = 1.5};
  const double age = 0.07;
  const Matrix3d share = lasting.share(fix.covariance_E);
  looks.near((p->residual - (Vector3d(1.0, -2.0, 0.5) - age * seen.state.nav.v_EU_E - share * Vector3d(0.3, -0.2, 0.1)))
                 .norm(),
             0.0, 1e-8);
  looks.near((p->H.middleCols<3>(seen.state.offset("fix_error")) - share).norm(), 0.0, 1e-13);
  looks.near((p->H.col(seen.state.offset("time_offset")) - seen.state.nav.v_EU_E).norm(), 0.0, 1e-13);
  looks.right(p->motion.has_value() && p->motion->measured);
  looks.near(p->motion->speed_m_s, 8.0, 1e-12),
      looks.near((p->motion->residual_m_s - Vector3d(0.1, 0.2, -0.3)).norm(), 0.0, 1e-13);
  const Vector3d a = seen.state.nav.R_EU * seen.f + gravity_E(seen.state.nav.p_EU_E) -
                     2.0 * earth_rate_E().cross(seen.state.nav.v_EU_E);
  const Matrix3d root = VelocityErrorParameters{}.share(fix.velocity_covariance_E,
                                                        rotation_E_from_enu(geodetic_from_ecef(fix.p_A_E)).col(2));
  looks.near((v->residual - (Vector3d(0.1, 0.2, -0.3) - age * a - root * Vector3d(0.5, 0.1, -0.4))).norm(), 0.0, 1e-11);
  Matrix3d noise = 4.0 * 0.5 * (fix.velocity_covariance_E + fix.velocity_covariance_E.transpose());
  for (int i = 0; i < 3; ++i) noise(i, i) = noise(i, i) > 0.09 ? noise(i, i) : 0.09;
  looks.near((v->R - noise).norm(), 0.0, 1e-14);
  // Without a velocity there is none, and of unknown quality neither.
  GnssFix silent = fix;
  silent.velocity_covariance_E(1, 1) = kNaN;
  looks.right(!velocity->received(seen.view(), silent, 0) &&
              !position->received(seen.view(), silent, 0)->motion->measured);
  silent.v_A_E.setConstant(kNaN);
  looks.right(!velocity->received(seen.view(), silent, 0) &&
              position->received(seen.view(), silent, 0)->motion->residual_m_s.isZero(0.0));
  silent.status = FixStatus::kNone;
  looks.right(!position->received(seen.view(), silent, 0));
  SeenState plain({});
  GnssFix usual = fix;
  usual.velocity_covariance_E = 1e-6 * Matrix3d::Identity();
  looks.near((plain.model("velocity")->received(plain.view(), usual, 0)->R - 0.0025 * Matrix3d::Identity()).norm(), 0.0,
             1e-16);
  // The antenna's way between two fixes: first none, then e^(-way / 40 m); a rest changes nothing.
  looks.right(position->parts(seen.view(), fix) == 1 && position->renewed().empty());
  fix.t = fix.t + 2.5;
  position->parts(seen.view(), fix);
  looks.right(position->renewed().size() == 3);
  for (std::size_t i = 0; i < position->renewed().size(); ++i) {
    looks.right(position->renewed()[i].state == seen.state.offset("fix_error") + static_cast<int>(i));
    looks.near(position->renewed()[i].kept, std::exp(-2.5 * 8.0 / 40.0), 1e-12);
  }
  seen.state.nav.v_EU_E *= 1e-9;
  fix.t = fix.t + 2.5;
  position->parts(seen.view(), fix);
  looks.right(position->renewed().empty());
  position->parts(seen.view(), OdometerSample{});
  looks.right(position->renewed().empty());
  position->start();
  seen.state.nav.v_EU_E *= 1e9;
  fix.t = fix.t + 2.5;
  position->parts(seen.view(), fix);
  looks.right(position->renewed().empty());
  return looks.figure();
}

GnssObservation satellite(const SeenState& seen, GnssSystem system, int prn, const Vector3d& direction_W) {
  GnssObservation o;
  o.sv = {system, static_cast<std::uint8_t>(prn)};
  o.p_E = seen.state.nav.p_EU_E + 2.2e7 * (kPlaceFrame.R_EW() * direction_W.normalized());
  o.v_E = kPlaceFrame.R_EW() * Vector3d(1500.0, -2000.0, 300.0);
  o.sigma_m = 1.5;
  o.pseudorange_m = 2.2e7 + 50.0;
  o.rate_m_s = (o.p_E - seen.state.nav.p_EU_E).normalized().dot(o.v_E - seen.state.nav.v_EU_E) + 0.7;
  return o;
}

/// Pseudoranges and rates one by one: the clock set by the middle one, and again after a jump; systems with their own
/// time; what lasts by C/N0, whether that is told or not; noise by its scale; places renewed by the way.
StressFigure ranges() {
  Looks looks;
  for (const bool lasting : {false, true}) {
    const std::vector<std::string> blocks = lasting ? std::vector<std::string>{"receiver_clock", "range_errors"}
                                                    : std::vector<std::string>{"receiver_clock"};
    SeenState seen(blocks, lasting ? "range_error_slots = 4\nrange_sigma_scale = 2\nrange_rate_sigma_m_s = 0.05" : "");
    const double scale = lasting ? 2.0 : 1.0, rate_sigma = lasting ? 0.05 : 0.2;
    Eigen::VectorXd clock(5);
    clock << 3.0, -0.4, 7.0, -2.0, 5.0;
    seen.set("receiver_clock", clock);
    const auto model = seen.model("ranges");
    GnssEpoch epoch{.t = kThen, .observations = {}};
    const Vector3d ways[] = {{1.0, 0.5, 2.0}, {-1.0, 0.3, 1.0}, {0.2, -1.0, 0.7}, {0.5, 0.6, 0.1}, {-0.7, -0.7, 1.5}};
    const GnssSystem systems[] = {GnssSystem::kGps, GnssSystem::kGlonass, GnssSystem::kGalileo, GnssSystem::kBeidou,
                                  GnssSystem::kQzss};
    const double of_system[] = {0.0, 7.0, -2.0, 5.0, 0.0}, off[] = {0.0, 4.0, -6.0, 2.0, 11.0};
    for (int i = 0; i < 5; ++i) {
      epoch.observations.push_back(satellite(seen, systems[i], 10 + i, ways[i]));
      GnssObservation& o = epoch.observations.back();
      o.pseudorange_m = 2.2e7 + 900.0 + 3.0 + of_system[i] + off[i];
      o.clock_m = -30.0 * i, o.correction_m = 8.0 - 30.0 * i;  // together 8 m less
      o.cn0_dbhz = i == 3 ? kNaN : 45.0 - 6.0 * i;
    }
    const RangeErrorsParameters r;
    double set = 900.0 - 8.0 + 2.0;  // the middle of what is off: 2 m
    const auto look = [&](double shift) {
      looks.right(model->parts(seen.view(), epoch) == 10);
      for (int i = 0; i < 5; ++i) {
        const GnssObservation& o = epoch.observations[static_cast<std::size_t>(i)];
        const auto m = model->received(seen.view(), epoch, 2 * i), v = model->received(seen.view(), epoch, 2 * i + 1);
        if (!m || !v) return looks.right(false);
        const Vector3d u = (o.p_E - seen.state.nav.p_EU_E).normalized();
        const double up = u.dot(seen.state.nav.p_EU_E.normalized()),
                     cn0 = i == 3 ? 45.0 - 7.0 * (1.0 - up) : 45.0 - 6.0 * i;
        double residual = 900.0 - 8.0 + off[i] + shift - set, R = std::pow(scale * 1.5, 2);
        if (lasting) {
          residual -= r.mean_m(cn0);
          if (i < 4) residual -= r.sigma_m(cn0) * seen.state.values(seen.state.offset("range_errors") + i, 1)[0];
          if (i < 4) looks.close(m->H(0, seen.state.offset("range_errors") + i), r.sigma_m(cn0), 64.0);
          if (i == 4) R += r.sigma_m(cn0) * r.sigma_m(cn0);
        }
        looks.near(m->residual[0], residual, 3e-8), looks.close(m->R(0, 0), R, 64.0);
        looks.near(v->residual[0], 0.7 + 0.4, 1e-9);
        looks.close(v->R(0, 0), std::pow(rate_sigma * (lasting ? r.growth(cn0) : 1.0), 2), 64.0);
        const int at = seen.state.offset("receiver_clock");
        looks.right(m->H(0, at) == 1.0 && m->H(0, at + 1) == 0.0 && v->H(0, at + 1) == 1.0 && v->H(0, at) == 0.0);
        for (int s = 2; s < 5; ++s) looks.right(m->H(0, at + s) == (ClockIndex::of(o.sv.system) == s ? 1.0 : 0.0));
        looks.near((m->H.middleCols<3>(ErrorIndex::kPosition).transpose() + u).norm(), 0.0, 1e-12);
        looks.near((v->H.middleCols<3>(ErrorIndex::kVelocity).transpose() + u).norm(), 0.0, 1e-12);
      }
    };
    look(0.0);
    if (lasting) {
      looks.right(model->renewed().size() == 4);
      for (const Renewal& renewal : model->renewed()) looks.right(renewal.kept == 0.0);
      seen.set("range_errors", (Eigen::VectorXd(4) << 0.5, -1.0, 0.3, 0.2).finished());
    } else {
      looks.right(model->renewed().empty());
    }
    // Two seconds of 8 m/s of the 50 m over which echoes change.
    epoch.t = epoch.t + 2.0;
    seen.state.nav.t = epoch.t;
    look(0.0);
    if (lasting) {
      looks.right(model->renewed().size() == 4);
      for (const Renewal& renewal : model->renewed()) looks.near(renewal.kept, std::exp(-16.0 / 50.0), 1e-12);
    }
    // A kilometre is the state's to find; a jump of a millisecond is taken out.
    for (GnssObservation& o : epoch.observations) o.pseudorange_m += 2900.0;
    look(2900.0);
    for (GnssObservation& o : epoch.observations) o.pseudorange_m += 296892.458;
    set += 299792.458;
    look(299792.458);
    epoch.observations[1].sigma_m = 0.0;
    looks.right(!model->received(seen.view(), epoch, 2) && model->received(seen.view(), epoch, 3));
    model->start();
    set = 900.0 - 8.0 + 2.0 + 299792.458;
    epoch.observations[1].sigma_m = 1.5;
    look(299792.458);
  }
  return looks.figure();
}

/// A place of the unit's own: points of a body that turns, from where it stands, and lever arms that are estimated.
StressFigure levers() {
  Looks looks;
  SeenState seen({"antenna_lever", "mounting", "hard_iron", "barometer_bias"});
  seen.lever_U = Vector3d(0.3, -0.2, 0.9), seen.lever_A = Vector3d(-1.0, 0.4, 1.6), seen.w = Vector3d(0.1, 0.3, -0.4);
  const Vector3d lever(0.05, -0.1, 0.2), mount(0.03, -0.02, 0.05);
  seen.set("antenna_lever", lever), seen.set("mounting", mount);
  seen.set("hard_iron", Vector3d(1.0, -2.0, 3.0)), seen.set("barometer_bias", Eigen::VectorXd::Constant(1, 12.0));
  const NavState& nav = seen.state.nav;
  const Vector3d arm = so3_exp(mount) * (seen.lever_A + lever - seen.lever_U);
  GnssFix fix = some_fix(seen);
  fix.v_A_E = Vector3d::Zero(), fix.velocity_covariance_E = Matrix3d::Identity();
  looks.near(
      (seen.model("position")->received(seen.view(), fix, 0)->residual - (fix.p_A_E - nav.p_EU_E - nav.R_EU * arm))
          .norm(),
      0.0, 1e-8);
  looks.near(
      (seen.model("velocity")->received(seen.view(), fix, 0)->residual + nav.v_EU_E + nav.R_EU * seen.w.cross(arm))
          .norm(),
      0.0, 1e-12);
  const auto compass =
      seen.model("magnetometer")->received(seen.view(), MagnetometerSample{kThen, Vector3d::Zero()}, 0);
  const Vector3d field_U = nav.R_EU.conjugate() * (kPlaceFrame.R_EW() * Vector3d(0.0, 25.0, -50.0 * std::sqrt(0.75)));
  looks.near((compass->residual + field_U + Vector3d(1.0, -2.0, 3.0)).norm(), 0.0, 1e-12);
  const auto air = seen.model("barometer")->received(seen.view(), BarometerSample{kThen, 90000.0}, 0);
  looks.near(air->residual[0], standard_height_m(90000.0) - geodetic_from_ecef(nav.p_EU_E).h_m - 12.0, 1e-8);
  // Heading is that of the body, not of the unit.
  const Matrix3d R_NB =
      kPlaceFrame.R_EW().transpose() * nav.R_EU.toRotationMatrix() * so3_exp(mount).toRotationMatrix();
  const auto heading = seen.model("heading")->received(seen.view(), HeadingSample{kThen, 0.0, 0.01}, 0);
  looks.near(std::remainder(heading->residual[0] + std::atan2(R_NB(0, 0), R_NB(1, 0)), 2.0 * kPi), 0.0, 1e-13);
  // And the axle's speed is along its axes.
  const auto axle_m = seen.model("non_holonomic");
  std::optional<Measurement> m;
  for (int k = 0; k < 20 && !m; ++k)
    m = axle_m->stepped(seen.view(), {.dt_s = 0.01, .dtheta_U = Vector3d::Zero(), .dv_U = Vector3d::Zero()});
  const Vector3d v_U = nav.R_EU.conjugate() * nav.v_EU_E + seen.w.cross(so3_exp(mount) * Vector3d(-seen.lever_U));
  looks.near((m->residual + (so3_exp(mount).conjugate() * v_U).tail<2>()).norm(), 0.0, 1e-13);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> measurement_model_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "rows of measurements over several messages",
           "a mean that goes on, a limit of another unit, a floor that is a ceiling",
           "when they measure and what they state, by hand: roundings", "of the bound"});
  rows.add("measurement_models/wheel_speeds", wheel_speeds)
      .add("measurement_models/axle", axle)
      .add("measurement_models/standing", standing);
  rows.add("measurement_models/single_readings", single_readings).add("measurement_models/fixes", fixes);
  rows.add("measurement_models/ranges", ranges).add("measurement_models/levers", levers);
  return rows.take();
}

}  // namespace canyon::fusion

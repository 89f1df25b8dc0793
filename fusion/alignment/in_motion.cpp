#include <cmath>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/fusion/alignment/alignment.h"

namespace canyon::fusion {
namespace {

struct InMotionStart {
  double in_motion_speed_m_s = 3.0;
  double in_motion_level_s = 2.0;
  double in_motion_slip_deg = 2.0;
};
void visit(FieldVisitor& f, InMotionStart& p) {
  f.number("in_motion_speed_m_s", p.in_motion_speed_m_s, {0.1, 1000}, "in_motion: how fast the fixes must move");
  f.number("in_motion_level_s", p.in_motion_level_s, {0.1, 60},
           "in_motion: seconds before, over which force and change of velocity are compared");
  f.number("in_motion_slip_deg", p.in_motion_slip_deg, {1e-3, 90}, "in_motion: 1-sigma of the nose against the course");
}

/// Fixes between which positions are taken for a velocity: not farther apart, s.
constexpr double kLongestStep_s = 2.5;

struct FixVelocity {
  const GnssFix* fix = nullptr;  ///< the later one
  GpsTime t;                     ///< whose velocity it is
  Eigen::Vector3d v_E = Eigen::Vector3d::Zero();
  double sigma_m_s = 0.0;  ///< per axis
};

bool usable(const GnssFix& fix) {
  return fix.status != FixStatus::kNone && fix.p_A_E.allFinite() && fix.covariance_E.allFinite();
}
double sigma(const Eigen::Matrix3d& covariance) {
  return std::sqrt(covariance.diagonal().maxCoeff());
}

/// The receiver's own, else the mean between two fixes, which is that of the middle.
std::vector<FixVelocity> velocities(std::span<const GnssFix> fixes) {
  std::vector<FixVelocity> out;
  const GnssFix* before = nullptr;
  for (const GnssFix& fix : fixes) {
    if (!usable(fix)) continue;
    if (fix.v_A_E.allFinite()) {
      const bool stated = fix.velocity_covariance_E.allFinite();
      out.push_back({&fix, fix.t, fix.v_A_E, stated ? sigma(fix.velocity_covariance_E) : 0.2});
    } else if (before != nullptr && fix.t - before->t <= kLongestStep_s) {
      const double step_s = fix.t - before->t;
      out.push_back({&fix, before->t + 0.5 * step_s, (fix.p_A_E - before->p_A_E) / step_s,
                     std::hypot(sigma(fix.covariance_E), sigma(before->covariance_E)) / step_s});
    }
    before = &fix;
  }
  return out;
}

/// Velocity change by force between two instants, in U as it stands at the second one; the gyroscope carries it there.
struct ForceSum {
  Eigen::Vector3d dv_end_U = Eigen::Vector3d::Zero();
  double span_s = 0.0;
};
ForceSum force_between(std::span<const ImuSample> imu, GpsTime from, GpsTime to) {
  ForceSum out;
  for (const ImuSample& sample : imu) {
    if (sample.t <= from) continue;
    if (sample.t - sample.dt_s >= to) break;
    out.dv_end_U = so3_exp(-sample.dtheta_U) * out.dv_end_U + sample.dv_U;
    out.span_s += sample.dt_s;
  }
  return out;
}

double told_bias_sigma(const TriadNoise& noise) {
  return std::hypot(noise.turn_on_bias_sigma, noise.in_run_bias_sigma);
}

Aligned aligned_at(const FixVelocity& first, const FixVelocity& last, const ForceSum& force, const InMotionStart& p,
                   const AlignmentInputs& inputs) {
  const GnssFix& fix = *last.fix;
  const double between_s = last.t - first.t;
  const Eigen::Vector3d acceleration = (last.v_E - first.v_E) / between_s, gravity = gravity_E(fix.p_A_E);
  const Eigen::Vector3d v_enu = rotation_E_from_enu(geodetic_from_ecef(fix.p_A_E)).transpose() * last.v_E;
  Aligned out;
  out.nav.t = fix.t;
  out.nav.R_EU =
      attitude_from_force(fix.p_A_E, force.dv_end_U, acceleration - gravity, std::atan2(v_enu.x(), v_enu.y()));
  out.nav.p_EU_E = fix.p_A_E + out.nav.R_EU * (inputs.lever_U_B - inputs.lever_A_B);
  out.nav.v_EU_E = last.v_E + acceleration * (fix.t - last.t);
  const double a_sigma = std::hypot(first.sigma_m_s, last.sigma_m_s) / between_s;
  const double turned = told_bias_sigma(inputs.noise.gyro) * between_s;
  out.tilt_rad = std::hypot(a_sigma / gravity.norm(), told_bias_sigma(inputs.noise.accel) / gravity.norm(), turned);
  out.heading_rad = std::hypot(last.sigma_m_s / v_enu.head<2>().norm(), p.in_motion_slip_deg * kDegree);
  out.position_m = sigma(fix.covariance_E) + out.tilt_rad * (inputs.lever_U_B - inputs.lever_A_B).norm();
  out.velocity_m_s = std::hypot(last.sigma_m_s, a_sigma * (fix.t - last.t));
  return out;
}

}  // namespace

/// At the first fix by which the antenna moves fast enough. Roll and pitch are those that make of the mean force what
/// gravity and the change of velocity ask for; the nose points along the course. A vehicle that begins in reverse is
/// taken for one that drives ahead. Sideslip, wind or a climb in which the nose does not follow the course are what
/// in_motion_slip_deg is for.
Result<Aligned> align_in_motion(const ModelParameters& own, const AlignmentInputs& inputs) {
  const InMotionStart& p = own.get<InMotionStart>();
  const std::vector<FixVelocity> moving = velocities(inputs.fixes);
  const GpsTime begin = inputs.imu.front().t - inputs.imu.front().dt_s;
  double fastest = 0.0;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const Eigen::Matrix3d R_enu = rotation_E_from_enu(geodetic_from_ecef(moving[i].fix->p_A_E));
    const double speed = (R_enu.transpose() * moving[i].v_E).head<2>().norm();
    if (moving[i].fix->t <= begin || moving[i].fix->t > inputs.imu.back().t) continue;
    fastest = std::max(fastest, speed);
    if (speed < p.in_motion_speed_m_s) continue;
    std::size_t first = i;
    while (first > 0 && moving[first - 1].t >= begin && moving[i].t - moving[first].t < p.in_motion_level_s) --first;
    if (first == i || moving[i].t - moving[first].t < 0.5 * p.in_motion_level_s) continue;
    const ForceSum force = force_between(inputs.imu, moving[first].t, moving[i].t);
    if (force.span_s < 0.5 * (moving[i].t - moving[first].t) || force.dv_end_U.norm() == 0.0) continue;
    return aligned_at(moving[first], moving[i], force, p, inputs);
  }
  char text[120];
  std::snprintf(text, sizeof text, "the fixes within the log never move faster than %.2f m/s", fastest);
  return Error{"", 0, "start.in_motion_speed_m_s", text, "a lower limit, or another row of start.from"};
}

void in_motion_parameters(ModelParameters& section) {
  section.add<InMotionStart>();
}

}  // namespace canyon::fusion

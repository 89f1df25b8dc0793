#include <cmath>
#include <optional>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/fusion/alignment/alignment.h"

namespace canyon::fusion {
namespace {

struct StaticStart {
  double static_s = 10.0;
  std::optional<double> static_heading_deg;
  double static_heading_sigma_deg = 1.0;
  double static_velocity_sigma_m_s = 0.02;
};
void visit(FieldVisitor& f, StaticStart& p) {
  f.number("static_s", p.static_s, {0.1, 1e5}, "static: seconds from the log's beginning that are taken for levelling");
  f.optional_number("static_heading_deg", p.static_heading_deg, -1000, {-360, 360},
                    "static: heading from true north; -1000: not known");
  f.number("static_heading_sigma_deg", p.static_heading_sigma_deg, {1e-6, 180}, "static: 1-sigma of that heading");
  f.number("static_velocity_sigma_m_s", p.static_velocity_sigma_m_s, {1e-6, 10}, "static: 1-sigma of the velocity");
}

/// Up to here a heading found by the Earth's rate is better than none: beyond, the filter is linear about nothing.
constexpr double kWorstGyrocompass_rad = 20.0 * kDegree;

double bias_sigma(const TriadNoise& noise) {
  return std::hypot(noise.turn_on_bias_sigma, noise.in_run_bias_sigma);
}

/// The mean over the first seconds.
struct Rest {
  GpsTime until;
  double span_s = 0.0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
};
Rest rest_of(std::span<const ImuSample> imu, double seconds) {
  Rest out;
  for (const ImuSample& sample : imu) {
    if (sample.t - imu.front().t > seconds && out.span_s > 0.0) break;
    out.until = sample.t;
    out.span_s += sample.dt_s;
    out.force += sample.dv_U;
    out.rate += sample.dtheta_U;
  }
  out.force /= out.span_s;
  out.rate /= out.span_s;
  return out;
}

/// Mean place of the antenna over the fixes at rest, else the first fix; nullopt: none. `spread_m`: between them.
struct MeanFix {
  Eigen::Vector3d p_E = Eigen::Vector3d::Zero();
  double sigma_m = 0.0, moved_m = 0.0;
};
std::optional<MeanFix> mean_fix(std::span<const GnssFix> fixes, GpsTime until) {
  MeanFix out;
  int count = 0;
  const GnssFix* first = nullptr;
  for (const GnssFix& fix : fixes) {
    if (fix.status == FixStatus::kNone) continue;
    if (fix.t > until && count > 0) break;
    if (first == nullptr) first = &fix;
    out.p_E += fix.p_A_E;
    out.sigma_m = std::max(out.sigma_m, std::sqrt(fix.covariance_E.diagonal().maxCoeff()));
    out.moved_m = std::max(out.moved_m, (fix.p_A_E - first->p_A_E).norm());
    ++count;
  }
  if (count == 0) return std::nullopt;
  out.p_E /= count;
  return out;
}

}  // namespace

/// Levelled with the mean force; the tilt is as good as the accelerometers' biases and noise let it be. The heading is
/// the one given; else that of the horizontal part of the Earth's rate as the gyroscopes see it, if their biases leave
/// it better than 20 degrees; else unknown, pi. The place is that of the fixes meanwhile (errors of fixes last, so
/// their mean counts as no better than one), the velocity zero. An Error where the fixes say that it moved by more than
/// six sigma and a metre.
Result<Aligned> align_static(const ModelParameters& own, const AlignmentInputs& inputs) {
  const StaticStart& p = own.get<StaticStart>();
  const Rest rest = rest_of(inputs.imu, p.static_s);
  const auto fix = mean_fix(inputs.fixes, rest.until);
  if (!fix) return Error{"", 0, "start.from", "no fix to start from", "a log of fixes, or start.from = \"given\""};
  if (fix->moved_m > 1.0 + 6.0 * fix->sigma_m)
    return Error{"", 0, "start.from", "the antenna moved during the first static_s seconds",
                 "a log that begins at rest, a shorter static_s, or \"in_motion\""};
  const Eigen::Vector3d up_force = -gravity_E(fix->p_E);
  const TriadNoise &gyro = inputs.noise.gyro, &accel = inputs.noise.accel;
  Aligned out;
  out.tilt_rad = std::hypot(bias_sigma(accel), accel.white_per_sqrt_hz / std::sqrt(rest.span_s)) / up_force.norm();

  double heading = 0.0;
  const Geodetic at = geodetic_from_ecef(fix->p_E);
  const double horizontal_rate = Wgs84::rate_rad_s * std::cos(at.lat_rad);
  const double compass =
      std::hypot(bias_sigma(gyro), gyro.white_per_sqrt_hz / std::sqrt(rest.span_s)) / horizontal_rate;
  if (p.static_heading_deg) {
    heading = *p.static_heading_deg * kDegree;
    out.heading_rad = p.static_heading_sigma_deg * kDegree;
  } else if (compass < kWorstGyrocompass_rad) {
    // Levelled towards north, the Earth's rate has no part east: what it has there is the heading.
    const Eigen::Vector3d w_enu =
        rotation_E_from_enu(at).transpose() * (attitude_from_force(fix->p_E, rest.force, up_force, 0.0) * rest.rate);
    heading = std::atan2(w_enu.x(), w_enu.y());
    heading = -heading;
    out.heading_rad = compass;
  } else {
    out.heading_rad = kPi;
  }
  out.nav.t = rest.until;
  out.nav.R_EU = attitude_from_force(fix->p_E, rest.force, up_force, heading);
  const Eigen::Vector3d arm = inputs.lever_U_B - inputs.lever_A_B;
  out.nav.p_EU_E = fix->p_E + out.nav.R_EU * arm;
  out.position_m = std::hypot(fix->sigma_m, std::min(2.0, out.heading_rad) * arm.norm());
  out.velocity_m_s = p.static_velocity_sigma_m_s;
  return out;
}

void static_parameters(ModelParameters& section) {
  section.add<StaticStart>();
}

}  // namespace canyon::fusion

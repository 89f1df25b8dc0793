#include "canyon/fusion/dead_reckoning.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/process/progress.h"

namespace canyon::fusion {
namespace {

constexpr std::size_t kStatesPerLook = 4096;  // at whether the user wants to stop: some 10 ms
constexpr double kStampRounding_s = 2e-9;     // a stamp and an interval's end, each rounded to 1 ns

void check_sample(const ImuSample& s, GpsTime last) {
  const bool finite = std::isfinite(s.dt_s) && s.dt_s > 0.0 && s.dtheta_U.allFinite() && s.dv_U.allFinite();
  CANYON_CHECK(finite, "IMU sample at ", s.t.iso(), ": dt_s = ", s.dt_s, ", dtheta = ", s.dtheta_U.transpose(),
               ", dv = ", s.dv_U.transpose());
  CANYON_CHECK(s.t > last, "IMU sample at ", s.t.iso(9), " after one at ", last.iso(9));
}

}  // namespace

std::vector<NavState> dead_reckon(std::span<const ImuSample> samples, const NavState& initial, Strapdown& strapdown) {
  strapdown.reset();
  NavState state = initial;
  std::vector<NavState> states = {initial};
  GpsTime last{std::numeric_limits<std::int64_t>::min()};
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k % kStatesPerLook == 0) throw_if_cancelled();
    const ImuSample& s = samples[k];
    check_sample(s, last);
    const double since_last_s = k > 0 ? s.t - last : s.dt_s;
    const bool contiguous = std::abs(since_last_s - s.dt_s) <= 0.5 * s.dt_s;
    if (!contiguous) strapdown.reset();
    last = s.t;
    Increments in{.dt_s = s.dt_s, .dtheta_U = s.dtheta_U, .dv_U = s.dv_U};
    if (s.t <= initial.t) {
      NavState scratch = initial;
      strapdown.advance(scratch, in);
      continue;
    }
    const double elapsed_s = s.t - state.t;
    // Where the start lies within the sample's interval, only what is after it counts.
    const bool begun_before = states.size() == 1 && s.dt_s - elapsed_s > kStampRounding_s;
    if (begun_before || std::abs(elapsed_s - s.dt_s) > 0.5 * s.dt_s) {
      const double scale = elapsed_s / s.dt_s;
      in = {.dt_s = elapsed_s, .dtheta_U = scale * s.dtheta_U, .dv_U = scale * s.dv_U};
    }
    strapdown.advance(state, in);
    state.t = s.t;
    states.push_back(state);
  }
  return states;
}

NavState levelled(const Geodetic& at, double heading_rad, const Eigen::Vector3d& force_U) {
  const YawPitchRoll attitude{.yaw_rad = yaw_from_heading(heading_rad),
                              .pitch_rad = std::atan2(-force_U.x(), std::hypot(force_U.y(), force_U.z())),
                              .roll_rad = std::atan2(force_U.y(), force_U.z())};
  NavState state;
  state.R_EU = (Eigen::Quaterniond(rotation_E_from_enu(at)) * rotation_from(attitude)).normalized();
  state.p_EU_E = ecef_from_geodetic(at);
  // Above the ellipsoid gravity leans against its normal, by 8e-10 rad per metre: 3 mm after a minute at 200 m.
  state.R_EU =
      (Eigen::Quaterniond::FromTwoVectors(state.R_EU * force_U, -gravity_E(state.p_EU_E)) * state.R_EU).normalized();
  return state;
}

NavState interpolate(const NavState& a, const NavState& b, GpsTime t) {
  const double h = b.t - a.t, u = (t - a.t) / h;
  NavState out;
  out.t = t;
  const double u2 = u * u, u3 = u2 * u;
  out.p_EU_E = a.p_EU_E + (3.0 * u2 - 2.0 * u3) * (b.p_EU_E - a.p_EU_E) +
               h * ((u3 - 2.0 * u2 + u) * a.v_EU_E + (u3 - u2) * b.v_EU_E);
  out.v_EU_E = a.v_EU_E + u * (b.v_EU_E - a.v_EU_E);
  out.R_EU = a.R_EU.slerp(u, b.R_EU);
  return out;
}

std::vector<NavError> navigation_errors(std::span<const NavState> estimate, std::span<const NavState> reference) {
  std::vector<NavError> errors;
  std::size_t next = 0;
  for (std::size_t k = 0; k < reference.size(); ++k) {
    if (k % kStatesPerLook == 0) throw_if_cancelled();
    const NavState& truth = reference[k];
    while (next < estimate.size() && estimate[next].t < truth.t) ++next;
    if (next == estimate.size()) break;
    if (next == 0 && estimate[0].t != truth.t) continue;
    const NavState here =
        estimate[next].t == truth.t ? estimate[next] : interpolate(estimate[next - 1], estimate[next], truth.t);
    const Eigen::Matrix3d R_enu_E = rotation_E_from_enu(geodetic_from_ecef(truth.p_EU_E)).transpose();
    errors.push_back({truth.t, R_enu_E * (here.p_EU_E - truth.p_EU_E), R_enu_E * (here.v_EU_E - truth.v_EU_E),
                      so3_log(truth.R_EU.conjugate() * here.R_EU)});
  }
  return errors;
}

NavErrorStatistics navigation_error_statistics(std::span<const NavError> errors) {
  NavErrorStatistics s;
  s.position_rms_enu_m = s.velocity_rms_enu_m_s = s.attitude_rms_rad = Eigen::Vector3d::Constant(kNaN);
  if (errors.size() < 2) return s;
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), velocity = position, attitude = position;
  for (const NavError& e : errors.subspan(1)) {
    position += e.position_enu_m.cwiseAbs2();
    velocity += e.velocity_enu_m_s.cwiseAbs2();
    attitude += e.attitude_rad.cwiseAbs2();
  }
  const double n = static_cast<double>(errors.size() - 1);
  s.position_rms_enu_m = (position / n).cwiseSqrt();
  s.velocity_rms_enu_m_s = (velocity / n).cwiseSqrt();
  s.attitude_rms_rad = (attitude / n).cwiseSqrt();
  s.position_rms_m = s.position_rms_enu_m.norm();
  s.final_error_m = errors.back().position_enu_m.norm();
  s.final_horizontal_m = errors.back().position_enu_m.head<2>().norm();
  return s;
}

}  // namespace canyon::fusion

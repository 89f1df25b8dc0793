#include "canyon/fusion/strapdown/strapdown_omissions.h"

#include <cmath>
#include <cstdio>

#include <Eigen/Geometry>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"

namespace canyon::fusion {
namespace {

// Of attitudes in double precision, normalized step by step: 1e6 of them.
constexpr double kRounding_rad = 1e-9;
constexpr double kDegPerHour = kDegree / 3600.0;

}  // namespace

StrapdownOmissions strapdown_omissions_of(const std::vector<Need>& needs) {
  StrapdownOmissions out;
  for (const Need& need : needs) {
    const bool left_out = need.verdict == Verdict::kNotNeeded;
    out.coning = out.coning || (left_out && need.effect == kConing);
    out.earth_rate = out.earth_rate || (left_out && need.effect == kEarthRate);
  }
  return out;
}

Need strapdown_need(const StrapdownEffect& effect, double turned_rad, double time_s, const ImuNoise& noise) {
  const double deg_per_hour = (turned_rad + kRounding_rad) / time_s / kDegPerHour;
  const double white = noise.gyro.white_per_sqrt_hz / std::sqrt(time_s) / kDegPerHour;
  char reason[160];
  std::snprintf(reason, sizeof reason,
                "turns the attitude by %.2g deg/h at most, the gyroscopes' noise by %.2g (1-sigma)", deg_per_hour,
                white);
  return {.effect = effect.name,
          .verdict = Verdict::kNotNeeded,
          .bound = deg_per_hour,
          .bound_unit = "deg/h",
          .reason = reason};
}

StepMove earth_rate_of(const StrapdownStep& step) {
  const Eigen::Vector3d rate = earth_rate_E();
  StepMove move;
  move.theta_U = -step.dt_s * (step.R_EU.transpose() * rate);
  move.v_E = -step.dt_s * rate.cross(2.0 * step.v_EU_E + 0.5 * (step.R_EU * step.dv_U));
  move.p_E = 0.5 * step.dt_s * move.v_E;
  return move;
}

std::span<const StrapdownEffect> earth_rate_alone() {
  static constexpr StrapdownEffect kEffects[] = {{kEarthRate, earth_rate_of}};
  return kEffects;
}

}  // namespace canyon::fusion

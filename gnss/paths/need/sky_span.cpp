#include "canyon/gnss/paths/need/sky_span.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"

namespace canyon::gnss {

namespace {

constexpr double kNearestSatellite_m = 1.8e7;  // GLONASS at the zenith stands 1.91e7 m away
constexpr double kRounding_rad = 1e-6;

double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return 2.0 * std::asin(std::min(1.0, 0.5 * (a - b).norm()));
}

}  // namespace

std::optional<std::size_t> SkySpan::through(const Ball& from, const Ball& at, std::size_t first) const {
  const Eigen::Vector3d v = at.center_W - from.center_W;
  const double distance_m = v.norm(), reach_m = at.radius_m + from.radius_m;
  if (first >= directions.size()) return std::nullopt;
  if (distance_m <= reach_m) return first;
  const double wide_rad = std::asin(reach_m / distance_m) + spread_rad;
  const double least = wide_rad < kPi ? std::cos(wide_rad) * distance_m : -distance_m;
  for (std::size_t i = first; i < directions.size(); ++i)
    if (v.dot(directions[i].s_W) >= least) return i;
  return std::nullopt;
}

SkySpan sky_span(const Constellation& constellation, const LocalFrame& frame, GpsTime start, GpsTime end,
                 const Ball& place, double mask_rad) {
  CANYON_CHECK(start <= end && place.radius_m <= 1e5, "start ", start.iso(), ", end ", end.iso(),
               ", radius_m = ", place.radius_m);
  const Eigen::Vector3d p_E = frame.to_E(place.center_W);
  // Verticals differ over the place, and W's own from those at its end.
  const double tilt_rad = (place.center_W.norm() + place.radius_m) / 6.3e6;
  const double parallax_rad = place.radius_m / kNearestSatellite_m + kRounding_rad;
  const double steps = std::max(1.0, std::ceil((end - start) / kSkyStep_s));
  const double step_s = (end - start) / steps;
  SkySpan span;
  std::vector<SkySpan::Direction> all;
  for (const SatelliteId sv : constellation.satellites()) {
    bool has_last = false;
    Eigen::Vector3d last_W = Eigen::Vector3d::Zero();
    for (int k = 0; k <= static_cast<int>(steps); ++k) {
      const auto signal = transmission_to(constellation, sv, start + k * step_s, p_E);
      if (!signal) {
        has_last = false;
        continue;
      }
      const Eigen::Vector3d s_W = frame.R_EW().transpose() * (signal->p_E() - p_E).normalized();
      if (has_last && std::max(s_W.z(), last_W.z()) > -0.1)
        span.spread_rad = std::max(span.spread_rad, angle_rad(s_W, last_W));
      has_last = true;
      last_W = s_W;
      all.push_back({sv, s_W});
    }
  }
  span.spread_rad += parallax_rad;
  const double received_rad = mask_rad - tilt_rad;
  span.lowest_rad = 0.5 * kPi;
  for (const auto& direction : all) {
    const double elevation_rad = std::asin(std::clamp(direction.s_W.z(), -1.0, 1.0));
    if (elevation_rad < received_rad - span.spread_rad) continue;
    span.directions.push_back(direction);
    span.lowest_rad = std::min(span.lowest_rad, std::max(received_rad, elevation_rad - span.spread_rad));
  }
  return span;
}

}  // namespace canyon::gnss

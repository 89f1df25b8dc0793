#include "canyon/gnss/sensor/sensor_need.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/need/path_question.h"

namespace canyon::gnss {

namespace {

bool not_needed(const std::vector<Need>& needs, const char* effect) {
  return std::any_of(needs.begin(), needs.end(),
                     [&](const Need& need) { return need.effect == effect && need.verdict == Verdict::kNotNeeded; });
}

bool stated(const std::vector<Need>& needs, const char* effect) {
  return std::any_of(needs.begin(), needs.end(), [&](const Need& need) { return need.effect == effect; });
}

Need does_not_say(const std::string& model) {
  return {.effect = model, .reason = "the model does not say"};
}

}  // namespace

Result<GnssSurroundings> GnssSurroundings::make(const GnssConfig& config, const scene::Scene& scene,
                                                const std::vector<scene::SweptRoom>& moving, GpsTime start, GpsTime end,
                                                const std::vector<RouteSegment>& route) {
  CANYON_TRY(const SatelliteSource source, make_satellite_source(config.satellites, start, end));
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e30), high = -low;
  double wide_m = config.lever_arm_m.norm();
  for (const RouteSegment& segment : route) {
    wide_m = std::max(wide_m, config.lever_arm_m.norm() + segment.half_width_m);
    for (Eigen::Vector3d p : segment.points_W) {
      for (const double z : {segment.low_m, segment.high_m}) {
        p.z() = z;
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
  }
  const Ball place{0.5 * (low + high), 0.5 * (high - low).norm() + 2.0 * wide_m};
  return GnssSurroundings{scene,
                          sky_span(*source.constellation, scene.frame(), start, end, place, config.mask_deg * kDegree),
                          ObstacleHeights(scene, moving), start, low.z()};
}

std::vector<Need> gnss_needs(const GnssConfig& config, const GnssSurroundings& around, const RouteSegment& segment) {
  const auto& row = model_row(sensor_models(), config.model.name);
  if (row.make.need == nullptr) return {does_not_say(config.model.name)};
  return row.make.need->places(config, around, segment);
}

std::vector<Need> gnss_range_needs(const GnssConfig& config, const GnssSurroundings& around) {
  const auto& row = model_row(sensor_models(), config.model.name);
  return row.make.need != nullptr ? row.make.need->ranges(config, around) : std::vector<Need>{};
}

std::vector<Need> pseudorange_path_needs(const GnssConfig& config, const GnssSurroundings& around,
                                         const RouteSegment& segment) {
  const Eigen::Vector3d& lever = config.lever_arm_m;
  const PathQuestion question{
      .segment = segment,
      .antenna_reach_m = lever.norm(),
      .antenna_above_m = std::min(lever.z(), lever.z() * std::cos(RouteSegment::kMostTilt_rad)) -
                         lever.head<2>().norm() * std::sin(RouteSegment::kMostTilt_rad),
      .scene = around.scene,
      .sky = around.sky,
      .heights = around.heights,
      .limits = path_limits(config)};
  std::vector<Need> needs;
  const auto ask = [&](const auto& rows, const std::string& name) {
    const auto& row = model_row(rows, name);
    if (row.make.need == nullptr) {
      needs.push_back(does_not_say(name));
      return;
    }
    for (Need& need : row.make.need(question)) needs.push_back(std::move(need));
  };
  ask(path_models(), config.propagation.paths.name);
  ask(diffraction_models(), config.propagation.diffraction.name);
  ask(scatter_models(), config.propagation.scatter.name);
  ask(clutter_models(), config.propagation.clutter.name);
  return needs;
}

PathOmissions omissions_of(const std::vector<Need>& needs) {
  PathOmissions out;
  out.occlusion = not_needed(needs, kOcclusion);
  out.foliage = not_needed(needs, kFoliage);
  out.diffraction = not_needed(needs, kDiffraction);
  // As many walls as the longest way that may matter has; nothing is said of more than the model looks for.
  for (int k = 3; k >= 1; --k) {
    if (!stated(needs, kReflections[k - 1])) continue;
    if (!not_needed(needs, kReflections[k - 1])) break;
    out.most_reflections = k - 1;
  }
  return out;
}

PathParameters path_limits(const GnssConfig& config) {
  PathParameters p;
  p.weakest_nlos_db = config.locks.tracking_threshold_dbhz - config.link.cn0_zenith_dbhz;
  p.weakest_db = std::min(p.weakest_db, p.weakest_nlos_db);
  return with_borders(config.propagation, std::move(p));
}

}  // namespace canyon::gnss

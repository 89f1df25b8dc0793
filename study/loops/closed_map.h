#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/output/json.h"
#include "canyon/fusion/smoothing/pose_graph/pose_graph.h"
#include "canyon/lidar/loops/loop_closures.h"
#include "canyon/lidar/map_quality/map_error.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::study {

/// A closure, what the graph made of it, and what it was in truth.
struct JudgedClosure {
  lidar::ClosureTrial trial;
  double weight = 0.0;                  ///< of its residual in the graph; 0: it does not close
  double off_m = kNaN, off_deg = kNaN;  ///< X_TS against the true one; NaN: it does not close
  bool beyond_bound = false;            ///< so far off lies outside of its own 99.9 % ellipsoid
};

/// Places of the keyframes, and the map that they make.
struct PlacedMap {
  const char* name = "";  ///< "prior", "registered", "smoothed", "closed"
  double keyframe_rms_m = kNaN, keyframe_rms_deg = kNaN;
  lidar::MapQuality map;
};

struct ClosedMap {
  std::string mission, fidelity;
  std::int64_t seed = 0;
  std::size_t keyframes = 0;
  double way_m = 0.0;
  std::vector<JudgedClosure> closures;
  std::array<PlacedMap, 4> placed;
  fusion::PoseGraphReport graph;
  Trajectory X_WL_closed;  ///< of the keyframes' LIDAR
};

/// One run, and after it a graph of its keyframes: what the filter says of each (its errors last, so a keyframe has
/// [registration] prior_correlation_s of it, as the map's own weights have), how each lies to the one before by its
/// alignment, and how those that come by an earlier place lie to that. "smoothed" is the graph without these. The run
/// itself knows nothing of it: closing loops looks back. `tape`: open loop; null: the run drives by itself. Holds all
/// keyframes' scans, 12 bytes a point. Same bits for any number of threads.
/// Errors: as of the run; [registration] method = "none"; a build without Ceres.
Result<ClosedMap> make_closed_map(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                  const Tape* tape, const std::string& fidelity, const lidar::ClosureOptions& options,
                                  bool show_progress);

Json closed_map_json(const ClosedMap& closed);
std::string closed_map_table(const ClosedMap& closed);

}  // namespace canyon::study

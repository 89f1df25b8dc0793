#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "canyon/lidar/registration/registration.h"

namespace canyon::lidar {

/// A keyframe of a map that is done: its cloud, where the map has it, and what the map knows of that.
struct MappedCloud {
  std::shared_ptr<const PreparedCloud> cloud;
  Pose X_WL;
  Matrix6d covariance;  ///< of its xi, [rotation; translation] in L
};

/// Where a place is taken for one seen before, and what an alignment there must show.
struct ClosureOptions {
  double within_m = 10.0;           ///< of one another, as the map has them
  double least_way_m = 50.0;        ///< driven between the two: what is nearer the map's own alignments have told
  std::int64_t around = 3;          ///< keyframes before and after the earlier one that are aligned to with it
  double apart_m = 4.0;             ///< driven from one keyframe that looks back to the next
  double least_overlap = 0.5;       ///< share of the later one's points that are matched
  double alignment_floor_m = 0.02;  ///< 1-sigma per axis, as of [registration]
  double alignment_floor_deg = 0.05;
};

/// A keyframe aligned to a place of earlier ones.
struct ClosureTrial {
  std::size_t source, target;  ///< later, earlier
  RegistrationStatus status = RegistrationStatus::kNotConverged;
  double overlap = kNaN;
  std::size_t open = 0;  ///< directions that the surfaces leave open: there the covariance is wide, and the rest closes
  bool closes = false;   ///< converged, with overlap enough, and tells something
  Pose X_TS;             ///< by the surfaces alone; valid if it closes
  Matrix6d covariance;   ///< of its xi, floor included
};

/// Each keyframe that comes by an earlier place, aligned to the nearest one there. The guess is where the map has both,
/// with both covariances, as if the two had nothing in common: two errors of one map have much in common, so this is on
/// the safe side. In the order of their sources; the same for any number of threads. Keyframes in the order of time.
std::vector<ClosureTrial> find_closures(const Registration& registration, std::span<const MappedCloud> keyframes,
                                        const ClosureOptions& options);

}  // namespace canyon::lidar

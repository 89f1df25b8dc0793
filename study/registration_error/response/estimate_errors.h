#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/model_table.h"

namespace canyon::study {

/// Where an error is laid on the true pose of B at a keyframe.
struct ErrorLaid {
  GpsTime t;
  Pose X_WB_true;
  std::function<Pose(GpsTime)> true_pose;                  ///< at other times; before the start: at it
  double since_s = 0.0;                                    ///< since the place began; before it negative
  std::size_t axis = 0;                                    ///< 0 forward, 1 left, 2 up
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitX();  ///< of that axis, level, where the place began
  double size = 0.0;                                       ///< in the kind's unit
  std::uint64_t seed = 0, keyframe = 0;                    ///< of the noise
};

/// One kind of error of the estimate that places scans.
struct EstimateErrorKind {
  Pose (*lay)(const ErrorLaid& on);  ///< the estimate
  /// The prediction between keyframes has it too: it drifts, is late or turned. Else the estimate is corrected, which
  /// is no motion, and alignments begin from the true one.
  bool predicted;
  bool by_axis;  ///< false: there is one direction alone
  std::vector<double> (*usual_sizes)();
};
/// Their names end with the unit of the size, as those of disturbances() (study/tolerance) do. A new one is a function
/// and a row.
ModelTable<EstimateErrorKind> estimate_errors();

/// "forward", "left", "up".
const char* axis_name(std::size_t axis);

}  // namespace canyon::study

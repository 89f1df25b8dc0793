#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/model_table.h"
#include "canyon/core/motion/trajectory.h"

namespace canyon::lidar {

/// How an estimated trajectory is laid over the true one before it is compared.
enum class TrajectoryAlignment {
  kNone,
  kYaw,  ///< turned about the vertical, and shifted: for estimates that know the vertical
  kSe3,  ///< turned and shifted
};
ModelTable<TrajectoryAlignment> trajectory_alignments();

/// Error of motion over a stretch of the way or of time, relative pose error: of (true motion)^-1 * estimated motion.
struct RelativeErrors {
  std::string over;        ///< "10 m", "1 s"
  std::int64_t pairs = 0;  ///< 0: nothing is known, as where poses lie twice that stretch apart
  double translation_rms_m = kNaN, rotation_rms_deg = kNaN;
};

/// An estimated trajectory against the true one (Sturm et al., IROS 2012), over the estimate's poses that lie within
/// the truth's time; that is interpolated on SE(3) there.
struct TrajectoryErrors {
  std::int64_t poses = 0;
  Pose X_true_estimated;  ///< the alignment: an estimated pose times this from the left is compared
  /// False where the positions do not determine it: where the turn about the axis that they determine least has a sigma
  /// of a degree or more, as about a straight way's own direction. The axis is that of the largest spread of the true
  /// positions (kYaw: the vertical), the sigma what is left of errors across it, rms over both directions, by the rms
  /// distance from it, all poses counted as one: errors of an estimate last. A degree is what attitudes are wrong by
  /// where that matters to rotation_rms_deg.
  bool alignment_determined = true;
  /// Absolute trajectory error, of positions: root mean square, mean, median, largest.
  double ate_rms_m = kNaN, ate_mean_m = kNaN, ate_median_m = kNaN, ate_max_m = kNaN;
  double rotation_rms_deg = kNaN;
  /// Over 1, 10, 100 m of the true way and 1, 10 s; from every pose to the first one at least so far on, where that is
  /// less than twice as far.
  std::vector<RelativeErrors> relative;
};
TrajectoryErrors trajectory_errors(const Trajectory& truth, const Trajectory& estimate, TrajectoryAlignment alignment);

}  // namespace canyon::lidar

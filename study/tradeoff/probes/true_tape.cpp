#include "canyon/study/tradeoff/probes/true_tape.h"

#include <algorithm>
#include <cmath>

namespace canyon::study {

TrueMotion true_motion(const Tape& tape, GpsTime start) {
  TrueMotion motion;
  for (const TapeNode& node : tape.nodes) {
    KinematicState state = node.motion;
    state.t = start + (node.motion.t - tape.nodes.front().motion.t);
    motion.append(state);
  }
  return motion;
}

Trajectory poses_of(const TrueMotion& motion, GpsTime from, GpsTime to, double step_s) {
  Trajectory poses;
  const auto steps = static_cast<std::int64_t>(std::ceil((to - from) / step_s - 1e-9));
  for (std::int64_t k = 0; k <= steps; ++k) {
    const GpsTime t = k == steps ? to : from + static_cast<double>(k) * step_s;
    poses.append({t, motion.at(t).X_WB});
  }
  return poses;
}

}  // namespace canyon::study

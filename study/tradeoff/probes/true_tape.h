#pragma once

#include "canyon/core/files/tape.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/motion/true_motion.h"

namespace canyon::study {

/// The whole of a tape laid at `start` as a dense motion.
TrueMotion true_motion(const Tape& tape, GpsTime start);

/// Poses of B in W every step_s of [from, to], both ends included, joined on SE(3).
Trajectory poses_of(const TrueMotion& motion, GpsTime from, GpsTime to, double step_s);

}  // namespace canyon::study

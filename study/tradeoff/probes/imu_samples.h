#pragma once

#include <optional>
#include <span>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/true_motion.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/inertial/imu_model.h"

namespace canyon::study {

/// Samples first + 1 ... last of a unit on a motion that began at `start`: sample k ends at its own tick of rate_hz.
std::vector<ImuSample> imu_samples(inertial::ImuModel& imu, const TrueMotion& motion, GpsTime start, double rate_hz,
                                   std::int64_t first, std::int64_t last);

/// Every `count` consecutive samples as one: increments are summed, noise included, as a slower strapdown is fed.
/// What does not fill one at the end is left out.
std::vector<ImuSample> summed(std::span<const ImuSample> fine, std::size_t count);

/// The IMU of a body that moves as `truth` says, `lever_arm_m` from B's origin in B, with axes R_BU (none: B's).
fusion::NavState imu_state(const KinematicState& truth, const LocalFrame& frame, const Eigen::Vector3d& lever_arm_m,
                           const std::optional<Eigen::Quaterniond>& R_BU);

}  // namespace canyon::study

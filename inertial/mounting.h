#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "canyon/core/messages.h"
#include "canyon/inertial/imu_config.h"

namespace canyon::inertial {

/// How askew the unit sits: R_BU, its axes U in the vehicle's B, constant over a run. A rotation vector of three
/// independent normal angles of `mounting_error_deg` each, from the stream "imu.mounting"; none where that is 0, and
/// the axes are parallel. Whoever works with the unit's samples is not told of it.
std::optional<Eigen::Quaterniond> mounting(const ImuConfig& config, std::uint64_t seed);

/// The increments of a unit whose axes are parallel to B, in those of one that sits askew at the same place: as the
/// angle is constant, the integrals turn as rate and force do.
ImuSample seen_askew(ImuSample sample, const Eigen::Quaterniond& R_BU);

}  // namespace canyon::inertial

#pragma once

#include <array>

#include "canyon/core/truth.h"
#include "canyon/inertial/motion/series.h"

namespace canyon::inertial {

using SeriesVector = std::array<Series, 3>;
/// w x y z, of any norm above 0.
using SeriesQuaternion = std::array<Series, 4>;

/// R = Rz(yaw) Ry(pitch) Rx(roll), as a quaternion of norm 1.
SeriesQuaternion quaternion_from(const Series& yaw, const Series& pitch, const Series& roll);

/// The kinematics of a body at that place with that attitude (the quaternion is normalized). `t` is left 0.
KinematicState kinematics(const SeriesVector& p_WB, const SeriesQuaternion& R_WB);

/// The kinematics of C in W, for B in W and C in B. `t` is that of B.
KinematicState compose(const KinematicState& X_WB, const KinematicState& X_BC);

}  // namespace canyon::inertial

#pragma once

#include <span>

#include <Eigen/Core>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/messages.h"
#include "canyon/core/motion/true_motion.h"

namespace canyon::inertial {

/// What an ideal IMU feels at an instant.
struct InertialInput {
  Eigen::Vector3d w_IU_U = Eigen::Vector3d::Zero();  ///< angular rate against inertial space, rad/s
  Eigen::Vector3d f_U = Eigen::Vector3d::Zero();     ///< specific force at U, m/s^2
};

/// Rate and specific force at U for a body that moves as `state` says. U sits at `lever_arm_m` in B, axes parallel to
/// B.
///
/// W is fixed to the rotating Earth, so with w = w_WB_B, l the lever arm and W_e = w_IE in W:
///   w_IU_U = w + R_BW W_e
///   v_WU_W = v_WB_W + R_WB (w x l)
///   a_WU_W = a_WB_W + R_WB (alpha x l + w x (w x l))
///   f_U    = R_BW (a_WU_W - g_W(p_U) + 2 W_e x v_WU_W)
/// where g is WGS84 normal gravity (gravitation plus centrifugal), evaluated at U.
/// Groves, Principles of GNSS, Inertial, and Multisensor Integrated Navigation Systems, 2nd ed.,
/// eqs. 2.147, 5.21, 5.25.
InertialInput inertial_input(const KinematicState& state, const LocalFrame& frame, const Eigen::Vector3d& lever_arm_m);

/// Increments of an ideal IMU over (nodes.front().t, nodes.back().t]: dtheta is the plain integral of w_IU_U, dv the
/// plain integral of f_U in the turning frame U, which is what an integrating sensor puts out; undoing the turning
/// (coning and sculling) is the strapdown's task.
///
/// `nodes` are equally spaced states, an odd number of at least 3. The quadrature is composite Boole where the number
/// of intervals is a multiple of 4 (error O(h^6) over a fixed time), else composite Simpson (O(h^4)). Throws
/// ProgramError on an even number of nodes, uneven spacing or a state that is not finite.
ImuSample true_increments(std::span<const KinematicState> nodes, const LocalFrame& frame,
                          const Eigen::Vector3d& lever_arm_m);

/// The same over (from, to] of a motion with nodes of its own: Boole's rule on every piece between two of them.
ImuSample true_increments(const TrueMotion& motion, GpsTime from, GpsTime to, const LocalFrame& frame,
                          const Eigen::Vector3d& lever_arm_m);

}  // namespace canyon::inertial

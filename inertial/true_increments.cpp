#include "canyon/inertial/true_increments.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"

namespace canyon::inertial {
namespace {

/// Weight of node i of n (n odd), in units of the total interval.
double quadrature_weight(std::size_t i, std::size_t n) {
  const std::size_t intervals = n - 1;
  const bool end = i == 0 || i == intervals;
  if (intervals % 4 == 0) {  // Boole: 7 32 12 32 7, over 90, per panel of four intervals
    const double panels = static_cast<double>(intervals / 4);
    if (end) return 7.0 / (90.0 * panels);
    if (i % 4 == 0) return 14.0 / (90.0 * panels);
    return (i % 2 == 0 ? 12.0 : 32.0) / (90.0 * panels);
  }
  const double panels = static_cast<double>(intervals / 2);  // Simpson: 1 4 1, over 6
  if (end) return 1.0 / (6.0 * panels);
  return (i % 2 == 0 ? 2.0 : 4.0) / (6.0 * panels);
}

void check_nodes(std::span<const KinematicState> nodes) {
  CANYON_CHECK(nodes.size() >= 3 && nodes.size() % 2 == 1, "number of nodes = ", nodes.size());
  const double dt_s = nodes.back().t - nodes.front().t;
  CANYON_CHECK(dt_s > 0.0, "dt_s = ", dt_s);
  const double step_s = dt_s / static_cast<double>(nodes.size() - 1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const KinematicState& s = nodes[i];
    const double uneven_s = (s.t - nodes.front().t) - step_s * static_cast<double>(i);
    CANYON_CHECK(std::abs(uneven_s) < 2e-9, "node ", i, " is off its place by ", uneven_s,
                 " s");  // stamps are rounded to 1 ns
    const bool finite = s.X_WB.p.allFinite() && s.X_WB.R.coeffs().allFinite() && s.v_WB_W.allFinite() &&
                        s.a_WB_W.allFinite() && s.w_WB_B.allFinite() && s.alpha_WB_B.allFinite();
    CANYON_CHECK(finite, "true motion handed to the IMU is not finite at node ", i);
  }
}

}  // namespace

InertialInput inertial_input(const KinematicState& state, const LocalFrame& frame, const Eigen::Vector3d& lever_arm_m) {
  const Eigen::Matrix3d R_WB = state.X_WB.R.toRotationMatrix();
  const Eigen::Vector3d earth_rate_W = frame.R_EW().transpose() * earth_rate_E();
  const Eigen::Vector3d& w = state.w_WB_B;
  const Eigen::Vector3d& l = lever_arm_m;

  const Eigen::Vector3d p_WU_W = state.X_WB * l;
  const Eigen::Vector3d v_WU_W = state.v_WB_W + R_WB * w.cross(l);
  const Eigen::Vector3d a_WU_W = state.a_WB_W + R_WB * (state.alpha_WB_B.cross(l) + w.cross(w.cross(l)));
  const Eigen::Vector3d gravity_W = frame.R_EW().transpose() * gravity_E(frame.to_E(p_WU_W));

  InertialInput input;
  input.w_IU_U = w + R_WB.transpose() * earth_rate_W;
  input.f_U = R_WB.transpose() * (a_WU_W - gravity_W + 2.0 * earth_rate_W.cross(v_WU_W));
  return input;
}

ImuSample true_increments(std::span<const KinematicState> nodes, const LocalFrame& frame,
                          const Eigen::Vector3d& lever_arm_m) {
  check_nodes(nodes);
  ImuSample sample;
  sample.t = nodes.back().t;
  sample.dt_s = nodes.back().t - nodes.front().t;
  Eigen::Vector3d mean_rate = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_force = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const InertialInput input = inertial_input(nodes[i], frame, lever_arm_m);
    const double weight = quadrature_weight(i, nodes.size());
    mean_rate += weight * input.w_IU_U;
    mean_force += weight * input.f_U;
  }
  sample.dtheta_U = mean_rate * sample.dt_s;
  sample.dv_U = mean_force * sample.dt_s;
  return sample;
}

ImuSample true_increments(const TrueMotion& motion, GpsTime from, GpsTime to, const LocalFrame& frame,
                          const Eigen::Vector3d& lever_arm_m) {
  ImuSample sum;
  motion.for_each_piece(from, to, [&](const TrueMotion::Piece& piece) {
    const ImuSample part = true_increments(piece, frame, lever_arm_m);
    sum.dtheta_U += part.dtheta_U;
    sum.dv_U += part.dv_U;
  });
  sum.t = to;
  sum.dt_s = to - from;
  return sum;
}

}  // namespace canyon::inertial

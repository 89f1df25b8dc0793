#include "canyon/mission/autonomy/perception/odometry_frame.h"

#include <cmath>

namespace canyon::mission {

void OdometryFrame::follow(const NavEstimate& estimate, bool stands, const std::optional<Counted>& counted) {
  const double dt_s = started_ ? estimate.t - t_ : 0.0;
  const double yaw_before = body_.yaw_rad;
  body_.yaw_rad = yaw_pitch_roll(estimate.X_WB.R).yaw_rad;
  const Eigen::Vector2d u = body_.forward();
  // A wheel to the left goes less far in a turn to the left.
  const double beside_m = counted && started_ ? counted->left_m * wrap_pi(body_.yaw_rad - yaw_before) : 0.0;
  const double speed =
      counted ? counted->speed_m_s + (dt_s > 0.0 ? beside_m / dt_s : 0.0) : u.dot(estimate.v_WB_W.head<2>());
  const double mean = started_ ? 0.5 * (speed_ + speed) : speed;
  if (counted || !stands) {
    const double way_m = counted ? counted->way_m + beside_m : dt_s * mean;
    body_.p_m += way_m * u;
    driven_ += std::abs(way_m);
  }
  speed_ = speed;
  to_W_ = estimate.X_WB.p.head<2>() - body_.p_m;
  t_ = estimate.t;
  started_ = true;
}

PlanPose OdometryFrame::at(const NavEstimate& estimate) const {
  PlanPose pose = body_;
  pose.yaw_rad = yaw_pitch_roll(estimate.X_WB.R).yaw_rad;
  if (started_) pose.p_m += (estimate.t - t_) * speed_ * pose.forward();
  return pose;
}

}  // namespace canyon::mission

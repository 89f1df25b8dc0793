#include "canyon/mission/autonomy/perception/local_frame.h"

#include <cmath>

namespace canyon::mission {

void LocalFrame::follow(const NavEstimate& estimate, bool stands) {
  const double dt_s = started_ ? estimate.t - t_ : 0.0;
  body_.yaw_rad = yaw_pitch_roll(estimate.X_WB.R).yaw_rad;
  const Eigen::Vector2d u = body_.forward();
  const double speed = u.dot(estimate.v_WB_W.head<2>());
  const double mean = started_ ? 0.5 * (speed_ + speed) : speed;
  if (!stands) {
    body_.p_m += dt_s * mean * u;
    driven_ += std::abs(dt_s * mean);
  }
  speed_ = speed;
  to_W_ = estimate.X_WB.p.head<2>() - body_.p_m;
  t_ = estimate.t;
  started_ = true;
}

PlanPose LocalFrame::at(const NavEstimate& estimate) const {
  PlanPose pose = body_;
  pose.yaw_rad = yaw_pitch_roll(estimate.X_WB.R).yaw_rad;
  if (started_) pose.p_m += (estimate.t - t_) * speed_ * pose.forward();
  return pose;
}

}  // namespace canyon::mission

#pragma once

#include <optional>

#include "canyon/core/messages.h"
#include "canyon/mission/autonomy/known_vehicle.h"

namespace canyon::mission {

/// The frame O that the autonomy remembers its surroundings in: level, with W's axes as believed, and an origin that no
/// correction of the estimate moves. In it the vehicle goes where its estimated speed and attitude take it, forwards
/// along its own axis, since a wheel rolls where it points: a fix that moves the estimate by metres then leaves what
/// was seen where it stands. While the vehicle is known to stand it does not go at all. Where its wheel is counted,
/// that tells the way instead: an estimated speed that is wrong moves what is remembered. (REP 105 calls such a frame
/// `odom`.)
class OdometryFrame {
 public:
  /// By a wheel: since the last call, and now; negative in reverse. It rolls beside B's axis.
  struct Counted {
    double way_m = 0.0, speed_m_s = 0.0;
    double left_m = 0.0;  ///< how far to the left of it
  };
  /// Once the estimate is of another time than the last; `stands`: the autonomy has it stopped for long enough.
  void follow(const NavEstimate& estimate, bool stands, const std::optional<Counted>& counted = {});

  PlanPose body() const { return body_; }
  double speed_m_s() const { return speed_; }            ///< along the body, negative in reverse
  double driven_m() const { return driven_; }            ///< since the start, either way
  Eigen::Vector2d from_O_to_W() const { return to_W_; }  ///< to be added to a place in O to have it in W, as believed
  PlanPose at(const NavEstimate& estimate) const;        ///< where it is believed at an estimate a moment away

 private:
  bool started_ = false;
  GpsTime t_;
  PlanPose body_;
  double speed_ = 0.0, driven_ = 0.0;
  Eigen::Vector2d to_W_{0, 0};
};

}  // namespace canyon::mission

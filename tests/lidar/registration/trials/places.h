#pragma once

#include <span>

#include "canyon/scene/scene.h"
#include "canyon/tests/lidar/registration/trials/draws.h"

namespace canyon::lidar::trials {

/// Where clouds are taken. What is drawn of a place (cars, relief, setbacks) is drawn anew for every trial.
struct Place {
  const char* name;
  /// `later`: as the source sees it, a while after the target; only what moves differs.
  scene::SceneParts (*build)(Draws& draws, bool later);
  double half_x_m, half_y_m;  ///< where sensors stand, about W's origin
  bool open_x, open_turn;     ///< what no surface tells: the way along x; y too, and the turn about the vertical
  double period_m;            ///< along x everything repeats; 0: it does not
  bool judged;                ///< of the covariance: one of the four that nothing is calibrated on
};
std::span<const Place> places();

}  // namespace canyon::lidar::trials

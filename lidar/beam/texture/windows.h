#pragma once

#include <cstdint>

#include "canyon/lidar/beam/texture/places.h"
#include "canyon/scene/surfaces/facade.h"

namespace canyon::lidar {

/// A pane in the middle of each bay of each floor of a wall. ASSUMPTIONS, of houses as they are commonly built, no
/// façade was measured: 1.5 x 1.5 m, a sill 0.9 m above the floor. With Facade's floors and bays glass is at most a
/// quarter of a wall. There are no frames, doors or shop fronts, and a gable's slope may cut a pane off.
struct Pane {
  static constexpr double kSill_m = 0.9, kWidth_m = 1.5, kHeight_m = 1.5;
};

/// For each lane 1 where its place, which must be on the wall's plane, is on a pane, else 0.
void find_panes(const scene::Facade& wall, const Places& places, std::int32_t* pane);
/// The same of one place.
bool on_pane(const scene::Facade& wall, const Eigen::Vector3d& p_W);

}  // namespace canyon::lidar

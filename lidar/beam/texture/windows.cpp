#include "canyon/lidar/beam/texture/windows.h"

#include "canyon/core/process/vector_clones.h"

namespace canyon::lidar {
namespace {

/// A wall as plain numbers, for vectorised loops.
struct PaneLattice {
  double along_x, along_y, begin_m, bays_per_m, bays, half_share, base_m, first_floor, end_floor;
};
[[gnu::always_inline]] inline PaneLattice lattice_of(const scene::Facade& w) {
  return {w.along_W.x(), w.along_W.y(), w.begin_m,  w.bays_per_m, w.bays, 0.5 * Pane::kWidth_m * w.bays_per_m,
          w.base_m,      w.first_floor, w.end_floor};
}

/// Nearest whole number, for |x| < 2^51.
[[gnu::always_inline]] inline double nearest_whole(double x) {
  constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52
  return (x + kShift) - kShift;
}

[[gnu::always_inline]] inline bool within_pane(const PaneLattice& w, double x, double y, double z) {
  constexpr double kPerFloor = 1.0 / scene::Facade::kFloor_m;
  constexpr double kMiddle = (Pane::kSill_m + 0.5 * Pane::kHeight_m) * kPerFloor;
  constexpr double kHalf = 0.5 * Pane::kHeight_m * kPerFloor;
  const double along = (w.along_x * x + w.along_y * y - w.begin_m) * w.bays_per_m - 0.5;
  const double bay = nearest_whole(along), beside = along - bay;
  const double up = (z - w.base_m) * kPerFloor - kMiddle;
  const double floor = nearest_whole(up), above = up - floor;
  return (bay >= 0.0) & (bay < w.bays) & (beside <= w.half_share) & (beside >= -w.half_share) &
         (floor >= w.first_floor) & (floor < w.end_floor) & (above <= kHalf) & (above >= -kHalf);
}

CANYON_VECTOR_CLONES void all_within_pane(const PaneLattice& lattice, const Places& places, std::int32_t* pane) {
  const PaneLattice w = lattice;
  std::int32_t out[scene::RayPacket::kRays];
  for (std::size_t i = 0; i < scene::RayPacket::kRays; ++i)
    out[i] = within_pane(w, places.x[i], places.y[i], places.z[i]) ? 1 : 0;
  for (std::size_t i = 0; i < scene::RayPacket::kRays; ++i) pane[i] = out[i];
}

}  // namespace

void find_panes(const scene::Facade& wall, const Places& places, std::int32_t* pane) {
  all_within_pane(lattice_of(wall), places, pane);
}

bool on_pane(const scene::Facade& wall, const Eigen::Vector3d& p_W) {
  return within_pane(lattice_of(wall), p_W.x(), p_W.y(), p_W.z());
}

}  // namespace canyon::lidar

#pragma once

#include <cstdint>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/lidar/beam/aim.h"
#include "canyon/lidar/beam/firing_pattern.h"
#include "canyon/scene/tracing/ray_packet.h"

namespace canyon::lidar {

/// The shots of all lasers in up to 32 consecutive firing cycles: what a scan is computed by. Its arrays stay in the
/// cache, its rays go to the tracer in packets of sixteen neighbouring azimuths of one laser, and it is long enough for
/// the random numbers to be drawn in batches.
///
/// Shot (laser, cycle) is in packet laser * 2 + cycle / 16, lane cycle % 16; shots are numbered packet * 16 + lane.
struct Volley {
  static constexpr std::size_t kCycles = 32;
  static constexpr std::size_t kLanes = AimPacket::kShots;
  static constexpr std::size_t kPacketsPerLaser = kCycles / kLanes;

  std::size_t lasers = 0;
  std::size_t first_cycle = 0;   ///< in its scan
  std::size_t cycles = 0;        ///< <= kCycles
  std::uint64_t first_draw = 0;  ///< sample index of its first cycle in the random streams; the entity is the laser
  double first_s = 0.0;          ///< time of its first cycle after the scan's stamp
  double step_s = 0.0;
  PlacementPacket placements[kPacketsPerLaser];
  std::vector<AimPacket> aims;  ///< nominal: where the sensor believes it points
  std::vector<scene::RayPacket> rays;
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();  ///< what the rays' origins are relative to

  std::size_t packets() const { return lasers * kPacketsPerLaser; }
  std::size_t shots() const { return packets() * kLanes; }
  static std::size_t shot(std::size_t laser, std::size_t cycle) { return laser * kCycles + cycle; }
  static std::size_t laser_of(std::size_t shot) { return shot / kCycles; }
  static std::size_t cycle_of(std::size_t shot) { return shot % kCycles; }
  std::uint64_t draw_of(std::size_t shot) const { return first_draw + cycle_of(shot); }
  Eigen::Vector3f nominal_direction(std::size_t shot) const {
    const AimPacket& aim = aims[shot / kLanes];
    const std::size_t lane = shot % kLanes;
    return {aim.direction_x[lane], aim.direction_y[lane], aim.direction_z[lane]};
  }
  Eigen::Vector3f nominal_origin(std::size_t shot) const {
    const AimPacket& aim = aims[shot / kLanes];
    const std::size_t lane = shot % kLanes;
    return {aim.origin_x[lane], aim.origin_y[lane], aim.origin_z[lane]};
  }
};

}  // namespace canyon::lidar

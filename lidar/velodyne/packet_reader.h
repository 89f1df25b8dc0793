#pragma once

#include <cstdint>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/lidar/beam/beam_table.h"
#include "canyon/lidar/velodyne/packet.h"

namespace canyon::lidar::velodyne {

/// One return of a packet.
struct Return {
  double time_us = 0;      ///< of its firing, after the packet's first
  double azimuth_deg = 0;  ///< of the beam, clockwise from forward, [0, 360)
  double distance_m = 0;
  std::uint8_t reflectivity = 0;
  std::uint16_t laser = 0;
  std::uint8_t block = 0;
  LidarPoint point;  ///< in L; time_s after the packet's first firing; return_index 1 = the other of two
};

/// The returns of a packet, block by block, channel by channel; channels without one are left out. The head's azimuth
/// between blocks is interpolated with the firing times of `table`, which must be the product's.
std::vector<Return> decode(const Packet& packet, const BeamTable& table);

/// What a recording of packets says of its timing.
struct Timing {
  std::size_t packets = 0;
  double packet_us = 0;         ///< mean between packets' time stamps
  double azimuth_step_deg = 0;  ///< mean between blocks of different cycles
  double azimuth_step_min_deg = 0, azimuth_step_max_deg = 0;
  double rpm = 0;  ///< from step and the product's block time
};
/// Of consecutive packets of one product, two or more.
Timing timing(const std::vector<Packet>& packets);

}  // namespace canyon::lidar::velodyne

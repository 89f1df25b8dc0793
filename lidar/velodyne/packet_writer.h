#pragma once

#include <cstdint>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/lidar/beam/firing_pattern.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/velodyne/packet.h"

namespace canyon::lidar::velodyne {

/// A data packet with the instant of its first firing.
struct StampedPacket {
  GpsTime t;
  Packet packet;
};

/// Scans of a VLP-16 or an HDL-32E as the packets that the sensor would send. With azimuth_steps = 0 the lasers fire as
/// the real ones do and packets are 1327.104 or 552.96 us apart.
///
/// Distances are from the beam's origin, in steps of 2 mm (a range beyond 131 m does not fit and is left out).
/// Reflectivity is 100 * intensity, rounded; an intensity of 1 (a retroreflector, or a clipped signal) is 255.
class PacketWriter {
 public:
  /// Fails for other beam tables and for returns = "first" or "all", which the packets cannot say.
  static Result<PacketWriter> create(const LidarConfig& config);

  /// Packets that are full after scan `index`; scans come in order.
  std::vector<StampedPacket> add(std::int64_t index, const LidarScan& scan);

 private:
  PacketWriter(const LidarConfig& config, BeamTable table, Packet::Mode mode, Packet::Product product);

  FiringPattern pattern_;
  double period_s_;
  StampedPacket open_;
  std::size_t blocks_ = 0;        ///< full or begun in the open packet
  std::size_t block_cycles_ = 0;  ///< cycles in the last begun block
};

}  // namespace canyon::lidar::velodyne

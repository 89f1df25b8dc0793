#pragma once

#include <optional>
#include <string>

#include "canyon/core/messages.h"
#include "canyon/core/output/staged.h"
#include "canyon/lidar/velodyne/packet_writer.h"
#include "canyon/lidar/velodyne/pcap.h"
#include "canyon/lidar/velodyne/udp_sender.h"

namespace canyon::lidar::velodyne {

/// Where a sensor's packets go: a capture, the network, both.
class PacketOutput {
 public:
  /// An Error if that sensor sends no packets of this kind.
  static Result<PacketOutput> create(const LidarConfig& config);
  Status capture_to(StagedFile& file);
  /// At the sensor's own pace, or as fast as they are made.
  void send_to(UdpSender sender, bool fast);

  Status add(std::int64_t index, const LidarScan& scan);
  std::int64_t packets() const { return packets_; }

 private:
  explicit PacketOutput(PacketWriter writer) : writer_(std::move(writer)) {}

  PacketWriter writer_;
  std::optional<UdpSender> udp_;
  std::optional<PcapWriter> capture_;
  bool fast_ = false;
  std::optional<GpsTime> first_;
  std::int64_t packets_ = 0;
};

}  // namespace canyon::lidar::velodyne

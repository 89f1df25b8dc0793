#include "canyon/lidar/velodyne/packet_output.h"

namespace canyon::lidar::velodyne {

Result<PacketOutput> PacketOutput::create(const LidarConfig& config) {
  CANYON_TRY(PacketWriter writer, PacketWriter::create(config));
  return PacketOutput(std::move(writer));
}

Status PacketOutput::capture_to(StagedFile& file) {
  CANYON_TRY(capture_, PcapWriter::begin(file));
  return Ok{};
}

void PacketOutput::send_to(UdpSender sender, bool fast) {
  udp_.emplace(std::move(sender));
  fast_ = fast;
}

Status PacketOutput::add(std::int64_t index, const LidarScan& scan) {
  for (const auto& p : writer_.add(index, scan)) {
    const std::string bytes = p.packet.bytes();
    ++packets_;
    if (!first_) first_ = p.t;
    if (udp_) CANYON_TRY_STATUS(fast_ ? udp_->send(bytes) : udp_->send_at(bytes, p.t - *first_));
    if (!capture_) continue;
    constexpr std::int64_t kGpsEpochInUnix_us = 315'964'800'000'000;
    const std::int64_t unix_us = p.t.ns / 1000 - p.t.leap_seconds() * 1'000'000 + kGpsEpochInUnix_us;
    CANYON_TRY_STATUS(capture_->add({unix_us, Packet::kPort, bytes}));
  }
  return Ok{};
}

}  // namespace canyon::lidar::velodyne

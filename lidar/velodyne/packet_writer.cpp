#include "canyon/lidar/velodyne/packet_writer.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::lidar::velodyne {
namespace {

/// By beam table.
constexpr ModelRow<Packet::Product> kProducts[] = {
    {"vlp16", Packet::Product::kVlp16, "VLP-16"},
    {"hdl32e", Packet::Product::kHdl32e, "HDL-32E"},
};

Packet::Channel channel_of(const LidarPoint& p, double origin_up_m) {
  const double range_m = std::hypot(p.x, p.y, p.z - origin_up_m);
  const double quanta = std::round(range_m / Packet::kRangeQuantum_m);
  if (!(quanta >= 1.0 && quanta <= 65535.0)) return {};
  const double reflectivity = p.intensity >= 1.0f ? 255.0 : std::round(100.0 * std::max(0.0f, p.intensity));
  return {static_cast<std::uint16_t>(quanta), static_cast<std::uint8_t>(reflectivity)};
}

}  // namespace

Result<PacketWriter> PacketWriter::create(const LidarConfig& config) {
  CANYON_TRY(BeamTable table, load_beam_table(config.beams));
  const auto* product = find_model(ModelTable<Packet::Product>(kProducts), config.beams);
  if (product == nullptr)
    return Error{"", 0, "lidar.beams", '"' + config.beams + "\" has no packets", "vlp16 or hdl32e"};
  Packet::Mode mode{};
  if (config.report.returns == ReturnMode::kStrongest)
    mode = Packet::Mode::kStrongest;
  else if (config.report.returns == ReturnMode::kLast)
    mode = Packet::Mode::kLast;
  else if (config.report.returns == ReturnMode::kDual)
    mode = Packet::Mode::kDual;
  else
    return Error{
        "", 0, "lidar.returns",
        std::string("\"") + row_of(return_modes(), config.report.returns).name + "\" does not fit into packets",
        "strongest, last or dual"};
  return PacketWriter(config, std::move(table), mode, product->make);
}

PacketWriter::PacketWriter(const LidarConfig& config, BeamTable table, Packet::Mode mode, Packet::Product product)
    : pattern_(std::move(table), config.rate_hz, static_cast<std::size_t>(config.azimuth_steps)),
      period_s_(1.0 / config.rate_hz) {
  open_.packet.mode = mode;
  open_.packet.product = product;
}

std::vector<StampedPacket> PacketWriter::add(std::int64_t index, const LidarScan& scan) {
  const FiringPattern::Sweep sweep = pattern_.sweep(index);
  const std::size_t lasers = pattern_.lasers();
  const bool dual = open_.packet.mode == Packet::Mode::kDual;
  const std::size_t copies = dual ? 2 : 1;
  // Each cycle's returns by laser: the last, and in dual mode the other.
  std::vector<Packet::Channel> channels(sweep.cycles * lasers * copies);
  for (const LidarPoint& p : scan.points) {
    const Beam& beam = pattern_.table().beams[p.ring];
    const double cycle = std::round((p.time_s - sweep.start_s - beam.firing_s) / pattern_.step_s());
    if (!(cycle >= 0 && cycle < static_cast<double>(sweep.cycles))) continue;
    Packet::Channel* slot = channels.data() + (static_cast<std::size_t>(cycle) * lasers + p.ring) * copies;
    const Packet::Channel channel = channel_of(p, beam.origin_up_m);
    slot[0] = channel;
    if (dual && p.return_index == 0) slot[1] = channel;
  }
  std::vector<StampedPacket> out;
  for (std::size_t c = 0; c < sweep.cycles; ++c) {
    const double cycle_s = sweep.start_s + static_cast<double>(c) * pattern_.step_s();
    if (block_cycles_ == 0) {
      if (blocks_ == 0) {
        open_.t = scan.t + cycle_s;
        const std::int64_t utc_ns = open_.t.ns - open_.t.leap_seconds() * kNsPerSecond;
        open_.packet.time_us = static_cast<std::uint32_t>(utc_ns % (3600 * kNsPerSecond) / 1000);
      }
      // From behind to forward is half a turn.
      const double turns = (sweep.turn_rad + 2.0 * kPi * (cycle_s - sweep.start_s) / period_s_) / (2.0 * kPi) + 0.5;
      const auto azimuth = static_cast<long>(std::lround(36000.0 * (turns - std::floor(turns))));
      for (std::size_t k = 0; k < copies; ++k) {
        Packet::Block& block = open_.packet.blocks[blocks_ + k];
        block = {};
        block.azimuth_cdeg = static_cast<std::uint16_t>(azimuth % 36000);
      }
      blocks_ += copies;
    }
    for (std::size_t laser = 0; laser < lasers; ++laser)
      for (std::size_t k = 0; k < copies; ++k)
        open_.packet.blocks[blocks_ - copies + k].channels[block_cycles_ * lasers + laser] =
            channels[(c * lasers + laser) * copies + k];
    if (++block_cycles_ == open_.packet.cycles_per_block()) block_cycles_ = 0;
    if (block_cycles_ == 0 && blocks_ == Packet::kBlocks) {
      out.push_back(open_);
      blocks_ = 0;
    }
  }
  return out;
}

}  // namespace canyon::lidar::velodyne

#include "canyon/lidar/velodyne/packet_reader.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::lidar::velodyne {
namespace {

/// From one azimuth clockwise to the next, in hundredths of a degree.
int clockwise(std::uint16_t from, std::uint16_t to) {
  return (int{to} - int{from} + 36000) % 36000;
}

}  // namespace

std::vector<Return> decode(const Packet& packet, const BeamTable& table) {
  CANYON_CHECK(table.beams.size() == packet.lasers(), "beams = ", table.beams.size());
  const std::size_t copies = packet.mode == Packet::Mode::kDual ? 2 : 1;
  const double block_us = static_cast<double>(packet.cycles_per_block()) * table.cycle_s * 1e6;
  std::vector<Return> out;
  double turn_deg = 0;  // over one block
  for (std::size_t b = 0; b < Packet::kBlocks; ++b) {
    const Packet::Block& block = packet.blocks[b];
    // The last block turns as far as the one before.
    if (b + copies < Packet::kBlocks)
      turn_deg = 0.01 * clockwise(block.azimuth_cdeg, packet.blocks[b + copies].azimuth_cdeg);
    for (std::size_t c = 0; c < Packet::kChannels; ++c) {
      const Packet::Channel& channel = block.channels[c];
      if (channel.distance == 0) continue;
      const std::size_t laser = c % packet.lasers(), cycle = c / packet.lasers();
      const Beam& beam = table.beams[laser];
      const double in_block_us = 1e6 * (static_cast<double>(cycle) * table.cycle_s + beam.firing_s);
      Return r;
      r.time_us = static_cast<double>(b / copies) * block_us + in_block_us;
      r.azimuth_deg = 0.01 * block.azimuth_cdeg + turn_deg * in_block_us / block_us + beam.azimuth_offset_rad / kDegree;
      r.azimuth_deg -= 360.0 * std::floor(r.azimuth_deg / 360.0);
      r.distance_m = channel.distance * Packet::kRangeQuantum_m;
      r.reflectivity = channel.reflectivity;
      r.laser = static_cast<std::uint16_t>(laser);
      r.block = static_cast<std::uint8_t>(b);
      const double level_m = r.distance_m * std::cos(beam.elevation_rad);
      r.point = {.x = static_cast<float>(level_m * std::cos(r.azimuth_deg * kDegree)),
                 .y = static_cast<float>(-level_m * std::sin(r.azimuth_deg * kDegree)),
                 .z = static_cast<float>(beam.origin_up_m + r.distance_m * std::sin(beam.elevation_rad)),
                 .intensity = std::min(1.0f, 0.01f * static_cast<float>(channel.reflectivity)),
                 .time_s = static_cast<float>(1e-6 * r.time_us),
                 .ring = r.laser,
                 .return_index = static_cast<std::uint8_t>(b % copies)};
      out.push_back(r);
    }
  }
  return out;
}

Timing timing(const std::vector<Packet>& packets) {
  CANYON_CHECK(packets.size() >= 2, "packets = ", packets.size());
  Timing t;
  t.packets = packets.size();
  std::int64_t total_us = 0;
  for (std::size_t i = 1; i < packets.size(); ++i) {
    constexpr std::int64_t kHour_us = 3'600'000'000;
    total_us += (std::int64_t{packets[i].time_us} - std::int64_t{packets[i - 1].time_us} + kHour_us) % kHour_us;
  }
  t.packet_us = static_cast<double>(total_us) / static_cast<double>(packets.size() - 1);
  const std::size_t copies = packets.front().mode == Packet::Mode::kDual ? 2 : 1;
  std::int64_t turned = 0, steps = 0;
  int least = 36000, most = 0;
  const Packet::Block* previous = nullptr;
  for (const Packet& packet : packets) {
    for (std::size_t b = 0; b < Packet::kBlocks; b += copies) {
      if (previous != nullptr) {
        const int step = clockwise(previous->azimuth_cdeg, packet.blocks[b].azimuth_cdeg);
        turned += step;
        ++steps;
        least = std::min(least, step);
        most = std::max(most, step);
      }
      previous = &packet.blocks[b];
    }
  }
  t.azimuth_step_deg = 0.01 * static_cast<double>(turned) / static_cast<double>(steps);
  t.azimuth_step_min_deg = 0.01 * least;
  t.azimuth_step_max_deg = 0.01 * most;
  const double block_us = t.packet_us * static_cast<double>(copies) / static_cast<double>(Packet::kBlocks);
  t.rpm = t.azimuth_step_deg / 360.0 / (block_us * 1e-6) * 60.0;
  return t;
}

}  // namespace canyon::lidar::velodyne

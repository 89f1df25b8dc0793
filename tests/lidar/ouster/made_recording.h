#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "canyon/lidar/velodyne/pcap.h"

/// A sensor so small that its returns are known by hand.
namespace canyon::lidar::ouster::testing {

/// Four pixels, four columns a turn, two a packet; the head 20 mm off its axis and turned by half.
inline constexpr const char* kMetadata = R"({
  "data_format": {"columns_per_frame": 4, "columns_per_packet": 2, "pixels_per_column": 4,
                  "udp_profile_lidar": "RNG15_RFL8_NIR8"},
  "beam_altitude_angles": [30, 0, 0, -30],
  "beam_azimuth_angles": [0, 0, 90, 0],
  "lidar_origin_to_beam_origin_mm": 20,
  "lidar_to_sensor_transform": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36, 0, 0, 0, 1]
})";

/// Two columns from `first` on; each pixel 1000 steps of 8 mm away, pixel 3 without a return.
inline std::string packet(int frame, int first, bool good = true) {
  const auto put = [](std::string& bytes, std::size_t at, std::uint64_t value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<char>(value >> (8 * i) & 0xff);
  };
  constexpr std::size_t kColumn = 12 + 4 * 4;
  std::string out(32 + 2 * kColumn + 32, '\0');
  put(out, 2, static_cast<std::uint64_t>(frame), 2);
  for (int k = 0; k < 2; ++k) {
    const std::size_t at = 32 + static_cast<std::size_t>(k) * kColumn;
    put(out, at, 1000000007ULL + static_cast<std::uint64_t>(first + k), 8);
    put(out, at + 8, static_cast<std::uint64_t>(first + k), 2);
    put(out, at + 10, good ? 1 : 0, 2);
    for (std::size_t i = 0; i < 3; ++i) {
      put(out, at + 12 + 4 * i, 1000 | 0x8000, 2);  // the highest bit is no range
      put(out, at + 12 + 4 * i + 2, 40 + i, 1);
    }
  }
  return out;
}

inline std::string capture(const std::vector<std::string>& packets) {
  std::vector<velodyne::Datagram> datagrams;
  for (const std::string& payload : packets) datagrams.push_back({.unix_us = 0, .port = 7502, .payload = payload});
  return velodyne::pcap_text(datagrams);
}

}  // namespace canyon::lidar::ouster::testing

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace canyon::lidar::velodyne {

/// The payload of a data packet of the VLP-16 and the HDL-32E: 12 blocks of 32 channels, 1206 bytes, little-endian.
/// Source: VLP-16 User Manual, Velodyne 63-9243, section 9; HDL-32E User's Manual, 63-9113, appendix on data packets.
///
/// A block of the VLP-16 holds two firing cycles of its 16 lasers, one of the HDL-32E a cycle of its 32. In dual mode
/// blocks come in pairs of the same cycles: first the last returns, then the strongest (or second strongest).
struct Packet {
  static constexpr std::size_t kBytes = 1206;
  static constexpr std::size_t kBlocks = 12;
  static constexpr std::size_t kChannels = 32;
  static constexpr double kRangeQuantum_m = 0.002;
  static constexpr std::uint16_t kPort = 2368;

  struct Channel {
    std::uint16_t distance = 0;  ///< in kRangeQuantum_m; 0 = no return
    std::uint8_t reflectivity = 0;
  };
  struct Block {
    std::uint16_t azimuth_cdeg = 0;  ///< of its first firing, hundredths of a degree clockwise from forward, 0..35999
    std::array<Channel, kChannels> channels;
  };
  enum class Mode : std::uint8_t { kStrongest = 0x37, kLast = 0x38, kDual = 0x39 };
  enum class Product : std::uint8_t { kHdl32e = 0x21, kVlp16 = 0x22 };

  std::array<Block, kBlocks> blocks;
  std::uint32_t time_us = 0;  ///< of the first firing, microseconds past the hour (UTC)
  Mode mode = Mode::kStrongest;
  Product product = Product::kVlp16;

  std::string bytes() const;
  /// nullopt if this is no data packet of these two sensors (another length, block flag, mode or product).
  static std::optional<Packet> parse(std::string_view payload);

  std::size_t cycles_per_block() const { return product == Product::kVlp16 ? 2 : 1; }
  std::size_t lasers() const { return product == Product::kVlp16 ? 16 : 32; }
};

/// Name of the product's beam table.
const char* beam_table_of(Packet::Product product);

}  // namespace canyon::lidar::velodyne

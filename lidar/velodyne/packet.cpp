#include "canyon/lidar/velodyne/packet.h"

namespace canyon::lidar::velodyne {
namespace {

constexpr std::uint16_t kBlockFlag = 0xEEFF;

void put(std::string& out, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) out.push_back(static_cast<char>((value >> (8 * i)) & 0xff));
}

std::uint32_t get(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

}  // namespace

std::string Packet::bytes() const {
  std::string out;
  out.reserve(kBytes);
  for (const Block& block : blocks) {
    put(out, kBlockFlag, 2);
    put(out, block.azimuth_cdeg, 2);
    for (const Channel& channel : block.channels) {
      put(out, channel.distance, 2);
      put(out, channel.reflectivity, 1);
    }
  }
  put(out, time_us, 4);
  put(out, static_cast<std::uint8_t>(mode), 1);
  put(out, static_cast<std::uint8_t>(product), 1);
  return out;
}

std::optional<Packet> Packet::parse(std::string_view payload) {
  if (payload.size() != kBytes) return std::nullopt;
  Packet packet;
  constexpr std::size_t kBlockBytes = 4 + 3 * kChannels;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::size_t at = b * kBlockBytes;
    Block& block = packet.blocks[b];
    block.azimuth_cdeg = static_cast<std::uint16_t>(get(payload, at + 2, 2));
    if (get(payload, at, 2) != kBlockFlag || block.azimuth_cdeg >= 36000) return std::nullopt;
    for (std::size_t c = 0; c < kChannels; ++c) {
      block.channels[c].distance = static_cast<std::uint16_t>(get(payload, at + 4 + 3 * c, 2));
      block.channels[c].reflectivity = static_cast<std::uint8_t>(get(payload, at + 6 + 3 * c, 1));
    }
  }
  packet.time_us = get(payload, 1200, 4);
  const std::uint32_t mode = get(payload, 1204, 1), product = get(payload, 1205, 1);
  if (mode < 0x37 || mode > 0x39 || product < 0x21 || product > 0x22) return std::nullopt;
  packet.mode = static_cast<Mode>(mode);
  packet.product = static_cast<Product>(product);
  return packet;
}

const char* beam_table_of(Packet::Product product) {
  return product == Packet::Product::kVlp16 ? "vlp16" : "hdl32e";
}

}  // namespace canyon::lidar::velodyne

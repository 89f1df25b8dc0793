#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace canyon::scene::testing {

/// A little-endian TIFF of one strip of single-precision samples, with whatever tags a test asks for.
class TiffText {
 public:
  TiffText(std::uint32_t columns, std::uint32_t rows, const std::vector<float>& samples) {
    add(256, columns), add(257, rows), add(258, 32), add(259, 1), add(262, 1), add(277, 1), add(278, rows), add(339, 3);
    pixels_.resize(4 * samples.size());
    if (!samples.empty()) std::memcpy(pixels_.data(), samples.data(), pixels_.size());
  }
  void add(std::uint16_t tag, std::uint32_t value) {
    tags_[tag] = {tag == 256 || tag == 257 || tag == 278 ? 4u : 3u, 1, text_of(value)};
  }
  void add(std::uint16_t tag, const std::vector<double>& values) {
    std::string bytes(8 * values.size(), 0);
    std::memcpy(bytes.data(), values.data(), bytes.size());
    tags_[tag] = {12, static_cast<std::uint32_t>(values.size()), bytes};
  }
  void add(std::uint16_t tag, const std::vector<std::uint16_t>& values) {
    std::string bytes(2 * values.size(), 0);
    std::memcpy(bytes.data(), values.data(), bytes.size());
    tags_[tag] = {3, static_cast<std::uint32_t>(values.size()), bytes};
  }
  /// North-west corner and size of a pixel, and the code of a projected system (0: none).
  void place(double west, double north, double step, std::uint16_t crs) {
    add(33550, std::vector<double>{step, step, 0});
    add(33922, std::vector<double>{0, 0, 0, west, north, 0});
    if (crs != 0) add(34735, std::vector<std::uint16_t>{1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, crs});
  }
  std::string text() {
    tags_[273] = {4, 1, text_of(8)};
    tags_[279] = {4, 1, text_of(static_cast<std::uint32_t>(pixels_.size()))};
    const auto directory = static_cast<std::uint32_t>(8 + pixels_.size());
    std::uint32_t after = directory + 2 + 12 * static_cast<std::uint32_t>(tags_.size()) + 4;
    std::string out = std::string("II*\0", 4) + text_of(directory) + pixels_, far;
    out += text_of(static_cast<std::uint32_t>(tags_.size())).substr(0, 2);
    for (const auto& [tag, entry] : tags_) {
      out += text_of(tag).substr(0, 2) + text_of(entry.type).substr(0, 2) + text_of(entry.count);
      if (entry.bytes.size() <= 4) {
        out += (entry.bytes + std::string(4, 0)).substr(0, 4);
      } else {
        out += text_of(after + static_cast<std::uint32_t>(far.size()));
        far += entry.bytes;
      }
    }
    return out + std::string(4, 0) + far;
  }

 private:
  struct Entry {
    std::uint32_t type, count;
    std::string bytes;
  };
  static std::string text_of(std::uint32_t value) {
    return {static_cast<char>(value), static_cast<char>(value >> 8), static_cast<char>(value >> 16),
            static_cast<char>(value >> 24)};
  }
  std::map<std::uint16_t, Entry> tags_;
  std::string pixels_;
};

}  // namespace canyon::scene::testing

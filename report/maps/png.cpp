#include "canyon/report/maps/png.h"

#include <zlib.h>

#include "canyon/core/check.h"

namespace canyon::report {
namespace {

void append_be32(std::string& out, std::uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((v >> shift) & 0xFFu);
}

/// Length, type, data, CRC over type and data.
void append_chunk(std::string& png, std::string_view type, std::string_view data) {
  append_be32(png, static_cast<std::uint32_t>(data.size()));
  std::string body(type);
  body += data;
  png += body;
  append_be32(png, static_cast<std::uint32_t>(
                       crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()))));
}

std::string deflate_all(const std::string& raw) {
  uLongf size = compressBound(static_cast<uLong>(raw.size()));
  std::string out(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
                               static_cast<uLong>(raw.size()), Z_BEST_COMPRESSION);
  CANYON_CHECK(status == Z_OK, "zlib status ", status);
  out.resize(size);
  return out;
}

}  // namespace

std::string write_indexed_png(std::size_t width, std::size_t height, std::span<const std::uint8_t> indices,
                              const std::vector<Rgba>& palette) {
  CANYON_CHECK(width > 0 && height > 0 && width < (1u << 20) && height < (1u << 20) && indices.size() == width * height,
               "width ", width, ", height ", height, ", indices ", indices.size());
  CANYON_CHECK(!palette.empty() && palette.size() <= 256, "palette of ", palette.size());
  const bool nibbles = palette.size() <= 16;

  // Each row starts with filter type 0: filters of neighbouring values mean nothing for palette indices.
  std::string rows;
  rows.reserve(height * (1 + width));
  for (std::size_t y = 0; y < height; ++y) {
    rows += '\0';
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint8_t index = indices[y * width + x];
      CANYON_CHECK(index < palette.size(), "index ", int{index}, ", palette of ", palette.size());
      if (nibbles && x % 2 == 1) {
        rows.back() = static_cast<char>(static_cast<unsigned char>(rows.back()) | index);
      } else {
        rows += static_cast<char>(nibbles ? index << 4 : index);
      }
    }
  }

  std::string header;
  append_be32(header, static_cast<std::uint32_t>(width));
  append_be32(header, static_cast<std::uint32_t>(height));
  header += static_cast<char>(nibbles ? 4 : 8);  // bits a pixel
  header += static_cast<char>(3);                // palette colour
  header += std::string(3, '\0');                // deflate, adaptive filters, not interlaced
  std::string colours, alphas;
  for (const Rgba& c : palette) {
    colours += static_cast<char>(c.r);
    colours += static_cast<char>(c.g);
    colours += static_cast<char>(c.b);
    alphas += static_cast<char>(c.a);
  }

  std::string png("\x89PNG\r\n\x1A\n", 8);
  append_chunk(png, "IHDR", header);
  append_chunk(png, "PLTE", colours);
  append_chunk(png, "tRNS", alphas);
  append_chunk(png, "IDAT", deflate_all(rows));
  append_chunk(png, "IEND", {});
  return png;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = (word << 8) | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= n ? kDigits[(word >> (18 - 6 * k)) & 63u] : '=';
  }
  return out;
}

std::string png_data_uri(std::string_view png) {
  return "data:image/png;base64," + base64(png);
}

}  // namespace canyon::report

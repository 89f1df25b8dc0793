#include "canyon/report/maps/png.h"

#include <zlib.h>

#include <map>

#include <gtest/gtest.h>

#include "canyon/core/check.h"

namespace canyon::report {
namespace {

std::uint32_t be32(const std::string& bytes, std::size_t at) {
  std::uint32_t v = 0;
  for (std::size_t i = 0; i < 4; ++i) v = (v << 8) | static_cast<unsigned char>(bytes[at + i]);
  return v;
}

/// The chunks of a PNG in their order, with length and CRC checked.
std::vector<std::pair<std::string, std::string>> chunks(const std::string& png) {
  std::vector<std::pair<std::string, std::string>> out;
  EXPECT_EQ(png.substr(0, 8), std::string("\x89PNG\r\n\x1A\n"));
  for (std::size_t at = 8; at < png.size();) {
    const std::uint32_t length = be32(png, at);
    const std::string body = png.substr(at + 4, 4 + length);
    EXPECT_EQ(be32(png, at + 8 + length),
              crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
    out.emplace_back(body.substr(0, 4), body.substr(4));
    at += 12 + length;
  }
  return out;
}

/// Palette indices out of a PNG as this writer makes them.
std::vector<std::uint8_t> decode(const std::string& png, std::size_t width, std::size_t height) {
  std::map<std::string, std::string> chunk;
  for (const auto& [type, data] : chunks(png)) chunk[type] = data;
  EXPECT_EQ(be32(chunk["IHDR"], 0), width);
  EXPECT_EQ(be32(chunk["IHDR"], 4), height);
  const int bits = chunk["IHDR"][8];
  EXPECT_EQ(chunk["IHDR"].substr(9), std::string("\x03\0\0\0", 4));
  const std::size_t row = 1 + (width * static_cast<std::size_t>(bits) + 7) / 8;
  std::string raw(row * height, '\0');
  uLongf size = static_cast<uLongf>(raw.size());
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(raw.data()), &size,
                       reinterpret_cast<const Bytef*>(chunk["IDAT"].data()), static_cast<uLong>(chunk["IDAT"].size())),
            Z_OK);
  EXPECT_EQ(size, raw.size());
  std::vector<std::uint8_t> out;
  for (std::size_t y = 0; y < height; ++y) {
    EXPECT_EQ(raw[y * row], 0);
    for (std::size_t x = 0; x < width; ++x) {
      const auto byte = static_cast<unsigned char>(raw[y * row + 1 + (bits == 4 ? x / 2 : x)]);
      out.push_back(static_cast<std::uint8_t>(bits == 8 ? byte : x % 2 == 0 ? byte >> 4 : byte & 15));
    }
  }
  return out;
}

TEST(Png, IndicesComeBackAtFourBits) {
  constexpr std::size_t kWidth = 7, kHeight = 5;  // odd, so that the last nibble of a row is padding
  std::vector<std::uint8_t> pixels;
  for (std::size_t i = 0; i < kWidth * kHeight; ++i) pixels.push_back(static_cast<std::uint8_t>(i % 9));
  const std::string png = write_indexed_png(kWidth, kHeight, pixels, std::vector<Rgba>(9));
  EXPECT_EQ(decode(png, kWidth, kHeight), pixels);
}

TEST(Png, IndicesComeBackAtEightBits) {
  std::vector<std::uint8_t> pixels;
  for (std::size_t i = 0; i < 256; ++i) pixels.push_back(static_cast<std::uint8_t>(255 - i));
  EXPECT_EQ(decode(write_indexed_png(32, 8, pixels, std::vector<Rgba>(256)), 32, 8), pixels);
}

TEST(Png, ChunksAreInOrderAndHoldThePalette) {
  const std::vector<std::uint8_t> pixels{0, 1};
  const auto list = chunks(write_indexed_png(2, 1, pixels, {{0, 0, 0, 0}, {1, 2, 3, 255}}));
  ASSERT_EQ(list.size(), 5u);
  EXPECT_EQ(list[0].first, "IHDR");
  EXPECT_EQ(list[1], (std::pair<std::string, std::string>("PLTE", std::string("\0\0\0\1\2\3", 6))));
  EXPECT_EQ(list[2], (std::pair<std::string, std::string>("tRNS", std::string("\0\xFF", 2))));
  EXPECT_EQ(list[3].first, "IDAT");
  EXPECT_EQ(list[4], (std::pair<std::string, std::string>("IEND", "")));
}

TEST(Png, RefusesIndicesOutsideThePalette) {
  const std::vector<std::uint8_t> pixels{0, 2};
  EXPECT_THROW(write_indexed_png(2, 1, pixels, std::vector<Rgba>(2)), ProgramError);
  EXPECT_THROW(write_indexed_png(3, 1, pixels, std::vector<Rgba>(3)), ProgramError);
}

TEST(Base64, TestVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xFF\xFE\xFD"), "//79");
}

}  // namespace
}  // namespace canyon::report

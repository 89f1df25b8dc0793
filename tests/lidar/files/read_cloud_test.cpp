#include "canyon/lidar/files/clouds/read_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/lidar/velodyne/pcap.h"
#include "canyon/tests/support/temporary_folder.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::lidar {
namespace {

using Points = std::vector<Eigen::Vector3d>;

const Points kPoints{{1, -2, 3}, {0.5, 0.25, -1024}, {-7, 8.5, 0}};

template <class T>
std::string bytes_of(T value, bool big_endian = false) {
  std::string out(sizeof value, '\0');
  std::memcpy(out.data(), &value, sizeof value);
  if (big_endian) std::reverse(out.begin(), out.end());
  return out;
}

class ReadCloud : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& bytes) const {
    EXPECT_TRUE(write_text_file(folder_.file(name), bytes).ok());
    return folder_.file(name);
  }
  Points points(const std::string& name, const std::string& bytes) const {
    const auto cloud = read_cloud(file(name, bytes));
    EXPECT_TRUE(cloud.ok()) << (cloud.ok() ? "" : cloud.error().str());
    return cloud.ok() ? cloud->points : Points();
  }
  /// Without the folder.
  std::string refusal(const std::string& name, const std::string& bytes) const {
    const auto cloud = read_cloud(file(name, bytes));
    return cloud.ok() ? "" : cloud.error().str().substr(folder_.path().string().size() + 1);
  }

  canyon::testing::TemporaryFolder folder_;
};

std::string ply_header(const std::string& format, const std::string& type) {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex 3\nproperty uchar ring\nproperty " +
         type + " x\nproperty " + type + " y\nproperty " + type +
         " z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";
}

TEST_F(ReadCloud, PlyOfText) {
  EXPECT_EQ(points("a.ply", ply_header("ascii", "float") + "1 1 -2 3\n\n2 0.5 0.25 -1024\n3 -7 8.5 0\n"), kPoints);
}

TEST_F(ReadCloud, PlyOfEitherOrderAndPrecision) {
  for (const bool big_endian : {false, true}) {
    const std::string format = big_endian ? "binary_big_endian" : "binary_little_endian";
    std::string single = ply_header(format, "float32"), twice = ply_header(format, "double"), whole;
    for (const Eigen::Vector3d& p : kPoints) {
      single += '\7', twice += '\7';
      for (const double x : p) {
        single += bytes_of(static_cast<float>(x), big_endian);
        twice += bytes_of(x, big_endian);
      }
    }
    EXPECT_EQ(points("a.ply", single), kPoints);
    EXPECT_EQ(points("b.ply", twice), kPoints);
    EXPECT_TRUE(read_cloud(folder_.file("a.ply"))->single_precision);
    EXPECT_FALSE(read_cloud(folder_.file("b.ply"))->single_precision);
  }
}

TEST_F(ReadCloud, PlyOfWholeNumbers) {
  std::string text = ply_header("binary_big_endian", "short");
  for (int i = 0; i < 3; ++i) {
    text += '\1';
    for (const int x : {-300, 2, 30000 + i}) text += bytes_of(static_cast<std::int16_t>(x), true);
  }
  EXPECT_EQ(points("a.ply", text), (Points{{-300, 2, 30000}, {-300, 2, 30001}, {-300, 2, 30002}}));
}

/// Three points of `format`, in steps of a sixteenth from (512, -1024, 2048).
std::string las(int minor, int format, std::size_t record) {
  const std::size_t header = minor == 4 ? 375 : 227;
  std::string out(header, '\0');
  const auto put = [&out](std::size_t at, const std::string& bytes) { out.replace(at, bytes.size(), bytes); };
  put(0, "LASF");
  out[24] = 1, out[25] = static_cast<char>(minor);
  put(96, bytes_of(static_cast<std::uint32_t>(header)));
  out[104] = static_cast<char>(format);
  put(105, bytes_of(static_cast<std::uint16_t>(record)));
  if (minor == 4)
    put(247, bytes_of(std::uint64_t{3}));
  else
    put(107, bytes_of(std::uint32_t{3}));
  for (std::size_t a = 0; a < 3; ++a) put(131 + 8 * a, bytes_of(0.0625));
  put(155, bytes_of(512.0)), put(163, bytes_of(-1024.0)), put(171, bytes_of(2048.0));
  for (std::int32_t i = 0; i < 3; ++i) {
    std::string point(record, '\0');
    for (std::size_t a = 0; a < 3; ++a) point.replace(4 * a, 4, bytes_of(static_cast<std::int32_t>(16 * i - 8)));
    out += point;
  }
  return out;
}

TEST_F(ReadCloud, LasOfEachVersion) {
  const Points expected{{511.5, -1024.5, 2047.5}, {512.5, -1023.5, 2048.5}, {513.5, -1022.5, 2049.5}};
  EXPECT_EQ(points("a.las", las(2, 1, 28)), expected);
  EXPECT_EQ(points("a.las", las(3, 3, 34)), expected);
  EXPECT_EQ(points("a.las", las(4, 6, 30)), expected);
}

TEST_F(ReadCloud, BinOfFourNumbersAPoint) {
  std::string text;
  for (const Eigen::Vector3d& p : kPoints)
    for (const double x : {p.x(), p.y(), p.z(), 0.5}) text += bytes_of(static_cast<float>(x));
  EXPECT_EQ(points("a.bin", text), kPoints);
}

TEST_F(ReadCloud, PcdOfTextAndOfOtherTypes) {
  EXPECT_EQ(points("a.pcd",
                   "VERSION 0.7\nFIELDS label x y z\nSIZE 1 8 8 8\nTYPE U F F F\nCOUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\n"
                   "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA ascii\n1 1 -2 3\n1 0.5 0.25 -1024\n1 -7 8.5 0\n"),
            kPoints);
}

/// Compressed data of floats x, y, z, four points by their header, and so many unpacked bytes by their second length.
std::string compressed(const std::string& points, std::uint32_t unpacked, const std::string& packed) {
  return "VERSION 0.7\nFIELDS x y z w\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nPOINTS " + points +
         "\nDATA binary_compressed\n" + bytes_of(static_cast<std::uint32_t>(packed.size())) + bytes_of(unpacked) +
         packed;
}

// Four bytes as they are and a copy of what is 4 bytes back, over and over: LZF by hand.
TEST_F(ReadCloud, PcdOfCompressedData) {
  const std::string run = '\3' + bytes_of(2.5F);
  const std::string copy{'\xe0', static_cast<char>(60 - 2 - 7), '\3'};
  EXPECT_EQ(points("a.pcd", compressed("4", 64, run + copy)), Points(4, Eigen::Vector3d::Constant(2.5)));
}

// 2026-11-29: 2^60 points of 16 bytes are 0 bytes in 64 bits, and the same file of 8 bytes of data was believed; one of
// 300 bytes could ask for 4 GB.
TEST_F(ReadCloud, CompressedDataThatPromiseTooMuchAreRefused) {
  const std::string too_long =
      "a.pcd: DATA: the compressed data end early or are not as long as the header says, expected ";
  EXPECT_EQ(refusal("a.pcd", compressed("1152921504606846976", 0, "")), too_long + "1152921504606846976 points");
  EXPECT_EQ(refusal("a.pcd", compressed("18446744073709551615", 4294967280U, "abc")),
            too_long + "18446744073709551615 points");
  EXPECT_EQ(refusal("a.pcd", compressed("268435455", 4294967280U, std::string(300, '\0'))),
            "a.pcd: DATA: the compressed data are damaged, expected LZF as PCL writes it");
  EXPECT_EQ(refusal("a.pcd", compressed("4", 64, std::string("\3abc", 4))),
            "a.pcd: DATA: the compressed data are damaged, expected LZF as PCL writes it");
}

// Of a capture the first whole revolution: 600 rpm of 16 beams, 18.08 a millisecond, and of 32, 28.9 at 543 rpm.
TEST_F(ReadCloud, CapturesOfAVelodyne) {
  CANYON_REAL_DATA(vlp16, "lidar/velodyne/sample_velodyne_vlp16_gps.pcap");
  CANYON_REAL_DATA(hdl32, "lidar/velodyne/sample_velodyne_hdl32.pcap");
  for (const auto& [path, most] : {std::pair{vlp16, 29000U}, std::pair{hdl32, 79000U}}) {
    const auto cloud = read_cloud(path);
    ASSERT_TRUE(cloud.ok()) << cloud.error().str();
    EXPECT_GT(cloud->points.size(), 1000U) << path;
    EXPECT_LT(cloud->points.size(), most) << path;
    for (const Eigen::Vector3d& p : cloud->points) ASSERT_LT(p.norm(), 130.0) << path;
  }
}

TEST_F(ReadCloud, WhatIsWrongIsSaid) {
  EXPECT_EQ(refusal("a.ply", ""), "a.ply: is empty, expected a cloud of points");
  EXPECT_EQ(
      refusal("a.txt", "1 2 3\n"),
      "a.txt: is no cloud of a known form, expected PCD, PLY, LAS, .bin or a capture of a Velodyne or Ouster sensor");
  EXPECT_EQ(refusal("a.bin", "123"), "a.bin: is 3 bytes long, expected records of 16: x, y, z, intensity");
  EXPECT_EQ(refusal("a.ply", ply_header("ascii", "float") + "1 1 -2 3\n"),
            "a.ply: the file holds 1 points, expected 3 as its header says");
  EXPECT_EQ(refusal("a.ply", ply_header("ascii", "float") + "1 1 -2 3\n1 1 x 3\n"),
            "a.ply:13: \"1 1 x 3\", expected 4 numbers");
  EXPECT_EQ(refusal("a.ply", ply_header("binary_little_endian", "float") + std::string(20, '\0')),
            "a.ply: the file holds 1 points, expected 3 as its header says");
  EXPECT_EQ(refusal("a.ply", ply_header("ascii", "quad")),
            "a.ply:6: \"property quad x\" is not understood, expected a PLY header");
  EXPECT_EQ(refusal("a.ply", "ply\nformat ascii 1.0\n"), "a.ply:2: the header has no end, expected end_header");
  EXPECT_EQ(refusal("a.ply",
                    "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty "
                    "float z\nend_header\n"),
            "a.ply: holds no points, expected a cloud of points");
  EXPECT_EQ(refusal("a.las", las(2, 1, 28).substr(0, 100)), "a.las: ends within the header, expected a LAS file");
  EXPECT_EQ(refusal("a.las", las(1, 1, 28)), "a.las: is LAS 1.1, expected LAS 1.2 to 1.4");
  EXPECT_EQ(refusal("a.las", las(4, 129, 30)), "a.las: holds points of format 129, expected 0 to 10, not compressed");
  EXPECT_EQ(refusal("a.las", las(2, 1, 28).substr(0, 227 + 2 * 28)),
            "a.las: the file holds 2 points, expected 3 as its header says");
  // 2026-11-30: its name stood there twice, and "the rest was read".
  const std::string capture = velodyne::pcap_text({{0, 2368, std::string(1206, 'x')}, {1, 2368, "position"}});
  EXPECT_EQ(refusal("a.pcap", capture.substr(0, capture.size() - 1)),
            "a.pcap: ends inside packet 2, expected a whole capture");
}

}  // namespace
}  // namespace canyon::lidar

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>

#include "canyon/core/files/files.h"
#include "canyon/core/files/pcd.h"
#include "canyon/lidar/beam/beam_table.h"
#include "canyon/lidar/files/clouds/read_cloud.h"
#include "canyon/lidar/ouster/recording.h"
#include "canyon/lidar/velodyne/packet_reader.h"
#include "canyon/lidar/velodyne/pcap.h"
#include "canyon/tests/lidar/ouster/made_recording.h"
#include "canyon/tests/mutation/format.h"
#include "canyon/tests/mutation/packed_pcd.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::testing {
namespace {

using lidar::velodyne::Packet;

int status_of(const Error& error) {
  std::fprintf(stderr, "%s\n", error.str().c_str());
  return error.exit_code;
}

/// Three packets of a product: a wall all around, farther with every channel.
std::vector<lidar::velodyne::Datagram> datagrams(Packet::Product product, Packet::Mode mode) {
  std::vector<lidar::velodyne::Datagram> out;
  for (std::uint32_t k = 0; k < 3; ++k) {
    Packet packet;
    packet.product = product, packet.mode = mode;
    packet.time_us = 1000 + 1327 * k;
    for (std::size_t b = 0; b < Packet::kBlocks; ++b) {
      packet.blocks[b].azimuth_cdeg = static_cast<std::uint16_t>((k * Packet::kBlocks + b) * 40 % 36000);
      for (std::size_t c = 0; c < Packet::kChannels; ++c)
        packet.blocks[b].channels[c] = {static_cast<std::uint16_t>(1000 + 100 * c), static_cast<std::uint8_t>(8 * c)};
    }
    out.push_back({1291422600000000 + 1327 * static_cast<std::int64_t>(k), Packet::kPort, packet.bytes()});
  }
  return out;
}

/// The same capture with the other order of bytes in its headers, and nanoseconds.
std::string other_byte_order(std::string capture) {
  std::size_t at = 24;
  const auto turn = [&](std::size_t begin, std::size_t count) {
    std::reverse(capture.begin() + static_cast<std::ptrdiff_t>(begin),
                 capture.begin() + static_cast<std::ptrdiff_t>(begin + count));
  };
  capture[0] = 0x4d, capture[1] = 0x3c;  // nanoseconds, little-endian
  while (at + 16 <= capture.size()) {
    std::uint32_t length = 0;
    std::memcpy(&length, capture.data() + at + 8, 4);
    for (std::size_t i = 0; i < 4; ++i) turn(at + 4 * i, 4);
    at += 16 + length;
  }
  turn(0, 4), turn(4, 2), turn(6, 2);
  for (std::size_t i = 2; i < 6; ++i) turn(4 * i, 4);
  return capture;
}

std::vector<Seed> captures() {
  const std::string vlp16 = lidar::velodyne::pcap_text(datagrams(Packet::Product::kVlp16, Packet::Mode::kStrongest));
  std::vector<Seed> out{
      {"a.pcap", vlp16},
      {"a.pcap", lidar::velodyne::pcap_text(datagrams(Packet::Product::kHdl32e, Packet::Mode::kDual))},
      {"a.pcap", other_byte_order(vlp16)}};
  if (const std::string real = data_file("lidar/velodyne/sample_velodyne_vlp16_gps.pcap"); !real.empty())
    if (const auto bytes = read_text_file(real)) out.push_back({"a.pcap", bytes->substr(0, 6000)});
  return out;
}

/// All that is read of a capture: its datagrams, those that are packets, their returns and their timing.
int read_capture(const std::string& path) {
  const auto capture = lidar::velodyne::read_pcap(path);
  if (!capture) return status_of(capture.error());
  std::vector<Packet> packets;
  for (const auto& datagram : capture->datagrams) {
    const auto packet = Packet::parse(datagram.payload);
    if (!packet) continue;
    const auto table = lidar::load_beam_table(beam_table_of(packet->product));
    if (!table) return status_of(table.error());
    (void)decode(*packet, *table);
    if (packets.empty() || packets.front().product == packet->product) packets.push_back(*packet);
  }
  if (packets.size() >= 2) (void)timing(packets);
  return 0;
}

std::vector<Seed> clouds() {
  std::array<std::array<float, 5>, 12> points{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto x = static_cast<float>(i);
    points[i] = {x, 0.5f * x, 1.0f, 0.1f, 0.02f};
  }
  std::string bytes(sizeof points, '\0');
  std::memcpy(bytes.data(), points.data(), bytes.size());
  const std::string ours = pcd_header(
      {{.name = "x"}, {.name = "y"}, {.name = "z"}, {.name = "intensity"}, {.name = "error"}}, points.size());
  const std::string theirs =
      "VERSION .7\nFIELDS _ x y z normal\nSIZE 1 4 4 4 4\nTYPE U F F F F\nCOUNT 8 1 1 1 3\nWIDTH 7\nHEIGHT 1\n"
      "POINTS 7\nDATA binary\n";
  return {{"a.pcd", ours + bytes},
          {"b.pcd", theirs + bytes.substr(0, 7 * 32)},
          {.name = "c.pcd", .bytes = "SIZE\nTYPE\nCOUNT\n" + theirs, .fits = false}};
}

/// Walls on two sides of level ground.
constexpr const char* kYard =
    "v -20 -20 0\nv 20 -20 0\nv 20 20 0\nv -20 20 0\nv -20 20 6\nv 20 20 6\nv 20 -20 6\no ground\nf 1 2 3 4\no wall 1\n"
    "f 4 3 6 5\nf 3 2 7 6\n";

/// Of the forms that a cloud to be registered may have, beside PCD and captures.
std::vector<Seed> clouds_to_register() {
  std::string records(3 * 16, '\0');
  for (std::size_t i = 0; i < 12; ++i) {
    const float x = 0.5f * static_cast<float>(i) - 2.0f;
    std::memcpy(records.data() + 4 * i, &x, sizeof x);
  }
  const std::string head =
      "\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float intensity\nend_header\n";
  std::vector<Seed> out{
      {"a.bin", records},
      {"a.ply", "ply\nformat binary_little_endian 1.0" + head + records},
      {"b.ply", "ply\nformat ascii 1.0" + head + "-2 -1.5 -1 0.5\n0 0.5 1 1.5\n2 2.5 3 3.5\n"},
      {"a.pcd",
       "VERSION .7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\n"
       "POINTS 3\nDATA ascii\n-2 -1.5 -1 0.5\n0 0.5 1 1.5\n2 2.5 3 3.5\n"}};
  static const std::vector<Seed> las = written_by_canyon({"lidar", "scan", "--scene", "yard.obj", "--at", "0,0,2,0",
                                                          "--azimuth-steps", "12", "--format", "las", "--out", "scan"},
                                                         {"scan/scan_000000.las"}, {{"yard.obj", kYard}});
  for (const Seed& seed : las) out.push_back({"a.las", seed.bytes});
  return out;
}

int read_any_cloud(const std::string& path) {
  const auto cloud = lidar::read_cloud(path);
  return cloud ? 0 : status_of(cloud.error());
}

/// All values of a column one after the other.
template <class T>
void add_column(std::string& columns, std::size_t points, const T& value_at) {
  for (std::size_t i = 0; i < points; ++i) {
    const auto value = value_at(static_cast<int>(i));
    columns.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
}

/// Runs, short copies and long ones in the one, columns of other widths in the other.
std::vector<Seed> compressed_clouds() {
  constexpr std::size_t kPacked = 90;
  std::string floats, mixed;
  add_column(floats, kPacked, [](int i) { return 0.37F * static_cast<float>(i * i); });
  add_column(floats, kPacked, [](int i) { return static_cast<float>(i % 5); });
  for (int column = 0; column < 2; ++column) add_column(floats, kPacked, [](int) { return -1.75F; });
  add_column(mixed, kPacked, [](int i) { return static_cast<std::uint8_t>(i / 30); });
  for (const double step : {0.5, 0.25, 0.0}) add_column(mixed, kPacked, [step](int i) { return step * i; });
  const auto wide = [](const char* name) { return PcdField{.name = name, .size = 8}; };
  return {{"a.pcd", packed_pcd({{.name = "x"}, {.name = "y"}, {.name = "z"}, {.name = "intensity"}}, kPacked, floats)},
          {"b.pcd",
           packed_pcd({{.name = "label", .type = 'U', .size = 1}, wide("x"), wide("y"), wide("z")}, kPacked, mixed)}};
}

std::string ouster_capture() {
  using lidar::ouster::testing::packet;
  return lidar::ouster::testing::capture(
      {packet(7, 0), "an inertial packet", packet(7, 2), packet(8, 0), packet(8, 2, false), packet(9, 0)});
}

/// Of a metadata file all that is made of it, with the capture beside it.
int read_ouster_metadata(const std::string& path) {
  const auto metadata = lidar::ouster::read_metadata(path);
  if (!metadata) return status_of(metadata.error());
  const auto frames = lidar::ouster::read_frames("whole.pcap", *metadata);
  return frames ? 0 : status_of(frames.error());
}

constexpr const char* kBeams =
    "# a made-up sensor\ncycle_us,50\nlaser,elevation_deg,azimuth_offset_deg,origin_up_mm,firing_us\n0,-10,0,0,0\n"
    "1,0,1.5,11,2.3\n2,5,-1.5,-11,4.6\n3,10,0,7,6.9\n";
constexpr const char* kBeamsWithOrigins =
    "cycle_us,50\nlaser,elevation_deg,azimuth_offset_deg,origin_up_mm,firing_us,origin_out_mm,origin_left_mm\n"
    "0,-10,0,0,0,10,2\n1,0,1.5,11,2.3,20,-2\n";
constexpr const char* kRosette =
    "rosette\nlasers,6\npoints_per_s,2400\nhead_hz,17.3\nswing_hz,21.1\nelevation_min_deg,-7\nelevation_max_deg,52\n";

}  // namespace

std::vector<Format> lidar_formats() {
  const auto yard = [] { return std::vector<Companion>{{"yard.obj", kYard}}; };
  return {{.name = "BeamTable",
           .command = {"lidar", "scan", "--scene", "yard.obj", "--at", "0,0,2,0", "--beams", "@", "--azimuth-steps",
                       "60", "--model", "single_ray"},
           .read = {},
           .seeds =
               [] {
                 return std::vector<Seed>{{"mine.csv", kBeams}, {"origins.csv", kBeamsWithOrigins}};
               },
           .beside = yard},
          {.name = "RosetteTable",
           .command = {"lidar", "scan", "--scene", "yard.obj", "--at", "0,0,2,0", "--beams", "@", "--azimuth-steps",
                       "0", "--model", "single_ray"},
           .read = {},
           .seeds =
               [] {
                 return std::vector<Seed>{{"rosette.csv", kRosette}};
               },
           .beside = yard},
          {.name = "Cloud", .command = {}, .read = read_any_cloud, .seeds = clouds_to_register},
          {.name = "CompressedPcd", .command = {}, .read = read_any_cloud, .seeds = compressed_clouds},
          {.name = "OusterCapture",
           .command = {},
           .read = read_any_cloud,
           .seeds =
               [] {
                 return std::vector<Seed>{{"a_b.pcap", ouster_capture()}};
               },
           .beside =
               [] {
                 return std::vector<Companion>{{"a.json", lidar::ouster::testing::kMetadata}};
               }},
          {.name = "OusterMetadata",
           .command = {},
           .read = read_ouster_metadata,
           .seeds =
               [] {
                 return std::vector<Seed>{{"a.json", lidar::ouster::testing::kMetadata}};
               },
           .beside =
               [] {
                 return std::vector<Companion>{{"whole.pcap", ouster_capture()}};
               }},
          {.name = "Pcap", .command = {}, .read = read_capture, .seeds = captures},
          {.name = "Pcd",
           .command = {},
           .read =
               [](const std::string& path) {
                 auto cloud = PcdReader::open(path);
                 if (!cloud) return status_of(cloud.error());
                 for (const char* field : {"x", "y", "z"})
                   if (const auto at = cloud->float_at(field); !at) return status_of(at.error());
                 for (;;) {
                   const auto bytes = cloud->next();
                   if (!bytes) return status_of(bytes.error());
                   if (bytes->empty()) return 0;
                 }
               },
           .seeds = clouds}};
}

}  // namespace canyon::testing

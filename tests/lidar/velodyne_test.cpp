#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/lidar/velodyne/packet_reader.h"
#include "canyon/lidar/velodyne/packet_writer.h"
#include "canyon/lidar/velodyne/pcap.h"
#include "canyon/lidar/velodyne/udp_sender.h"
#include "canyon/tests/lidar/lidar_scenes.h"
#include "canyon/tests/support/temporary_folder.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::lidar::velodyne {
namespace {

using lidar::testing::kStart;

std::vector<Packet> data_packets(const std::string& path) {
  const auto capture = read_pcap(path);
  EXPECT_TRUE(capture.ok()) << capture.error().str();
  std::vector<Packet> packets;
  for (const Datagram& d : capture->datagrams)
    if (const auto packet = Packet::parse(d.payload)) packets.push_back(*packet);
  return packets;
}

LidarConfig free_running(const std::string& beams, double rpm) {
  LidarConfig config = lidar::testing::ideal_lidar();
  config.beams = beams;
  config.azimuth_steps = 0;
  config.rate_hz = rpm / 60.0;
  config.report.range_quantum_m = 0.002;
  return config;
}

struct Stream {
  std::vector<LidarScan> scans;
  std::vector<StampedPacket> packets;
};

/// `scans` revolutions standing among the blocks of a street crossing.
Stream stream_of(const LidarConfig& config, int scans) {
  const scene::Scene scene(lidar::testing::street_crossing());
  const auto scanner = *make_scanner(config, 1);
  auto writer = PacketWriter::create(config);
  EXPECT_TRUE(writer.ok()) << writer.error().str();
  const Trajectory motion = lidar::testing::standing(lidar::testing::pose_at(0, 0, 1.8, 30), 10.0);
  Stream out;
  for (int i = 0; i < scans; ++i) {
    const LidarOutput output = scanner->scan(i, kStart + (i + 1) / config.rate_hz, motion, scene::SceneAt(scene));
    out.scans.push_back(output.scan);
    for (const StampedPacket& p : writer->add(i, output.scan)) out.packets.push_back(p);
  }
  return out;
}

std::vector<Packet> bare(const std::vector<StampedPacket>& stamped) {
  std::vector<Packet> out;
  for (const StampedPacket& p : stamped) out.push_back(p.packet);
  return out;
}

TEST(VelodyneRecording, Vlp16TimingAzimuthStepsAndRanges) {
  CANYON_REAL_DATA(path, "lidar/velodyne/sample_velodyne_vlp16_gps.pcap");
  const auto capture = read_pcap(path);
  ASSERT_TRUE(capture.ok()) << capture.error().str();
  EXPECT_EQ(capture->datagrams.size(), 293u + 57u) << "data and position packets";
  EXPECT_EQ(capture->warning, "");
  const auto packets = data_packets(path);
  ASSERT_EQ(packets.size(), 293u);
  const Timing t = timing(packets);
  // Time stamps are whole microseconds: their mean over 292 intervals is off by 1/292 us at most.
  EXPECT_NEAR(t.packet_us, 24 * 55.296, 1.0 / 292);
  EXPECT_NEAR(t.azimuth_step_deg, 0.3975, 0.0001);
  EXPECT_NEAR(t.rpm, 599.1, 0.1);
  EXPECT_NEAR(t.azimuth_step_min_deg, 0.38, 1e-9);
  EXPECT_NEAR(t.azimuth_step_max_deg, 0.42, 1e-9);
  const BeamTable table = *load_beam_table("vlp16");
  double farthest_m = 0;
  for (const Packet& p : packets) {
    EXPECT_EQ(p.mode, Packet::Mode::kStrongest);
    EXPECT_EQ(p.product, Packet::Product::kVlp16);
    for (const Return& r : decode(p, table)) farthest_m = std::max(farthest_m, r.distance_m);
  }
  EXPECT_NEAR(farthest_m, 2.84, 0.005) << "an indoor recording";
}

TEST(VelodyneRecording, Hdl32eTimingAndRanges) {
  CANYON_REAL_DATA(path, "lidar/velodyne/sample_velodyne_hdl32.pcap");
  const auto packets = data_packets(path);
  ASSERT_EQ(packets.size(), 500u);
  const Timing t = timing(packets);
  EXPECT_NEAR(t.packet_us, 12 * 46.08, 1.0 / 499);
  EXPECT_NEAR(t.rpm, 543, 1.0);
  const BeamTable table = *load_beam_table("hdl32e");
  std::vector<double> ranges_m;
  for (const Packet& p : packets) {
    EXPECT_EQ(p.product, Packet::Product::kHdl32e);
    for (const Return& r : decode(p, table)) ranges_m.push_back(r.distance_m);
  }
  ASSERT_GT(ranges_m.size(), 100'000u);
  std::sort(ranges_m.begin(), ranges_m.end());
  EXPECT_NEAR(ranges_m.back(), 81, 1);
  EXPECT_NEAR(ranges_m[ranges_m.size() / 2], 5.8, 0.05);
}

TEST(VelodyneRecording, OurSensorTurnsAndFiresLikeTheRecordedOne) {
  CANYON_REAL_DATA(path, "lidar/velodyne/sample_velodyne_vlp16_gps.pcap");
  const Timing real = timing(data_packets(path));
  const Timing ours = timing(bare(stream_of(free_running("vlp16", real.rpm), 4).packets));
  EXPECT_NEAR(ours.azimuth_step_deg, real.azimuth_step_deg, 0.001);
  EXPECT_GE(ours.azimuth_step_min_deg, real.azimuth_step_min_deg);
  EXPECT_LE(ours.azimuth_step_max_deg, real.azimuth_step_max_deg);
  EXPECT_NEAR(ours.packet_us, real.packet_us, 1.0 / 292 + 1.0 / static_cast<double>(ours.packets - 1));
}

class Packets : public ::testing::TestWithParam<const char*> {};

TEST_P(Packets, TurnAndFireAsTheManualSays) {
  const std::string beams = GetParam();
  const double rpm = beams == "vlp16" ? 599.1 : 543.0;
  const double block_us = beams == "vlp16" ? 110.592 : 46.08;
  const Stream stream = stream_of(free_running(beams, rpm), 4);
  const Timing t = timing(bare(stream.packets));
  ASSERT_GT(t.packets, 250u);
  const double step_deg = 360.0 * rpm / 60.0 * block_us * 1e-6;
  // Azimuths are rounded to 0.01 deg, times to whole microseconds; only the first and last roundings count in a mean.
  const auto intervals = static_cast<double>(t.packets - 1);
  EXPECT_NEAR(t.packet_us, 12 * block_us, 1.0 / intervals);
  EXPECT_NEAR(t.azimuth_step_deg, step_deg, 0.01 / (12 * intervals));
  EXPECT_GE(t.azimuth_step_min_deg, step_deg - 0.01);
  EXPECT_LE(t.azimuth_step_max_deg, step_deg + 0.01);
  EXPECT_NEAR(t.rpm, rpm, 0.01);
}

TEST_P(Packets, SayWhatTheScansSaid) {
  const std::string beams = GetParam();
  const LidarConfig config = free_running(beams, 600);
  const Stream stream = stream_of(config, 2);
  const BeamTable table = *load_beam_table(beams);
  std::vector<LidarPoint> scanned;
  std::vector<double> scanned_s;
  for (const LidarScan& scan : stream.scans) {
    for (const LidarPoint& p : scan.points) {
      scanned.push_back(p);
      scanned_s.push_back(scan.t - kStart + p.time_s);
    }
  }
  std::size_t i = 0, compared = 0;
  for (const StampedPacket& stamped : stream.packets) {
    auto returns = decode(Packet::parse(stamped.packet.bytes()).value(), table);
    // Channels of a block in the order of firing, as in the scan.
    ASSERT_TRUE(std::is_sorted(returns.begin(), returns.end(),
                               [](const Return& a, const Return& b) { return a.time_us < b.time_us; }));
    for (const Return& r : returns) {
      ASSERT_LT(i, scanned.size());
      const LidarPoint& p = scanned[i];
      ASSERT_EQ(r.laser, p.ring) << i;
      // The float time of a point, and the stamp in whole nanoseconds.
      ASSERT_NEAR(stamped.t - kStart + 1e-6 * r.time_us, scanned_s[i], 1e-8) << i;
      // Ranges are whole quanta in both; azimuths are rounded to 0.01 deg, and interpolated over a block rounded at
      // both ends.
      const double range_m = lidar::testing::position(p).norm();
      ASSERT_NEAR(r.point.z, p.z, 1e-5);
      ASSERT_LT((lidar::testing::position(r.point) - lidar::testing::position(p)).norm(),
                range_m * 0.02 * kDegree + 1e-5)
          << i;
      ASSERT_NEAR(r.reflectivity, 100 * p.intensity, 0.5 + 1e-4);
      ++i, ++compared;
    }
  }
  EXPECT_GT(compared, 20'000u);
}

INSTANTIATE_TEST_SUITE_P(Both, Packets, ::testing::Values("vlp16", "hdl32e"));

TEST(Packets, OfTwoReturnsTheLastComesFirst) {
  LidarConfig config = free_running("vlp16", 600);
  config.model.name = "footprint";
  config.report.returns = ReturnMode::kDual;
  const Stream stream = stream_of(config, 1);
  ASSERT_GT(stream.packets.size(), 100u);
  std::size_t differ = 0, equal = 0;
  for (const StampedPacket& stamped : stream.packets) {
    ASSERT_EQ(stamped.packet.mode, Packet::Mode::kDual);
    for (std::size_t b = 0; b < Packet::kBlocks; b += 2) {
      const Packet::Block &last = stamped.packet.blocks[b], &other = stamped.packet.blocks[b + 1];
      ASSERT_EQ(last.azimuth_cdeg, other.azimuth_cdeg);
      for (std::size_t c = 0; c < Packet::kChannels; ++c) {
        ASSERT_GE(last.channels[c].distance, other.channels[c].distance);
        (last.channels[c].distance > other.channels[c].distance ? differ : equal)++;
      }
    }
  }
  EXPECT_GT(differ, 10u) << "at the edges of the blocks";
  EXPECT_GT(equal, 100 * differ) << "a single return is both";
}

TEST(Packets, OnlyForSensorsAndModesThatHaveThem) {
  LidarConfig config;
  config.beams = "os1_64";
  EXPECT_EQ(PacketWriter::create(config).error().str(),
            "lidar.beams: \"os1_64\" has no packets, expected vlp16 or hdl32e");
  config.beams = "vlp16";
  config.report.returns = ReturnMode::kFirst;
  EXPECT_EQ(PacketWriter::create(config).error().str(),
            "lidar.returns: \"first\" does not fit into packets, expected strongest, last or dual");
}

class Pcap : public ::testing::Test {
 protected:
  std::string path_ = canyon::testing::temporary_file("test.pcap");
  std::string error_of(const std::string& bytes) {
    EXPECT_TRUE(write_text_file(path_, bytes).ok());
    const auto capture = read_pcap(path_);
    return capture.ok() ? "no error" : capture.error().str();
  }
};

TEST_F(Pcap, ReadsBackWhatWasWritten) {
  std::vector<Datagram> sent;
  for (int i = 0; i < 5; ++i)
    sent.push_back({1'293'840'000'123'456 + i, static_cast<std::uint16_t>(2368 + i), std::string(100 + i, 'a')});
  ASSERT_TRUE(write_text_file(path_, pcap_text(sent)).ok());
  const auto capture = read_pcap(path_);
  ASSERT_TRUE(capture.ok()) << capture.error().str();
  ASSERT_EQ(capture->datagrams.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(capture->datagrams[i].unix_us, sent[i].unix_us);
    EXPECT_EQ(capture->datagrams[i].port, sent[i].port);
    EXPECT_EQ(capture->datagrams[i].payload, sent[i].payload);
  }
}

TEST_F(Pcap, DamagedFilesAreToldAndNeverCrash) {
  const std::string good = pcap_text({{0, 2368, std::string(1206, 'x')}, {1, 2368, std::string(1206, 'y')}});
  EXPECT_EQ(error_of(""),
            path_ + ": too short to be a capture, expected a capture in pcap format with Ethernet frames");
  EXPECT_EQ(error_of(std::string(1000, 'z')),
            path_ + ": does not begin as a capture, expected a capture in pcap format with Ethernet frames");
  std::string other_link = good;
  other_link[20] = 113;
  EXPECT_EQ(error_of(other_link), path_ + ": link type 113, expected a capture in pcap format with Ethernet frames");
  for (std::size_t length = 24; length < good.size(); length += 7) {
    ASSERT_TRUE(write_text_file(path_, std::string_view(good).substr(0, length)).ok());
    const auto capture = read_pcap(path_);
    ASSERT_TRUE(capture.ok());
    const std::size_t whole = (length - 24) / (16 + 42 + 1206);
    EXPECT_EQ(capture->datagrams.size(), whole);
    const bool inside = (length - 24) % (16 + 42 + 1206) != 0;
    EXPECT_EQ(capture->warning, inside ? "ends inside packet " + std::to_string(whole + 1) : "");
  }
}

TEST(PacketBytes, AnythingElseIsNoPacket) {
  EXPECT_FALSE(Packet::parse("").has_value());
  EXPECT_FALSE(Packet::parse(std::string(1206, '\0')).has_value());
  EXPECT_FALSE(Packet::parse(std::string(512, 'x')).has_value()) << "a position packet";
  Packet packet;
  packet.blocks[3].azimuth_cdeg = 35999;
  packet.blocks[11].channels[31] = {65535, 255};
  packet.time_us = 3'599'999'999;
  packet.mode = Packet::Mode::kLast;
  packet.product = Packet::Product::kHdl32e;
  std::string bytes = packet.bytes();
  const auto again = Packet::parse(bytes);
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->bytes(), bytes);
  EXPECT_EQ(again->blocks[11].channels[31].distance, 65535);
  EXPECT_EQ(again->time_us, 3'599'999'999u);
  bytes[1205] = 0x28;  // a VLP-32C
  EXPECT_FALSE(Packet::parse(bytes).has_value());
}

TEST(UdpSender, SendsOverLoopback) {
  const int receiver = socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(receiver, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(receiver, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  socklen_t size = sizeof address;
  ASSERT_EQ(getsockname(receiver, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const auto sender = UdpSender::open("127.0.0.1", ntohs(address.sin_port));
  ASSERT_TRUE(sender.ok()) << sender.error().str();
  const std::string sent = Packet{}.bytes();
  ASSERT_TRUE(sender->send(sent).ok());
  std::string received(2000, '\0');
  const auto length = recv(receiver, received.data(), received.size(), 0);
  close(receiver);
  ASSERT_EQ(length, static_cast<ssize_t>(sent.size()));
  EXPECT_EQ(received.substr(0, sent.size()), sent);
  EXPECT_EQ(UdpSender::open("somewhere", 2368).error().str(),
            "udp: \"somewhere\" is not an address, expected an IPv4 address such as 127.0.0.1");
}

}  // namespace
}  // namespace canyon::lidar::velodyne

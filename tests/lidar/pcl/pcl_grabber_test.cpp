// PCL's own decoders of Velodyne packets read our captures.
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>
#include <pcl/io/hdl_grabber.h>
#include <pcl/io/vlp_grabber.h>
#include <pcl/point_types.h>

#include "canyon/core/files/files.h"
#include "canyon/lidar/velodyne/packet_reader.h"
#include "canyon/lidar/velodyne/packet_writer.h"
#include "canyon/lidar/velodyne/pcap.h"
#include "canyon/lidar/velodyne/udp_sender.h"
#include "canyon/tests/lidar/lidar_scenes.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::lidar {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZI>;

// How far PCL's azimuths are off, at 3600 deg/s: the VLP grabber interpolates between the two cycles of a block but
// takes one azimuth for all firings of a cycle, 34.56 us; the HDL grabber takes one for all firings of a block, 36.9
// us.
constexpr double kVlpBlur_deg = 34.56e-6 * 3600 + 0.02, kHdlBlur_deg = 36.9e-6 * 3600 + 0.02;

/// Four revolutions as packets, written as a capture; returns every return in the packets' order.
std::vector<velodyne::Return> write_capture(const std::string& beams, double rpm, const std::string& path) {
  LidarConfig config = testing::ideal_lidar();
  config.beams = beams;
  config.azimuth_steps = 0;
  config.rate_hz = rpm / 60.0;
  const scene::Scene scene(testing::street_crossing());
  const auto scanner = *make_scanner(config, 1);
  auto writer = *velodyne::PacketWriter::create(config);
  const Trajectory motion = testing::standing(testing::pose_at(0, 0, 1.8, 30), 10.0);
  const BeamTable table = *load_beam_table(beams);
  std::vector<velodyne::Return> returns;
  std::vector<velodyne::Datagram> datagrams;
  for (int i = 0; i < 4; ++i) {
    const GpsTime t = testing::kStart + (i + 1) / config.rate_hz;
    for (const auto& p : writer.add(i, scanner->scan(i, t, motion, scene::SceneAt(scene)).scan)) {
      datagrams.push_back({p.t.ns / 1000, velodyne::Packet::kPort, p.packet.bytes()});
      for (const auto& r : velodyne::decode(p.packet, table)) returns.push_back(r);
    }
  }
  EXPECT_TRUE(write_text_file(path, velodyne::pcap_text(datagrams)).ok());
  return returns;
}

/// Everything a grabber gives, sweep after sweep.
std::vector<pcl::PointXYZI> grab(pcl::HDLGrabber& grabber, std::size_t& sweeps) {
  std::vector<pcl::PointXYZI> points;
  std::mutex mutex;
  std::function<void(const Cloud::ConstPtr&)> take = [&](const Cloud::ConstPtr& cloud) {
    const std::lock_guard lock(mutex);
    points.insert(points.end(), cloud->begin(), cloud->end());
    ++sweeps;
  };
  grabber.registerCallback(take);
  grabber.start();
  // The file is played at its own pace, 0.4 s. PCL does not tell its end: nothing new for a second is taken for it.
  std::size_t seen = 0;
  for (int quiet = 0, waited = 0; quiet < 20 && waited < 400; ++waited) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const std::lock_guard lock(mutex);
    quiet = points.size() == seen && seen > 0 ? quiet + 1 : 0;
    seen = points.size();
  }
  grabber.stop();
  const std::lock_guard lock(mutex);
  return points;
}

/// PCL's points are ours, in the same order, in Velodyne's frame (x right, y forward). `blur_deg`: how far its azimuth
/// may be off.
void expect_same(const std::vector<pcl::PointXYZI>& theirs, const std::vector<velodyne::Return>& ours, double blur_deg,
                 const BeamTable& table) {
  ASSERT_GT(theirs.size(), 20'000u);
  ASSERT_LE(theirs.size(), ours.size());
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    const pcl::PointXYZI& p = theirs[i];
    const velodyne::Return& r = ours[i];
    const double range_m = std::hypot(p.x, p.y, p.z);
    ASSERT_NEAR(range_m, r.distance_m, 2e-5 * r.distance_m) << i;
    ASSERT_NEAR(p.z, r.distance_m * std::sin(table.beams[r.laser].elevation_rad), 2e-4 + 2e-5 * range_m) << i;
    ASSERT_NEAR(std::hypot(p.x, p.y), std::hypot(r.point.x, r.point.y), 2e-4 + 2e-5 * range_m) << i;
    const double azimuth_deg = std::atan2(p.x, p.y) / kDegree;
    ASSERT_LE(std::abs(std::remainder(azimuth_deg - r.azimuth_deg, 360.0)), blur_deg) << i;
    ASSERT_EQ(p.intensity, r.reflectivity) << i;
  }
}

class PclGrabber : public ::testing::Test {
 protected:
  std::string path_ = canyon::testing::temporary_file("test.pcap");
};

TEST_F(PclGrabber, VlpGrabberDecodesOurVlp16) {
  const auto ours = write_capture("vlp16", 600, path_);
  std::size_t sweeps = 0;
  pcl::VLPGrabber grabber(path_);
  const auto theirs = grab(grabber, sweeps);
  EXPECT_GE(sweeps, 3u);
  expect_same(theirs, ours, kVlpBlur_deg, *load_beam_table("vlp16"));
}

TEST_F(PclGrabber, HdlGrabberDecodesOurHdl32e) {
  const auto ours = write_capture("hdl32e", 600, path_);
  std::size_t sweeps = 0;
  pcl::HDLGrabber grabber("", path_);
  const auto theirs = grab(grabber, sweeps);
  EXPECT_GE(sweeps, 3u);
  expect_same(theirs, ours, kHdlBlur_deg, *load_beam_table("hdl32e"));
}

/// Everything that a grabber gives which listens on a port of the loopback interface. We send a capture as `canyon
/// lidar scan --udp` does, at the sensor's own pace.
std::vector<pcl::PointXYZI> listen(pcl::HDLGrabber& grabber, std::uint16_t port, const std::string& path) {
  const auto capture = *velodyne::read_pcap(path);
  std::mutex mutex;
  std::vector<pcl::PointXYZI> theirs;
  std::size_t sweeps = 0;
  std::function<void(const Cloud::ConstPtr&)> take = [&](const Cloud::ConstPtr& cloud) {
    const std::lock_guard lock(mutex);
    theirs.insert(theirs.end(), cloud->begin(), cloud->end());
    ++sweeps;
  };
  grabber.registerCallback(take);
  grabber.start();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until it listens
  auto sender = *velodyne::UdpSender::open("127.0.0.1", port);
  const auto begin = std::chrono::steady_clock::now();
  const std::int64_t first_us = capture.datagrams.front().unix_us;
  double sent_s = 0;
  for (const auto& datagram : capture.datagrams) {
    sent_s = 1e-6 * static_cast<double>(datagram.unix_us - first_us);
    EXPECT_TRUE(sender.send_at(datagram.payload, sent_s).ok());
  }
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_GE(took_s, sent_s) << "never ahead of the sensor";
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  // PCL notices that it is to stop when a packet arrives: one that is no data packet, until it has.
  std::atomic<bool> stopped = false;
  std::thread last([&] {
    while (!stopped) {
      EXPECT_TRUE(sender.send("the end").ok());
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  grabber.stop();
  stopped = true;
  last.join();
  const std::lock_guard lock(mutex);
  EXPECT_GE(sweeps, 3u);
  return theirs;
}

TEST_F(PclGrabber, VlpGrabberDecodesOurUdpStream) {
  constexpr std::uint16_t kPort = 23688;
  const auto ours = write_capture("vlp16", 600, path_);
  pcl::VLPGrabber grabber(boost::asio::ip::address::from_string("127.0.0.1"), kPort);
  expect_same(listen(grabber, kPort, path_), ours, kVlpBlur_deg, *load_beam_table("vlp16"));
}

TEST_F(PclGrabber, HdlGrabberDecodesOurUdpStream) {
  constexpr std::uint16_t kPort = 23689;
  const auto ours = write_capture("hdl32e", 600, path_);
  pcl::HDLGrabber grabber(boost::asio::ip::address::from_string("127.0.0.1"), kPort);
  expect_same(listen(grabber, kPort, path_), ours, kHdlBlur_deg, *load_beam_table("hdl32e"));
}

}  // namespace
}  // namespace canyon::lidar

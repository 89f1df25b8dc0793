// canyon lidar scan: as a user calls it.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Json = nlohmann::json;

/// A square of 40 m and a wall of 10 m before it, to the east.
constexpr const char* kYard = R"(o ground
v -20 -20 0
v 20 -20 0
v 20 20 0
v -20 20 0
f 1 2 3 4
o wall
v 10 -15 -1
v 10 15 -1
v 10 15 10
v 10 -15 10
f 5 6 7 8
)";

class LidarScanTest : public testing::CommandLineTest {
 protected:
  std::size_t lines_of(const std::string& name) const {
    const std::string text = read(name);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
};

TEST_F(LidarScanTest, EveryFormatHoldsWhatTheSummarySays) {
  for (const std::string format : {"pcd", "ply", "las"}) {
    ASSERT_EQ(canyon("lidar scan --at 120,-40,0,90 --scans 2 --format " + format + " --out " + format + " --json"), 0)
        << read("stderr");
    const Json summary = Json::parse(read("stdout"));
    EXPECT_EQ(summary["scans"], 2);
    EXPECT_EQ(summary["rays"], 2 * 28800);
    EXPECT_EQ(summary["beams"], "vlp16");
    EXPECT_GT(summary["timing"]["ms_per_scan"].get<double>(), 0.0);
    EXPECT_GT(summary["timing"]["million_rays_per_s"].get<double>(), 0.0);
    const std::string first = read(format + "/scan_000000." + format), second = read(format + "/scan_000001." + format);
    const std::size_t points =
        lines_of(format + "/scan_000000_truth.csv") + lines_of(format + "/scan_000001_truth.csv") - 2;
    EXPECT_EQ(summary["points"], points);
    const std::size_t point_bytes = format == "las" ? 28 : 23;
    const std::size_t headers = format == "las"   ? 2 * 227
                                : format == "pcd" ? first.find("binary\n") + 7 + second.find("binary\n") + 7
                                                  : first.find("end_header\n") + 11 + second.find("end_header\n") + 11;
    EXPECT_EQ(first.size() + second.size(), headers + points * point_bytes);
    EXPECT_THAT(read(format + "/scan_000000_truth.csv"), StartsWith("true_range_m,cos_incidence,material,object\n"));
    EXPECT_EQ(lines_of(format + "/trajectory.tum"), 3u) << "a comment and two poses";
  }
  EXPECT_THAT(read("pcd/scan_000000.pcd"), HasSubstr("FIELDS x y z intensity time ring return\n"));
}

TEST_F(LidarScanTest, TheSummarySaysWhatItCost) {
  ASSERT_EQ(canyon("lidar scan --at 120,-40,0,90 --model footprint --returns dual --see-through both"), 0)
      << read("stderr");
  EXPECT_THAT(read("stdout"), StartsWith("1 scans with vlp16, footprint: 460800 rays, "));
  EXPECT_THAT(read("stdout"),
              ::testing::ContainsRegex("Scanned in [0-9.]+ s: [0-9.]+ ms per scan, [0-9.]+ million rays"));
}

TEST_F(LidarScanTest, AnySceneFileIsScanned) {
  write("given_yard.obj", kYard);
  ASSERT_EQ(canyon("lidar scan --scene given_yard.obj --at 0,0,0,0 --frame scene --format ply --out yard --json"), 0)
      << read("stderr");
  EXPECT_GT(Json::parse(read("stdout"))["points"].get<int>(), 5000);
  EXPECT_THAT(read("yard/scan_000000_truth.csv"), HasSubstr("wall"));
}

TEST_F(LidarScanTest, MovingThingsOfAMissionAreSeen) {
  write("traffic.toml", std::string(testing::kMission) + R"([[scene.moving]]
name = "van"
shape = "bus"
path_m = [213.9, 45.0, 213.9, 60.0]
speed_m_s = 8.0
)");
  ASSERT_EQ(canyon("lidar scan --scene traffic.toml --at 213.9,30,0,90 --scans 2 --out out"), 0) << read("stderr");
  EXPECT_THAT(read("out/scan_000000_truth.csv"), HasSubstr(",van\n"));
}

TEST_F(LidarScanTest, DrivesAlongATrajectory) {
  write("given.tum", "1000000000 120 -40 60 0 0 0 1\n1000000001 121 -40 60 0 0 0 1\n");
  ASSERT_EQ(canyon("lidar scan --trajectory given.tum --rate 5 --out drive --json"), 0) << read("stderr");
  const Json summary = Json::parse(read("stdout"));
  EXPECT_EQ(summary["scans"], 4) << "the first needs a revolution before it";
  EXPECT_EQ(summary["rate_hz"], 5.0);
}

TEST_F(LidarScanTest, CapturesAreWholeAndNotReplacedUnasked) {
  ASSERT_EQ(canyon("lidar scan --at 120,-40,0,90 --azimuth-steps 0 --scans 3 --pcap given.pcap --json"), 0)
      << read("stderr");
  const Json summary = Json::parse(read("stdout"));
  const std::size_t packets = summary["packets"];
  EXPECT_EQ(packets, 226u) << "0.3 s are 226.06 packets of 1327.104 us";
  EXPECT_EQ(read("given.pcap").size(), 24 + packets * (16 + 42 + 1206));
  EXPECT_EQ(canyon("lidar scan --at 120,-40,0,90 --azimuth-steps 0 --pcap given.pcap"), 2);
  EXPECT_EQ(read("stderr"), "given.pcap: output file exists, expected a new name or --force\n");
  EXPECT_EQ(canyon("lidar scan --at 120,-40,0,90 --azimuth-steps 0 --pcap given.pcap --force"), 0);
  EXPECT_EQ(read("given.pcap").size() % (16 + 42 + 1206), 24u);
}

/// We listen on a port of our own; packets come at the sensor's pace, or all at once with --udp-fast.
TEST_F(LidarScanTest, PacketsGoOutAtTheSensorsPace) {
  const int listener = socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(listener, 0);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof here;
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&here), size), 0);
  ASSERT_EQ(getsockname(listener, reinterpret_cast<sockaddr*>(&here), &size), 0);
  const timeval patience{.tv_sec = 20, .tv_usec = 0};
  setsockopt(listener, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  const std::string to = "127.0.0.1:" + std::to_string(ntohs(here.sin_port));
  int status = -1;
  std::thread sender([&] { status = canyon("lidar scan --at 120,-40,0,90 --azimuth-steps 0 --scans 5 --udp " + to); });
  std::vector<double> times_s;
  for (char buffer[2048]; times_s.size() < 376;) {  // 0.5 s of packets
    if (recv(listener, buffer, sizeof buffer, 0) != 1206) break;
    times_s.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count());
  }
  sender.join();
  close(listener);
  EXPECT_EQ(status, 0);
  ASSERT_EQ(times_s.size(), 376u);
  EXPECT_GE(times_s.back() - times_s.front(), 375 * 1327.104e-6 - 0.05)
      << "not ahead; 50 ms for what the system held back";
}

TEST_F(LidarScanTest, MistakesAreNamed) {
  expect_mistake("lidar scan", "command line: no place given, expected --at X,Y,H,YAW or --trajectory FILE");
  expect_mistake("lidar scan --trajectory given_short.tum --scans 5",
                 "--scans: stands alone, expected --at beside it\n");
  expect_mistake("lidar scan --at 1,2,3",
                 "--at: \"1,2,3\" cannot be read, expected X,Y,H,YAW: metres in the scene, metres above ground, "
                 "degrees from east");
  expect_mistake("lidar scan --at 99999,0,0,0",
                 "--at: \"99999,0,0,0\" lies outside the scene, expected a place over its terrain");
  expect_mistake("lidar scan --at 120,-40,0,90 --format xyz --out out",
                 "--format: unknown format \"xyz\", expected one of pcd, ply, las");
  expect_mistake("lidar scan --at 120,-40,0,90 --scene missing.obj --out out", "missing.obj");
  expect_mistake("lidar scan --at 120,-40,0,90 --beams os1 --out out", "unknown beam table \"os1\"");
  expect_mistake("lidar scan --at 120,-40,0,90 --beams os1_64 --azimuth-steps 1024 --pcap out.pcap",
                 "lidar.beams: \"os1_64\" has no packets, expected vlp16 or hdl32e");
  expect_mistake("lidar scan --at 120,-40,0,90 --returns all --pcap out.pcap",
                 "lidar.returns: \"all\" does not fit into packets, expected strongest, last or dual");
  expect_mistake("lidar scan --at 120,-40,0,90 --udp nowhere:2368",
                 "udp: \"nowhere\" is not an address, expected an IPv4 address such as 127.0.0.1");
  expect_mistake("lidar scan --at 120,-40,0,90 --udp 127.0.0.1:99999",
                 "--udp: \"127.0.0.1:99999\", expected a port from 1 to 65535");
  write("given_short.tum", "1000000000 120 -40 60 0 0 0 1\n1000000000.05 120 -40 60 0 0 0 1\n");
  expect_mistake("lidar scan --trajectory given_short.tum --out out",
                 "given_short.tum: covers 0.050 s, expected at least one revolution, 0.101 s");
  write("given_empty.tum", "");
  expect_mistake("lidar scan --trajectory given_empty.tum --out out", "given_empty.tum");
}

}  // namespace
}  // namespace canyon::apps

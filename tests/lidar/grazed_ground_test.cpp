// How much of the ground real HDL-32E see at grazing incidence, beside a simulated one with the beam of `high`.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/lidar/velodyne/packet_reader.h"
#include "canyon/lidar/velodyne/pcap.h"
#include "canyon/tests/lidar/ground_under.h"
#include "canyon/tests/lidar/lidar_scenes.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::lidar {
namespace {

using testing::ground_under;
using testing::GroundPlane;
using testing::kStart;

constexpr std::size_t kHdlLasers = 32;
constexpr double kRangeBin_m = 2.5;
constexpr std::size_t kRangeBins = 24;
constexpr double kLeastShots = 200.0;  ///< of a bin that is judged

struct HdlShot {
  bool returned = false;
  Eigen::Vector3d p_L = Eigen::Vector3d::Zero();
  double intensity = 0.0;  ///< as the sensor gives it, 0 to 255
};
/// One firing of all lasers.
struct HdlColumn {
  double azimuth_rad = 0.0;  ///< from x towards y
  std::array<HdlShot, kHdlLasers> shots;
};

std::vector<Eigen::Vector3d> returned_points(const std::vector<HdlColumn>& columns) {
  std::vector<Eigen::Vector3d> out;
  for (const HdlColumn& column : columns)
    for (const HdlShot& shot : column.shots)
      if (shot.returned) out.push_back(shot.p_L);
  return out;
}

/// Shots that would meet the ground so far off, how many came back from it, and how bright.
struct RangeBin {
  double shots = 0.0, returned = 0.0, intensity = 0.0, incidence_deg = 0.0;  ///< the last two are sums
  double share() const { return returned / shots; }
};
using RangeBins = std::array<RangeBin, kRangeBins>;

/// A shot counts where nothing but ground, or nothing at all, was met by those below it in its column. A laser that
/// never returns is broken.
void count_grazed(const std::vector<HdlColumn>& columns, const GroundPlane& ground, const BeamTable& table,
                  RangeBins& out) {
  std::vector<std::size_t> upwards;
  for (std::size_t laser = 0; laser < kHdlLasers; ++laser)
    if (std::any_of(columns.begin(), columns.end(), [laser](const HdlColumn& c) { return c.shots[laser].returned; }))
      upwards.push_back(laser);
  std::sort(upwards.begin(), upwards.end(),
            [&](std::size_t a, std::size_t b) { return table.beams[a].elevation_rad < table.beams[b].elevation_rad; });
  for (const HdlColumn& column : columns) {
    for (const std::size_t laser : upwards) {
      const double up = table.beams[laser].elevation_rad;
      const Eigen::Vector3d along(std::cos(column.azimuth_rad) * std::cos(up),
                                  std::sin(column.azimuth_rad) * std::cos(up), std::sin(up));
      const double there_m = ground.range_m(along);
      if (there_m >= kRangeBin_m * kRangeBins) break;
      const HdlShot& shot = column.shots[laser];
      const bool is_ground = shot.returned && ground.holds(shot.p_L);
      if (shot.returned && !is_ground) break;
      RangeBin& bin = out[static_cast<std::size_t>(there_m / kRangeBin_m)];
      bin.shots += 1.0;
      bin.incidence_deg += std::acos(ground.below_m / there_m) / kDegree;
      if (!is_ground) continue;
      bin.returned += 1.0;
      bin.intensity += shot.intensity;
    }
  }
}

/// A revolution of our sensor over level asphalt that it sees from so high and so askew as the recording one saw its
/// ground.
RangeBins simulated_ground(const GroundPlane& ground, const std::string& reflection) {
  LidarConfig config = testing::ideal_lidar();
  config.beams = "hdl32e";
  config.azimuth_steps = 2160;
  testing::set_keys(
      config, "detector = \"radiometric\"\nrange_at_10_percent_m = 35.4\nbrightness = \"varied\"\nreflection = \"" +
                  reflection + "\"\n");
  scene::SceneParts parts = testing::empty_parts();
  testing::add_ground(parts, 120.0);
  const scene::Scene scene(std::move(parts));
  const Trajectory motion = testing::standing(
      {Eigen::Quaterniond::FromTwoVectors(ground.normal, Eigen::Vector3d::UnitZ()), {0.3, 0.2, ground.below_m}});
  const auto scanner = *make_scanner(config, 1);
  RangeBins out;
  const auto bin_of = [&out](float range_m) -> RangeBin* {
    return range_m < kRangeBin_m * kRangeBins ? &out[static_cast<std::size_t>(range_m / kRangeBin_m)] : nullptr;
  };
  for (const float range_m : scanner->true_ranges(0, kStart, motion, scene::SceneAt(scene)))
    if (RangeBin* bin = bin_of(range_m)) bin->shots += 1.0;
  for (const LidarPointTruth& point : scanner->scan(0, kStart, motion, scene::SceneAt(scene)).truth)
    if (RangeBin* bin = bin_of(point.range_m)) bin->returned += 1.0;
  return out;
}

/// Prints the bins beyond 10 m, and holds those with shots enough against the simulated beams of `high`: within a
/// factor of 1.5. Returns how many these are.
std::size_t expect_as_simulated(const RangeBins& recorded, const GroundPlane& ground) {
  const RangeBins rough = simulated_ground(ground, "rough"), lambertian = simulated_ground(ground, "lambertian");
  std::size_t judged = 0;
  std::printf("sensor %.2f m above the ground, which leans by %.1f deg\n", ground.below_m,
              std::acos(ground.normal.z()) / kDegree);
  std::printf("       range  incidence    shots  returned  intensity  lambertian  rough\n");
  for (std::size_t k = 0; k < kRangeBins; ++k) {
    const RangeBin& bin = recorded[k];
    if (bin.shots == 0.0) continue;
    const double from_m = kRangeBin_m * static_cast<double>(k);
    const bool is_judged = from_m >= 10.0 && bin.shots >= kLeastShots;
    std::printf("%4.1f-%4.1f m  %9.1f  %7.0f  %8.2f  %9.1f  %10.2f  %5.2f%s\n", from_m, from_m + kRangeBin_m,
                bin.incidence_deg / bin.shots, bin.shots, bin.share(), bin.intensity / std::max(bin.returned, 1.0),
                lambertian[k].share(), rough[k].share(), is_judged ? "" : "  (not judged)");
    if (!is_judged) continue;
    ++judged;
    EXPECT_LT(std::max(rough[k].share() / bin.share(), bin.share() / rough[k].share()), 1.5) << from_m;
  }
  return judged;
}

/// A scan of data/lidar/pair: vertices of four floats, column by column, lasers in the order of firing, zeros where
/// nothing came back.
std::vector<HdlColumn> pair_columns(const std::string& path) {
  const auto text = read_text_file(path);
  EXPECT_TRUE(text.ok());
  const std::string end = "end_header\n";
  std::size_t at = text->find(end) + end.size();
  std::vector<HdlColumn> out;
  constexpr std::size_t kVertex = 4 * sizeof(float);
  for (; at + kHdlLasers * kVertex <= text->size(); at += kHdlLasers * kVertex) {
    HdlColumn column;
    bool any = false;
    for (std::size_t laser = 0; laser < kHdlLasers; ++laser) {
      float v[4];
      std::memcpy(v, text->data() + at + laser * kVertex, kVertex);
      HdlShot& shot = column.shots[laser];
      shot.p_L = {v[0], v[1], v[2]};
      shot.returned = shot.p_L.norm() > 0.0;
      shot.intensity = v[3];
      if (!shot.returned) continue;
      any = true;
      column.azimuth_rad = std::atan2(shot.p_L.y(), shot.p_L.x());
    }
    if (any) out.push_back(column);
  }
  return out;
}

// Their ground leans against the sensor by 6 degrees, so a ring meets it at many ranges: bins are by range. The largest
// factor is 1.48, from 12.5 to 15 m, where a third of the shots is lost by something else than incidence
// (docs/lidar.md).
TEST(GrazedGround, GroundComesBackAsInTheHdlPair) {
  CANYON_REAL_DATA(source_path, "lidar/pair/source.ply");
  CANYON_REAL_DATA(target_path, "lidar/pair/target.ply");
  const BeamTable table = *load_beam_table("hdl32e");
  RangeBins bins;
  GroundPlane ground;
  for (const std::string& path : {source_path, target_path}) {
    const std::vector<HdlColumn> columns = pair_columns(path);
    ASSERT_GT(columns.size(), 2000U);
    for (std::size_t laser = 0; laser < kHdlLasers; ++laser) {  // the order of lasers is the table's
      const HdlShot& shot = columns.front().shots[laser];
      // The table has elevations to 0.01 degrees.
      if (shot.returned) {
        ASSERT_NEAR(std::asin(shot.p_L.z() / shot.p_L.norm()), table.beams[laser].elevation_rad, 0.01 * kDegree);
      }
    }
    ground = ground_under(returned_points(columns));
    count_grazed(columns, ground, table, bins);
  }
  EXPECT_EQ(expect_as_simulated(bins, ground), 3U);
}

std::vector<HdlColumn> capture_columns(const std::string& path, const BeamTable& table) {
  std::vector<HdlColumn> out;
  const auto capture = velodyne::read_pcap(path);
  EXPECT_TRUE(capture.ok());
  for (const velodyne::Datagram& datagram : capture->datagrams) {
    const auto packet = velodyne::Packet::parse(datagram.payload);
    if (!packet) continue;
    const std::size_t first = out.size();
    for (const velodyne::Packet::Block& block : packet->blocks) {
      out.emplace_back();
      out.back().azimuth_rad = -0.01 * block.azimuth_cdeg * kDegree;
    }
    for (const velodyne::Return& r : velodyne::decode(*packet, table))
      out[first + r.block].shots[r.laser] = {true, testing::position(r.point), static_cast<double>(r.reflectivity)};
  }
  return out;
}

TEST(GrazedGround, GroundComesBackAsInTheHdl32eCapture) {
  CANYON_REAL_DATA(path, "lidar/velodyne/sample_velodyne_hdl32.pcap");
  const BeamTable table = *load_beam_table("hdl32e");
  const std::vector<HdlColumn> columns = capture_columns(path, table);
  ASSERT_EQ(columns.size(), 500U * velodyne::Packet::kBlocks);
  const GroundPlane ground = ground_under(returned_points(columns));
  RangeBins bins;
  count_grazed(columns, ground, table, bins);
  EXPECT_EQ(expect_as_simulated(bins, ground), 4U);
  // From 15 m on a Lambertian street is lost, where all of this one comes back.
  const RangeBins lambertian = simulated_ground(ground, "lambertian");
  for (std::size_t k = 6; k < kRangeBins; ++k)
    if (bins[k].shots >= kLeastShots) {
      EXPECT_LT(1.5 * lambertian[k].share(), bins[k].share()) << kRangeBin_m * static_cast<double>(k);
    }
}

}  // namespace
}  // namespace canyon::lidar

// How much of the ground real HDL-32E see at grazing incidence, beside a simulated one with the beam of `high`.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/beam_table.h"
#include "canyon/lidar/velodyne/packet_reader.h"
#include "canyon/lidar/velodyne/pcap.h"
#include "canyon/tests/lidar/grazed_ground.h"
#include "canyon/tests/lidar/lidar_scenes.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::lidar {
namespace {

using testing::beam_of_high;
using testing::compare_ground;
using testing::free_ground_m;
using testing::GroundComparison;
using testing::GroundRecording;
using testing::ShotColumn;

constexpr std::size_t kHdlLasers = 32;
// The simulated turn begins elsewhere within a step, and its head turns by a step while the lasers fire; the recorded
// columns have one azimuth.
constexpr std::ptrdiff_t kBeside = 2;

struct HdlShot {
  bool returned = false;
  Eigen::Vector3d p_L = Eigen::Vector3d::Zero();
  double intensity = 0.0;  ///< as the sensor gives it, 0 to 255
};
/// One firing of all lasers.
struct HdlColumn {
  double azimuth_rad = 0.0;  ///< from x towards y, of all
  std::array<HdlShot, kHdlLasers> shots;
};

std::vector<Eigen::Vector3d> returned_points(const std::vector<HdlColumn>& columns) {
  std::vector<Eigen::Vector3d> out;
  for (const HdlColumn& column : columns)
    for (const HdlShot& shot : column.shots)
      if (shot.returned) out.push_back(shot.p_L);
  return out;
}

/// A laser that never returns is broken.
std::vector<std::size_t> working_lasers(const std::vector<HdlColumn>& columns, const BeamTable& table) {
  std::vector<std::size_t> upwards;
  for (std::size_t laser = 0; laser < kHdlLasers; ++laser)
    if (std::any_of(columns.begin(), columns.end(), [laser](const HdlColumn& c) { return c.shots[laser].returned; }))
      upwards.push_back(laser);
  std::sort(upwards.begin(), upwards.end(),
            [&](std::size_t a, std::size_t b) { return table.beams[a].elevation_rad < table.beams[b].elevation_rad; });
  return upwards;
}

std::vector<ShotColumn> aimed(const std::vector<HdlColumn>& columns, const std::vector<std::size_t>& lasers,
                              const BeamTable& table) {
  std::vector<ShotColumn> out;
  for (const HdlColumn& column : columns) {
    out.push_back({column.azimuth_rad, {}});
    for (const std::size_t laser : lasers) {
      const double up = table.beams[laser].elevation_rad;
      const HdlShot& shot = column.shots[laser];
      out.back().shots.push_back({.along_L = {std::cos(column.azimuth_rad) * std::cos(up),
                                              std::sin(column.azimuth_rad) * std::cos(up), std::sin(up)},
                                  .returned = shot.returned,
                                  .p_L = shot.p_L,
                                  .intensity = shot.intensity});
    }
  }
  return out;
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

// A street of walls 8 m to the left, open ahead of a corner, and 5 m to the right, whose walls are painted; of what
// comes back from the road every third shot is lost. By what can be written down beside what the columns tell.
TEST(FreeGround, EndsAtTheWallsOfAMadeStreet) {
  constexpr double kUp_m = 2.0, kLeft_m = 8.0, kRight_m = 5.0, kCorner_m = 6.0, kSeen_m = 20.0,
                   kStep_rad = 2.0 * kDegree;
  constexpr double kRing_rad = 0.25 * kDegree, kPaint = 90.0, kRoad = 7.0;
  const testing::GroundPlane ground{Eigen::Vector3d::UnitZ(), kUp_m};
  std::vector<ShotColumn> turn;
  std::vector<double> free_m, told_m;
  testing::GroundBins expected, found;
  int shots = 0;
  for (int c = 0; c < 180; ++c) {
    const double azimuth_rad = (c + 0.5) * kStep_rad, ahead = std::cos(azimuth_rad), left = std::sin(azimuth_rad);
    double wall_m = left > 0.0 ? kLeft_m / left : -kRight_m / left;  // across the axis
    if (wall_m > kSeen_m || (left > 0.0 && wall_m * ahead > kCorner_m)) wall_m = testing::kOpen_m;
    ShotColumn column{azimuth_rad, {}};
    for (int ring = 0; ring < 120; ++ring) {
      const double down_rad = 25.0 * kDegree - ring * kRing_rad;
      testing::AimedShot shot;
      shot.along_L = {ahead * std::cos(down_rad), left * std::cos(down_rad), -std::sin(down_rad)};
      const double ground_m = down_rad > 0.1 * kRing_rad ? kUp_m / std::tan(down_rad) : testing::kOpen_m;
      const bool is_road = ground_m < wall_m;
      const double range_m = std::min(ground_m, wall_m) / std::cos(down_rad);
      const bool is_lost = is_road && shots % 3 == 0;
      shots += is_road ? 1 : 0;
      shot.returned = !is_lost && range_m < testing::kFarthestGround_m;
      shot.p_L = range_m * shot.along_L;
      shot.intensity = is_road ? kRoad : kPaint;
      if (is_road && range_m < testing::kFarthestGround_m) {
        testing::GroundBin& bin = expected[static_cast<std::size_t>(range_m / testing::GroundBin::kWidth_m)];
        bin.shots += 1.0;
        bin.returned += is_lost ? 0.0 : 1.0;
      }
      column.shots.push_back(shot);
    }
    turn.push_back(column);
    free_m.push_back(wall_m);
    told_m.push_back(free_ground_m(column, ground));
  }
  // The wall is told by a return above its foot, as far off as the foot.
  for (std::size_t c = 0; c < turn.size(); ++c)
    EXPECT_NEAR(told_m[c], free_m[c], 1e-9) << turn[c].azimuth_rad / kDegree;
  testing::count_ground(turn, told_m, ground, kStep_rad, 0, found);
  for (std::size_t k = 0; k < testing::kGroundBins; ++k) {
    EXPECT_EQ(found[k].shots, expected[k].shots) << k;
    EXPECT_EQ(found[k].returned, expected[k].returned) << k;
    EXPECT_LE(found[k].least, found[k].shots);
    EXPECT_GE(found[k].most, found[k].shots);
    // Paint at the foot of a wall lies within what counts as ground, and is not counted.
    if (found[k].returned > 0.0) {
      EXPECT_EQ(found[k].mean_intensity(), kRoad) << k;
    }
  }
  EXPECT_GT(found[1].shots, 1000.0);
}

// Where a beam meets what lies below the ground, the edge is somewhere between it and the beam before.
TEST(FreeGround, EndsWhereTheGroundFallsAway) {
  constexpr double kUp_m = 2.0, kEdge_m = 12.0, kDeeper_m = 1.0;
  ShotColumn column;
  double before_m = 0.0, behind_m = 0.0;
  for (int ring = 0; ring < 80; ++ring) {
    const double down_rad = (25.0 - 0.25 * ring) * kDegree, ground_m = kUp_m / std::tan(down_rad);
    const bool is_road = ground_m < kEdge_m;
    (is_road ? before_m : behind_m) = is_road || behind_m == 0.0 ? ground_m : behind_m;
    testing::AimedShot shot;
    shot.along_L = {std::cos(down_rad), 0.0, -std::sin(down_rad)};
    shot.returned = true;
    shot.p_L = shot.along_L * ((is_road ? kUp_m : kUp_m + kDeeper_m) / std::sin(down_rad));
    column.shots.push_back(shot);
  }
  EXPECT_NEAR(free_ground_m(column, {Eigen::Vector3d::UnitZ(), kUp_m}), 0.5 * (before_m + behind_m), 1e-9);
  for (testing::AimedShot& shot : column.shots) shot.returned = false;
  EXPECT_EQ(free_ground_m(column, {Eigen::Vector3d::UnitZ(), kUp_m}), testing::kOpen_m);
}

// Their ground leans against the sensor by 6 degrees, so a ring meets it at many ranges: bins are by range.
TEST(GrazedGround, GroundComesBackAsInTheHdlPair) {
  CANYON_REAL_DATA(source_path, "lidar/pair/source.ply");
  CANYON_REAL_DATA(target_path, "lidar/pair/target.ply");
  const BeamTable table = *load_beam_table("hdl32e");
  std::vector<std::vector<HdlColumn>> scans;
  std::vector<HdlColumn> all;
  for (const std::string& path : {source_path, target_path}) {
    scans.push_back(pair_columns(path));
    const std::vector<HdlColumn>& columns = scans.back();
    ASSERT_GT(columns.size(), 2000U);
    for (std::size_t laser = 0; laser < kHdlLasers; ++laser) {  // the order of lasers is the table's
      const HdlShot& shot = columns.front().shots[laser];
      // The table has elevations to 0.01 degrees.
      if (shot.returned) {
        ASSERT_NEAR(std::asin(shot.p_L.z() / shot.p_L.norm()), table.beams[laser].elevation_rad, 0.01 * kDegree);
      }
    }
    all.insert(all.end(), columns.begin(), columns.end());
  }
  GroundRecording recording{"hdl32e", working_lasers(all, table), all.size() / 2, kBeside, {}};
  for (const std::vector<HdlColumn>& columns : scans)
    recording.turns.push_back(
        {aimed(columns, recording.lasers, table), testing::ground_under(returned_points(columns))});
  const GroundComparison both =
      compare_ground(recording, {{"high", beam_of_high(35.4)}, {"lambertian", beam_of_high(35.4, "lambertian")}});
  both.expect_as_much_ground();
  EXPECT_EQ(both.judged_m(), (std::vector<double>{10.0, 12.5}));
  EXPECT_EQ(both.misses_m(0), std::vector<double>{});
  EXPECT_EQ(both.misses_m(1), std::vector<double>{});
  // A known miss: this ground darkens with incidence as a Lambertian one does, and more.
  EXPECT_EQ(both.intensity_misses_m(0), (std::vector<double>{10.0, 12.5}));
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
  double turned_rad = 0.0;
  for (std::size_t c = 1; c < columns.size(); ++c)
    turned_rad += std::abs(std::remainder(columns[c].azimuth_rad - columns[c - 1].azimuth_rad, 2.0 * kPi));
  const auto steps =
      static_cast<std::size_t>(std::lround(2.0 * kPi / turned_rad * static_cast<double>(columns.size() - 1)));
  GroundRecording recording{"hdl32e", working_lasers(columns, table), steps, kBeside, {}};
  const auto ground = testing::ground_under(returned_points(columns));
  for (std::size_t first = 0; first < columns.size(); first += steps) {
    const std::size_t end = std::min(first + steps, columns.size());
    const auto at = [&columns](std::size_t c) { return columns.begin() + static_cast<std::ptrdiff_t>(c); };
    recording.turns.push_back({aimed({at(first), at(end)}, recording.lasers, table), ground});
  }
  const GroundComparison both =
      compare_ground(recording, {{"high", beam_of_high(35.4)}, {"lambertian", beam_of_high(35.4, "lambertian")}});
  both.expect_as_much_ground();
  EXPECT_EQ(both.judged_m(), (std::vector<double>{10.0, 12.5, 15.0, 17.5}));
  EXPECT_EQ(both.misses_m(0), std::vector<double>{});
  // A Lambertian street is lost where all of this one comes back.
  EXPECT_EQ(both.misses_m(1), (std::vector<double>{12.5, 15.0, 17.5}));
  // Its intensities are clipped at 255 and say nothing.
  for (const double from_m : both.judged_m()) {
    const auto bin = static_cast<std::size_t>(from_m / testing::GroundBin::kWidth_m);
    EXPECT_EQ(both.recorded[bin].median_intensity(), 255.0) << from_m;
  }
}

}  // namespace
}  // namespace canyon::lidar

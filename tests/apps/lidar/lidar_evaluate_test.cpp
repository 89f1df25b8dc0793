// canyon lidar evaluate and canyon lidar close-loops: as a user calls them.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

using Json = nlohmann::json;

/// A square of 40 m and a wall of 10 m on it, to the east.
constexpr const char* kCourt = R"(o ground
v -20 -20 0
v 20 -20 0
v 20 20 0
v -20 20 0
f 1 2 3 4
o wall
v 10 -15 0
v 10 15 0
v 10 15 10
v 10 -15 10
f 5 6 7 8
)";

/// `xyz` as a binary PCD.
std::string pcd(const std::vector<float>& xyz) {
  const std::string n = std::to_string(xyz.size() / 3);
  std::string out = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + n +
                    "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA binary\n";
  out.append(reinterpret_cast<const char*>(xyz.data()), xyz.size() * sizeof(float));
  return out;
}

/// The same as a PLY, as records of x, y, z and intensity, and as LAS 1.2 in steps of a sixteenth of a metre.
std::string map_as_ply(const std::vector<float>& xyz) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(xyz.size() / 3) +
                    "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  out.append(reinterpret_cast<const char*>(xyz.data()), xyz.size() * sizeof(float));
  return out;
}
std::string map_as_bin(const std::vector<float>& xyz) {
  std::string out;
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    const float record[] = {xyz[i], xyz[i + 1], xyz[i + 2], 0.5F};
    out.append(reinterpret_cast<const char*>(record), sizeof record);
  }
  return out;
}
std::string map_as_las(const std::vector<float>& xyz) {
  constexpr std::size_t kHeader = 227, kRecord = 20;
  constexpr double kStep_m = 0.0625;
  std::string out(kHeader, '\0');
  const auto put = [&out](std::size_t at, const auto& value) { std::memcpy(out.data() + at, &value, sizeof value); };
  out.replace(0, 4, "LASF");
  out[24] = 1, out[25] = 2;
  put(96, static_cast<std::uint32_t>(kHeader));
  put(105, static_cast<std::uint16_t>(kRecord));
  put(107, static_cast<std::uint32_t>(xyz.size() / 3));
  for (std::size_t axis = 0; axis < 3; ++axis) put(131 + 8 * axis, kStep_m);
  out.resize(kHeader + kRecord * (xyz.size() / 3), '\0');
  for (std::size_t i = 0; i < xyz.size(); ++i)
    put(kHeader + kRecord * (i / 3) + 4 * (i % 3), static_cast<std::int32_t>(xyz[i] / static_cast<float>(kStep_m)));
  return out;
}

class LidarEvaluateTest : public testing::CommandLineTest {
 protected:
  void SetUp() override {
    CommandLineTest::SetUp();
    write("given.obj", kCourt);
    std::vector<float> xyz;
    for (int i = -40; i < 0; ++i)
      for (int k = -40; k < 40; ++k)
        xyz.insert(xyz.end(), {0.4F * static_cast<float>(i) + 0.1F, 0.2F * static_cast<float>(k), 0.07F});
    write("given.pcd", pcd(xyz));
  }
  void refused(const std::string& arguments, const std::string& line) {
    EXPECT_EQ(canyon("lidar evaluate " + arguments), 2);
    EXPECT_EQ(read("stderr"), line + "\n");
    EXPECT_EQ(read("stdout"), "");
    EXPECT_TRUE(leftovers().empty());
  }
};

TEST_F(LidarEvaluateTest, AGroundSevenCentimetresTooHigh) {
  ASSERT_EQ(canyon("lidar evaluate given.pcd --scene given.obj --undulation 0 --json"), 0) << read("stderr");
  const Json out = Json::parse(read("stdout"));
  // Single precision of the scene's corners.
  EXPECT_NEAR(out["rms_m"].get<double>(), 0.07, 1e-5);
  EXPECT_NEAR(out["up_rms_m"].get<double>(), 0.07, 1e-5);
  EXPECT_NEAR(out["p95_m"].get<double>(), 0.07, 1e-5);
  EXPECT_EQ(out["points"], 3200);
  EXPECT_EQ(out["accuracy_5cm"], 0.0);
  EXPECT_EQ(out["accuracy_10cm"], 1.0);
  EXPECT_EQ(out["completeness_of"], "surfaces near the map");
  EXPECT_TRUE(out["completeness_5cm"].is_number());
  EXPECT_TRUE(out["mean_map_entropy"].is_number());
}

// Ground a sixteenth of a metre too high, whose places all four formats hold to the bit.
TEST_F(LidarEvaluateTest, TheSameMapInEveryFormatHasTheSameFigures) {
  std::vector<float> xyz;
  for (int i = -40; i < 0; ++i)
    for (int k = -40; k < 40; ++k)
      xyz.insert(xyz.end(), {0.375F * static_cast<float>(i), 0.1875F * static_cast<float>(k), 0.0625F});
  write("given_same.pcd", pcd(xyz));
  write("given_same.ply", map_as_ply(xyz));
  write("given_same.bin", map_as_bin(xyz));
  write("given_same.las", map_as_las(xyz));
  const auto figures = [this](const std::string& ending) {
    EXPECT_EQ(canyon("lidar evaluate given_same." + ending + " --scene given.obj --undulation 0 --json"), 0)
        << read("stderr");
    return read("stdout");
  };
  const std::string as_pcd = figures("pcd");
  const Json out = Json::parse(as_pcd);
  EXPECT_EQ(out["points"], 3200);
  EXPECT_NEAR(out["rms_m"].get<double>(), 0.0625, 1e-5);
  for (const char* ending : {"ply", "bin", "las"}) EXPECT_EQ(figures(ending), as_pcd) << ending;
}

TEST_F(LidarEvaluateTest, ATrajectoryLaidOverItsTruth) {
  std::string truth, estimate;
  for (int k = 0; k < 50; ++k) {
    truth += std::to_string(100 + k) + " " + std::to_string(0.1 * k) + " 0 2 0 0 0 1\n";
    estimate += std::to_string(100 + k) + " " + std::to_string(0.1 * k) + " 3 2 0 0 0 1\n";
  }
  write("given_truth.tum", truth);
  write("given_estimate.tum", estimate);
  ASSERT_EQ(canyon("lidar evaluate given.pcd --scene given.obj --undulation 0 --trajectory given_truth.tum --estimate "
                   "given_estimate.tum --json"),
            0)
      << read("stderr");
  const Json plain = Json::parse(read("stdout"));
  EXPECT_NEAR(plain["trajectory"]["ate_rms_m"].get<double>(), 3.0, 1e-12);
  EXPECT_EQ(plain["completeness_of"], "beams");
  ASSERT_EQ(canyon("lidar evaluate given.pcd --scene given.obj --undulation 0 --trajectory given_truth.tum --estimate "
                   "given_estimate.tum --alignment yaw --aligned given_aligned.kitti --json"),
            0)
      << read("stderr");
  EXPECT_NEAR(Json::parse(read("stdout"))["trajectory"]["ate_rms_m"].get<double>(), 0.0, 1e-12);
  EXPECT_FALSE(read("given_aligned.kitti").empty());
}

// Ten seconds straight on, with few beams: a place that was left 5 m ago is taken for one that is come back to.
TEST_F(LidarEvaluateTest, ClosedLoopsLeaveTheirFiles) {
  const int status = canyon(
      "lidar close-loops mission.toml --fidelity low --set time.limit_s=10 --set 'registration.method=\"gicp\"' --set "
      "'lidar.beams=\"grid:8:-15:5\"' --set lidar.azimuth_steps=360 --least-way 5 --apart 2 --out given_closed --json");
  if (read("stderr").find("CANYON_WITH_CERES") != std::string::npos) GTEST_SKIP() << "built without CANYON_WITH_CERES";
  ASSERT_EQ(status, 0) << read("stderr");
  Json out = Json::parse(read("stdout"));
  EXPECT_EQ(out["fidelity"], "low");
  EXPECT_GT(out["way_m"].get<double>(), 5.0);
  const Json& closures = out["closures"];
  EXPECT_GT(closures["closing"].get<int>(), 0);
  EXPECT_EQ(closures["tried"], out["trials"].size());
  for (const auto& [fewer, more] :
       {std::pair{"believed", "closing"}, std::pair{"closing", "tried"}, std::pair{"beyond_bound", "closing"}})
    EXPECT_LE(closures[fewer].get<int>(), closures[more].get<int>()) << fewer;
  for (const Json& trial : out["trials"]) EXPECT_LT(trial["target"].get<int>(), trial["source"].get<int>());
  for (const char* placed : {"prior", "registered", "smoothed", "closed"}) {
    EXPECT_TRUE(out["placed"][placed]["keyframe_rms_m"].is_number()) << placed;
    EXPECT_GT(out["placed"][placed]["map_points"].get<int>(), 0) << placed;
  }
  EXPECT_LE(out["graph"]["final_cost"].get<double>(), out["graph"]["initial_cost"].get<double>());

  EXPECT_EQ(out["results_dir"], "given_closed");
  out.erase("results_dir");
  EXPECT_EQ(Json::parse(read("given_closed/summary.json")), out);
  const std::string way = read("given_closed/closed.tum");
  EXPECT_EQ(std::count(way.begin(), way.end(), '\n'), 1 + out["keyframes"].get<int>()) << "under a line of names";
  EXPECT_TRUE(leftovers().empty());
}

// 2026-11-30: they were not looked at, whatever their values.
TEST_F(LidarEvaluateTest, WhatMeansNothingByItselfIsRefused) {
  for (const char* option : {"--fidelity nope", "--beams nope", "--model nope", "--detector nope", "--returns nope",
                             "--see-through nope", "--rate 1e9", "--azimuth-steps=-5", "--start nope", "--reach 50"}) {
    const std::string given = option;
    refused("given.pcd --scene given.obj " + given,
            given.substr(0, given.find_first_of(" =")) + ": stands alone, expected --trajectory beside it");
  }
  refused("given.pcd --scene given.obj --alignment yaw", "--alignment: stands alone, expected --estimate beside it");
  refused("given.pcd --scene given.obj --trajectory given.tum --estimate-rate 5",
          "--estimate-rate: stands alone, expected --estimate beside it");
  // What canyon lidar scan has alone.
  refused("given.pcd --at 0,0,0,0",
          "canyon lidar evaluate: no option \"--at\", expected one that canyon lidar evaluate --help names");
  ASSERT_EQ(canyon("lidar evaluate --help"), 0);
  for (const char* option : {"--at ", "--scans "}) EXPECT_EQ(read("stdout").find(option), std::string::npos) << option;
}

TEST_F(LidarEvaluateTest, BadInputsAreOneLine) {
  write("given.txt", "no cloud");
  write("given_empty.pcd", pcd({}));
  EXPECT_EQ(canyon("lidar evaluate given_missing.pcd --scene given.obj"), 2);
  EXPECT_EQ(canyon("lidar evaluate given.txt --scene given.obj"), 2);
  refused("given_empty.pcd --scene given.obj", "given_empty.pcd: holds no points, expected a cloud of points");
  refused("given.pcd --scene given.obj --estimate given.txt",
          "command line: --estimate without the true way, expected --trajectory FILE");
  refused("given.pcd --scene given.obj --aligned given_aligned.tum",
          "command line: --aligned without an estimate, expected --estimate FILE");
  EXPECT_EQ(canyon("lidar error-budget mission.toml --fidelity hihg"), 2);
  EXPECT_EQ(canyon("lidar error-budget mission.toml --permutations 1"), 2);
  EXPECT_EQ(canyon("lidar error-budget mission.toml --keep-mb=-1"), 2);
  EXPECT_EQ(canyon("lidar close-loops --set 'registration.method=\"none\"' --fidelity low"), 2);
  EXPECT_EQ(read("stderr"), "registration.method: \"none\" gives no map to close, expected a method that registers\n");
  EXPECT_EQ(canyon("lidar close-loops --tape given.tape"), 2);
  EXPECT_EQ(read("stderr"), "--tape: is for open loops, expected --open-loop beside it\n");
  EXPECT_TRUE(leftovers().empty());
}

}  // namespace
}  // namespace canyon::apps

// canyon lidar register: as a user calls it, on clouds of several forms.
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "canyon/core/messages.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

using Json = nlohmann::json;

/// Points on the floor, two walls at a right angle and a box of a yard, 1 cm of noise.
std::vector<Eigen::Vector3d> yard(std::uint64_t seed, std::uint32_t count) {
  const RandomStream draws(seed, "test.yard");
  std::vector<Eigen::Vector3d> out;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double u = draws.uniform(0, i), v = draws.uniform(1, i);
    Eigen::Vector3d p;
    switch (i % 5) {
      case 0:
        p = {20.0 * u - 10.0, 20.0 * v - 10.0, 0.0};
        break;
      case 1:
        p = {10.0, 20.0 * u - 10.0, 6.0 * v};
        break;
      case 2:
        p = {20.0 * u - 10.0, -10.0, 6.0 * v};
        break;
      case 3:
        p = {3.0 + 2.0 * u, 4.0, 2.0 * v};
        break;
      default:
        p = {3.0, 4.0 + 3.0 * u, 2.0 * v};
    }
    out.push_back(p + 0.01 * draws.normal3(i, 2));
  }
  return out;
}

std::string bin(const std::vector<Eigen::Vector3d>& points) {
  std::string out;
  for (const Eigen::Vector3d& p : points) {
    const float record[4] = {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), 0.5F};
    out.append(reinterpret_cast<const char*>(record), sizeof record);
  }
  return out;
}

std::string ply(const std::vector<Eigen::Vector3d>& points) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  for (const Eigen::Vector3d& p : points) out.append(reinterpret_cast<const char*>(p.data()), 24);
  return out;
}

class LidarRegisterTest : public testing::CommandLineTest {
 protected:
  void SetUp() override {
    CommandLineTest::SetUp();
    write("given_target.bin", bin(yard(1, 20000)));
    std::vector<Eigen::Vector3d> moved = yard(2, 20000);
    for (Eigen::Vector3d& p : moved) p = X_TS_.inverse() * p;
    write("given_source.ply", ply(moved));
  }
  void refused(const std::string& arguments, const std::string& line) {
    EXPECT_EQ(canyon("lidar register " + arguments), 2);
    EXPECT_EQ(read("stderr"), line + "\n");
    EXPECT_EQ(read("stdout"), "");
    EXPECT_TRUE(leftovers().empty());
  }
  Json answer(const std::string& arguments) {
    EXPECT_EQ(canyon("lidar register " + arguments + " --json"), 0) << read("stderr");
    return Json::parse(read("stdout"));
  }
  /// Largest difference of the 16 numbers from the truth.
  double off(const Json& out) const {
    const Eigen::Matrix4d T = X_TS_.matrix();
    double worst = 0.0;
    for (int i = 0; i < 16; ++i)
      worst = std::max(worst, std::abs(out["T_target_source"][i].get<double>() - T(i / 4, i % 4)));
    return worst;
  }

  const Eigen::Isometry3d X_TS_ =
      Eigen::Translation3d(0.4, -0.3, 0.1) * Eigen::AngleAxisd(3.0 * kDegree, Eigen::Vector3d::UnitZ());
};

TEST_F(LidarRegisterTest, FindsThePoseBetweenClouds) {
  for (const char* method : {"gicp", "point_to_plane", "vgicp"}) {
    const Json out = answer(std::string("given_source.ply given_target.bin --sigma 1,5 --method ") + method);
    EXPECT_EQ(out["status"], "converged") << method;
    EXPECT_LT(off(out), 0.02) << method;
    EXPECT_EQ(out["method"], method);
    EXPECT_EQ(out["covariance"].size(), 36U);
    EXPECT_TRUE(out["open_directions"].empty());
    EXPECT_GT(out["overlap"].get<double>(), 0.9);
    EXPECT_GT(out["points"]["source"].get<int>(), 1000);
  }
}

TEST_F(LidarRegisterTest, AGuessMayBeSixteenWordsOrOne) {
  const std::string numbers = "0.9986,-0.0523,0,0.4,0.0523,0.9986,0,-0.3,0,0,1,0.1,0,0,0,1";
  std::string words = numbers;
  std::replace(words.begin(), words.end(), ',', ' ');
  const Json one = answer("given_source.ply given_target.bin --guess=" + numbers);
  const Json many = answer("given_source.ply given_target.bin --guess " + words);
  EXPECT_EQ(one["T_target_source"], many["T_target_source"]);
  EXPECT_LT(off(one), 0.02);
}

TEST_F(LidarRegisterTest, SaysItInWords) {
  ASSERT_EQ(canyon("lidar register given_source.ply given_target.bin"), 0);
  EXPECT_THAT(read("stdout"), ::testing::HasSubstr("converged after "));
  EXPECT_THAT(read("stdout"), ::testing::HasSubstr("(source frame); 0 open directions"));
}

// Clouds that are none, or determine nothing: a status, with exit 0 and no number that is none.
TEST_F(LidarRegisterTest, WhatCannotBeRegisteredIsAStatus) {
  std::vector<Eigen::Vector3d> line, nowhere(2000, {kNaN, 0, 0}), far = yard(3, 4000);
  for (int i = 0; i < 2000; ++i) line.emplace_back(0.01 * i, 0, 0);
  for (Eigen::Vector3d& p : far) p += Eigen::Vector3d(1e9, 0, 0);
  write("given_one.bin", bin({{1, 2, 3}}));
  write("given_line.ply", ply(line));
  write("given_nowhere.ply", ply(nowhere));
  write("given_far.ply", ply(far));
  for (const auto& [name, status] :
       {std::pair{"given_one.bin", "too_few_points"}, std::pair{"given_line.ply", "degenerate"},
        std::pair{"given_nowhere.ply", "too_few_points"}}) {
    const Json out = answer(std::string(name) + " given_target.bin");
    EXPECT_EQ(out["status"], status) << name;
    EXPECT_TRUE(out["covariance"][0].is_null()) << name;
    // 2026-11-30: was the guess.
    EXPECT_TRUE(out["T_target_source"].is_null()) << name;
    ASSERT_EQ(canyon(std::string("lidar register ") + name + " given_target.bin"), 0);
    const std::string words = read("stdout");
    EXPECT_EQ(words.find(std::string(status) + " after "), 0U) << words;
    EXPECT_EQ(words.substr(words.find('\n')), "\nno pose\n");
  }
  EXPECT_NE(answer("given_far.ply given_target.bin")["status"], "converged");
}

// Who does not say how sure a pose is has one all the same.
TEST_F(LidarRegisterTest, APoseMayHaveNoCovariance) {
  const Json out = answer("given_source.ply given_target.bin --method none");
  EXPECT_EQ(out["status"], "converged");
  EXPECT_TRUE(out["covariance"][0].is_null());
  EXPECT_EQ(out["T_target_source"].size(), 16U);
  ASSERT_EQ(canyon("lidar register given_source.ply given_target.bin --method none"), 0);
  EXPECT_THAT(read("stdout"), ::testing::Not(::testing::HasSubstr("no pose")));
}

TEST_F(LidarRegisterTest, HelpSaysWhatFewBeamsWantAndWhichRoundsCount) {
  ASSERT_EQ(canyon("lidar register --help"), 0);
  EXPECT_THAT(read("stdout"), ::testing::HasSubstr("; clouds of 16 beams want 0.5\n"));
  EXPECT_THAT(read("stdout"), ::testing::HasSubstr("; reported are the rounds of all starts and descents, coarse ones "
                                                   "too\n"));
}

// Single precision is no finer than a millimetre there; the clouds are registered all the same. One far point is enough
// to say so, once for each cloud, and doubles may be anywhere.
TEST_F(LidarRegisterTest, FloatsBeyondTenKilometresAreWarnedOf) {
  const Eigen::Vector3d origin(20000.0, -15000.0, 100.0);
  std::vector<Eigen::Vector3d> target = yard(1, 20000), source = yard(2, 20000), near = target;
  for (Eigen::Vector3d& p : target) p += origin;
  for (Eigen::Vector3d& p : source) p = X_TS_.inverse() * p + origin;
  near.emplace_back(0.0, 10001.0, 0.0);
  write("given_far_target.bin", bin(target));
  write("given_far_source.bin", bin(source));
  write("given_far_source.ply", ply(source));
  write("given_one_far.bin", bin(near));
  const auto warning = [](const std::string& file) {
    return "warning: " + file + ": coordinates in single precision beyond 10 km are no finer than 1 mm\n";
  };

  const Json out = answer("given_far_source.bin given_far_target.bin");
  EXPECT_EQ(read("stderr"), warning("given_far_source.bin") + warning("given_far_target.bin"));
  EXPECT_EQ(out["status"], "converged");
  for (int i = 0; i < 3; ++i) {  // where the yard's middle comes to lie
    double at = out["T_target_source"][4 * i + 3].get<double>();
    for (int k = 0; k < 3; ++k) at += out["T_target_source"][4 * i + k].get<double>() * origin[k];
    EXPECT_NEAR(at, origin[i] + X_TS_.translation()[i], 0.02) << i;  // as off() of the near ones
  }

  answer("given_far_source.ply given_far_target.bin");
  EXPECT_EQ(read("stderr"), warning("given_far_target.bin"));
  answer("given_source.ply given_one_far.bin");
  EXPECT_EQ(read("stderr"), warning("given_one_far.bin"));
  answer("given_source.ply given_target.bin");
  EXPECT_EQ(read("stderr"), "");
}

// 2026-11-30: the turn's sigma was about the file's origin, so that of clouds in UTM coordinates 5 degrees were a shift
// of 400 km, and the answer was too_little_overlap.
TEST_F(LidarRegisterTest, SigmaIsAboutTheMiddleOfTheSource) {
  const Eigen::Vector3d origin(500000.0, 4649776.0, 100.0);
  std::vector<Eigen::Vector3d> target = yard(1, 20000), source = yard(2, 20000);
  for (Eigen::Vector3d& p : target) p += origin;
  for (Eigen::Vector3d& p : source) p = X_TS_.inverse() * p + origin;
  write("given_utm_target.ply", ply(target));
  write("given_utm_source.ply", ply(source));
  const Json out = answer("given_utm_source.ply given_utm_target.ply --sigma 1,5");
  EXPECT_EQ(out["status"], "converged");
  EXPECT_TRUE(out["open_directions"].empty());
  for (int i = 0; i < 3; ++i) {  // where the yard's middle comes to lie
    double at = out["T_target_source"][4 * i + 3].get<double>();
    for (int k = 0; k < 3; ++k) at += out["T_target_source"][4 * i + k].get<double>() * origin[k];
    EXPECT_NEAR(at, origin[i] + X_TS_.translation()[i], 0.02) << i;  // as off() of the near ones
  }
  ASSERT_EQ(canyon("lidar register --help"), 0);
  EXPECT_THAT(read("stdout"), ::testing::HasSubstr("about the middle of SOURCE"));
}

TEST_F(LidarRegisterTest, WhatIsWrongIsSaidInOneLine) {
  write("given_empty.ply", "");
  write("given_cut.bin", "12345");
  refused("given_none.pcd given_target.bin",
          "given_none.pcd: cannot be read (No such file or directory), expected a readable file");
  refused("given_empty.ply given_target.bin", "given_empty.ply: is empty, expected a cloud of points");
  refused("given_cut.bin given_target.bin",
          "given_cut.bin: is 5 bytes long, expected records of 16: x, y, z, intensity");
  refused("given_source.ply given_target.bin --guess=2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1",
          "--guess: is no rigid transform, expected a rotation to 1e-3, a shift, and 0 0 0 1");
  refused("given_source.ply given_target.bin --sigma=-1,2",
          "--sigma: \"-1,2\", expected 0 to 1e4 m and 0 to 180 degrees");
  refused("given_source.ply given_target.bin --method icp",
          "--method: unknown name \"icp\", expected one of \"none\", \"point_to_plane\", \"gicp\", \"vgicp\", "
          "\"pcl_shell_gicp\", \"pcl_icp_normals\", \"pcl_gicp\", \"pcl_ndt\"; nearest is \"gicp\"");
}

// 700 MB of memory, a minute.
TEST_F(LidarRegisterTest, TenMillionPointsNightly) {
  write("given_many.ply", ply(yard(4, 10000000)));
  const Json out = answer("given_many.ply given_target.bin");
  EXPECT_EQ(out["status"], "converged");
}

}  // namespace
}  // namespace canyon::apps

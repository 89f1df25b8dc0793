// canyon imu fit as a user calls it: the entry it writes is one that a mission takes.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/core/random/random.h"
#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

using testing::CommandLineTest;
using ::testing::HasSubstr;

class ImuFitTest : public CommandLineTest {
 protected:
  /// A unit under gravity that turns as `motion` says, with gain and bias of its own.
  static std::string log(int rows, bool moving, double scale, double bias) {
    const RandomStream stream(4, "test.fit");
    std::string out = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
    for (int k = 0; k < rows; ++k) {
      const double t = 0.01 * k;
      double v[6] = {0, 0, 0, 0, 0, 9.80665};
      if (moving)
        for (int c = 0; c < 6; ++c) v[c] += std::sin((0.5 + 0.3 * c) * t);
      for (int c = 0; c < 6; ++c)
        v[c] = (1.0 + scale) * v[c] + bias +
               1e-4 * stream.normal(static_cast<std::uint32_t>(c), static_cast<std::uint64_t>(k));
      char line[200];
      std::snprintf(line, sizeof line, "%.2f,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", t, v[0], v[1], v[2], v[3], v[4], v[5]);
      out += line;
    }
    return out;
  }
};

TEST_F(ImuFitTest, AnEntryThatAMissionTakes) {
  write("given.csv", log(3000, false, 0.0, 1e-3));
  ASSERT_EQ(canyon("imu fit given.csv --static --out mine.toml"), 0) << read("stderr");
  EXPECT_THAT(read("mine.toml"), HasSubstr("name = \"given\""));
  EXPECT_THAT(read("mine.toml"), HasSubstr("arw_deg_per_sqrt_hr = "));
  EXPECT_EQ(canyon("imu fit given.csv --static --out mine.toml"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("mine.toml: output file exists, expected a new name or --force"));
  write("mission.toml", std::string(testing::kMission) + "[imu]\nsensor = \"mine.toml\"\nerrors = \"full\"\n");
  EXPECT_EQ(canyon("run mission.toml --fidelity low --out out"), 0) << read("stderr");
}

TEST_F(ImuFitTest, AgainstAReference) {
  write("given.csv", log(4000, true, 0.01, 0.05));
  write("given_truth.csv", log(4000, true, 0.0, 0.0));
  ASSERT_EQ(canyon("imu fit given.csv --truth given_truth.csv --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  for (const char* triad : {"gyro", "accel"}) {
    EXPECT_NEAR(json[triad]["gain"][0].get<double>(), 0.01, 1e-4) << triad;
    EXPECT_NEAR(json[triad]["gain"][4].get<double>(), 0.01, 1e-4) << triad;
    EXPECT_NEAR(json[triad]["bias"][1].get<double>(), 0.05, 1e-3) << triad;
  }
}

// With a reference and from positions too an entry is written, and its figures are what was found.
TEST_F(ImuFitTest, EveryWayWritesAnEntry) {
  write("given.csv", log(4000, true, 0.01, 0.05));
  write("given_truth.csv", log(4000, true, 0.0, 0.0));
  ASSERT_EQ(canyon("imu fit given.csv --truth given_truth.csv --out mine.toml --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(json["entry"], read("mine.toml"));
  EXPECT_THAT(read("mine.toml"), HasSubstr("scale_source = \"found in given.csv against the reference given_truth.csv, "
                                           "root mean square of the axes\""));
  double scale_ppm = 0.0;
  const std::string toml = read("mine.toml");
  ASSERT_EQ(std::sscanf(toml.c_str() + toml.find("scale_ppm"), "scale_ppm = %lf", &scale_ppm), 1);
  EXPECT_NEAR(scale_ppm, 1e4, 100.0);
  ASSERT_EQ(canyon("imu simulate --at 45,7,200 --sensor mine.toml --errors full --duration 1 --out again.csv"), 0)
      << read("stderr");
  // Twelve rests of 4 s, two up each axis and some between, with a turn of 1 s after each.
  std::string positions = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
  const double up[12][3] = {{1, 0, 0},   {-1, 0, 0},   {0, 1, 0},    {0, -1, 0},    {0, 0, 1},    {0, 0, -1},
                            {.6, .8, 0}, {-.6, 0, .8}, {0, .6, -.8}, {-.8, -.6, 0}, {.8, 0, -.6}, {0, -.8, .6}};
  const RandomStream stream(4, "test.positions");
  std::uint64_t k = 0;
  for (const auto& u : up)
    for (int i = 0; i < 500; ++i, ++k) {
      const bool turning = i >= 400;
      char line[200];
      double v[6];
      for (int c = 0; c < 3; ++c) {
        v[c] = 0.01 + 1e-4 * stream.normal(static_cast<std::uint32_t>(c), k) + (turning ? std::sin(0.2 * i) : 0.0);
        v[3 + c] = 1.02 * 9.81 * u[c] + 0.1 + 1e-3 * stream.normal(static_cast<std::uint32_t>(3 + c), k) +
                   (turning ? 5.0 * std::cos(0.3 * i) : 0.0);
      }
      std::snprintf(line, sizeof line, "%.2f,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", 0.01 * static_cast<double>(k), v[0],
                    v[1], v[2], v[3], v[4], v[5]);
      positions += line;
    }
  write("turned.csv", positions);
  ASSERT_EQ(canyon("imu fit turned.csv --positions --gravity 9.81 --out turned.toml"), 0) << read("stderr");
  EXPECT_THAT(read("turned.toml"), HasSubstr("found from 12 resting positions in turned.csv against gravity given as "
                                             "9.81 m/s^2"));
  EXPECT_THAT(read("turned.toml"), HasSubstr("scale_ppm = 0.0\nscale_source = \"the log does not show it\""));
  const std::string accel = read("turned.toml").substr(read("turned.toml").find("[accel]"));
  ASSERT_EQ(std::sscanf(accel.c_str() + accel.find("scale_ppm"), "scale_ppm = %lf", &scale_ppm), 1);
  EXPECT_NEAR(scale_ppm, 2e4, 50.0);
}

// Standard gravity is a guess, and said to be one; a place has its own.
TEST_F(ImuFitTest, GravityIsThatOfThePlace) {
  write("given.csv", log(3000, false, 0.0, 0.0));
  ASSERT_EQ(canyon("imu fit given.csv --static"), 0);
  EXPECT_THAT(read("stderr"), HasSubstr("note: gravity is taken as 9.80665 m/s^2"));
  ASSERT_EQ(canyon("imu fit given.csv --static --at 0,0,0"), 0);
  EXPECT_EQ(read("stderr"), "");
  EXPECT_THAT(read("stdout"), HasSubstr("against WGS84 normal gravity there, 9.78033 m/s^2: along the vertical"));
}

// A hole of the reference is not bridged: what it does not cover is left out.
TEST_F(ImuFitTest, AHoleOfTheReferenceIsLeftOut) {
  write("given.csv", log(4000, true, 0.01, 0.05));
  std::string truth = log(4000, true, 0.0, 0.0), kept;
  std::size_t row = 0;
  for (std::size_t begin = 0, end; begin < truth.size(); begin = end + 1, ++row) {
    end = truth.find('\n', begin);
    if (row < 1000 || row > 1500) kept += truth.substr(begin, end + 1 - begin);
  }
  write("given_truth.csv", kept);
  ASSERT_EQ(canyon("imu fit given.csv --truth given_truth.csv --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_LT(json["gyro"]["residual_rms"].get<double>(), 3e-4);
  EXPECT_NEAR(json["gyro"]["used"].get<double>(), 3500.0, 5.0);
}

TEST_F(ImuFitTest, MistakesAreOneLine) {
  write("given.csv", log(3000, false, 0.0, 0.0));
  expect_mistake("imu fit given.csv --positions", "given.csv: 1 resting positions, expected nine or more");
}

// 2026-11-22: groups of options were taken for verbs: "no verb given, expected one of".
TEST_F(ImuFitTest, AMissingOrWrongMethodIsNamed) {
  write("given.csv", log(10, false, 0.0, 0.0));
  expect_mistake("imu fit given.csv",
                 "canyon imu fit: no method given, expected one of --static, --positions, --truth\n");
  expect_mistake("imu fit given.csv --static --positions",
                 "canyon imu fit: --static, --positions together, expected one of --static, --positions, --truth\n");
  expect_mistake("imu fit given.csv --statik", "canyon imu fit: no option \"--statik\", expected \"--static\"?\n");
  expect_mistake("imu fit --static", "canyon imu fit: LOG is missing");
  expect_mistake("imu", "canyon imu: no verb given, expected one of allan, fit, simulate, dead-reckon\n");
}

}  // namespace
}  // namespace canyon::apps

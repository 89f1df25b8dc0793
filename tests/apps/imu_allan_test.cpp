// canyon imu allan as a user calls it: the contract of --json, the files, the messages.
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/random.h"
#include "tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

using testing::CommandLineTest;
using ::testing::HasSubstr;

class ImuAllanTest : public CommandLineTest {
 protected:
  /// A resting unit at 100 Hz with white noise of 1e-3 rad/s and 1e-2 m/s^2 per sample.
  static std::string resting(int rows) {
    const RandomStream stream(4, "test.resting");
    std::string out = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
    for (int k = 0; k < rows; ++k) {
      double v[6];
      for (int c = 0; c < 6; ++c)
        v[c] = (c == 5 ? 9.8 : 0.0) +
               (c < 3 ? 1e-3 : 1e-2) * stream.normal(static_cast<std::uint32_t>(c), static_cast<std::uint64_t>(k));
      char line[200];
      std::snprintf(line, sizeof line, "%.2f,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", 0.01 * k, v[0], v[1], v[2], v[3], v[4],
                    v[5]);
      out += line;
    }
    return out;
  }
};

TEST_F(ImuAllanTest, JsonKeepsItsContract) {
  write("given.csv", resting(20000));
  ASSERT_EQ(canyon("imu allan given.csv --kind hadamard --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  for (const char* axis : {"gx", "gy", "gz", "ax", "ay", "az"}) {
    const auto& a = json["axes"][axis];
    const auto tau = a["tau_s"].get<std::vector<double>>();
    for (const char* key : {"adev", "adev_low", "adev_high"}) EXPECT_EQ(a[key].size(), tau.size()) << key;
    for (double octave = 0.01; octave < 20.0; octave *= 2.0)
      EXPECT_TRUE(std::any_of(tau.begin(), tau.end(), [&](double t) { return std::abs(t / octave - 1.0) < 1e-9; }));
    EXPECT_FALSE(a["hadamard"]["deviation"].empty());
    const double n = (axis[0] == 'g' ? 1e-3 : 1e-2) * 0.1;
    const auto& white = a["fit"]["white"];
    ASSERT_EQ(white["determined"], true) << axis;
    // As good as it says, and it says a few percent: 5 sigma.
    EXPECT_LT(std::abs(white["value"].get<double>() - n), 5.0 * white["sigma"].get<double>()) << axis;
    EXPECT_LT(white["sigma"].get<double>(), 0.05 * n) << axis;
    EXPECT_EQ(a["fit"]["ramp"]["determined"], false);
    EXPECT_TRUE(a["fit"]["ramp"]["value"].is_null());
    EXPECT_TRUE(a["fit"]["ramp"]["sigma"].is_null());
  }
}

TEST_F(ImuAllanTest, WritesTableCurveAndPicture) {
  write("given.csv", resting(3000));
  ASSERT_EQ(canyon("imu allan given.csv --out out"), 0) << read("stderr");
  EXPECT_THAT(read("stdout"), HasSubstr("given.csv: 3000 samples, 30.0 s at 100.000 Hz, 0 gaps"));
  EXPECT_THAT(read("stdout"), HasSubstr("Not determined by this log on any axis: "));
  EXPECT_THAT(read("out/allan.csv"),
              HasSubstr("axis,kind,tau_s,samples,deviation,low,high,degrees_of_freedom,fit,unit"));
  EXPECT_THAT(read("out/allan.svg"), HasSubstr("Allan deviation of given.csv"));
  EXPECT_TRUE(nlohmann::json::accept(read("out/allan.json")));
}

TEST_F(ImuAllanTest, MistakesAreOneLine) {
  expect_mistake("imu allan missing.csv",
                 "missing.csv: cannot be read (No such file or directory), expected a readable file");
  write("given.csv", "t_s,gx_rad_s,gy_rad_s,gz_rad_s\n0,1,2,3\n0.01,1,2\n");
  expect_mistake("imu allan given.csv", "given.csv:3: 3 fields, expected 4 or more");
  expect_mistake("imu allan given.csv --kind mtie", "--kind: \"mtie\" is none, expected of overlapping, modified, ");
}

}  // namespace
}  // namespace canyon::apps

// canyon imu fit as a user calls it: the entry it writes is one that a mission takes.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/random.h"
#include "tests/apps/command_line_fixture.h"

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
  EXPECT_THAT(read("stderr"), HasSubstr("mine.toml: exists, expected another --out, or --force"));
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

TEST_F(ImuFitTest, MistakesAreOneLine) {
  write("given.csv", log(3000, false, 0.0, 0.0));
  expect_mistake("imu fit given.csv --positions", "given.csv: 1 resting positions, expected nine or more");
  expect_mistake("imu fit given.csv --positions --out x.toml", "--out: there is an entry to write only with --static");
}

}  // namespace
}  // namespace canyon::apps

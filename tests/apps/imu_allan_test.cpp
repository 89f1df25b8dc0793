// canyon imu allan as a user calls it: the contract of --json, the files, the messages.
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/allan.h"
#include "canyon/core/random/random.h"
#include "canyon/tests/apps/command_line_fixture.h"

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

// 2026-11-22: a log that moves gave figures of its motion as those of its noise, without a word.
TEST_F(ImuAllanTest, ALogThatMovesIsWarnedOf) {
  write("given.csv", resting(6000));
  ASSERT_EQ(canyon("imu allan given.csv --json"), 0) << read("stderr");
  EXPECT_EQ(read("stderr"), "");
  auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_TRUE(json["moves"].empty());
  EXPECT_EQ(json["moving_share"], 0.0);
  // Taken in hand for five seconds.
  std::string handled = resting(6000);
  std::size_t at = 0;
  std::string out;
  for (int row = 0; at < handled.size(); ++row) {
    const std::size_t next = handled.find('\n', at);
    std::string line = handled.substr(at, next - at);
    if (row >= 2001 && row < 2501) {
      const std::size_t first = line.find(','), second = line.find(',', first + 1);
      line.replace(first + 1, second - first - 1, std::to_string(0.2 + 1e-4 * (row % 17 - 8)));
    }
    out += line + "\n";
    at = next + 1;
  }
  write("given.csv", out);
  ASSERT_EQ(canyon("imu allan given.csv --json"), 0) << read("stderr");
  EXPECT_THAT(read("stderr"),
              HasSubstr("warning: given.csv moves from 20 to 24.99 s of its time (gx differs from rest by "
                        "11.5 deg/s): the figures are of noise and motion together\n"));
  json = nlohmann::json::parse(read("stdout"));
  ASSERT_EQ(json["moves"].size(), 1U);
  EXPECT_EQ(json["moves"][0]["channel"], "gx");
  EXPECT_NEAR(json["moves"][0]["from_s"].get<double>(), 20.0, 1e-9);
  EXPECT_NEAR(json["moving_share"].get<double>(), 5.0 / 60.0, 1e-9);
  ASSERT_EQ(canyon("imu fit given.csv --static"), 0) << read("stderr");
  EXPECT_THAT(read("stderr"), HasSubstr("warning: given.csv moves from 20 to 24.99 s"));
  // Of motions, evenly fast ones too.
  for (const char* path : {"figure_eight", "circle", "coning"}) {
    ASSERT_EQ(
        canyon(std::string("imu simulate --errors white_only --duration 60 --rate 100 --out given_log.csv --path ") +
               path + " --force"),
        0)
        << read("stderr");
    EXPECT_EQ(canyon("imu allan given_log.csv"), 0) << path;
    EXPECT_THAT(read("stderr"), HasSubstr("warning: given_log.csv moves from ")) << path;
  }
}

// A build without Ceres has the curves all the same, and says what it has not.
TEST(AllanAnswer, WithoutAFitHasTheCurves) {
  inertial::ImuLog log;
  const RandomStream stream(5, "test.unfitted");
  for (int k = 0; k < 2000; ++k) {
    log.t_s.push_back(0.01 * k);
    log.channels[0].push_back(1e-3 * stream.normal(0, static_cast<std::uint64_t>(k)));
  }
  auto a = inertial::analyse_log(std::move(log), {});
  ASSERT_TRUE(a.ok()) << a.error().str();
  EXPECT_THAT(allan_svg(*a, "log.csv"), HasSubstr("line: fitted processes"));
  EXPECT_FALSE(allan_json(*a).contains("no_fit"));
  for (inertial::ChannelNoise& c : a->channels) c.fit.reset();
  const auto json = allan_json(*a);
  EXPECT_EQ(json["no_fit"], "this build has no noise fit");
  EXPECT_TRUE(json["axes"]["gx"]["fit"].is_null());
  EXPECT_EQ(json["axes"]["gx"]["adev"].size(), a->channels[0].points.size());
  EXPECT_THAT(inertial::deviations_csv(*a), ::testing::ContainsRegex("gx,overlapping,0.01,1,.*,,rad/s\n"));
  EXPECT_THAT(allan_svg(*a, "log.csv"), ::testing::Not(HasSubstr("fitted")));
  ::testing::internal::CaptureStdout();
  print_allan(*a, "log.csv");
  const std::string said = ::testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("  axis  least deviation         at\n"));
  EXPECT_THAT(said, HasSubstr("\nNo processes: this build has no noise fit (CANYON_WITH_CERES)\n"));
}

}  // namespace
}  // namespace canyon::apps

#include "canyon/study/dead_reckoning/dead_reckoning.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/core/earth/gravity.h"
#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/study/dead_reckoning/files.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using ::testing::HasSubstr;

/// Rates at rest, level, nose north at 45 degrees of latitude, as CSV at 100 Hz: axes forward, left, up, or forward,
/// right, down.
std::string resting_csv(int samples, bool frd = false, double yaw_rate_rad_s = 0.0) {
  const double g = gravity_E(ecef_from_geodetic({45.0 * kDegree, 0.0, 0.0})).norm(), s = frd ? -1.0 : 1.0;
  const double earth = 7.292115e-5 * std::sqrt(0.5);
  std::string out = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
  char line[200];
  for (int k = 1; k <= samples; ++k) {
    // What never changes, or is often at its extreme, is taken for a dead channel.
    const double dither = 1e-12 * (k % 7 - 3);
    std::snprintf(line, sizeof line, "%.3f,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", 0.01 * k, earth + dither, dither,
                  s * (earth + yaw_rate_rad_s) + dither, dither, dither, s * g + dither);
    out += line;
  }
  return out;
}

class DeadReckoningTest : public ::testing::Test {
 protected:
  Result<ImuRecording> read(const std::string& text, const ImuRecordingFormat& format = {}) {
    EXPECT_TRUE(write_text_file(path_, text).ok());
    return read_imu_recording(path_, format, [this](const std::string& line) { warnings_.push_back(line); });
  }
  static constexpr Geodetic kPlace{45.0 * kDegree, 0.0, 0.0};
  canyon::testing::TemporaryFolder folder_;
  std::string path_ = folder_.file("imu.csv");
  std::vector<std::string> warnings_;
};

TEST_F(DeadReckoningTest, ARecordingHoldsIncrements) {
  const auto recording = read(resting_csv(300, true), {.forward_right_down = true, .gps_week = 2100});
  ASSERT_TRUE(recording.ok()) << recording.error().str();
  ASSERT_EQ(recording->samples.size(), 300u);
  EXPECT_EQ(recording->gaps.count, 0u);
  EXPECT_FALSE(recording->kf_gins);
  EXPECT_EQ(recording->samples[0].t, GpsTime::from_week_sow(2100, 0.01));
  for (const ImuSample& s : recording->samples) {
    EXPECT_NEAR(s.dt_s, 0.01, 1e-12);
    EXPECT_GT(s.dv_U.z(), 0.098);
  }
}

// At rest for 20 s nothing drifts but what the log's digits and the first second's levelling leave.
TEST_F(DeadReckoningTest, AUnitAtRestStaysWhereItIs) {
  auto recording = read(resting_csv(2000));
  ASSERT_TRUE(recording.ok());
  const Reference reference = reference_at_rest(kPlace, 0.0, 1.0, *recording);
  ASSERT_EQ(reference.truth.size(), 2000u);
  ASSERT_TRUE(check_axes(*recording, reference.initial, "").ok());
  const DeadReckoning result = dead_reckon(std::move(*recording), reference, "two_sample", "wgs84");
  ASSERT_EQ(result.states.size(), 2000u);
  EXPECT_TRUE(result.holds());
  EXPECT_EQ(result.errors.size(), result.states.size());
  // The Earth's rate as written here is good to 1e-12 of itself; dithers of 1e-12 m/s^2 over 20 s make 2e-10 m.
  EXPECT_LT(result.statistics.final_error_m, 1e-6);
  EXPECT_NEAR(unscored(result).before_s, 0.01, 1e-9);
  EXPECT_EQ(unscored(result).behind_s, 0.0);
  const auto json = dead_reckoning_json(result);
  EXPECT_EQ(json["samples"], 1999);
  EXPECT_TRUE(json["holds_until_s"].is_null());
  ASSERT_TRUE(write_dead_reckoning(result, PlainIntegrals(result), folder_.path().string()).ok());
  for (const char* file : {"estimate.nav", "heading.csv", "drift.csv", "summary.json"})
    EXPECT_TRUE(read_text_file(folder_.file(file)).ok()) << file;
}

// 0.1 rad/s for 10 s are 1 rad, and so says the plain integral of the gyroscope; the start has no interval of its own.
TEST_F(DeadReckoningTest, PlainIntegralsTurnWithTheGyroscope) {
  auto recording = read(resting_csv(1000, false, 0.1));
  ASSERT_TRUE(recording.ok());
  const Reference reference = reference_from_state({.place = kPlace}, *recording);
  EXPECT_TRUE(reference.truth.empty());
  const DeadReckoning result = dead_reckon(std::move(*recording), reference, "two_sample", "wgs84");
  const PlainIntegrals plain(result);
  ASSERT_EQ(plain.t_s.size(), 999u);
  const double earth_deg = 7.292115e-5 * std::sqrt(0.5) * 9.99 / kDegree;
  EXPECT_NEAR(plain.angle_deg[2].back(), 0.1 * 9.99 / kDegree + earth_deg, 1e-9);  // 1000 roundings of 57
  EXPECT_TRUE(result.errors.empty());
}

TEST_F(DeadReckoningTest, MistakesWordForWord) {
  EXPECT_EQ(read("t_s,gx_rad_s,gy_rad_s,gz_rad_s\n0.01,1,2,3\n0.02,2,3,1\n0.03,3,1,2\n").error().what,
            "no column for ax");
  auto recording = read(resting_csv(300, true));
  ASSERT_TRUE(recording.ok());
  const Reference reference = reference_from_state({.place = kPlace}, *recording);
  EXPECT_EQ(check_axes(*recording, reference.initial, "the other axes").error().str(),
            path_ + ": in the initial attitude the specific force points down, expected the other axes");
  NavigationFile elsewhere;
  elsewhere.records.resize(2);
  elsewhere.records[0].t = GpsTime::from_week_sow(0, 900.0);
  elsewhere.records[1].t = GpsTime::from_week_sow(0, 901.0);
  EXPECT_EQ(
      reference_from_file(elsewhere, "truth.nav", *recording).error().str(),
      "truth.nav: covers 900.000 to 901.000 s of the week, expected times from 0.000 to 3.000 s of the week, as in " +
          path_);
  elsewhere.gravity = "wgs48";
  elsewhere.gravity_line = 3;
  EXPECT_THAT(check_stated_gravity(elsewhere, "truth.nav").error().str(),
              HasSubstr("truth.nav:3: # gravity: unknown name \"wgs48\""));
}

}  // namespace
}  // namespace canyon::study

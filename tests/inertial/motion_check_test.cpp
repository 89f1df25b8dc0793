#include "canyon/inertial/allan/motion_check.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::inertial {
namespace {

/// A unit at rest at 100 Hz, as noisy as a poor MEMS.
ImuLog resting(std::size_t rows) {
  const RandomStream stream(8, "test.motion");
  ImuLog log;
  for (std::size_t k = 0; k < rows; ++k) {
    log.t_s.push_back(0.01 * static_cast<double>(k));
    for (std::uint32_t c = 0; c < 6; ++c)
      log.channels[c].push_back((c == 5 ? 9.8 : 0.0) + (c < 3 ? 0.5 * kDegree : 0.05) * stream.normal(c, k));
  }
  return log;
}

TEST(MotionCheck, RestIsNotMotion) {
  EXPECT_FALSE(find_motion(resting(60000)).moves());
  // Nor is a bias that drifts by 0.8 deg/s and 30 mg over ten minutes, or a unit that lies on its side.
  ImuLog drifting = resting(60000);
  for (std::size_t k = 0; k < drifting.size(); ++k) {
    drifting.channels[0][k] += 0.8 * kDegree * static_cast<double>(k) / 60000.0;
    drifting.channels[4][k] += 0.3 * static_cast<double>(k) / 60000.0 + 9.0;
  }
  EXPECT_FALSE(find_motion(drifting).moves());
}

TEST(MotionCheck, MotionIsFoundWithItsTime) {
  ImuLog log = resting(12000);
  for (std::size_t k = 3000; k < 3400; ++k) log.channels[2][k] += 3.0 * kDegree;  // a slow turn
  for (std::size_t k = 7000; k < 7200; ++k) log.channels[3][k] += std::sin(0.9 * static_cast<double>(k));  // a shake
  for (std::size_t k = 9000; k < 12000; ++k) log.channels[4][k] += 1.0;  // set down with a tilt of 6 degrees
  const MotionFound found = find_motion(log);
  ASSERT_EQ(found.intervals.size(), 3U);
  EXPECT_EQ(found.intervals[0].channel, 2);
  EXPECT_FALSE(found.intervals[0].shakes);
  EXPECT_NEAR(found.intervals[0].from_s, 30.0, 1e-9);
  EXPECT_NEAR(found.intervals[0].to_s, 33.99, 1e-9);
  EXPECT_NEAR(found.intervals[0].amount / kDegree, 3.0, 4.0 * 0.5 / 10.0);  // a second's mean, four sigmas
  EXPECT_EQ(found.intervals[1].channel, 3);
  EXPECT_TRUE(found.intervals[1].shakes);
  EXPECT_NEAR(found.intervals[1].from_s, 70.0, 1e-9);
  EXPECT_EQ(found.intervals[2].channel, 4);
  EXPECT_NEAR(found.intervals[2].to_s, 119.99, 1e-9);
  EXPECT_NEAR(found.share, 36.0 / 120.0, 1e-9);
}

/// Even motions have no quiet second to be compared with: a turntable, and coning in place.
TEST(MotionCheck, EvenMotionsAreFound) {
  ImuLog turning = resting(6000), coning = resting(6000);
  for (std::size_t k = 0; k < turning.size(); ++k) {
    turning.channels[2][k] += 11.5 * kDegree;
    coning.channels[0][k] += 30.0 * kDegree * std::sin(0.5 * static_cast<double>(k));
  }
  EXPECT_NEAR(find_motion(turning).share, 1.0, 1e-12);
  EXPECT_NEAR(find_motion(coning).share, 1.0, 1e-12);
}

TEST(MotionCheck, LogsWithFewSamplesOrChannels) {
  EXPECT_FALSE(find_motion(resting(5)).moves());
  ImuLog log = resting(1000);
  for (std::size_t c = 0; c < 3; ++c) log.channels[c].clear();
  EXPECT_FALSE(find_motion(log).moves());
}

/// Real units at rest, one of them with a bias of 4.5 deg/s, the other on a pillar that swings.
TEST(MotionCheckReal, RestIsNotMotion) {
  CANYON_REAL_DATA(path, "inertial/allan_mpu6050/mpu6050_static_655s.csv");
  const auto log = read_imu_log(path, {"t_us,ax_g*2.44140625e-4,ay_g*2.44140625e-4,az_g*2.44140625e-4,"
                                       "gx_deg_s*0.00763358779,gy_deg_s*0.00763358779,gz_deg_s*0.00763358779"});
  ASSERT_TRUE(log.ok()) << log.error().str();
  EXPECT_FALSE(find_motion(*log).moves());
  CANYON_REAL_DATA(counts_path, "inertial/allan_adis16405/adis16405_imu1_first30min_100hz.i16");
  const std::string bytes = *read_text_file(counts_path);
  std::vector<std::int16_t> counts(bytes.size() / 2);
  std::memcpy(counts.data(), bytes.data(), bytes.size());
  ImuLog pillar;
  for (std::size_t k = 0; k < counts.size() / 6; ++k) {
    pillar.t_s.push_back(0.01 * static_cast<double>(k));
    for (std::size_t c = 0; c < 6; ++c)
      pillar.channels[c].push_back(counts[6 * k + c] * (c < 3 ? 0.05 * kDegree : 0.00333 * kStandardGravity));
  }
  EXPECT_FALSE(find_motion(pillar).moves());
}

/// A real drive: the car stands with its engine running for the first seconds, and moves for most of the nine minutes.
TEST(MotionCheckReal, ADriveIsMotion) {
  CANYON_REAL_DATA(path, "inertial/drive_mems_ppk/imu_raw_100hz.csv");
  const auto log = read_imu_log(path, {"t_s,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps"});
  ASSERT_TRUE(log.ok()) << log.error().str();
  const MotionFound found = find_motion(*log);
  std::printf("a drive: %zu times of motion, %.0f %% of it\n", found.intervals.size(), 100.0 * found.share);
  EXPECT_GT(found.share, 0.5);
}

}  // namespace
}  // namespace canyon::inertial

#include "canyon/inertial/imu_log.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/files.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::inertial {
namespace {

class ImuLogTest : public ::testing::Test {
 protected:
  void SetUp() override { path_ = testing::temporary_file("log.csv"); }
  void TearDown() override { std::filesystem::remove(path_); }

  Result<ImuLog> read(const std::string& text, const ImuLogFormat& format = {}) const {
    EXPECT_TRUE(write_text_file(path_, text).ok());
    return read_imu_log(path_, format);
  }
  /// The message without the folder.
  std::string mistake(const std::string& text, const ImuLogFormat& format = {}) const {
    const auto log = read(text, format);
    if (log.ok()) return "no error";
    const std::string message = log.error().str();
    return message.rfind(path_, 0) == 0 ? "log.csv" + message.substr(path_.size()) : message;
  }
  std::string path_;
};

/// A resting unit at 100 Hz: header, then rows of time, rates, forces, each times its factor.
std::string resting(const std::string& header, double gyro, double accel, int rows = 200,
                    const std::function<void(int, double*)>& change = {}) {
  const RandomStream stream(3, "test.log");
  std::string out = header + "\n";
  for (int k = 0; k < rows; ++k) {
    double v[6] = {1e-4, 2e-4, -1e-4, 0.0, 0.0, kStandardGravity};
    for (int c = 0; c < 6; ++c)
      v[c] = (v[c] + 1e-3 * stream.normal(static_cast<std::uint32_t>(c), static_cast<std::uint64_t>(k))) *
             (c < 3 ? gyro : accel);
    if (change) change(k, v);
    char line[200];
    std::snprintf(line, sizeof line, "%.2f,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", 0.01 * k, v[0], v[1], v[2], v[3], v[4],
                  v[5]);
    out += line;
  }
  return out;
}
constexpr const char* kSi = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2";
constexpr const char* kNames =
    "t_s or --rate, and channels such as gx_rad_s, gy_deg_s, az_m_s2, ax_g, with *FACTOR for counts";

TEST_F(ImuLogTest, LayoutsOfTheSameLogAgree) {
  const ImuLog si = *read(resting(kSi, 1.0, 1.0));
  ASSERT_EQ(si.size(), 200U);
  const auto same = [&](const Result<ImuLog>& other, double sign_yz = 1.0) {
    ASSERT_TRUE(other.ok()) << other.error().str();
    ASSERT_EQ(other->size(), si.size());
    for (std::size_t c = 0; c < 6; ++c)
      for (std::size_t k = 0; k < si.size(); ++k)  // 9 digits are written
        ASSERT_NEAR(other->channels[c][k], (c % 3 == 0 ? 1.0 : sign_yz) * si.channels[c][k], 1e-8 * 10.0) << c;
  };
  same(read(resting("t_s,gx_deg_s,gy_dps,gz_deg_h*3600,ax_g,ay_mg*1000,az_g", 1.0 / kDegree, 1.0 / kStandardGravity)));
  same(read(resting("t_s,gx_rad,gy_rad,gz_rad,ax_m_s,ay_m_s,az_m_s", 0.01, 0.01)));
  same(read(resting("# no names here", 1.0, 1.0), {.columns = std::string(kSi)}));
  same(read(resting("# KF-GINS", 0.01, 0.01), {.columns = "kf_gins"}), -1.0);
  same(read(resting("#timestamp [ns],w_RS_S_x [rad s^-1],...", 1.0, 1.0), {.columns = "euroc", .rate_hz = 100.0}));
  same(read(resting("%time,field.angular_velocity.x,field.angular_velocity.y,field.angular_velocity.z,"
                    "field.linear_acceleration.x,field.linear_acceleration.y,field.linear_acceleration.z",
                    1.0, 1.0),
            {.rate_hz = 100.0}));
  std::string blanks = resting("# columns apart by blanks", 1.0, 1.0);
  std::replace(blanks.begin(), blanks.end(), ',', ' ');
  same(read(blanks, {.columns = std::string(kSi)}));
}

TEST_F(ImuLogTest, MissingColumnsAreNamedWithTheirLine) {
  EXPECT_EQ(mistake("# mine\nt_s,gx_rad_s,gy_rad_s\n0,1,2\n"),
            std::string("log.csv:2: no column for gz, expected ") + kNames);
  EXPECT_EQ(mistake("time,gyro,force\n0,1,2\n"), std::string("log.csv:1: no column of an IMU, expected ") + kNames);
  EXPECT_EQ(mistake("gx_rad_s,gy_rad_s,gz_rad_s\n1,2,3\n"),
            std::string("log.csv:1: no time column, expected ") + kNames);
  EXPECT_EQ(mistake("t_s,gx_rads,gy_rad_s,gz_rad_s\n"),
            std::string("log.csv:1: column \"gx_rads\": no such unit, expected ") + kNames);
  EXPECT_EQ(mistake("t_s,gx_rad_s*x,gy_rad_s,gz_rad_s\n"),
            std::string("log.csv:1: column \"gx_rad_s*x\": no factor, expected ") + kNames);
  EXPECT_EQ(mistake("t_s,gx_rad_s,gy_rad_s,gz_rad_s,gx_deg_s\n"), "log.csv:1: two columns for gx, expected one");
  EXPECT_EQ(mistake("1,2,3\n"),
            "log.csv:1: no header, expected a header of names, or --columns with names or a layout: euroc, kf_gins");
  EXPECT_EQ(mistake("0,1,2,3\n0.01,1,2\n", {.columns = "t_s,gx_rad_s,gy_rad_s,gz_rad_s"}),
            "log.csv:2: 3 fields, expected 4 or more");
  EXPECT_EQ(mistake("", {.columns = "t_s,bogus"}), std::string("--columns: no column of an IMU, expected ") + kNames);
}

TEST_F(ImuLogTest, BadRowsAreNamedWithTheirLine) {
  EXPECT_EQ(mistake("t_s,gx_rad_s,gy_rad_s,gz_rad_s\n0,1,2,3\n0.01,1,x,3\n"),
            "log.csv:3: \"x\" is not a finite number, expected a number");
  EXPECT_EQ(mistake("t_s,gx_rad_s,gy_rad_s,gz_rad_s\n0,1,2,3\n0.01,1,nan,3\n"),
            "log.csv:3: \"nan\" is not a finite number, expected a number");
  EXPECT_EQ(mistake("t_s,gx_rad_s,gy_rad_s,gz_rad_s\n0,1,2,3\n0.02,1,2,3\n0.01,1,2,3\n"),
            "log.csv:4: time does not increase, expected samples in the order of time");
  EXPECT_EQ(mistake("t_s,gx_rad_s,gy_rad_s,gz_rad_s\n"),
            "log.csv: holds no samples, expected at least one line of numbers");
  EXPECT_EQ(mistake(""), "log.csv: holds no samples, expected at least one line of numbers");
  EXPECT_EQ(mistake(std::string("\x7f"
                                "ELF\0\1\2",
                                7)),
            std::string("log.csv:1: no column of an IMU, expected ") + kNames);
}

// Each mix-up of units is told by gravity or the Earth's rate.
TEST_F(ImuLogTest, UnitMixUpsAreNamed) {
  EXPECT_EQ(mistake(resting(kSi, 1.0, 1.0 / kStandardGravity)),
            "log.csv:2: mean specific force 1 m/s^2: these are g, expected names in _g");
  EXPECT_EQ(mistake(resting(kSi, 1.0, 1000.0 / kStandardGravity)),
            "log.csv:2: mean specific force 1000 m/s^2: these are mg, expected names in _mg");
  EXPECT_EQ(mistake(resting(kSi, 1.0, 100.0)),
            "log.csv:2: mean specific force 980.7 m/s^2: these are cm/s^2, expected _m_s2*0.01");
  EXPECT_EQ(mistake(resting("t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_g,ay_g,az_g", 1.0, 1.0)),
            "log.csv:2: mean specific force 96.17 m/s^2: these are m/s^2, expected names in _m_s2");
  EXPECT_EQ(mistake(resting(kSi, 0.01, 0.01)),
            "log.csv:2: mean specific force 0.09807 m/s^2: these are velocity increments, not rates, expected names in "
            "_m_s");
  EXPECT_EQ(mistake(resting("t_s,ax_m_s2,ay_m_s2,az_m_s2,gx_rad_s,gy_rad_s,gz_rad_s", 1.0, 1.0)),
            "log.csv:2: mean specific force 0.001623 m/s^2: gravity is in the columns that are named rates, expected "
            "rates and "
            "forces in the columns that name them");
  EXPECT_EQ(mistake(resting("t_s,ax_g,ay_g,az_g,gx_deg_s,gy_deg_s,gz_deg_s", 1.0, 1.0 / kStandardGravity)),
            "log.csv:2: mean specific force 0.01591 m/s^2: gravity is in the columns that are named rates, expected "
            "rates and "
            "forces in the columns that name them");
  EXPECT_EQ(mistake(resting("# rates", 1.0, 1.0), {.columns = "kf_gins"}),
            "log.csv:2: mean specific force 980.7 m/s^2: these are rates, where increments are said, expected names in "
            "_m_s2");
  const auto earth = [](int k, double* v) {
    for (int c = 0; c < 3; ++c) v[c] = Wgs84::rate_rad_s * 0.01 / std::sqrt(3.0) * (k % 2 ? 1.01 : 0.99);
  };
  EXPECT_EQ(mistake(resting("t_s,gx_rad_s,gy_rad_s,gz_rad_s", 1.0, 1.0, 200, earth)),
            "log.csv:2: mean rate 7.292e-07 rad/s is the Earth's times the interval: these are angle increments, not "
            "rates, expected names in _rad");
}

// Each triad is judged by itself. The Earth's rate by the interval: rates where increments are said.
TEST_F(ImuLogTest, UnitMixUpsOfOneTriadAreNamed) {
  const auto earth = [](double factor) {
    return [factor](int k, double* v) {
      for (int c = 0; c < 3; ++c) v[c] = Wgs84::rate_rad_s * factor / std::sqrt(3.0) * (k % 2 ? 1.01 : 0.99);
    };
  };
  EXPECT_EQ(mistake(resting("t_s,gx_rad,gy_rad,gz_rad", 1.0, 1.0, 200, earth(1.0))),
            "log.csv:2: mean rate 0.007292 rad/s is the Earth's by the interval: these are rates, where increments are "
            "said, expected names in _rad_s");
  EXPECT_EQ(mistake(resting("t_s,gx_rad,gy_rad,gz_rad,ax_m_s2,ay_m_s2,az_m_s2", 1.0, 1.0, 200, earth(1.0))),
            "log.csv:2: mean rate 0.007292 rad/s is the Earth's by the interval: these are rates, where increments are "
            "said, expected names in _rad_s");
  EXPECT_EQ(mistake(resting("t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s,ay_m_s,az_m_s", 1.0, 0.01, 200, earth(0.01))),
            "log.csv:2: mean rate 7.292e-07 rad/s is the Earth's times the interval: these are angle increments, not "
            "rates, expected names in _rad");
  // Rates of the one and increments of the other, both right.
  EXPECT_TRUE(read(resting("t_s,gx_rad,gy_rad,gz_rad,ax_m_s2,ay_m_s2,az_m_s2", 0.01, 1.0)).ok());
  EXPECT_EQ(mistake("t_s,gx_rad,gy_rad_s,gz_rad\n0,1,2,3\n"),
            "log.csv:1: rates and increments in one gyroscope, expected one of the two");
}

// 2026-11-21: the increment behind a gap was divided by the whole gap, and showed a ninth of gravity there; the jitter
// of a host's stamps became noise of the accelerometer.
TEST_F(ImuLogTest, IncrementsCoverOneSampleIntervalWhateverTheStampsSay) {
  std::string text = "t_s,gx_rad,gy_rad,gz_rad,ax_m_s,ay_m_s,az_m_s\n";
  for (int k = 0; k < 400; ++k) {
    const double t = 0.01 * k + (k >= 200 ? 1.0 : 0.0) + 1e-3 * std::sin(2.1 * k);
    char row[120];
    std::snprintf(row, sizeof row, "%.6f,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", t, 1e-5 * (k % 3), -1e-5 * (k % 5),
                  1e-5 * (k % 7), 1e-4 * (k % 3), -1e-4 * (k % 5), 0.0980665 + 1e-5 * (k % 11));
    text += row;
  }
  const auto log = read(text);
  ASSERT_TRUE(log.ok()) << log.error().str();
  EXPECT_TRUE(log->increments[0] && log->increments[1]);
  for (std::size_t k = 0; k < log->size(); ++k)
    EXPECT_NEAR(log->channels[5][k], 9.80665 + 1e-3 * static_cast<double>(k % 11), 0.02) << k;  // interval: 0.1 %
}

TEST_F(ImuLogTest, StuckAndSaturatedChannelsAreNamed) {
  const std::string stuck = resting(kSi, 1.0, 1.0, 200, [](int, double* v) { v[2] = 0.25; });
  EXPECT_EQ(mistake(stuck), "log.csv:2: gz never changes, expected a channel that is alive");
  EXPECT_TRUE(read(stuck, {.live = false}).ok());
  const auto clipped = [](int k, double* v) {
    if (k >= 50 && k < 75) v[0] = 8.726646;
  };
  EXPECT_EQ(mistake(resting(kSi, 1.0, 1.0, 200, clipped)),
            "log.csv:52: gx stays at its extreme value 8.72665 rad/s for 25 samples: saturated, expected a log within "
            "the sensor's range");
  // Coarse steps stay at their extreme without being saturated.
  EXPECT_TRUE(read(resting(kSi, 1.0, 1.0, 200, [](int k, double* v) { v[0] = 0.05 * std::floor(k / 10 % 3); })).ok());
}

// 2026-11-22: rates above those of any gyroscope were refused as deg/s where the header says rad/s.
TEST_F(ImuLogTest, UnitsThatAreNamedAreOnlyDoubted) {
  const auto fast = [](int k, double* v) { v[1] = k == 7 ? 180.0 : v[1]; };
  const auto doubt = [&](const std::string& text, const ImuLogFormat& format = {}) {
    const auto log = read(text, format);
    EXPECT_TRUE(log.ok()) << log.error().str();
    return log.ok() && log->doubts.size() == 1 ? log->doubts[0].substr(path_.size()) : "no doubt";
  };
  const char* expected = ":9: gy = 180 rad/s, taken as named: no gyroscope on the market goes so far";
  EXPECT_EQ(doubt(resting(kSi, 1.0, 1.0, 200, fast)), expected);
  EXPECT_EQ(doubt(resting("# no names here", 1.0, 1.0, 200, fast), {.columns = std::string(kSi)}), expected);
  // rostopic's names have no units: there it is a guess.
  EXPECT_EQ(mistake(resting("%time,field.angular_velocity.x,field.angular_velocity.y,field.angular_velocity.z,"
                            "field.linear_acceleration.x,field.linear_acceleration.y,field.linear_acceleration.z",
                            1.0, 1.0, 200, fast),
                    {.rate_hz = 100.0}),
            "log.csv:9: gy = 180 rad/s: no gyroscope goes so far; these are deg/s, expected names in _deg_s");
  // 100 g, and a unit that turns at 31 rad/s: a centrifuge, not cm/s^2.
  const auto spin = [](int, double* v) { v[2] += 31.0; };
  EXPECT_EQ(doubt(resting(kSi, 1.0, 100.0, 200, spin)),
            ":2: mean specific force 980.7 m/s^2: these are cm/s^2, expected _m_s2*0.01; taken as named, for the unit "
            "turns fast");
  EXPECT_TRUE(read(resting(kSi, 1.0, 1.0))->doubts.empty());
}

// 2026-11-22: numbers that no clock and no sensor gives ended in failed checks of the time, or in figures of nothing.
TEST_F(ImuLogTest, ImpossibleNumbersAreNamed) {
  EXPECT_EQ(mistake(std::string(kSi) + "\n0,0,0,0,0,0,9.8\n1,0,0,0,0,-1e200,9.8\n"),
            "log.csv:3: ay = -1e+200 m/s^2 is out of range, expected a rate or force below 1e12");
  EXPECT_EQ(mistake(std::string(kSi) + "\n-1e10,0,0,0,0,0,9.8\n1,0,0,0,0,0,9.8\n"),
            "log.csv:2: time -1e+10 s, expected seconds from -9.2e9 to 9.2e9");
  EXPECT_EQ(mistake(std::string(kSi) + "\n0,0,0,0,0,0,9.8\n1e-300,0,0,0,0,0,9.8\n"),
            "log.csv:2: samples 1e-300 s apart, expected a nanosecond or more; is the time's unit right?");
}

}  // namespace
}  // namespace canyon::inertial

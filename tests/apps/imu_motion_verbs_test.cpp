// canyon imu simulate and imu dead-reckon: as a user calls them.
#include <cmath>
#include <cstring>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "tests/apps/command_line_fixture.h"
#include "tests/support/test_data.h"

namespace canyon::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class ImuMotionVerbsTest : public testing::CommandLineTest {
 protected:
  nlohmann::json json_of(const std::string& arguments) const {
    EXPECT_EQ(canyon(arguments + " --json"), 0) << arguments << "\n" << read("stderr");
    return nlohmann::json::parse(read("stdout"), nullptr, false);
  }
  /// A sensor with a constant accelerometer bias and nothing else.
  void write_biased_sensor() const {
    const std::string others = "in_run_bias_source = \"test\"\nscale_ppm = 0.0\nmisalignment_mrad = 0.0\n";
    write(
        "biased.toml",
        "name = \"biased\"\n[gyro]\narw_deg_per_sqrt_hr = 0.0\nturn_on_bias_deg_per_hr = 0.0\nin_run_bias_deg_per_hr = "
        "0.0\n" +
            others +
            "[accel]\nvrw_m_s_per_sqrt_hr = 0.0\nturn_on_bias_mg = 1.0\nturn_on_bias_source = \"test\"\n"
            "in_run_bias_mg = 0.0\n" +
            others);
  }
};

/// A drive of at most 15 m/s and 25 deg/s, integrated over ten minutes from both logs: within the millimetre.
TEST_F(ImuMotionVerbsTest, WhatIsSimulatedWithoutErrorsIsFoundAgain) {
  const auto made = json_of(
      "imu simulate --path figure_eight --set length_m=120 --set width_m=100 --set period_s=75 --set climb_m=2 --set "
      "sway_deg=4 --set imu.lever_arm_m=[0.3,0.1,0.5] --errors none --start 1590:604700 --out eight");
  EXPECT_EQ(made["samples"], 120000);
  EXPECT_LE(made["speed_max_m_s"].get<double>(), 15.0);
  EXPECT_LE(made["rate_max_deg_s"].get<double>(), 25.0);
  EXPECT_THAT(read("eight/imu.csv"),
              StartsWith("t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n604700.005000000,"));
  for (const char* log : {"imu.csv", "imu_kf_gins.txt"}) {
    const auto drift = json_of(std::string("imu dead-reckon --imu eight/") + log + " --truth eight/truth.nav");
    EXPECT_EQ(drift["compared"], 120000) << log;
    EXPECT_EQ(drift["gravity"], "wgs84") << log;
    EXPECT_LT(drift["final_error_m"].get<double>(), 1e-3) << log;
    EXPECT_LT(drift["rms_3d_m"].get<double>(), 1e-3) << log;
    EXPECT_FALSE(drift.contains("nees_mean"));  // of a filter
    std::printf("%s, free for 600 s: %.2e m at the end\n", log, drift["final_error_m"].get<double>());
  }
}

/// The drift is that of the errors in the truth record, b t^2 / 2, but for Schuler's oscillation, (t / 806 s)^2 / 12,
/// and for what Coriolis brings over from the other axes, 2 w_IE t / 3.
TEST_F(ImuMotionVerbsTest, ErrorsDriftAsTheirLawSays) {
  write_biased_sensor();
  json_of("imu simulate --at 45,7,200 --sensor biased.toml --duration 60 --rate 50 --seed 4 --out still");
  const auto drift = json_of("imu dead-reckon --imu still/imu.csv --truth still/truth.nav --out drift");
  const std::string errors = read("still/errors.csv");
  double t, g[3], a[3];
  ASSERT_EQ(std::sscanf(errors.c_str() + errors.find('\n') + 1, "%lf,%lf,%lf,%lf,%lf,%lf,%lf", &t, &g[0], &g[1], &g[2],
                        &a[0], &a[1], &a[2]),
            7);
  const double law_m = 0.5 * std::hypot(a[0], a[1]) * 3600.0;
  EXPECT_GT(law_m, 1.0);
  EXPECT_NEAR(drift["final_horizontal_error_m"].get<double>() / law_m, 1.0,
              5e-4 + 2.0 * 7.3e-5 * 60.0 / 3.0 * std::hypot(a[0], a[1], a[2]) / std::hypot(a[0], a[1]));
  EXPECT_THAT(read("drift/drift.csv"), StartsWith("t_s,error_e_m,error_n_m,error_u_m,error_ve_m_s,"));
  EXPECT_THAT(read("drift/heading.csv"), StartsWith("t_s,roll_deg,pitch_deg,heading_deg,angle_x_deg,"));
  EXPECT_THAT(read("drift/drift.svg"), HasSubstr("Integral of each gyroscope"));
  const std::string xml = "/usr/bin/python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' '";
  EXPECT_EQ(std::system((xml + path("drift/drift.svg") + "'").c_str()), 0);
}

TEST_F(ImuMotionVerbsTest, AStaticLogIsLevelledByItself) {
  json_of(
      "imu simulate --at 45,7,200 --errors none --set pitch_deg=3 --set roll_deg=-2 --duration 60 --rate 50 --out "
      "still");
  const auto drift = json_of("imu dead-reckon --imu still/imu.csv --static 45,7,200,0");
  EXPECT_LT(drift["final_error_m"].get<double>(), 1e-3);
}

TEST_F(ImuMotionVerbsTest, PointsAndRecordingsBecomeLogs) {
  write("given.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n10,80,10,1\n20,120,60,0\n30,200,90,2\n");
  json_of("imu simulate --points given.csv --at 45,7,200 --errors none --rate 100 --out points");
  EXPECT_LT(json_of("imu dead-reckon --imu points/imu.csv --truth points/truth.nav")["final_error_m"].get<double>(),
            1e-3);
  // Its truth, as a recording, becomes a log of the same motion again.
  json_of("imu simulate --trajectory points/truth.nav --errors none --rate 100 --out again");
  EXPECT_LT(json_of("imu dead-reckon --imu again/imu.csv --truth points/truth.nav")["final_error_m"].get<double>(),
            1e-3);
}

TEST_F(ImuMotionVerbsTest, SameSeedSameBitsForAnyNumberOfThreads) {
  const std::string call = "imu simulate --path circle --sensor stim300 --duration 5 --seed 3 --out ";
  ASSERT_EQ(canyon(call + "one.csv --threads 1"), 0);
  ASSERT_EQ(canyon(call + "two.csv --threads 2"), 0);
  EXPECT_EQ(read("one.csv"), read("two.csv"));
}

TEST_F(ImuMotionVerbsTest, MistakesAreToldInOneLine) {
  expect_mistake("imu simulate --errors none",
                 "command line: no motion given, expected --at LAT,LON,H, --path NAME, --points or --trajectory FILE");
  expect_mistake("imu simulate --path circle --duration 1e7 --rate 5000",
                 "--duration: 50000000000 samples, expected at most 10000000: a shorter duration or a lower --rate");
  expect_mistake("imu simulate --path circel",
                 "--path: path: unknown name \"circel\", expected one of \"stationary\", \"straight\", \"circle\", ");
  expect_mistake("imu simulate --path circle --set radius=5",
                 "--set:1: radius: unknown key, expected one of the documented keys; nearest is \"radius_m\"");
  expect_mistake("imu simulate --at 45,7",
                 "--at: \"45,7\" cannot be read, expected LAT,LON,H: degrees, degrees, metres");
  write("given.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,5,0,0\n");
  expect_mistake("imu simulate --points given.csv", "given.csv: 2 points, expected three or more");
  write("given.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,5,0,0\n2,5,0,0\n3,5,0,0\n");
  expect_mistake("imu simulate --points given.csv",
                 "there is no direction of travel, expected attitudes where the body halts or turns back");
  write("given.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n0,5,0,0\n");
  expect_mistake("imu simulate --points given.csv",
                 "given.csv:3: time does not increase, expected points in the order of time");
  write("given.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,9,1,0\n2,18,0,0\n");
  expect_mistake("imu simulate --points given.csv --duration 3",
                 "--duration: 3 s, expected at most 2 s, the length of the trajectory");
  expect_mistake("imu dead-reckon --imu given.csv",
                 "command line: no start given, expected --truth FILE, --initial ... or --static ...");
  expect_mistake("imu dead-reckon --imu given.csv --static 45,7,200,0 --integrator rk",
                 "--integrator: \"rk\", expected one of euler, trapezoid, constant_rate, two_sample, three_sample");
  expect_mistake("imu dead-reckon --imu nowhere.csv --static 45,7,200,0", "nowhere.csv");
}

/// Rows of a log, with those from `begin` to `end` left out.
std::string without_rows(const std::string& text, std::size_t begin, std::size_t end) {
  std::string out;
  std::size_t row = 0;
  for (std::size_t at = 0, next; at < text.size(); at = next + 1, ++row) {
    next = text.find('\n', at);
    if (row < begin || row >= end) out += text.substr(at, next + 1 - at);
  }
  return out;
}

// 2026-11-21: at rest with a second missing, the log of increments fell for the time of the gap.
TEST_F(ImuMotionVerbsTest, AGapIsBridgedInRatesAndInIncrements) {
  ASSERT_EQ(canyon("imu simulate --at 45,7,200 --errors none --duration 20 --rate 50 --out still"), 0);
  for (const char* log : {"imu.csv", "imu_kf_gins.txt"}) {
    write("given.csv", without_rows(read(std::string("still/") + log), 500, 550));
    const auto drift = json_of("imu dead-reckon --imu given.csv --truth still/truth.nav");
    EXPECT_EQ(drift["gaps"], 1) << log;
    EXPECT_LT(drift["final_error_m"].get<double>(), 1e-3) << log;
  }
}

TEST_F(ImuMotionVerbsTest, DeadAndSaturatedChannelsAreWarnedOf) {
  ASSERT_EQ(canyon("imu simulate --at 45,7,200 --errors white_only --duration 4 --rate 50 --out still"), 0);
  const std::string log = read("still/imu.csv");
  const auto with_gx = [&](auto value_of) {
    std::string out;
    std::size_t row = 0;
    for (std::size_t at = 0, next; at < log.size(); at = next + 1, ++row) {
      next = log.find('\n', at);
      const std::string line = log.substr(at, next - at);
      const std::size_t first = line.find(','), second = line.find(',', first + 1);
      out += row == 0 ? line
                      : line.substr(0, first + 1) + value_of(row, line.substr(first + 1, second - first - 1)) +
                            line.substr(second);
      out += '\n';
    }
    return out;
  };
  write("given.csv", with_gx([](std::size_t, const std::string&) { return std::string("0.001"); }));
  json_of("imu dead-reckon --imu given.csv --truth still/truth.nav");
  EXPECT_THAT(read("stderr"), HasSubstr("given.csv:2: gx never changes, expected a channel that is alive"));
  EXPECT_THAT(read("stderr"), StartsWith("warning: "));
  write("given.csv",
        with_gx([](std::size_t row, const std::string& was) { return row > 50 && row < 80 ? "0.01" : was; }));
  json_of("imu dead-reckon --imu given.csv --truth still/truth.nav");
  EXPECT_THAT(read("stderr"),
              HasSubstr("given.csv:52: gx stays at its extreme value 0.01 rad/s for 29 samples: saturated"));
}

// 2026-11-21: an interval lengthened by jitter divided the increment of a true one.
TEST_F(ImuMotionVerbsTest, JitterOfTheClockIsInTheStampsAlone) {
  write("jitter.toml", std::string("name = \"jitter\"\n[gyro]\narw_deg_per_sqrt_hr = 0.0\nturn_on_bias_deg_per_hr = "
                                   "0.0\nin_run_bias_deg_per_hr = 0.0\nscale_ppm = 0.0\nmisalignment_mrad = 0.0\n"
                                   "[accel]\nvrw_m_s_per_sqrt_hr = 0.0\nturn_on_bias_mg = 0.0\nin_run_bias_mg = 0.0\n"
                                   "scale_ppm = 0.0\nmisalignment_mrad = 0.0\n[unit]\nclock_jitter_us = 500\n"
                                   "clock_jitter_source = \"test\"\n"));
  ASSERT_EQ(canyon("imu simulate --at 45,7,200 --sensor jitter.toml --errors full --duration 2 --rate 50 --out still"),
            0)
      << read("stderr");
  const std::string log = read("still/imu.csv");
  double least_s = 1.0, most_s = 0.0, before = 0.0, t, v[6];
  std::size_t row = 0;
  for (std::size_t at = log.find('\n') + 1; at < log.size(); at = log.find('\n', at) + 1, ++row) {
    ASSERT_EQ(std::sscanf(log.c_str() + at, "%lf,%lf,%lf,%lf,%lf,%lf,%lf", &t, v, v + 1, v + 2, v + 3, v + 4, v + 5),
              7);
    EXPECT_NEAR(v[5], 9.8057, 1e-3) << row;
    if (row > 0) least_s = std::min(least_s, t - before), most_s = std::max(most_s, t - before);
    before = t;
  }
  EXPECT_LT(least_s, 0.0195);
  EXPECT_GT(most_s, 0.0205);
}

TEST_F(ImuMotionVerbsTest, PaperFiguresAreWritten) {
  const auto json = json_of("imu paper --out figures");
  ASSERT_EQ(json["figures"].size(), 6U);
  for (const char* name : {"figures_2_and_3", "figure_7", "figure_7_text_parameters"})
    for (const char* form : {"as_printed", "corrected"}) {
      const std::string file = std::string("figures/") + name + "_" + form;
      EXPECT_THAT(read(file + ".csv"), StartsWith("t_s,rate_x_deg_s,rate_y_deg_s,rate_z_deg_s,angle_x_deg,"));
      EXPECT_THAT(read(file + ".svg"), HasSubstr("Integral of each gyroscope (heading), deg"));
    }
  for (const auto& figure : json["figures"])
    if (figure["figure"] == "figures_2_and_3" && figure["form"] == "as corrected") {
      EXPECT_NEAR(figure["drift_deg_per_hr"][0].get<double>(), 3.0, 2.0);
    }
}

TEST_F(ImuMotionVerbsTest, MistakenLogsAreRecognized) {
  ASSERT_EQ(canyon("imu simulate --at 45,7,200 --duration 2 --rate 50 --out given_still"), 0) << read("stderr");
  const std::string truth = " --truth given_still/truth.nav";
  // Rates where the format has increments, and the other way round.
  std::string rates = read("given_still/imu.csv");
  rates = rates.substr(rates.find('\n') + 1);
  for (char& c : rates) c = c == ',' ? ' ' : c;
  write("given.txt", rates);
  expect_mistake("imu dead-reckon --imu given.txt" + truth, "these are rates, where increments are said");
  write("given.csv", "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n");
  expect_mistake("imu dead-reckon --imu given.csv" + truth, "given.csv: holds no samples");
  write("given.csv", "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2\n0.02,0,0,0,0\n0.04,0,0,0,0\n");
  expect_mistake("imu dead-reckon --imu given.csv" + truth, "no column for ay");
  expect_mistake("imu dead-reckon --axes frd --imu given_still/imu.csv" + truth,
                 "in the initial attitude the specific force points down, expected --axes flu");
  write("given.nav", "0 1000 45 7 200 0 0 0 0 0 0\n0 1001 45 7 200 0 0 0 0 0 0\n");
  expect_mistake(
      "imu dead-reckon --imu given_still/imu.csv --truth given.nav",
      "given.nav: covers 1000.000 to 1001.000 s of the week, expected times from 0.000 to 2.000 s of the week");
}

/// The ideal log of another program on a real car's path: within a public filter's figure after ten minutes.
TEST_F(ImuMotionVerbsTest, IdealLogOfARealDrive) {
  CANYON_REAL_DATA(imu, "inertial/sim_leador_a15/imu_ideal_100hz.f64");
  CANYON_REAL_DATA(truth, "inertial/sim_leador_a15/truth_10hz.csv");
  const std::string bytes = *read_text_file(imu);
  std::string text;
  for (std::size_t k = 0; k * 48 < bytes.size(); ++k) {
    double v[6];
    std::memcpy(v, bytes.data() + k * 48, 48);
    char row[200];
    std::snprintf(row, sizeof row, "%.2f %.17g %.17g %.17g %.17g %.17g %.17g\n",
                  457000.0 + 0.01 * static_cast<double>(k + 1), v[0], v[1], v[2], v[3], v[4], v[5]);
    text += row;
  }
  write("ideal.txt", text);
  const auto drift = json_of("imu dead-reckon --imu ideal.txt --truth " + truth);
  std::printf("ideal IMU on a real drive, free for %.0f s: %.3f mm at the end\n", drift["duration_s"].get<double>(),
              1e3 * drift["final_error_m"].get<double>());
  EXPECT_EQ(drift["gravity"], "grs80_series");
  EXPECT_LT(drift["final_error_m"].get<double>(), 8.2e-3);
}

}  // namespace
}  // namespace canyon::apps

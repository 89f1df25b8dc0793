// A recorded walk with a u-blox receiver and a MEMS unit (rtklibexplorer/GNSS_IMU, walk_0827), the reference by RTK:
// the filter loosely and tightly coupled on the same satellites. The raw messages of the receiver are made RINEX by
// RTKLIB.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/time.h"
#include "canyon/tests/apps/command_line_fixture.h"
#include "canyon/tests/support/outside_program.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::apps {
namespace {

struct Walked {
  double rms_3d_m = 0.0, rms_up_m = 0.0, nees = 0.0;
  double innovations_m = 0.0;  ///< RMS, of what tells the headings apart
};

class RecordedWalk : public testing::CommandLineTest {
 protected:
  /// Logs as `canyon fuse` reads them. The unit's stamps are of its own clock, of which nothing is known: it is put
  /// 0.95 s after the receiver's first epoch, where its rate about the vertical is most like that of the reference's
  /// course (correlation -0.92). So much of the reference all filters have been given, and no more.
  void prepare(const std::string& raw, const std::string& imu, const std::string& reference) {
    ASSERT_TRUE(write_text_file(path("given.ubx"), *read_text_or_gzip_file(raw)).ok());
    const std::string convert =
        "cd '" + folder_.string() +
        "' && convbin -r ubx -v 3.04 -od -os -o given.obs -n given.nav given.ubx > /dev/null 2>&1";
    ASSERT_EQ(std::system(convert.c_str()), 0);
    std::ofstream log(path("given_imu.csv"));
    log << "ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps,t_ms\n";
    std::istringstream rows(*read_text_file(imu));
    for (std::string line; std::getline(rows, line);)  // the first and the last one are cut off
      if (std::count(line.begin(), line.end(), ',') == 6 && line.back() != ',') log << line << "\n";
    std::ofstream truth(path("given_truth.csv"));
    truth << "gps_week,sow,lat_deg,lon_deg,h_m,vn_m_s,ve_m_s,vu_m_s\n";
    std::istringstream places(*read_text_file(reference));
    for (std::string line; std::getline(places, line);) {
      if (line.empty() || line[0] == '%') continue;
      std::istringstream in(line);
      std::vector<std::string> words;
      for (std::string word; in >> word;) words.push_back(word);
      std::string date = words[0];
      std::replace(date.begin(), date.end(), '/', '-');
      const GpsTime t = *GpsTime::parse(date + "T" + words[1], "reference");
      char time[64];
      std::snprintf(time, sizeof time, "%d,%.3f", t.week(), t.sow_s());
      truth << time << "," << words[2] << "," << words[3] << "," << words[4] << "," << words[15] << "," << words[16]
            << "," << words[17] << "\n";
    }
    write("given_solve.toml", "ionosphere = \"none\"\n");  // the two minutes hold no coefficients
  }

  Walked walk_along(double heading_deg, const std::string& fusion, const std::string& noise) {
    write("given.toml",
          "[imu]\nsensor = \"mpu6050\"\nclock_offset_s = 405314.36\n" + noise +
              "[gnss]\nsolve = \"given_solve.toml\"\n[start]\nfrom = \"static\"\nstatic_s = 8\nstatic_heading_deg = " +
              std::to_string(heading_deg) + "\nstatic_heading_sigma_deg = 30\n[fusion]\nacceptance = \"student_t\"\n" +
              fusion);
    EXPECT_EQ(canyon("fuse --imu given_imu.csv --gnss given.obs --nav given.nav --truth given_truth.csv --config "
                     "given.toml --out fused --force --json"),
              0)
        << read("stderr");
    const auto json = nlohmann::json::parse(read("stdout"));
    Walked out{json["rms_3d_m"], json["rms_u_m"], json["nees_mean"]};
    double square = 0.0;
    int count = 0;
    std::istringstream rows(read("fused/innovations.csv"));
    for (std::string line; std::getline(rows, line);) {
      std::istringstream in(line);
      std::vector<std::string> words;
      for (std::string word; std::getline(in, word, ',');) words.push_back(word);
      if (words.size() < 7 || (words[2] != "position" && words[2] != "ranges")) continue;
      for (std::size_t k = 6; k < words.size(); ++k)
        if (!words[k].empty()) square += std::stod(words[k]) * std::stod(words[k]), ++count;
    }
    out.innovations_m = std::sqrt(square / count);
    return out;
  }

  /// Which way the unit looks nobody has written down: of eight headings the one whose innovations are the smallest.
  Walked walk(const char* name, const std::string& fusion, const std::string& noise = "") {
    double heading_deg = 0.0, least = 1e300;
    for (double at = 0.0; at < 360.0; at += 45.0)
      if (const double found = walk_along(at, fusion, noise).innovations_m; found < least)
        least = found, heading_deg = at;
    const Walked out = walk_along(heading_deg, fusion, noise);
    std::printf("%-26s 3-D RMS %.1f m, up %.1f m, NEES %.0f, innovations %.2f m\n", name, out.rms_3d_m, out.rms_up_m,
                out.nees, out.innovations_m);
    return out;
  }
};

const std::string kPositions = "states = [\"biases\", \"fix_error\"]\nmeasurements = [\"position\"]\n",
                  kRanges =
                      "states = [\"biases\", \"receiver_clock\", \"range_errors\"]\nmeasurements = [\"ranges\"]\n",
                  kWhitePositions = "states = [\"biases\"]\nmeasurements = [\"position\"]\n",
                  kWhiteRanges = "states = [\"biases\", \"receiver_clock\"]\nmeasurements = [\"ranges\"]\n",
                  kVelocities =
                      "states = [\"biases\", \"fix_error\", \"velocity_error\"]\n"
                      "measurements = [\"position\", \"velocity\"]\n";

#define CANYON_RECORDED_WALK()                                             \
  CANYON_OUTSIDE_PROGRAM("convbin");                                       \
  CANYON_REAL_DATA(raw, "gnss/gnss_imu_walk_0827/gnss_1730.ubx.gz");       \
  CANYON_REAL_DATA(imu, "gnss/gnss_imu_walk_0827/imu_1730.csv");           \
  CANYON_REAL_DATA(reference, "gnss/gnss_imu_walk_0827/gnss_1730_sf.pos"); \
  prepare(raw, imu, reference)

TEST_F(RecordedWalk, SatellitesOneByOneErrLessThanTheirFixes) {
  CANYON_RECORDED_WALK();
  EXPECT_LT(walk("ranges and rates", kRanges).rms_3d_m, walk("positions", kPositions).rms_3d_m);
}

// The table of docs/fusion.md: coupling by itself, and the states of each satellite.
TEST_F(RecordedWalk, WhatMakesTheDifferenceNightly) {
  CANYON_RECORDED_WALK();
  for (const std::string noise : {"", "arw_deg_per_sqrt_hr = 10\nvrw_m_s_per_sqrt_hr = 10\n"}) {
    std::printf("%s", noise.empty() ? "noise of the datasheet\n" : noise.c_str());
    const Walked positions = walk("positions", kPositions, noise), ranges = walk("ranges and rates", kRanges, noise);
    walk("positions and velocities", kVelocities, noise);
    const Walked white = walk("positions, errors white", kWhitePositions, noise),
                 white_ranges = walk("ranges, errors white", kWhiteRanges, noise);
    EXPECT_LT(ranges.rms_3d_m, positions.rms_3d_m);
    EXPECT_LT(ranges.rms_3d_m, white_ranges.rms_3d_m);
    EXPECT_GT(positions.rms_3d_m, white.rms_3d_m);
  }
}

}  // namespace
}  // namespace canyon::apps

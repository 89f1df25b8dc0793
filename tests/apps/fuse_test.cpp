// canyon fuse, as a user calls it.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kUnit = "[imu]\nsensor = \"stim300\"\n[gnss]\nsigma_enu_m = [1.0, 1.0, 2.0]\n";

class FuseTest : public testing::CommandLineTest {
 protected:
  /// A minute of a figure eight by a tactical unit, and its truth at 50 Hz.
  void simulate() const {
    ASSERT_EQ(canyon("imu simulate --path figure_eight --at 45,7,200 --sensor stim300 --rate 50 --duration 60 --start "
                     "2200:1000 --seed 3 --out log"),
              0)
        << read("stderr");
    write("fuse.toml", kUnit);
  }
  /// Lines of the truth, `every` so many, as fixes: `row` makes a line of week, sow, lat, lon, h, vN, vE, vD.
  template <class Row>
  std::string fixes(const std::string& header, const Row& row, int every = 25) const {
    std::istringstream truth(read("log/truth.nav"));
    std::string line, out = header;
    for (int k = 0; std::getline(truth, line);) {
      double v[8];
      std::istringstream numbers(line);
      if (line.front() == '#') continue;
      for (double& x : v) numbers >> x;
      if (k++ % every == 1) out += row(v);
    }
    return out;
  }
  static std::string text(const char* format, auto... values) {
    char buffer[400];
    std::snprintf(buffer, sizeof buffer, format, values...);
    return buffer;
  }
  nlohmann::json json_of(const std::string& arguments) const {
    EXPECT_EQ(canyon(arguments + " --json"), 0) << arguments << "\n" << read("stderr");
    return nlohmann::json::parse(read("stdout"), nullptr, false);
  }
  void refused(const std::string& arguments, const std::string& line) const {
    EXPECT_EQ(canyon(arguments), 2) << arguments;
    EXPECT_EQ(read("stderr"), line + "\n");
  }
  std::string bare_fixes() const {
    return fixes("", [](const double* v) { return text("%.3f %.9f %.9f %.4f 1 1 2\n", v[1], v[2], v[3], v[4]); });
  }
};

constexpr const char* kCall =
    "fuse --imu log/imu_kf_gins.txt --gnss fixes.txt --truth log/truth.nav --config fuse.toml";

TEST_F(FuseTest, TheContractOfItsJson) {
  simulate();
  write("fixes.txt", bare_fixes());
  const auto out = json_of(std::string(kCall) + " --outage 5,20,20 --out fused");
  for (const char* key : {"rms_3d_m", "rms_e_m", "rms_n_m", "rms_u_m", "nees_mean", "nis_mean", "final_error_m"})
    EXPECT_TRUE(out[key].is_number()) << key;
  EXPECT_EQ(out["velocity_rms_m_s"].size(), 3U);
  EXPECT_EQ(out["attitude_rms_deg"].size(), 3U);
  EXPECT_EQ(out["outage"]["count"], 2);
  EXPECT_TRUE(out["outage"]["horizontal_rms_of_max_m"].is_number());
  EXPECT_LT(out["rms_3d_m"].get<double>(), 1.0);
  EXPECT_EQ(out["samples"], 3000);
  EXPECT_EQ(out["fixes"].get<int>() + out["fixes_withheld"].get<int>(), 120);
  EXPECT_EQ(out["start"]["from"], "truth");
  EXPECT_EQ(nlohmann::json::parse(read("fused/summary.json")), out);
  EXPECT_THAT(read("fused/nav.csv"), StartsWith("gps_week,sow,lat_deg,lon_deg,h_m,vn_m_s,"));
  EXPECT_THAT(read("fused/innovations.csv"), HasSubstr(",position,1,3,"));
  EXPECT_THAT(read("fused/errors.csv"), StartsWith("gps_week,sow,scored,error_e_m,"));
  EXPECT_THAT(read("fused/estimate.kml"), HasSubstr("<LineString>"));
  EXPECT_THAT(read("fused/errors.svg"), HasSubstr("Position error"));
  // What it writes it reads: the estimate as a reference of itself.
  const auto again = json_of("fuse --imu log/imu.csv --gnss fixes.txt --truth fused/estimate.nav --config fuse.toml");
  EXPECT_LT(again["rms_3d_m"].get<double>(), 1.0);
  // Without a reference there is nothing to compare with.
  const auto alone = json_of("fuse --imu log/imu.csv --gnss fixes.txt --config fuse.toml");
  EXPECT_TRUE(alone["rms_3d_m"].is_null());
  EXPECT_TRUE(alone["outage"].is_null());
  EXPECT_EQ(alone["start"]["from"], "in_motion");
}

/// The same drive in every layout gives the same figures.
TEST_F(FuseTest, LayoutsOfFixesAndReferences) {
  simulate();
  write("fixes.txt", bare_fixes());
  const double expected = json_of(kCall)["rms_3d_m"].get<double>();
  const std::string rest = " --config fuse.toml";
  write("named.csv", fixes("t_s,lat_rad,lon_rad,h_mm,sd_n_cm,sd_e,sd_u\n", [](const double* v) {
          const double rad = std::acos(-1.0) / 180.0;
          return text("%.3f,%.15f,%.15f,%.2f,100,1,2\n", v[1], v[2] * rad, v[3] * rad, 1e3 * v[4]);
        }));
  write("rtk.pos",
        fixes("%  GPST            latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)   sdu(m)\n",
              [](const double* v) { return text("2200 %.3f %.9f %.9f %.4f 1 9 1 1 2\n", v[1], v[2], v[3], v[4]); }));
  write("plain.csv", fixes("gps_week,sow,lat_deg,lon_deg,h_m\n", [](const double* v) {
          return text("%.0f,%.3f,%.9f,%.9f,%.4f\n", v[0], v[1], v[2], v[3], v[4]);
        }));
  for (const char* file : {"named.csv", "rtk.pos", "plain.csv"})
    // Places are rounded to 1e-9 deg, 0.1 mm, in some of them.
    EXPECT_NEAR(
        json_of("fuse --imu log/imu.csv --gnss " + std::string(file) + " --truth log/truth.nav" + rest)["rms_3d_m"]
            .get<double>(),
        expected, 3e-4)
        << file;
  // ECEF and quaternions: of the estimate's own TUM, which is local, with its origin said.
  ASSERT_EQ(canyon(std::string(kCall) + " --out fused"), 0);
  write("local.toml", std::string(kUnit) + "[truth]\norigin_deg_deg_m = [45, 7, 200]\n");
  EXPECT_EQ(canyon("fuse --imu log/imu.csv --gnss fixes.txt --truth fused/estimate.tum --config local.toml"), 0)
      << read("stderr");
  refused("fuse --imu log/imu.csv --gnss fixes.txt --truth fused/estimate.tum --config fuse.toml",
          "fused/estimate.tum:2: is in local coordinates, expected truth.origin_deg_deg_m in --config, or "
          "lat_deg,lon_deg,h_m");
}

/// Observations through the solver, and the positions that the solver has written of them, are the same fixes.
TEST_F(FuseTest, ObservationsAndTheirPositions) {
  simulate();
  write("way.csv",
        fixes(
            "gps_week,sow,lat_deg,lon_deg,h_m\n",
            [](const double* v) { return text("%.0f,%.3f,%.11f,%.11f,%.5f\n", v[0], v[1], v[2], v[3], v[4]); }, 5));
  ASSERT_EQ(canyon("gnss simulate --trajectory way.csv --start 2200:1001 --duration 55 --rate 2 --rinex-obs o.rnx "
                   "--rinex-nav n.rnx"),
            0)
      << read("stderr");
  ASSERT_EQ(canyon("gnss solve --obs o.rnx --nav n.rnx --out positions.csv"), 0) << read("stderr");
  const std::string rest = " --truth log/truth.nav --config fuse.toml";
  const auto solved = json_of("fuse --imu log/imu.csv --gnss o.rnx --nav n.rnx" + rest);
  const auto read_again = json_of("fuse --imu log/imu.csv --gnss positions.csv" + rest);
  EXPECT_EQ(solved["fixes"], read_again["fixes"]);
  // Positions are written to 0.1 mm, covariances to six digits.
  EXPECT_NEAR(solved["rms_3d_m"].get<double>(), read_again["rms_3d_m"].get<double>(), 1e-4);
  EXPECT_LT(solved["rms_3d_m"].get<double>(), 5.0);  // of single-point fixes
}

TEST_F(FuseTest, WhatIsMendedIsToldInOneLineEach) {
  simulate();
  std::string log = read("log/imu_kf_gins.txt");
  // After some lines: a NaN, a sample twice, one from the past; then half a second is lost.
  std::istringstream lines(log);
  std::string line, out, before;
  for (int k = 0; std::getline(lines, line); ++k) {
    if (k >= 2000 && k < 2025) continue;
    out += line + "\n";
    if (k == 500) out += line.substr(0, line.find(' ')) + ".5 nan 0 0 0 0 0\n";
    if (k == 600) out += line + "\n";
    if (k == 700) out += before + "\n";
    before = line;
  }
  write("damaged.txt", out);
  write("fixes.txt", bare_fixes() + "1059.9 nan 7 200 1 1 2\n");
  const auto json = json_of("fuse --imu damaged.txt --gnss fixes.txt --truth log/truth.nav --config fuse.toml");
  const auto& d = json["diagnoses"];
  EXPECT_EQ(d["imu_not_finite"], 1);
  EXPECT_EQ(d["imu_duplicates"], 1);
  EXPECT_EQ(d["imu_reversed"], 1);
  EXPECT_EQ(d["imu_gaps"], 1);
  EXPECT_EQ(d["fixes_not_finite"], 1);
  EXPECT_EQ(json["gaps_bridged"], 1);
  EXPECT_NEAR(json["bridged_s"].get<double>(), 0.5, 1e-6);
  EXPECT_LT(json["rms_3d_m"].get<double>(), 1.5);
  EXPECT_EQ(read("stderr"),
            "warning: damaged.txt:502: no finite numbers after 1010.020 s, passed over (1 in all)\n"
            "warning: damaged.txt:603: 1012.020 s once more, passed over (1 in all)\n"
            "warning: damaged.txt:704: back in time from 1014.020 s to 1014.000 s, one of them passed over (1 in all)\n"
            "warning: damaged.txt:2004: gap of 0.5 s after 1040.000 s (1 in all)\n"
            "warning: fixes.txt:121: no finite numbers after 1059.520 s, passed over (1 in all)\n");
}

// Of several the first, of each file and each kind.
TEST_F(FuseTest, TheFirstOfWhatIsMendedHasItsLineAndTime) {
  simulate();
  write(
      "fixes.csv",
      "gps_week,sow,lat_deg,lon_deg,h_m,status,offered\n2200,1000.01,,7,200,none,1\n" + fixes("", [](const double* v) {
        const std::string end = v[1] < 1003.0 ? ",none,1\n" : v[1] < 1005.0 ? ",single,0\n" : ",single,1\n";
        return text("2200,%.3f,%.9f,%.9f,%.4f", v[1], v[2], v[3], v[4]) + end;
      }));
  write("wheel.csv",
        "sow,speed_m_s,dt_s\n1001,nan,1\n1002,5,1\n1002,5,1\n1003,nan,1\n1001.5,5,1\n1002,5,1\n1004,5,1\n");
  json_of("fuse --imu log/imu.csv --gnss fixes.csv --odometer wheel.csv --truth log/truth.nav --config fuse.toml");
  EXPECT_EQ(read("stderr"),
            "warning: fixes.csv:2: no solution at 1000.010 s (7 in all)\n"
            "warning: fixes.csv:9: fix at 1003.020 s marked as withheld, not used (4 in all)\n"
            "warning: wheel.csv:2: no finite numbers at the beginning, passed over (2 in all)\n"
            "warning: wheel.csv:4: 1002.000 s once more, passed over (1 in all)\n"
            "warning: wheel.csv:6: back in time from 1003.000 s to 1001.500 s, one of them passed over (2 in all)\n");
}

// Rows of fixes in another order than that of their times, one of them twice, and some that stand still.
TEST_F(FuseTest, FixesThatComeLateAreTakenInTheirPlace) {
  simulate();
  const std::string in_order = bare_fixes();
  write("fixes.txt", in_order);
  const auto expected = json_of(kCall);
  std::istringstream lines(in_order);
  std::vector<std::string> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(line + "\n");
  std::swap(rows[40], rows[41]);
  rows.insert(rows.begin() + 60, rows[60]);
  std::string shuffled;
  for (const std::string& row : rows) shuffled += row;
  write("fixes.txt", shuffled);
  const auto out = json_of(kCall);
  EXPECT_EQ(out["taken_late"], 1);
  EXPECT_EQ(out["incidents"]["duplicate"]["count"], 1);
  EXPECT_EQ(out["incidents"]["duplicate"]["what"], "the same instant twice");
  EXPECT_EQ(out["fixes_accepted"], expected["fixes_accepted"]);
  EXPECT_EQ(out["final_error_m"], expected["final_error_m"]);  // to the last bit
}

TEST_F(FuseTest, TheVerdictAndThePage) {
  simulate();
  write("fixes.txt", bare_fixes());
  // Fixes that are exact, and claim to be a metre off.
  const auto out = json_of(std::string(kCall) + " --outage 5,20,20 --smoother rts --out fused");
  EXPECT_THAT(out["verdict"].dump(), HasSubstr("position: innovations "));
  EXPECT_THAT(out["verdict"].dump(), HasSubstr(" times too small"));
  EXPECT_EQ(out["evidence"]["measurements"][0]["name"], "position");
  EXPECT_EQ(out["evidence"]["errors"].size(), 9U);
  const auto& observed = out["evidence"]["observability"];
  EXPECT_GE(observed["t_s"].size(), 25U);
  EXPECT_LE(observed["t_s"].size(), 50U);
  EXPECT_EQ(observed["states"].size(), out["evidence"]["states"].size());
  for (const auto& state : out["evidence"]["states"])
    EXPECT_EQ(observed["states"][state["name"].get<std::string>()].size(), observed["t_s"].size());
  EXPECT_EQ(out["smoother"]["name"], "rts");
  EXPECT_TRUE(out["smoother"]["outage"]["horizontal_rms_of_max_m"].is_number());
  EXPECT_LT(out["smoother"]["rms_3d_m"].get<double>(), out["rms_3d_m"].get<double>());
  EXPECT_THAT(read("fused/smoothed.csv"), StartsWith("gps_week,sow,lat_deg,lon_deg,h_m,vn_m_s,"));
  EXPECT_THAT(read("fused/smoothed_errors.csv"), StartsWith("gps_week,sow,scored,error_e_m,"));
  const std::string page = read("fused/report.html");
  for (const char* text : {"Errors over time", "Outages of the fixes", "Innovations", "position: innovations ",
                           "Does the filter know how wrong it is?", "smoothed by rts", "log/imu_kf_gins.txt",
                           "What the measurements tell of each state, over time"})
    EXPECT_THAT(page, HasSubstr(text));
  ASSERT_EQ(canyon("report fused"), 0) << read("stderr");
  EXPECT_EQ(read("fused/report.html"), page);
  // Without a reference only innovations speak, and the page says so.
  const auto alone = json_of("fuse --imu log/imu.csv --gnss fixes.txt --config fuse.toml --out alone");
  EXPECT_EQ(alone["evidence"]["errors"].size(), 0U);
  EXPECT_TRUE(alone["evidence"]["fixes"].is_null());
  EXPECT_THAT(alone["verdict"].dump(), HasSubstr("position: innovations "));
  EXPECT_THAT(read("alone/report.html"), HasSubstr("There was no reference (--truth)"));
}

// The truth's own attitudes as headings, and its poses as those of a map.
TEST_F(FuseTest, HeadingsAndPosesInAMap) {
  simulate();
  write("fixes.txt", bare_fixes());
  const std::string call = "fuse --imu log/imu.csv --gnss fixes.txt --truth log/truth.nav --heading log/truth.nav ";
  const std::string logs =
      "[heading]\ncolumns = \"gps_week,sow,a,b,c,d,e,f,g,i,heading_deg\"\nsigma_deg = 0.2\n"
      "[poses]\nsigma_enu_m = [0.1, 0.1, 0.1]\nattitude_sigma_deg = [0.2, 0.2, 0.2]\n";
  write("both.toml",
        std::string(kUnit) + logs + "[fusion]\nmeasurements = [\"position\", \"heading\", \"map_pose\"]\n");
  const auto out = json_of(call + "--poses log/truth.nav --config both.toml");
  EXPECT_EQ(out["measurements"], nlohmann::json({"position", "heading", "map_pose"}));
  EXPECT_EQ(out["innovations"]["heading"]["count"], 3000);
  EXPECT_EQ(out["innovations"]["map_pose"]["count"], 3000);
  EXPECT_LT(out["rms_3d_m"].get<double>(), 0.1);
  write("none.toml", std::string(kUnit) + logs);
  refused(call + "--config none.toml",
          "--heading: log/truth.nav, but the filter does not measure with \"heading\", expected \"heading\" in "
          "fusion.measurements of --config");
  write("heading.csv", "sow,heading_deg\n1001,10\n");
  write("fuse.toml", std::string(kUnit) + "[fusion]\nmeasurements = [\"position\", \"heading\"]\n");
  refused(std::string(kCall) + " --heading heading.csv",
          "heading.csv:2: a heading without a sigma, or with one of 0, expected a column sigma_deg, or "
          "heading.sigma_deg in --config");
  refused(kCall, "fuse.toml:6: fusion.measurements: \"heading\" without a log of one, expected --heading FILE");
}

TEST_F(FuseTest, MistakesAreToldInOneLine) {
  simulate();
  write("fixes.txt", bare_fixes());
  const std::string logs = "fuse --imu log/imu.csv --gnss fixes.txt --truth log/truth.nav";
  refused("fuse --imu log/imu.csv",
          "command line: no logs given, expected --imu FILE and --gnss FILE, or --results DIR and --run NAME");
  refused(logs + " --results there --run high", "command line: logs beside --results, expected one or the other");
  refused("fuse --results there",
          "command line: no logs given, expected --imu FILE and --gnss FILE, or --results DIR and --run NAME");
  refused(logs + " --outage 30,10,0",
          "--outage: \"30,10,0\", expected LENGTH,EVERY,FIRST in seconds, EVERY at least LENGTH");
  write("bad.toml", "[fusion]\nstates = [\"bises\"]\n");
  EXPECT_EQ(canyon(logs + " --config bad.toml"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("bad.toml:2: fusion.states"));
  write("bad.toml", "[fusion]\nmeasurements = [\"odometer\"]\n");
  refused(logs + " --config bad.toml",
          "bad.toml:2: fusion.measurements: \"odometer\" without a log of one, expected --odometer FILE");
  write("bad.toml", "[fusion]\nmeasurements = [\"position\", \"magnetometer\"]\n");
  refused(logs + " --config bad.toml",
          "bad.toml:2: fusion.measurements: \"magnetometer\" without a log of one, expected --results of a run whose "
          "filter measures with it");
  refused(logs + " --config fuse.toml --smoother rts2",
          "--smoother: unknown name \"rts2\", expected one of \"none\", \"rts\", \"batch_graph\", "
          "\"fixed_lag_graph\"; nearest is \"rts\"");
  // Another place of the same drive: 1 degree of latitude.
  {
    std::istringstream truth(read("log/truth.nav"));
    std::string moved;
    for (std::string line; std::getline(truth, line);) {
      double v[11];
      std::istringstream numbers(line);
      if (line.front() == '#') continue;
      for (double& x : v) numbers >> x;
      moved += text("%.0f %.3f %.9f %.9f %.4f %.5f %.5f %.5f %.6f %.6f %.6f\n", v[0], v[1], v[2] + 1.0, v[3], v[4],
                    v[5], v[6], v[7], v[8], v[9], v[10]);
    }
    write("elsewhere.nav", moved);
  }
  refused("fuse --imu log/imu.csv --gnss fixes.txt --truth elsewhere.nav --config fuse.toml",
          "elsewhere.nav: lies 111 km from the fixes of the same time, expected the frame of fixes.txt (degrees or "
          "metres, their order, truth.origin_deg_deg_m)");
  write("late.txt", "9000 45 7 200 1 1 2\n9001 45 7 200 1 1 2\n");
  refused("fuse --imu log/imu.csv --gnss late.txt --config fuse.toml",
          "late.txt: covers 9000.000 to 9001.000 s of the week, expected times from 1000.000 to 1060.000 s of the "
          "week, as in log/imu.csv");
  // Degrees are said and the columns are in another order.
  write("swapped.txt",
        fixes("", [](const double* v) { return text("%.3f %.9f %.9f %.4f 1 1 2\n", v[1], v[3], v[2], v[4]); }));
  EXPECT_EQ(canyon("fuse --imu log/imu.csv --gnss swapped.txt --truth log/truth.nav --config fuse.toml"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("log/truth.nav: lies 5.41e+03 "));
  EXPECT_THAT(read("stderr"), HasSubstr("km from the fixes of the same time, expected the frame of swapped.txt"));
  write("eight.txt", "1001 45 7 200 1 1 2 3 4\n");
  refused("fuse --imu log/imu.csv --gnss eight.txt --config fuse.toml",
          "eight.txt:1: 9 columns without a header, expected a header of names, or 7, 8, 11 or 13 columns as of "
          "KF-GINS and TUM");
  write("units.csv", "t_s,gx_rpm,gy_rps,gz_rps,ax_mps2,ay_mps2,az_mps2\n1,0,0,0,0,0,9.8\n");
  EXPECT_EQ(canyon("fuse --imu units.csv --gnss fixes.txt --config fuse.toml"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("units.csv:1: column \"gx_rpm\": no such unit"));
}

/// Names and units of public data sets.
TEST_F(FuseTest, NamesOfOtherDataSets) {
  CANYON_REAL_DATA(gnss, "inertial/drive_mems_ppk/gnss_ppk_4hz.csv");
  CANYON_REAL_DATA(imu, "inertial/drive_mems_ppk/imu_raw_100hz.csv");
  write("drive.toml",
        "[imu]\nsensor = \"mpu6050\"\nturn_deg = [180.0, -6.79, 185.35]\naxes = \"frd\"\nclock_offset_s = -0.125\n"
        "[truth]\nof = \"antenna\"\n[score]\nskip_s = 60\n");
  const auto out = json_of("fuse --imu " + imu + " --gnss " + gnss + " --truth " + gnss + " --config drive.toml");
  EXPECT_EQ(out["start"]["from"], "in_motion");
  EXPECT_LT(out["rms_3d_m"].get<double>(), 0.1);  // the fixes themselves, centimetres good
  EXPECT_TRUE(out["attitude_rms_deg"][0].is_null());
}

TEST_F(FuseTest, TheReferenceOfKeysIsThatOfTheDocs) {
  ASSERT_EQ(canyon("keys --fuse"), 0);
  std::ifstream page(std::string(CANYON_SOURCE_DIR) + "/docs/fuse.md");
  std::ostringstream text;
  text << page.rdbuf();
  EXPECT_THAT(text.str(), HasSubstr(read("stdout"))) << "run: canyon keys --fuse, into docs/fuse.md";
}

}  // namespace
}  // namespace canyon::apps

// canyon gnss solve: as a user calls it, on files that canyon gnss simulate wrote.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/tests/apps/command_line_fixture.h"
#include "canyon/tests/gnss/atmosphere/product_text.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::apps {
namespace {

using ::testing::HasSubstr;

class GnssSolveTest : public testing::CommandLineTest {
 protected:
  void SetUp() override {
    CommandLineTest::SetUp();
    write("vacuum.toml", "ionosphere = \"none\"\ntroposphere = \"none\"\nsmoothing_s = 0.0\nshared_ionosphere = 0.0\n");
    ASSERT_EQ(
        canyon(
            "gnss simulate --force --at 32.35,-90.88,60 --duration 60 --errors none --rinex-obs given.rnx --rinex-nav "
            "given.nav"),
        0)
        << read("stderr");
  }
  /// The fields from one heading to another of every row of a table, as they stand there.
  static std::string columns(const std::string& table, const std::string& first, const std::string& last) {
    const auto fields_of = [](const std::string& line) {
      std::istringstream in(line);
      std::vector<std::string> out;
      for (std::string field; std::getline(in, field, ',');) out.push_back(field);
      return out;
    };
    std::istringstream lines(table);
    std::string line, out;
    std::getline(lines, line);
    const std::vector<std::string> headings = fields_of(line);
    const auto place = [&](const std::string& heading) {
      const auto at = std::find(headings.begin(), headings.end(), heading);
      EXPECT_NE(at, headings.end()) << heading;
      return static_cast<std::size_t>(at - headings.begin());
    };
    const std::size_t begin = place(first), end = place(last) + 1;
    while (std::getline(lines, line)) {
      const std::vector<std::string> fields = fields_of(line);
      for (std::size_t i = begin; i < std::min(end, fields.size()); ++i) out += fields[i] + ",";
      out += "\n";
    }
    return out;
  }
  static constexpr const char* kTruth = "--truth-ecef=-82834.0589,-5392805.4332,3393314.4988";
};

TEST_F(GnssSolveTest, SolvesWhatWasSimulated) {
  write("given.csv", "gps_week,sow,lat_deg,lon_deg,h_m\n1500,0,32.35,-90.88,60\n");
  ASSERT_EQ(canyon("gnss solve --obs given.rnx --nav given.nav --systems G --config vacuum.toml --truth given.csv "
                   "--out positions.csv --json"),
            0)
      << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(json["epochs"], 61);
  EXPECT_EQ(json["solved"], 61);
  EXPECT_LT(json["rms_3d_m"].get<double>(), 0.005);  // a millimetre of rounding, times PDOP
  for (const char* key :
       {"mean_e_m", "mean_n_m", "mean_u_m", "std_e_m", "std_n_m", "std_u_m", "h50_m", "h95_m", "v95_m"})
    EXPECT_TRUE(json[key].is_number()) << key;
  EXPECT_THAT(read("positions.csv"), HasSubstr("gps_week,sow,x_m,y_m,z_m,status,satellites,gdop,"));
  EXPECT_THAT(read("positions.csv"), HasSubstr(",single,"));

  ASSERT_EQ(canyon("gnss solve --obs given.rnx --nav given.nav --systems G --config vacuum.toml --out dir"), 0);
  EXPECT_THAT(read("stdout"), HasSubstr("61 epochs"));
  EXPECT_THAT(read("dir/positions.csv"), HasSubstr(",single,"));
  // Without a truth there are no errors to tell: null, never 0.
  EXPECT_TRUE(nlohmann::json::parse(read("dir/summary.json"))["rms_3d_m"].is_null());
}

// The covariance that is reported moves no position; with a truth the summary says how honest it is.
TEST_F(GnssSolveTest, ReportedCovarianceMovesNothingButItself) {
  ASSERT_EQ(canyon("gnss simulate --force --at 32.35,-90.88,60 --duration 60 --errors noise --rinex-obs given.rnx "
                   "--rinex-nav given.nav"),
            0)
      << read("stderr");
  write("given.csv", "gps_week,sow,lat_deg,lon_deg,h_m\n1500,0,32.35,-90.88,60\n");
  for (const std::string estimator : {"least_squares", "kalman"}) {
    struct Solved {
      nlohmann::json summary;
      std::string positions, covariances;  ///< of all epochs, as they are written
    };
    const auto solved = [&](const std::string& reported) {
      write("reported.toml", "ionosphere = \"none\"\ntroposphere = \"none\"\nshared_ionosphere = 0.0\nestimator = \"" +
                                 estimator + "\"\nreported_covariance = \"" + reported + "\"\n");
      EXPECT_EQ(canyon("gnss solve --force --obs given.rnx --nav given.nav --systems G --config reported.toml --truth "
                       "given.csv --out positions.csv --json"),
                0)
          << read("stderr");
      const std::string table = read("positions.csv");
      return Solved{nlohmann::json::parse(read("stdout")), columns(table, "x_m", "z_m"),
                    columns(table, "xx_m2", "zz_m2")};
    };
    Solved geometry = solved("geometry"), environment = solved("environment");
    EXPECT_EQ(geometry.summary["solved"], 61) << estimator;
    EXPECT_EQ(environment.positions, geometry.positions) << estimator;
    EXPECT_NE(environment.covariances, geometry.covariances) << estimator;
    for (Solved* one : {&geometry, &environment}) {
      for (const char* key : {"ellipse_50_share", "ellipse_95_share", "ellipse_997_share", "beyond_3_sigma"}) {
        ASSERT_TRUE(one->summary[key].is_number()) << estimator << " " << key;
        EXPECT_GE(one->summary[key].get<double>(), 0.0) << estimator << " " << key;
        EXPECT_LE(one->summary[key].get<double>(), 1.0) << estimator << " " << key;
      }
      EXPECT_TRUE(one->summary["horizontal_log_score"].is_number()) << estimator;
    }
    EXPECT_NE(environment.summary["horizontal_log_score"], geometry.summary["horizontal_log_score"]) << estimator;
  }
  // Without a truth nothing is said of it.
  ASSERT_EQ(canyon("gnss solve --obs given.rnx --nav given.nav --systems G --config reported.toml --json"), 0);
  EXPECT_FALSE(nlohmann::json::parse(read("stdout")).contains("ellipse_95_share"));
}

// What the simulated receiver said of the same observations: without errors both are at the same place, to the rounding
// of NMEA (0.2 mm, 1 mm in height) and of RINEX's pseudoranges (1 mm, times a PDOP of 5 at most).
TEST_F(GnssSolveTest, ComparesWithTheReceiverItself) {
  ASSERT_EQ(canyon("gnss simulate --force --at 32.35,-90.88,60 --duration 60 --errors none --rinex-obs given.rnx "
                   "--rinex-nav given.nav --nmea given.nmea"),
            0)
      << read("stderr");
  const std::string solve = "gnss solve --obs given.rnx --nav given.nav --systems G --config vacuum.toml --compare ";
  ASSERT_EQ(canyon(solve + "given.nmea --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_TRUE(json["rms_3d_m"].is_null()) << "there is no truth";
  const auto& compare = json["compare"];
  EXPECT_EQ(compare["file"], "given.nmea");
  EXPECT_EQ(compare["positions"], 61);
  EXPECT_EQ(compare["compared"], 61);
  for (const char* key : {"mean_e_m", "mean_n_m", "mean_u_m", "std_e_m", "std_n_m", "std_u_m", "h50_m", "h95_m"})
    EXPECT_LT(std::abs(compare[key].get<double>()), 0.006) << key;
  ASSERT_EQ(canyon(solve + "given.nmea"), 0);
  EXPECT_THAT(read("stdout"),
              HasSubstr("  against given.nmea: 61 of its 61 positions are at times of ours; ours minus its "
                        "own:\n  diff., m     mean     std\n  east "));
  expect_mistake(solve + "missing.nmea", "missing.nmea: ");
  expect_mistake(solve + "given.rnx", "given.rnx: no GGA or RMC sentence in it, expected an NMEA 0183 log");
  // It is read before anything is solved: of two mistakes, the other of which shows in the solution, this one is told.
  ASSERT_EQ(
      canyon("gnss simulate --force --at 32.35,-90.88,60 --start 2021-01-01 --duration 60 --errors none --rinex-obs "
             "given_other.rnx --rinex-nav given_other.nav"),
      0)
      << read("stderr");
  const std::string unsolvable = "gnss solve --obs given.rnx --nav given_other.nav --systems G";
  expect_mistake(unsolvable, "has a valid ephemeris");
  expect_mistake(unsolvable + " --compare given.rnx", "given.rnx: no GGA");
}

/// A constellation seen at its centres of mass, `offset_m` further out than the antennas.
class CentresOfMass final : public gnss::Constellation {
 public:
  CentresOfMass(const gnss::Constellation& antennas, double offset_m) : antennas_(antennas), offset_m_(offset_m) {}
  const std::vector<SatelliteId>& satellites() const override { return antennas_.satellites(); }
  std::optional<gnss::SatelliteState> state(SatelliteId sv, GpsTime t) const override {
    auto s = antennas_.state(sv, t);
    if (s) s->p_E += offset_m_ * s->p_E.normalized();
    return s;
  }

 private:
  const gnss::Constellation& antennas_;
  double offset_m_;
};

/// ANTEX of 24 GPS and 24 GLONASS satellites whose antennas stand `up_mm` from the centre of mass towards the Earth.
std::string antex(double up_mm) {
  const auto line = [](std::string text, const char* label) {
    text.resize(60, ' ');
    return text + label + "\n";
  };
  std::string out = line("     1.4            M", "ANTEX VERSION / SYST") + line("A", "PCV TYPE / REFANT") +
                    line("", "END OF HEADER");
  char text[80];
  for (const char system : {'G', 'R'})
    for (int prn = 1; prn <= 24; ++prn) {
      out += line("", "START OF ANTENNA");
      std::snprintf(text, sizeof text, "%-20s%c%02d%17s%c0%02d", "BLOCK TEST", system, prn, "", system, prn);
      out += line(text, "TYPE / SERIAL NO") + line("     0.0", "DAZI") +
             line("     0.0  17.0   1.0", "ZEN1 / ZEN2 / DZEN") + line("     2", "# OF FREQUENCIES");
      for (const char band : {'1', '2'}) {
        std::snprintf(text, sizeof text, "   %c0%c", system, band);
        const std::string name = text;
        out += line(name, "START OF FREQUENCY");
        std::snprintf(text, sizeof text, "%10.2f%10.2f%10.2f", 0.0, 0.0, up_mm);
        out += line(text, "NORTH / EAST / UP") + "   NOAZI";
        for (int k = 0; k < 18; ++k) out += "    0.00";
        out += "\n" + line(name, "END OF FREQUENCY");
      }
      out += line("", "END OF ANTENNA");
    }
  return out;
}

// Precise orbits, clocks and antennas, GLONASS's channels from the header of the observations.
TEST_F(GnssSolveTest, PreciseOrbitsAndAntennas) {
  const GpsTime start = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
  ASSERT_EQ(
      canyon(
          "gnss simulate --force --at 32.35,-90.88,60 --systems GR --start 2010-11-17T13:00:00 --duration 600 --rate "
          "0.1 --errors none --rinex-obs given.rnx --rinex-nav given.nav"),
      0)
      << read("stderr");
  EXPECT_EQ(read("stderr"), "");
  const auto nominal = gnss::make_nominal("GR");
  write("given.sp3", gnss::testing::sp3_text(CentresOfMass(*nominal, 2.0), start - 5400.0, 300.0, 40));
  write("given.atx", antex(2000.0));
  write("smooth.toml", "ionosphere = \"none\"\ntroposphere = \"none\"\nshared_ionosphere = 0.0\n");
  const auto solved = [&](const std::string& more) {
    EXPECT_EQ(canyon("gnss solve --obs given.rnx --nav given.nav --sp3 given.sp3 --config smooth.toml --json " +
                     std::string(kTruth) + " " + more),
              0)
        << read("stderr");
    const auto json = nlohmann::json::parse(read("stdout"));
    EXPECT_EQ(json["solved"], 61);
    return json;
  };
  for (const char* systems : {"R", "GR"}) {
    const auto json = solved(std::string("--antex given.atx --systems ") + systems);
    // Positions in the file to 1 mm, ranges to 1 mm, times a PDOP of 3 at most.
    EXPECT_LT(json["rms_3d_m"].get<double>(), 0.02) << systems;
    for (const char* axis : {"e", "n", "u"})
      EXPECT_LT(json[std::string("velocity_rms_") + axis + "_m_s"].get<double>(), 0.01) << systems;
    EXPECT_EQ(read("stderr"), "");
  }
  // Without the antennas the ranges are 2 m off, most of it in the clock; that is told.
  const auto bare = solved("--systems G");
  EXPECT_GT(bare["rms_3d_m"].get<double>(), 0.02);
  EXPECT_LT(bare["rms_3d_m"].get<double>(), 1.0);
  EXPECT_EQ(
      read("stderr"),
      "warning: given.sp3: without --antex its positions are taken as those of the antennas; IGS products give the "
      "centre of mass, and ranges err by metres\n");
}

/// IONEX of one shell, `tecu` everywhere at noon, half as much at midnight.
std::string ionex(double tecu) {
  const auto line = [](std::string text, const char* label) {
    text.resize(60, ' ');
    return text + label + "\n";
  };
  std::string out =
      line("     1.0            IONOSPHERE MAPS     GPS", "IONEX VERSION / TYPE") + line("  6371.0", "BASE RADIUS") +
      line("     2", "MAP DIMENSION") + line("   450.0 450.0   0.0", "HGT1 / HGT2 / DHGT") +
      line("    90.0 -90.0 -30.0", "LAT1 / LAT2 / DLAT") + line("  -180.0 180.0  60.0", "LON1 / LON2 / DLON") +
      line("    -1", "EXPONENT") + line("", "END OF HEADER");
  char text[80];
  for (int k = 0; k < 3; ++k) {
    const CalendarTime c = calendar(GpsTime::from_calendar(2010, 11, 17, 0, 0, 0.0) + 43200.0 * k);
    out += line("     " + std::to_string(k + 1), "START OF TEC MAP");
    std::snprintf(text, sizeof text, "%6d%6d%6d%6d%6d%6d", c.year, c.month, c.day, c.hour, c.minute, 0);
    out += line(text, "EPOCH OF CURRENT MAP");
    for (double lat = 90.0; lat >= -90.0; lat -= 30.0) {
      std::snprintf(text, sizeof text, "  %6.1f%6.1f%6.1f%6.1f%6.1f", lat, -180.0, 180.0, 60.0, 450.0);
      out += line(text, "LAT/LON1/LON2/DLON/H");
      for (int i = 0; i < 7; ++i) {
        std::snprintf(text, sizeof text, "%5d", static_cast<int>(10.0 * tecu * (k == 1 ? 1.0 : 0.5)));
        out += text;
      }
      out += "\n";
    }
    out += line("     " + std::to_string(k + 1), "END OF TEC MAP");
  }
  return out + line("", "END OF FILE");
}

// An ionosphere by maps: what was simulated with them is solved with them.
TEST_F(GnssSolveTest, IonosphereMaps) {
  write("given.ionex", ionex(80.0));
  write("ionex.toml",
        "base = \"vicksburg\"\n[scene]\nempty = true\n[gnss]\nmode = \"single_uncorrected\"\nionosphere = \"ionex\"\n"
        "ionex_file = \"given.ionex\"\n");
  ASSERT_EQ(
      canyon("gnss simulate --force --scene ionex.toml --at 32.35,-90.88,60 --start 2010-11-17T13:00:00 --duration 60 "
             "--errors ionosphere --rinex-obs given.rnx --rinex-nav given.nav"),
      0)
      << read("stderr");
  write("maps.toml", "ionosphere = \"ionex\"\ntroposphere = \"none\"\nsmoothing_s = 0.0\nshared_ionosphere = 0.0\n");
  const auto rms_m = [&](const std::string& more) {
    EXPECT_EQ(
        canyon("gnss solve --obs given.rnx --nav given.nav --systems G --json " + std::string(kTruth) + " " + more), 0)
        << read("stderr");
    return nlohmann::json::parse(read("stdout"))["rms_3d_m"].get<double>();
  };
  EXPECT_LT(rms_m("--config maps.toml --ionex given.ionex"), 0.01);
  EXPECT_GT(rms_m("--config vacuum.toml"), 3.0);  // 12 m at the zenith
  expect_mistake("gnss solve --obs given.rnx --nav given.nav --config maps.toml",
                 "ionosphere: \"ionex\" needs ionosphere maps, expected an IONEX file (--ionex)");
}

// The station of 2020-06-25 with its SP3 file: three systems (the file has no BeiDou), all epochs.
TEST_F(GnssSolveTest, RealPreciseOrbits) {
  CANYON_REAL_DATA(obs, "gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz");
  CANYON_REAL_DATA(nav, "gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_MN.rnx.gz");
  CANYON_REAL_DATA(sp3, "gnss/esbc_2020_177/GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz");
  ASSERT_EQ(canyon("gnss solve --obs '" + obs + "' --nav '" + nav + "' --sp3 '" + sp3 +
                   "' --systems GRE --json --truth-ecef 3582104.902,532590.196,5232755.293"),
            0)
      << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(json["epochs"], 2880);
  EXPECT_EQ(json["solved"], 2866);                 // the last orbit is of 23:45
  EXPECT_LT(json["rms_3d_m"].get<double>(), 1.2);  // measured 1.133
  EXPECT_THAT(read("stderr"), HasSubstr("without --antex"));
  EXPECT_THAT(json["skipped_navigation_records"]["EPH S"].get<int>(), ::testing::Gt(0));
}

/// As --base-position has it.
std::string ecef_text(double lat_deg, double lon_deg, double h_m) {
  const Eigen::Vector3d p_E = ecef_from_geodetic({lat_deg * kDegree, lon_deg * kDegree, h_m});
  char text[120];
  std::snprintf(text, sizeof text, "%.4f,%.4f,%.4f", p_E.x(), p_E.y(), p_E.z());
  return text;
}

// Two receivers 4.4 km apart under the same sky: alone the rover is metres off, with the base by what the air and the
// orbits differ by over the distance, epoch by epoch and filtered.
TEST_F(GnssSolveTest, ABaseTakesAwayWhatBothSee) {
  const std::string simulate =
      "gnss simulate --force --duration 60 --errors ionosphere,troposphere,ephemeris --systems ";
  const auto simulated = [&](const std::string& more) { ASSERT_EQ(canyon(simulate + more), 0) << read("stderr"); };
  simulated("GR --at 32.35,-90.88,60 --rinex-obs given.rnx --rinex-nav given.nav");
  simulated("GR --at 32.38,-90.85,70 --rinex-obs given_base.rnx --rinex-nav given_base.nav");
  write("filter.toml", "estimator = \"kalman\"\n");
  const std::string base = " --base given_base.rnx --base-position=" + ecef_text(32.38, -90.85, 70.0);
  const std::string solve = "gnss solve --obs given.rnx --nav given.nav --systems GR --json ";
  for (const char* config : {"", "--config filter.toml "}) {
    const auto rms_m = [&](const std::string& more) {
      EXPECT_EQ(canyon(solve + config + kTruth + more), 0) << read("stderr");
      const auto json = nlohmann::json::parse(read("stdout"));
      EXPECT_EQ(json["solved"], 61);
      return json["rms_3d_m"].get<double>();
    };
    EXPECT_GT(rms_m(""), 1.0);
    // 4.4 km over 20,000 km of metres each, and millimetres of what the models see elsewhere, times a gain of 5.
    EXPECT_LT(rms_m(base), 0.05);
  }
  ASSERT_EQ(canyon("gnss solve --obs given.rnx --nav given.nav --systems GR --out given_out.csv" + base), 0);
  EXPECT_THAT(read("given_out.csv"), HasSubstr(",differential,"));

  simulated("R --at 32.38,-90.85,70 --rinex-obs given_r.rnx --rinex-nav given_r.nav");
  simulated(
      "GR --start 2010-11-17T15:00:00 --at 32.38,-90.85,70 --rinex-obs given_late.rnx --rinex-nav given_late.nav");
  const std::string there = " --base-position=" + ecef_text(32.38, -90.85, 70.0);
  expect_mistake("gnss solve --obs given.rnx --nav given.nav --systems GR --base given_late.rnx" + there,
                 "given_late.rnx: has epochs from 2010-11-17T15:00:00 to 2010-11-17T15:01:00, none near those of "
                 "given.rnx, 2010-11-17T13:00:00 to 2010-11-17T13:01:00, expected a base that observed at the same "
                 "time");
  expect_mistake("gnss solve --obs given.rnx --nav given.nav --systems G --base given_r.rnx" + there,
                 "given_r.rnx: has no satellite in common with given.rnx from 2010-11-17T13:00:00 to "
                 "2010-11-17T13:01:00, expected a base near by that observed the same systems and bands");
  expect_mistake("gnss solve --obs given.rnx --nav given.nav --base given_base.rnx",
                 "--base: stands alone, expected both");
  expect_mistake("gnss solve --obs given.rnx --nav given.nav" + there, "--base-position: stands alone, expected both");
}

TEST_F(GnssSolveTest, MistakesWordForWord) {
  expect_mistake("gnss solve --obs missing.rnx --nav given.nav", "missing.rnx: ");
  expect_mistake("gnss solve --obs given.nav --nav given.nav",
                 "given.nav:1: RINEX file type \"N\", expected \"O\", observation data");
  expect_mistake("gnss solve --obs given.rnx --nav given.rnx", "given.rnx:1: RINEX file type \"O\"");
  expect_mistake("gnss solve --obs given.rnx --nav given.nav --systems X", "--systems");
  expect_mistake("gnss solve --obs given.rnx --nav given.nav --truth-ecef 1,2",
                 "--truth-ecef: \"1,2\", expected X,Y,Z of a place on the Earth, metres");
  write("bad.toml", "sistems = \"G\"\n");
  expect_mistake("gnss solve --obs given.rnx --nav given.nav --config bad.toml", "bad.toml:1: sistems: unknown key");
}

}  // namespace
}  // namespace canyon::apps

// canyon gnss ...: as a user calls it.
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

using ::testing::HasSubstr;

class GnssVerbsTest : public testing::CommandLineTest {
 protected:
  /// Whether Python's XML parser takes it.
  bool is_well_formed(const std::string& name) const {
    const std::string command = "/usr/bin/python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' '";
    return std::system((command + path(name) + "'").c_str()) == 0;
  }
};

TEST_F(GnssVerbsTest, SkyOfAnOpenFieldAndOfAStreet) {
  ASSERT_EQ(canyon("gnss sky --at 32.35,-90.88,60 --json"), 0) << read("stderr");
  const auto open = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(open["open_sky_share_above_10_deg"], 1.0);
  for (const auto& s : open["epochs"][0]["satellites"]) {
    EXPECT_TRUE(s["line_of_sight"].get<bool>());
    EXPECT_GE(s["elevation_deg"].get<double>(), 10.0);
  }
  ASSERT_EQ(canyon("gnss sky --scene vicksburg --xy 120,-40 --duration 600 --step 300 --out sky"), 0) << read("stderr");
  EXPECT_THAT(read("stdout"), HasSubstr("over 3 epochs"));
  EXPECT_TRUE(is_well_formed("sky/sky.svg"));
  EXPECT_THAT(
      read("sky/satellites.csv"),
      HasSubstr("t_s,satellite,elevation_deg,azimuth_deg,cn0_dbhz,line_of_sight,tracked,reflections,multipath_m\n"));
  EXPECT_THAT(read("sky/dop.csv"), HasSubstr("t_s,satellites,gdop,pdop,hdop,vdop,tdop\n"));
  EXPECT_THAT(read("sky/satellites.csv"), HasSubstr(",0,"));  // somebody is hidden
}

TEST_F(GnssVerbsTest, MapWritesPicturesAndGrids) {
  ASSERT_EQ(canyon("gnss map --cell 50 --out map"), 0) << read("stderr");
  EXPECT_THAT(read("stdout"), HasSubstr("20 x 20 cells of 50 m"));
  for (const char* layer : {"visible", "gdop", "error_horizontal", "error_up", "fix_share"}) {
    EXPECT_THAT(read(std::string("map/") + layer + ".asc"), HasSubstr("ncols 20\nnrows 20\n"));
    EXPECT_EQ(read(std::string("map/") + layer + ".png").substr(1, 3), "PNG");
    EXPECT_TRUE(is_well_formed(std::string("map/") + layer + ".svg"));
    EXPECT_THAT(read(std::string("map/") + layer + ".prj"), HasSubstr("Orthographic"));
  }
}

TEST_F(GnssVerbsTest, SimulationWithoutErrorsFindsTheTruth) {
  ASSERT_EQ(canyon("gnss simulate --at 32.35,-90.88,60 --duration 60 --errors none --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(json["epochs"], 61);
  EXPECT_EQ(json["fixes"], 61);
  EXPECT_EQ(json["nlos_share"], 0.0);
  EXPECT_GT(json["gdop_median"].get<double>(), 1.0);
  EXPECT_LT(json["rms_3d_m"].get<double>(), 1e-5);  // clock times and light times to below 1e-5 m
}

// 2026-11-26: scattering and clutter stayed, and the fix was metres off.
TEST_F(GnssVerbsTest, SimulationWithoutErrorsFindsTheTruthInAStreetToo) {
  ASSERT_EQ(canyon("gnss simulate --scene vicksburg --at 32.35,-90.88,75 --errors none --receiver m8 --duration 20 "
                   "--json"),
            0)
      << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(json["fixes"], 21);
  EXPECT_LT(json["rms_3d_m"].get<double>(), 1e-5);  // as above
}

// A base that errs by nothing, and one whose receiver has noise: the switch is the base's own.
TEST_F(GnssVerbsTest, SimulationBesideABaseThatIsSimulated) {
  write("base.toml", "base = \"vicksburg\"\n[scene]\nempty = true\n[gnss]\nmode = \"dgps_base\"\n");
  const auto rms_m = [&](const std::string& errors) {
    EXPECT_EQ(canyon("gnss simulate --scene base.toml --at 32.35,-90.88,60 --duration 20 --json --errors " + errors), 0)
        << read("stderr");
    const auto json = nlohmann::json::parse(read("stdout"));
    EXPECT_EQ(json["fixes"], 21);
    return json["rms_3d_m"].get<double>();
  };
  EXPECT_LT(rms_m("none"), 1e-5);  // as without a base
  EXPECT_GT(rms_m("base_station"), 1e-3);
  write("bad.toml", "base = \"vicksburg\"\n[gnss]\nmode = \"dgps_base\"\nbase_receiver = \"m9\"\n");
  expect_mistake("gnss simulate --scene bad.toml --at 32.35,-90.88,60",
                 "gnss.base_receiver: no receiver \"m9\" in the catalogue, expected \"m8\"?");
}

TEST_F(GnssVerbsTest, AReceiverFileWithFiguresMissing) {
  write("mine.toml", "name = \"mine\"\ndescription = \"d\"\nsystems = \"G\"\n");
  expect_mistake("gnss simulate --at 32.35,-90.88,60 --receiver mine.toml",
                 "mine.toml: mode: is missing, and so are mask_deg, receiver_clock");
}

// The catalogue's phone with an integration over which its carrier loop cannot be; then with a key misspelt as well.
TEST_F(GnssVerbsTest, AReceiverFileWithFiguresThatContradict) {
  std::ostringstream phone;
  phone << std::ifstream(CANYON_SOURCE_DIR "/gnss/receivers/phone.toml").rdbuf();
  std::string text = phone.str();
  const auto exchange = [&text](const std::string& word, const std::string& by) {
    const auto at = text.find(word);
    ASSERT_NE(at, std::string::npos) << word;
    text.replace(at, word.size(), by);
  };
  exchange("\nintegration_ms = 20.0\n", "\nintegration_ms = 40.0\n");
  write("mine.toml", text);
  const std::string simulate = "gnss simulate --at 32.35,-90.88,60 --receiver mine.toml";
  expect_mistake(simulate, "contradictory");
  EXPECT_EQ(read("stderr"),
            "mine.toml:49: carrier_loop_hz: contradictory: carrier_loop_hz = 15 with integration_ms = 40, expected "
            "figures of one receiver\n");
  exchange("\nmax_gdop = ", "\nmax_gdp = ");
  write("mine.toml", text);
  expect_mistake(simulate, "max_gdp");
  EXPECT_EQ(read("stderr"),
            "mine.toml:94: max_gdp: is not a figure of a receiver (expected \"max_gdop\"?); missing: max_gdop; "
            "contradictory: carrier_loop_hz = 15 with integration_ms = 40, expected every figure of a receiver, each "
            "with its source or \"assumed\"\n");
}

TEST_F(GnssVerbsTest, SimulationAlongAWay) {
  std::string way = "gps_week,sow,lat_deg,lon_deg,h_m\n";
  for (int k = 0; k <= 10; ++k)
    way += "1610," + std::to_string(306000 + k) + ",32.35," + std::to_string(-90.88 + 1e-5 * k) + ",60\n";
  write("given.csv", way);
  ASSERT_EQ(canyon("gnss simulate --trajectory given.csv --rate 2 --out out --nmea out.nmea"), 0) << read("stderr");
  const std::string fixes = read("out/fixes.csv");
  EXPECT_EQ(std::count(fixes.begin(), fixes.end(), '\n'), 22);
  EXPECT_THAT(fixes, HasSubstr("\n1610,306009.500000000,differential,"));
  EXPECT_THAT(read("out.nmea"), HasSubstr("$GNGGA,125945.00,32"));
  EXPECT_THAT(read("out/satellites.csv"), HasSubstr("1610,306000.000000000,G03,"));
}

// 2026-11-22: a receiver at the Earth's centre saw ten satellites.
TEST_F(GnssVerbsTest, HeightsThatNoModelCoversAreRefused) {
  const std::string covered = ", expected -500 to 20000 m, the heights that the models of the atmosphere cover";
  expect_mistake("gnss simulate --at 32,-90,-6378000",
                 "--at: the antenna would be 6378000 m below the ellipsoid" + covered);
  expect_mistake("gnss simulate --at 32,-90,20001", "--at: the antenna would be 20001 m above the ellipsoid" + covered);
  expect_mistake("gnss sky --at 32,-90,-501", "--at: the antenna would be 501 m below the ellipsoid" + covered);
  expect_mistake("gnss sky --scene vicksburg --xy 0,0 --height -5", "--height");
  expect_mistake("gnss solve --obs given.rnx --nav given.nav --truth-ecef 0,0,1",
                 "--truth-ecef: the antenna would be 6370999 m below the ellipsoid" + covered);
  write("given_high.csv", "gps_week,sow,lat_deg,lon_deg,h_m\n1610,306000,32,-90,60\n1610,306001,32,-90,4e5\n");
  expect_mistake("gnss simulate --trajectory given_high.csv --out out",
                 "given_high.csv:3: the antenna would be 400000 m above the ellipsoid" + covered);
  expect_mistake("gnss solve --obs given.rnx --nav given.nav --truth given_high.csv", "given_high.csv:3: the antenna");
  // Both ends on the ground, and the way between them through the Earth: Mississippi to France in 100 s.
  write("given_chord.csv", "1610,306000,32,-90,60\n1610,306100,45,5,60\n");
  expect_mistake("gnss simulate --trajectory given_chord.csv --out out --nmea log.nmea",
                 "given_chord.csv: 2010-11-17T13:00:01.000: the antenna would be ");
  write("given_deep.tum", "0 0 0 -900 0 0 0 1\n10 0 0 -900 0 0 0 1\n");
  expect_mistake("gnss simulate --scene vicksburg --trajectory given_deep.tum --start 0:0", "given_deep.tum: ");
  EXPECT_EQ(canyon("gnss simulate --at 32,-90,-500 --json"), 0);
  EXPECT_EQ(canyon("gnss simulate --at 32,-90,20000 --json"), 0);
}

// Below the ground of a scene: a mistake where the place was typed in, without reception on a way that leads there.
TEST_F(GnssVerbsTest, BelowTheGroundThereIsNoReception) {
  expect_mistake("gnss simulate --scene vicksburg --at 32.35,-90.88,-20",
                 "m below the ground of the scene, expected an");
  expect_mistake("gnss sky --scene vicksburg --at 32.35,-90.88,-20", "m below the ground of the scene, expected an");
  std::string way;
  for (int k = 0; k < 4; ++k)
    way +=
        std::to_string(1290000000 + k) + " 213.9 " + std::to_string(30 + k) + (k < 2 ? " 30" : " -30") + " 0 0 0 1\n";
  write("given_way.tum", way);
  ASSERT_EQ(canyon("gnss simulate --scene vicksburg --trajectory given_way.tum --json"), 0) << read("stderr");
  EXPECT_THAT(read("stderr"),
              HasSubstr("given_way.tum: the antenna is below the ground of the scene in 2 of 4 epochs"));
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(json["fixes"], 2);
}

// 2026-11-22: the geoid separation of GGA was 0 where no geoid was installed.
TEST_F(GnssVerbsTest, NmeaHasTheGeoidsSeparation) {
  ASSERT_EQ(canyon("gnss simulate --at 32.35,-90.88,60 --errors none --nmea out.nmea"), 0) << read("stderr");
  // EGM96 has -27.57 m there, EGM2008 within a metre of it; height above sea level + separation = 60 m.
  const std::string log = read("out.nmea");
  const std::size_t at = log.find(",M,");
  ASSERT_NE(at, std::string::npos);
  const double above_sea_m = std::stod(log.substr(log.rfind(',', at - 1) + 1)),
               separation_m = std::stod(log.substr(at + 3));
  EXPECT_NEAR(separation_m, -27.57, 1.0);
  EXPECT_NEAR(above_sea_m + separation_m, 60.0, 0.0015);
}

// 2026-11-22: the mistake was told as that of the key time.start, and no limit was said.
TEST_F(GnssVerbsTest, AStartThatIsNoTimeIsTheOptionsMistake) {
  expect_mistake("gnss sky --at 32.35,-90.88,60 --start bad", "--start: time.start: \"bad\" is not a time, expected ");
  expect_mistake("gnss simulate --at 32.35,-90.88,60 --start 2300-01-01T00:00:00", "from 1980-01-06 to 2261-12-31");
  expect_mistake("lidar scan --start bad --at 0,0,2,0 --out scan", "--start: time.start: \"bad\" is not a time");
}

TEST_F(GnssVerbsTest, MistakesAreToldInOneLine) {
  expect_mistake("gnss simulate --at 1,2,3 --errors noise,magic",
                 "--errors: \"magic\" is not an error, expected none, all, or of ionosphere troposphere ephemeris "
                 "receiver_clock multipath noise antenna base_station");
  expect_mistake("gnss simulate", "command line: no place given, expected --at LAT,LON,H or --trajectory FILE");
  write("given_way.csv", "1610,306000,32.35,-90.88,60\n1610,306010,32.35,-90.88,60\n");
  expect_mistake("gnss simulate --trajectory given_way.csv --duration 20",
                 "given_way.csv: covers 2010-11-17T13:00:00.000 to 2010-11-17T13:00:10.000, expected all of "
                 "2010-11-17T13:00:00.000 and the 20 s that follow");
  // 2026-11-25: no epoch was simulated, and writing none as RINEX ended the program.
  expect_mistake("gnss simulate --trajectory given_way.csv --start 2010-11-17T14:00:00 --rinex-obs none.obs",
                 "given_way.csv: covers 2010-11-17T13:00:00.000 to 2010-11-17T13:00:10.000, expected all of "
                 "2010-11-17T14:00:00.000 and the 0 s that follow");
  expect_mistake("gnss sky", "command line: no place given, expected --at LAT,LON,H, or --scene and --xy X,Y");
  expect_mistake("gnss sky --at 32.35,x,60",
                 "--at: \"32.35,x,60\" cannot be read, expected LAT,LON,H: degrees, degrees, metres");
  expect_mistake("gnss sky --at 95,0,60", "--at: \"95,0,60\" is not on the Earth");
  expect_mistake("gnss sky --scene vicksburg --xy 5000,0", "--xy: \"5000,0\" lies outside the scene");
  expect_mistake("gnss sky --scene nowhere.toml --xy 0,0", "nowhere.toml");
  // 2026-11-22: taken by the option, and then an internal error.
  expect_mistake("gnss simulate --at 32.35,-90.88,60 --rate 1e-4", "--rate");
  expect_mistake("gnss map --scene none", "--scene: \"none\" has no ground to map, expected a scene");
  expect_mistake("gnss map --fidelity best", "best");
  expect_mistake("gnss", "canyon gnss: no verb given, expected one of sky, ");
}

TEST_F(GnssVerbsTest, DriveCheckOfALogAndItsMistakes) {
  // The reference lasts longer than the log, whose clock may tag its ends a little outside of the drive.
  std::string way, truth;
  for (int k = -1; k <= 21; ++k) {
    const std::string place =
        "1610," + std::to_string(306000 + k) + "," + std::to_string(32.35 + 2e-5 * k) + ",-90.88,60\n";
    if (k >= 0 && k <= 20) way += place;
    truth += place;
  }
  write("given.csv", way);
  write("given_truth.csv", truth);
  expect_mistake("gnss drive-check --obs given.obs --truth given_truth.csv",
                 "command line: no navigation file given, expected --nav FILE of the day of the drive");
  expect_mistake("gnss drive-check --obs given.obs --nav given.nav", "--truth");
  EXPECT_EQ(read("stderr"),
            "canyon gnss drive-check: --truth is missing; canyon gnss drive-check --help shows an example\n");
  ASSERT_EQ(canyon("gnss simulate --trajectory given.csv --rate 1 --rinex-obs given.obs --rinex-nav given.nav"), 0);
  write("given_later.csv", "1610,307000,32.35,-90.88,60\n1610,307010,32.35,-90.88,60\n");
  expect_mistake("gnss drive-check --obs given.obs --nav given.nav --truth given_later.csv --scene vicksburg",
                 "given.obs: has no epoch at a time of given_later.csv, expected a reference of the same time\n");
  write("given_far.csv", "1610,305999,33.35,-90.88,60\n1610,306021,33.35,-90.88,60\n");
  expect_mistake("gnss drive-check --obs given.obs --nav given.nav --truth given_far.csv --scene vicksburg",
                 "vicksburg: covers 0 of 21 epochs of the drive, expected a city around all of it, or --from-sow and "
                 "--to-sow of the stretch that it covers\n");
  ASSERT_EQ(canyon("gnss drive-check --obs given.obs --nav given.nav --truth given_truth.csv --scene vicksburg --json "
                   "--out check"),
            0)
      << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(json["epochs"], 21);
  for (const char* key : {"tracked_in_sight", "tracked_hidden", "cn0_in_sight_dbhz", "cn0_hidden_dbhz", "cn0_auc",
                          "hidden_error_m", "in_sight_error_p95_m", "fix_h50_m", "fix_h95_m", "beyond_3_sigma"}) {
    EXPECT_TRUE(json["simulated"].contains(key)) << key;
    EXPECT_TRUE(json["measured"].contains(key)) << key;
  }
  EXPECT_THAT(read("check/signals.csv"), HasSubstr("\nmeasured,1610,306000.000,G"));
}

// A log of an open field, held against a street between tall houses of the built-in city. It lasts 50 s: what was
// measured in other blocks of 20 s than a signal's own is what its forecast is scored against.
TEST_F(GnssVerbsTest, DriveCheckOverDrawsAndItsPage) {
  std::string way, truth;
  for (int k = -1; k <= 51; ++k) {
    const std::string place =
        "1610," + std::to_string(306000 + k) + "," + std::to_string(32.35027 + 2e-5 * k) + ",-90.877728,75\n";
    if (k >= 0 && k <= 50) way += place;
    truth += place;
  }
  write("given.csv", way);
  write("given_truth.csv", truth);
  ASSERT_EQ(canyon("gnss simulate --trajectory given.csv --rate 1 --rinex-obs given.obs --rinex-nav given.nav"), 0)
      << read("stderr");
  ASSERT_EQ(canyon("gnss drive-check --obs given.obs --nav given.nav --truth given_truth.csv --scene vicksburg "
                   "--draws 2 --json --out check"),
            0)
      << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(nlohmann::json::parse(read("check/summary.json")), json);
  EXPECT_EQ(json["epochs"], 51);
  for (const char* key : {"simulated_draws", "measured_interval"}) {
    EXPECT_EQ(json[key].size(), json["figures"].size()) << key;
    EXPECT_EQ(json[key]["fix_h50_m"].size(), 2u) << key;
    ASSERT_EQ(json[key]["hidden_error_m"].size(), 2u) << key;
    for (const auto& low_high : json[key]["hidden_error_m"]) EXPECT_EQ(low_high.size(), 2u) << key;
  }
  EXPECT_EQ(json["score"]["draws"], 2);
  EXPECT_GT(json["score"]["signals"].get<int>(), 100);
  for (const char* key : {"foretold_share", "crps_simulation_m", "crps_blind_m", "crps_elevation_m"})
    EXPECT_TRUE(json["score"][key].is_number()) << key;
  for (const char* key : {"against_blind_m", "against_elevation_m"}) EXPECT_EQ(json["score"][key].size(), 2u) << key;
  for (const char* side : {"simulated", "measured"}) {
    for (const char* key : {"cn0_in_sight_dbhz", "cn0_hidden_dbhz", "in_sight_error_m", "hidden_error_m",
                            "in_sight_rate_error_m_s", "hidden_rate_error_m_s", "fix_horizontal_error_m"}) {
      const auto& of = json["distributions"][key][side];
      EXPECT_GT(of["count"].get<int>(), 0) << key << " " << side;
      EXPECT_EQ(of["percentiles"].size(), 101u) << key << " " << side;
    }
    EXPECT_EQ(json["distributions"]["fix_horizontal_error_m"][side]["count"], json["reference_instants"]) << side;
  }
  double tracked = 0.0;
  for (const auto& of : json["satellites"]) {
    if (!of.contains("measured")) continue;
    for (const char* column : {"in_sight", "elevation_deg", "azimuth_deg", "cn0_dbhz", "error_m", "rate_error_m_s"})
      EXPECT_EQ(of["measured"][column].size(), of["measured"]["sow"].size()) << column;
    tracked += static_cast<double>(of["measured"]["sow"].size());
  }
  const double per_epoch =
      json["measured"]["tracked_in_sight"].get<double>() + json["measured"]["tracked_hidden"].get<double>();
  EXPECT_NEAR(tracked, per_epoch * json["epochs"].get<double>(), 1e-6) << "all that the figures count";
  const std::string page = read("check/report.html");
  for (const char* words : {"Distributions</h2>", "Range error of hidden satellites", "Horizontal error of fixes",
                            "CRPS", "Each satellite over time</h2>", "tracked while hidden"})
    EXPECT_THAT(page, HasSubstr(words));
}

}  // namespace
}  // namespace canyon::apps

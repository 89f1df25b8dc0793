#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "canyon/tests/core/config/example_config.h"

namespace canyon {
namespace {

using config_example::Mission;

std::string json_of(Mission& mission) {
  return fields_as_json([&](FieldVisitor& f) { visit(f, mission); });
}

TEST(FieldsAsJson, InTheOrderOfDeclaration) {
  Mission m;
  m.waypoint.resize(1);
  EXPECT_EQ(json_of(m),
            R"({"title":"recon","loop":false,"lever_m":[0.1,0.2,0.3],"levels":[0.5],"map":"city","logs":[],)"
            R"("gnss":{"rate_hz":1.0,"sigma_m":0.23,"channels":12,"receiver":"high","systems":["GPS"]},)"
            R"("waypoint":[{"at_m":[null,null],"stop_s":5.0}]})");
}

TEST(FieldsAsJson, NumbersRoundTripToTheBit) {
  for (const double value :
       {1.0 / 3.0, 0.1 + 0.2, 5e-324, 1.7976931348623157e308, -0.0, 1e22, 123456789.123456789, 2.0 / 3.0 * 1e-7}) {
    const std::string json = fields_as_json([&](FieldVisitor& f) {
      double v = value;
      f.number("x", v, kAnyNumber, "");
    });
    ASSERT_EQ(json.substr(0, 5), "{\"x\":");
    const double back = std::strtod(json.c_str() + 5, nullptr);
    EXPECT_EQ(back, value) << json;
    EXPECT_EQ(std::signbit(back), std::signbit(value));
  }
  std::int64_t large = 9'223'372'036'854'775'807;
  EXPECT_EQ(fields_as_json([&](FieldVisitor& f) { f.integer("n", large, kAnyNumber, ""); }),
            "{\"n\":9223372036854775807}");
}

TEST(FieldsAsJson, TextIsEscapedAndNothingIsAnEmptyObject) {
  std::string text = "a \"quoted\" line\nand \xff";
  EXPECT_EQ(fields_as_json([&](FieldVisitor& f) { f.text("t", text, ""); }),
            "{\"t\":\"a \\\"quoted\\\" line\\nand \xEF\xBF\xBD\"}");
  EXPECT_EQ(fields_as_json([](FieldVisitor&) {}), "{}");
}

TEST(FieldsAsJson, EqualConfigurationsHaveEqualTextAndDifferentOnesDoNot) {
  Mission a, b;
  EXPECT_EQ(json_of(a), json_of(b));
  b.gnss.sigma_m = std::nextafter(a.gnss.sigma_m, 1.0);
  EXPECT_NE(json_of(a), json_of(b));
}

TEST(DocumentedFields, OneRowPerField) {
  Mission m;
  std::string all;
  for (const FieldDoc& row : documented_fields("mission", [&](FieldVisitor& f) { visit(f, m); }))
    all += row.key + " | " + row.unit + " | " + row.default_value + " | " + row.range + " | " + row.meaning + "\n";
  EXPECT_EQ(all, R"(mission.title |  | "recon" | a string | name of the mission
mission.loop |  | false | true or false | drive it again
mission.lever_m | m | [0.1, 0.2, 0.3] | a list of 3 numbers, each a number from -10 to 10 | antenna in B
mission.levels |  | [0.5] | a list of numbers, each a number from 0 to 1 | any | several
mission.map |  | "city" | a name, or a path that ends in .osm | where to drive
mission.logs |  | [] | a list of paths | what to replay
mission.gnss.rate_hz | Hz | 1 | a number from 0.1 to 20 | fixes per second
mission.gnss.sigma_m | m | 0.23 | a positive number | of one axis
mission.gnss.channels |  | 12 | a whole number from 1 to 64 | satellites at once
mission.gnss.receiver |  | "high" | one of "low", "paper", "high" | model
mission.gnss.systems |  | ["GPS"] | a list of strings | constellations
mission.waypoint |  | 0 items | a list of tables | places to go
mission.waypoint[].at_m | m | required | a list of 2 numbers, each a number | east and north
mission.waypoint[].stop_s | s | 5 | a number of 0 or more | time to stop
)");
  EXPECT_TRUE(m.waypoint.empty());
}

// 2026-11-26: of a key of several units the last alone was told, "Hz" of a variance in m^2 Hz, or nothing.
TEST(DocumentedFields, UnitsOfSeveralFactors) {
  double x = 1.0;
  const auto unit = [&](const char* key) {
    return documented_fields("", [&](FieldVisitor& f) { f.number(key, x, kPositive, ""); }).at(0).unit;
  };
  EXPECT_EQ(unit("light_variance_m2"), "m²");
  EXPECT_EQ(unit("light_variance_m2_hz"), "m² Hz");
  EXPECT_EQ(unit("closeness_cost_1_m2"), "1/m²");
  EXPECT_EQ(unit("front_cornering_per_deg"), "1/deg");
  EXPECT_EQ(unit("camera_px_per_rad"), "px/rad");
  EXPECT_EQ(unit("clock_walk_m_per_sqrt_s"), "m/√s");
  EXPECT_EQ(unit("clock_rate_walk_m_s_per_sqrt_s"), "m/s/√s");
  EXPECT_EQ(unit("arw_deg_per_sqrt_hr"), "deg/√h");
  EXPECT_EQ(unit("vrw_m_s_per_sqrt_hr"), "m/s/√h");
  EXPECT_EQ(unit("noise_pa_per_sqrt_hz"), "Pa/√Hz");
  EXPECT_EQ(unit("slip_percent_per_m_s2"), "% s²/m");
  EXPECT_EQ(unit("rate_hz"), "Hz");
  EXPECT_EQ(unit("period_s"), "s");
}

TEST(NamedFiles, PathsButNoNames) {
  Mission m;
  const auto list = [&] {
    std::string all;
    for (const NamedFile& file : named_files([&](FieldVisitor& f) { visit(f, m); }))
      all += file.key + " = " + file.path + "\n";
    return all;
  };
  EXPECT_EQ(list(), "");
  m.map = "town.osm";
  m.logs = {"a.csv", "b.csv"};
  EXPECT_EQ(list(), "map = town.osm\nlogs = a.csv\nlogs = b.csv\n");
}

}  // namespace
}  // namespace canyon

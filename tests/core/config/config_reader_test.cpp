#include <gtest/gtest.h>

#include "canyon/tests/core/config/example_config.h"

namespace canyon {
namespace {

using config_example::Mission;

Status read(const std::string& toml, Mission& mission) {
  const auto node = ConfigNode::parse(toml, "my.toml");
  if (!node.ok()) return node.error();
  return read_config(&*node, "", mission);
}

struct Gyro {
  double noise = std::nan("");
};
void visit(FieldVisitor& f, Gyro& c) {
  f.number("noise", c.noise, {0, 9}, "");
}

std::string error_of(const std::string& toml) {
  Mission mission;
  const Status status = read(toml, mission);
  return status.ok() ? "no error" : status.error().str();
}

TEST(ConfigReader, SetsWhatIsThereAndKeepsDefaults) {
  Mission m;
  const Status status = read(R"(
title = "other"
loop = true
lever_m = [1, -2.5, 3]
levels = [0, 0.5, 1]
waypoint = [{ at_m = [1, 2] }, { at_m = [3, 4], stop_s = 0 }]
[gnss]
rate_hz = 5
channels = 24
receiver = "paper"
systems = ["GPS", "Galileo"]
)",
                             m);
  ASSERT_TRUE(status.ok()) << status.error().str();
  EXPECT_EQ(m.title, "other");
  EXPECT_TRUE(m.loop);
  EXPECT_EQ(m.lever_m, Eigen::Vector3d(1, -2.5, 3));
  EXPECT_EQ(m.levels, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(m.gnss.rate_hz, 5.0);  // an integer where a number is expected
  EXPECT_EQ(m.gnss.sigma_m, 0.23);
  EXPECT_EQ(m.gnss.channels, 24);
  EXPECT_EQ(m.gnss.receiver, "paper");
  EXPECT_EQ(m.gnss.systems, (std::vector<std::string>{"GPS", "Galileo"}));
  ASSERT_EQ(m.waypoint.size(), 2u);
  EXPECT_EQ(m.waypoint[1].at_m, Eigen::Vector2d(3, 4));
  EXPECT_EQ(m.waypoint[0].stop_s, 5.0);
  EXPECT_EQ(m.waypoint[1].stop_s, 0.0);
}

TEST(ConfigReader, NoTableMeansDefaults) {
  Mission m;
  EXPECT_TRUE(read_config(nullptr, "mission", m).ok());
  EXPECT_EQ(m.gnss.rate_hz, 1.0);
  EXPECT_TRUE(read("", m).ok());
}

TEST(ConfigReader, ListItemsStartFromDefaultsNotFromEarlierItems) {
  Mission m;
  m.waypoint.resize(3);
  m.waypoint[0].stop_s = 77.0;
  ASSERT_TRUE(read("waypoint = [{ at_m = [1, 2] }]", m).ok());
  ASSERT_EQ(m.waypoint.size(), 1u);
  EXPECT_EQ(m.waypoint[0].stop_s, 5.0);
}

// 2026-11-21: a waypoint without its place was driven to at (0, 0).
TEST(ConfigReader, ANumberWithoutADefaultMustBeThere) {
  EXPECT_EQ(error_of("\n[[waypoint]]\nat_m = [1, 2]\n[[waypoint]]\nstop_s = 1\n"),
            "my.toml:4: waypoint[2].at_m: is missing, expected a list of 2 numbers");
  // A misspelt key is the cause of the missing one, and is told.
  EXPECT_EQ(error_of("[[waypoint]]\natm = [1, 2]\n"),
            "my.toml:2: waypoint[1].atm: unknown key, expected one of the documented keys; nearest is \"at_m\"");
  // Also where the whole table is missing that should hold it.
  Gyro gyro;
  const auto node = ConfigNode::parse("", "my.toml");
  EXPECT_EQ(read_fields(&*node, "", [&](FieldVisitor& f) { f.group("gyro", gyro, ""); }).error().str(),
            "my.toml: gyro.noise: is missing, expected a number from 0 to 9");
}

TEST(ConfigReader, PathsStartAtTheFolderOfTheFileThatNamesThem) {
  const auto read_from = [](const std::string& file, const std::string& toml) {
    Mission m;
    const auto node = ConfigNode::parse(toml, file);
    EXPECT_TRUE(read_config(&*node, "", m).ok());
    return m;
  };
  EXPECT_EQ(read_from("a/b/my.toml", "map = \"town.osm\"").map, "a/b/town.osm");
  EXPECT_EQ(read_from("a/b/my.toml", "map = \"../town.osm\"").map, "a/town.osm");
  EXPECT_EQ(read_from("my.toml", "map = \"town.osm\"").map, "town.osm");
  EXPECT_EQ(read_from("/home/my.toml", "map = \"/maps/town.osm\"").map, "/maps/town.osm");
  EXPECT_EQ(read_from("a/my.toml", "map = \"city\"").map, "city");  // a name
  EXPECT_EQ(read_from("a/my.toml", "logs = [\"x.csv\", \"/y.csv\"]").logs,
            (std::vector<std::string>{"a/x.csv", "/y.csv"}));
  Mission m;
  ConfigNode option;
  option.set("map", ConfigNode::of(std::string("town.osm")), "--map");  // where the user stands
  ASSERT_TRUE(read_config(&option, "", m).ok());
  EXPECT_EQ(m.map, "town.osm");
}

TEST(ConfigReader, OfManyKeysNoneIsListed) {
  double value = 0;
  const auto node = ConfigNode::parse("x = 1", "my.toml");
  const auto status = read_fields(&*node, "", [&](FieldVisitor& f) {
    for (const char* key : {"aaaa", "bbbb", "cccc", "dddd", "eeee", "ffff", "gggg", "hhhh", "iiii"})
      f.number(key, value, kAnyNumber, "");
  });
  EXPECT_EQ(status.error().str(), "my.toml:1: x: unknown key, expected one of the 9 documented keys");
}

/// A list of names out of a table.
struct Menu {
  std::vector<std::string> dishes{"soup"};
};
void visit(FieldVisitor& f, Menu& m) {
  f.choices("dishes", m.dishes, {"soup", "fish", "cake"}, "what is eaten");
}

TEST(ConfigReader, AListOfNamesIsOutOfItsTable) {
  const auto read = [](const std::string& toml, Menu& menu) {
    const auto node = ConfigNode::parse(toml, "m.toml");
    const Status status = read_config(&*node, "menu", menu);
    return status.ok() ? std::string() : status.error().str();
  };
  Menu menu;
  EXPECT_EQ(read("dishes = [\"cake\", \"fish\"]\n", menu), "");
  EXPECT_EQ(menu.dishes, (std::vector<std::string>{"cake", "fish"}));
  EXPECT_EQ(read("dishes = \"soup\"\n", menu), "");
  EXPECT_EQ(menu.dishes, std::vector<std::string>{"soup"});
  EXPECT_EQ(read("dishes = []\n", menu), "");
  EXPECT_TRUE(menu.dishes.empty());
  EXPECT_EQ(read("dishes = [\"fisch\"]\n", menu),
            "m.toml:1: menu.dishes: unknown name \"fisch\", expected one of \"soup\", \"fish\", \"cake\"; nearest is "
            "\"fish\"");
  EXPECT_EQ(read("dishes = [\"fish\", \"fish\"]\n", menu),
            "m.toml:1: menu.dishes: \"fish\" stands there twice, expected a list out of \"soup\", \"fish\", \"cake\"");
  EXPECT_EQ(read("dishes = 3\n", menu),
            "m.toml:1: menu.dishes: found integer 3, expected a list out of \"soup\", \"fish\", \"cake\"");
  EXPECT_TRUE(menu.dishes.empty());  // nothing of a wrong list is taken
}

TEST(ConfigReader, RangesAreClosed) {
  Mission m;
  EXPECT_TRUE(read("gnss.rate_hz = 20", m).ok());
  EXPECT_TRUE(read("gnss.rate_hz = 0.1", m).ok());
  EXPECT_TRUE(read("gnss.channels = 64", m).ok());
  EXPECT_FALSE(read("gnss.rate_hz = 20.000001", m).ok());
  EXPECT_FALSE(read("gnss.sigma_m = 0", m).ok());
  EXPECT_FALSE(read("gnss.channels = 0", m).ok());
}

TEST(ConfigReader, UnknownKeysWordForWord) {
  EXPECT_EQ(error_of("\n\n\n\n\n\n\n\n\n\n[gnss]\nrate_hzz = 5"),
            "my.toml:12: gnss.rate_hzz: unknown key, expected one of the documented keys; nearest is \"rate_hz\"");
  EXPECT_EQ(error_of("titel = \"x\""),
            "my.toml:1: titel: unknown key, expected one of the documented keys; nearest is \"title\"");
  EXPECT_EQ(error_of("[atmosphere]\nx = 1"),
            "my.toml:1: atmosphere: unknown key, expected one of the documented keys: \"title\", \"loop\", "
            "\"lever_m\", \"levels\", \"map\", \"logs\", \"gnss\", \"waypoint\"");
  EXPECT_EQ(error_of("waypoint = [{}, { stops_s = 1 }]"),
            "my.toml:1: waypoint[2].stops_s: unknown key, expected one of the documented keys; nearest is \"stop_s\"");
}

TEST(ConfigReader, OutOfRangeWordForWord) {
  EXPECT_EQ(error_of("\n\n\n\n\n[gnss]\nrate_hz = 500"),
            "my.toml:7: gnss.rate_hz: 500 is out of range, expected a number from 0.1 to 20");
  EXPECT_EQ(error_of("[gnss]\nrate_hz = 0.05"),
            "my.toml:2: gnss.rate_hz: 0.05 is out of range, expected a number from 0.1 to 20");
  EXPECT_EQ(error_of("[gnss]\nsigma_m = -1"),
            "my.toml:2: gnss.sigma_m: -1 is out of range, expected a positive number");
  EXPECT_EQ(error_of("[gnss]\nchannels = 65"),
            "my.toml:2: gnss.channels: 65 is out of range, expected a whole number from 1 to 64");
  EXPECT_EQ(error_of("waypoint = [{ stop_s = -1 }]"),
            "my.toml:1: waypoint[1].stop_s: -1 is out of range, expected a number of 0 or more");
  EXPECT_EQ(error_of("lever_m = [0, 0, 11]"),
            "my.toml:1: lever_m[3]: 11 is out of range, expected a number from -10 to 10");
}

TEST(ConfigReader, NotFiniteWordForWord) {
  EXPECT_EQ(error_of("[gnss]\nrate_hz = nan"),
            "my.toml:2: gnss.rate_hz: nan is not a finite number, expected a number from 0.1 to 20");
  EXPECT_EQ(error_of("waypoint = [{ at_m = [0, inf] }]"),
            "my.toml:1: waypoint[1].at_m[2]: inf is not a finite number, expected a number");
  EXPECT_EQ(error_of("waypoint = [{ at_m = [-inf, 0] }]"),
            "my.toml:1: waypoint[1].at_m[1]: -inf is not a finite number, expected a number");
}

TEST(ConfigReader, WrongTypesWordForWord) {
  EXPECT_EQ(error_of("[gnss]\nrate_hz = \"fast\""),
            "my.toml:2: gnss.rate_hz: found string \"fast\", expected a number from 0.1 to 20");
  EXPECT_EQ(error_of("[gnss]\nchannels = 2.0"),
            "my.toml:2: gnss.channels: found float 2, expected a whole number from 1 to 64");
  EXPECT_EQ(error_of("[gnss]\nrate_hz = true"),
            "my.toml:2: gnss.rate_hz: found boolean true, expected a number from 0.1 to 20");
  EXPECT_EQ(error_of("title = 5"), "my.toml:1: title: found integer 5, expected a string");
  EXPECT_EQ(error_of("loop = 1"), "my.toml:1: loop: found integer 1, expected true or false");
  EXPECT_EQ(error_of("gnss = 3"), "my.toml:1: gnss: found integer 3, expected a table");
  EXPECT_EQ(error_of("levels = 0.5"), "my.toml:1: levels: found float 0.5, expected a list of numbers");
  EXPECT_EQ(error_of("levels = [0.5, \"x\"]"),
            "my.toml:1: levels[2]: found string \"x\", expected a number from 0 to 1");
  EXPECT_EQ(error_of("lever_m = [1, 2]"), "my.toml:1: lever_m: found array of 2, expected a list of 3 numbers");
  EXPECT_EQ(error_of("waypoint = 5"), "my.toml:1: waypoint: found integer 5, expected a list of tables");
  EXPECT_EQ(error_of("waypoint = [5]"), "my.toml:1: waypoint[1]: found integer 5, expected a table");
  EXPECT_EQ(error_of("[gnss]\nsystems = \"GPS\""),
            "my.toml:2: gnss.systems: found string \"GPS\", expected a list of strings");
  EXPECT_EQ(error_of("[gnss]\nsystems = [1]"), "my.toml:2: gnss.systems[1]: found integer 1, expected a string");
}

TEST(ConfigReader, UnknownNamesWordForWord) {
  EXPECT_EQ(error_of("[gnss]\nreceiver = \"hihg\""),
            "my.toml:2: gnss.receiver: unknown name \"hihg\", expected one of \"low\", \"paper\", \"high\"; nearest is "
            "\"high\"");
  EXPECT_EQ(error_of("[gnss]\nreceiver = \"magic\""),
            "my.toml:2: gnss.receiver: unknown name \"magic\", expected one of \"low\", \"paper\", \"high\"");
  EXPECT_EQ(error_of("[gnss]\nreceiver = 1"),
            "my.toml:2: gnss.receiver: found integer 1, expected one of \"low\", \"paper\", \"high\"");
}

TEST(ConfigReader, OfSeveralMistakesTheTopmostIsTold) {
  EXPECT_EQ(error_of("loop = true\nfoo_bar = 1\n[gnss]\nrate_hz = 500\n"),
            "my.toml:2: foo_bar: unknown key, expected one of the documented keys: \"title\", \"loop\", \"lever_m\", "
            "\"levels\", \"map\", \"logs\", \"gnss\", \"waypoint\"");
}

TEST(ConfigReader, PrefixAndOptionsAreNamed) {
  ConfigNode node;
  node.set("rate_hz", ConfigNode::of(500.0), "--rate");
  config_example::Gnss gnss;
  EXPECT_EQ(read_config(&node, "gnss", gnss).error().str(),
            "--rate: gnss.rate_hz: 500 is out of range, expected a number from 0.1 to 20");
  EXPECT_EQ(gnss.rate_hz, 1.0);
  const ConfigNode plain = ConfigNode::of(3.0);
  EXPECT_EQ(read_config(&plain, "gnss", gnss).error().str(), "gnss: found float 3, expected a table");
}

TEST(ConfigReader, AMistakeIsAlwaysReportedEvenIfOtherFieldsWereSet) {
  Mission m;
  const Status status = read("title = \"new\"\nlever_m = [1, 2, \"x\"]\n", m);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(m.lever_m, Eigen::Vector3d(0.1, 0.2, 0.3));  // the wrong field itself is untouched
}

}  // namespace
}  // namespace canyon

#include "scene/material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "tests/support/test_data.h"

namespace canyon::scene {
namespace {

constexpr double kL1_hz = 1575.42e6;

const Material& material(const std::string& name) {
  for (const Material& m : builtin_materials()) {
    if (m.name == name) return m;
  }
  throw std::runtime_error("no material " + name);
}

TEST(Materials, BuiltinTableIsComplete) {
  std::set<std::string> names;
  for (const Material& m : builtin_materials()) {
    names.insert(m.name);
    EXPECT_FALSE(m.source.empty()) << m.name;
  }
  for (const char* name :
       {"concrete", "brick", "glass", "metal", "asphalt", "grass", "ground", "wood", "marble", "foliage", "absorber"}) {
    EXPECT_TRUE(names.count(name)) << name;
  }
  EXPECT_TRUE(material("absorber").rf_absorbing);
  EXPECT_FALSE(material("concrete").rf_absorbing);
}

// ITU-R P.2040-3 table 3 worked out at GPS L1; the printed figures have four significant digits, so half a unit of the
// last.
TEST(Materials, PermittivityAtL1) {
  const auto expect = [](const char* name, double real, double imaginary, double half_digit) {
    const std::complex<double> eta = material(name).permittivity(kL1_hz);
    EXPECT_NEAR(eta.real(), real, 0.5e-3) << name;
    EXPECT_NEAR(eta.imag(), -imaginary, half_digit) << name;
  };
  expect("concrete", 5.240, 0.752, 0.5e-3);
  expect("brick", 3.910, 0.292, 0.5e-3);
  expect("glass", 6.310, 0.076, 0.5e-3);
  expect("wood", 1.990, 0.087, 0.5e-3);
  expect("marble", 7.074, 0.096, 0.5e-3);
  expect("grass", 14.333, 0.838, 0.5e-3);
  expect("wet_ground", 25.013, 3.091, 0.5e-3);
  expect("metal", 1.000, 114128295.946, 0.5e-3);
}

TEST(Materials, FoliageIsTransparentToMirrors) {
  EXPECT_EQ(material("foliage").permittivity(kL1_hz), std::complex<double>(1.0, 0.0));
}

TEST(Materials, TableAgreesWithTheRecommendation) {
  CANYON_REAL_DATA(path, "materials/itu_p2040_table3.csv");
  const std::vector<std::pair<std::string, std::string>> rows = {{"concrete", "concrete"},
                                                                 {"brick", "brick"},
                                                                 {"glass", "glass"},
                                                                 {"metal", "metal"},
                                                                 {"wood", "wood"},
                                                                 {"marble", "marble"},
                                                                 {"foliage", "vacuum"},
                                                                 {"grass", "medium_dry_ground"},
                                                                 {"ground", "very_dry_ground"},
                                                                 {"wet_ground", "wet_ground"},
                                                                 {"plasterboard", "plasterboard"},
                                                                 {"asphalt", "concrete"}};
  std::map<std::string, std::vector<double>> table;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string name, field;
    std::getline(fields, name, ',');
    if (name.empty() || name[0] == '#' || name == "material") continue;
    while (std::getline(fields, field, ',')) table[name].push_back(std::stod(field));
  }
  for (const auto& [ours, theirs] : rows) {
    ASSERT_TRUE(table.count(theirs)) << theirs;
    const Material& m = material(ours);
    const std::vector<double>& row = table[theirs];
    EXPECT_EQ(m.itu_a, row[0]) << ours;
    EXPECT_EQ(m.itu_b, row[1]) << ours;
    EXPECT_EQ(m.itu_c, row[2]) << ours;
    EXPECT_EQ(m.itu_d, row[3]) << ours;
  }
}

TEST(Materials, MistakesAreNamedWithTheirLine) {
  const auto message = [](const char* toml) {
    const auto result = parse_materials(toml, "my.toml");
    EXPECT_FALSE(result.ok());
    return result.ok() ? std::string() : result.error().str();
  };
  EXPECT_EQ(message("[[material]]\nname = \"a\"\nlidar_reflectence = 0.3\n"),
            "my.toml:3: material[1].lidar_reflectence: unknown key, expected one of the documented keys; nearest is "
            "\"lidar_reflectance\"");
  EXPECT_EQ(message("[[material]]\nname = \"a\"\nlidar_reflectance = 1.3\n"),
            "my.toml:3: material[1].lidar_reflectance: 1.3 is out of range, expected a number from 0 to 1");
  EXPECT_EQ(message("[[material]]\nname = \"a\"\nitu = [1.0, 0.0]\n"),
            "my.toml:3: material[1].itu: found array of 2, expected a list of 4 numbers");
  EXPECT_EQ(message("[[material]]\nname = \"a\"\nitu = [0.5, 0.0, 0.0, 0.0]\n"),
            "my.toml:3: material[1].itu: a = 0.5, expected a permittivity of at least 1");
  EXPECT_EQ(message("[[material]]\nname = \"a\"\nitu = [1.0, 0.0, -1.0, 0.0]\n"),
            "my.toml:3: material[1].itu: c = -1, expected a conductivity of at least 0");
  EXPECT_EQ(message("[[material]]\nlidar_reflectance = 0.3\n"),
            "my.toml:1: material[1].name: missing, expected a name");
  EXPECT_EQ(message("[[material]]\nname = \"a\"\n[[material]]\nname = \"a\"\n"),
            "my.toml:4: material[2].name: \"a\" appears twice, expected unique names");
  EXPECT_EQ(message(""), "my.toml: material: no material, expected at least one [[material]] table");
  EXPECT_NE(message("[[material]\n").find("my.toml:1: not valid TOML"), std::string::npos)
      << "the rest is the parser's";
}

}  // namespace
}  // namespace canyon::scene

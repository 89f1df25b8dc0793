#include "canyon/scene/surfaces/material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "canyon/tests/support/outside_program.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::scene {
namespace {

constexpr double kL1_hz = 1575.42e6;

const Material& material(const std::string& name) {
  for (const Material& m : builtin_materials()) {
    if (m.name == name) return m;
  }
  throw std::runtime_error("no material " + name);
}

/// The numbers of each row of a CSV file, by the name in its first column.
std::map<std::string, std::vector<double>> rows_of(const std::string& path) {
  std::map<std::string, std::vector<double>> table;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string name, field;
    std::getline(fields, name, ',');
    if (name.empty() || name[0] == '#' || name == "material") continue;
    while (std::getline(fields, field, ',')) table[name].push_back(std::stod(field));
  }
  return table;
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

// Debye's relaxation from 80.2 to 5.2 at 9.3 ps (pure water at 20 C), worked out here at GPS L1: 79.6 - 6.9j; the
// table's power laws are rounded to 1 and to 0.1.
TEST(Materials, WaterRelaxes) {
  const std::complex<double> turning(1.0, 2.0 * std::acos(-1.0) * kL1_hz * 9.3e-12);
  const std::complex<double> debye = 5.2 + (80.2 - 5.2) / turning, table = material("water").permittivity(kL1_hz);
  EXPECT_NEAR(table.real(), debye.real(), 1.0);
  EXPECT_NEAR(table.imag(), debye.imag(), 0.1);
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
  auto table = rows_of(path);
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

TEST(Materials, ReflectanceAgreesWithTheSpectra) {
  CANYON_REAL_DATA(path, "materials/lidar_reflectance_mavs_spectra.csv");
  const std::map<std::string, std::string> rows = {{"concrete", "concrete"},
                                                   {"brick", "weathered_red_brick"},
                                                   {"asphalt", "gray_asphalt"},
                                                   {"roofing", "weathered_black_tar_paper"},
                                                   {"metal", "galvanized_sheet_metal"},
                                                   {"painted_metal", "olive_green_paint"},
                                                   {"wood", "plywood"},
                                                   {"plywood", "plywood"},
                                                   {"grass", "lawn_grass"},
                                                   {"ground", "oat_grass"},
                                                   {"bark", "oak_trunk"},
                                                   {"foliage", "american_beech_leaf"}};
  auto table = rows_of(path);
  for (const auto& [ours, theirs] : rows) {
    ASSERT_EQ(table[theirs].size(), 4u) << theirs;
    const Material& m = material(ours);
    EXPECT_EQ(m.reflectance(850.0), table[theirs][0]) << ours;
    EXPECT_EQ(m.reflectance(905.0), table[theirs][2]) << ours;
    EXPECT_EQ(m.reflectance(1550.0), table[theirs][3]) << ours;
    // The spectra's own value at 865 nm against the straight line between 850 and 905 nm: curvature, not rounding.
    EXPECT_NEAR(m.reflectance(865.0), table[theirs][1], 0.011) << ours;
  }
}

TEST(Materials, ReflectanceBetweenAndOutsideTheWavelengthsGiven) {
  Material m;
  m.lidar_reflectance = 0.4;
  EXPECT_EQ(m.reflectance(850.0), 0.4);
  EXPECT_EQ(m.reflectance(1550.0), 0.4);
  m.lidar_reflectance_850 = 0.2;
  m.lidar_reflectance_1550 = 0.8;
  EXPECT_EQ(m.reflectance(532.0), 0.2);
  EXPECT_NEAR(m.reflectance(877.5), 0.3, 1e-15);
  EXPECT_NEAR(m.reflectance(905.0 + 64.5), 0.44, 1e-15);
  EXPECT_EQ(m.reflectance(2000.0), 0.8);
}

// A slab at normal incidence (ITU-R P.2040-3, 2.2.2.2): T = (1 - r^2) e / (1 - r^2 e^2), e = exp(-j k0 d sqrt(eta)).
// The figures for L1 are given to 0.1 dB, so half of that.
TEST(Materials, ThicknessesGiveTheKnownLossesOfSlabs) {
  const auto loss_db = [](const Material& m) {
    const std::complex<double> n = std::sqrt(m.permittivity(kL1_hz)), r = (1.0 - n) / (1.0 + n);
    const double k0 = 2.0 * std::acos(-1.0) * kL1_hz / 299792458.0;
    const std::complex<double> e = std::exp(std::complex<double>(0.0, -1.0) * k0 * m.thickness_m * n);
    return -20.0 * std::log10(std::abs((1.0 - r * r) * e / (1.0 - r * r * e * e)));
  };
  EXPECT_NEAR(loss_db(material("glass")), 1.0, 0.05);
  EXPECT_NEAR(loss_db(material("concrete")), 10.8, 0.05);
  EXPECT_NEAR(loss_db(material("brick")), 5.1, 0.05);
}

TEST(Materials, UsersFilesAddAndReplace) {
  const canyon::testing::ScratchDirectory scratch;
  const std::string first = scratch.file("first.toml"), second = scratch.file("second.toml");
  std::ofstream(first) << "[[material]]\nname = \"straw\"\nlidar_reflectance = 0.6\n";
  std::ofstream(second) << "[[material]]\nname = \"glass\"\nitu = [7.0, 0.0, 0.0, 0.0]\nlidar_transmittance = 0.5\n"
                           "[[material]]\nname = \"straw\"\nlidar_reflectance = 0.7\n";
  const auto table = load_materials({first, second});
  ASSERT_TRUE(table.ok()) << table.error().str();
  ASSERT_EQ(table->size(), builtin_materials().size() + 1);
  EXPECT_EQ(table->back().name, "straw");
  EXPECT_EQ(table->back().lidar_reflectance, 0.7);
  for (std::size_t i = 0; i < builtin_materials().size(); ++i) {
    EXPECT_EQ((*table)[i].name, builtin_materials()[i].name);
    if ((*table)[i].name == "glass") {
      EXPECT_EQ((*table)[i].itu_a, 7.0);
      EXPECT_EQ((*table)[i].lidar_specular, 0.0);  // the row is replaced whole
    }
  }
  EXPECT_EQ(load_materials({scratch.file("none.toml")}).error().file, scratch.file("none.toml"));
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
  EXPECT_EQ(
      message("[[material]]\nname = \"a\"\nlidar_reflectance = 0.7\nlidar_transmittance = 0.4\n"),
      "my.toml:3: material[1].lidar_reflectance: reflectance 0.7, specular 0 and transmittance 0.4 make more than "
      "1, expected no more light than comes in");
  EXPECT_EQ(message("[[material]]\nname = \"a\"\nlidar_reflectance = 0.8\nlidar_spread = 0.1\n"),
            "my.toml:4: material[1].lidar_spread: with 0.1 the brightest place reflects 1.0546 beside "
            "specular 0 and transmittance 0, expected no more light than comes in");
  EXPECT_EQ(message("[[material]]\nname = \"a\"\nlidar_spread = 0.4\n"),
            "my.toml:3: material[1].lidar_spread: 0.4 is out of range, expected a number from 0 to 0.3");
  EXPECT_EQ(message(""), "my.toml: material: no material, expected at least one [[material]] table");
  EXPECT_NE(message("[[material]\n").find("my.toml:1: not valid TOML"), std::string::npos)
      << "the rest is the parser's";
}

}  // namespace
}  // namespace canyon::scene

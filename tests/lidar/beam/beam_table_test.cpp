#include "canyon/lidar/beam/beam_table.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"

namespace canyon::lidar {
namespace {

constexpr double kTableEps = 2.3e-16;

std::string error_of(std::string_view csv) {
  const auto table = parse_beam_table(csv, "my.csv");
  return table.ok() ? "no error" : table.error().str();
}

const std::string kHead = "cycle_us,55.296\nlaser,elevation_deg,azimuth_offset_deg,origin_up_mm,firing_us\n";

TEST(BeamTable, Vlp16AsItsManualDescribesIt) {
  const auto table = load_beam_table("vlp16");
  ASSERT_TRUE(table.ok()) << table.error().str();
  EXPECT_EQ(table->name, "vlp16");
  ASSERT_EQ(table->beams.size(), 16u);
  EXPECT_DOUBLE_EQ(table->cycle_s, 16 * 2.304e-6 + 18.432e-6);
  for (std::size_t j = 0; j < 16; ++j) {
    const Beam& beam = table->beams[j];
    // Even lasers from -15 deg upwards, odd ones from +1 deg, both in steps of 2 deg.
    const double elevation_deg = j % 2 == 0 ? -15.0 + static_cast<double>(j) : static_cast<double>(j);
    EXPECT_NEAR(beam.elevation_rad, elevation_deg * kDegree, 4 * kTableEps) << j;
    EXPECT_EQ(beam.azimuth_offset_rad, 0.0);
    EXPECT_NEAR(beam.firing_s, static_cast<double>(j) * 2.304e-6, 1e-18) << j;
    // The manual's corrections are the beams' common crossing point seen from the spin axis: opposite in sign to the
    // angle, 0.7 to 11.2 mm, the same for +a and -a.
    EXPECT_LT(beam.origin_up_m * beam.elevation_rad, 0.0) << j;
    EXPECT_NEAR(beam.origin_up_m, -table->beams[15 - j].origin_up_m, 1e-12) << j;
    // They are printed to 0.1 mm and follow an arm of 41.9 mm.
    EXPECT_NEAR(beam.origin_up_m, -41.9e-3 * std::tan(beam.elevation_rad), 0.05e-3) << j;
  }
}

TEST(BeamTable, GridHasTheSameElevationsWithoutOffsets) {
  const auto grid = load_beam_table("grid16");
  ASSERT_TRUE(grid.ok()) << grid.error().str();
  ASSERT_EQ(grid->beams.size(), 16u);
  for (std::size_t j = 0; j < 16; ++j) {
    EXPECT_NEAR(grid->beams[j].elevation_rad, (-15.0 + 2.0 * static_cast<double>(j)) * kDegree, 4 * kTableEps);
    EXPECT_EQ(grid->beams[j].firing_s, 0.0);
    EXPECT_EQ(grid->beams[j].origin_up_m, 0.0);
  }
  EXPECT_EQ(grid->last_firing_s(), 0.0);
}

TEST(BeamTable, CommentsBlanksAndSpacesAreFine) {
  const auto table =
      parse_beam_table("# mine\r\n\n" + kHead + " 0 , -1.5,0.25, 3,0 \r\n# between\n1,2,0,0,2.304", "my.csv");
  ASSERT_TRUE(table.ok()) << table.error().str();
  ASSERT_EQ(table->beams.size(), 2u);
  EXPECT_DOUBLE_EQ(table->beams[0].elevation_rad, -1.5 * kDegree);
  EXPECT_DOUBLE_EQ(table->beams[0].azimuth_offset_rad, 0.25 * kDegree);
  EXPECT_DOUBLE_EQ(table->beams[0].origin_up_m, 0.003);
  EXPECT_DOUBLE_EQ(table->last_firing_s(), 2.304e-6);
}

TEST(BeamTable, MistakesAreNamedWithTheirPlace) {
  EXPECT_EQ(error_of(""), "my.csv: the file ends early, expected cycle_us,VALUE");
  EXPECT_EQ(error_of("cycle_us,55\n1,2,3"),
            "my.csv:2: \"1,2,3\", expected laser,elevation_deg,azimuth_offset_deg,origin_up_mm,firing_us");
  EXPECT_EQ(error_of(kHead), "my.csv: the file ends early, expected one line per laser");
  EXPECT_EQ(error_of(kHead + "0,1,2,3\n"),
            "my.csv:3: \"0,1,2,3\", expected 5 values: laser,elevation_deg,azimuth_offset_deg,origin_up_mm,firing_us");
  EXPECT_EQ(error_of(kHead + "0,abc,0,0,0\n"), "my.csv:3: elevation_deg: \"abc\", expected a number from -90 to 90");
  EXPECT_EQ(error_of(kHead + "0,nan,0,0,0\n"), "my.csv:3: elevation_deg: \"nan\", expected a number from -90 to 90");
  EXPECT_EQ(error_of(kHead + "0,91,0,0,0\n"), "my.csv:3: elevation_deg: \"91\", expected a number from -90 to 90");
  EXPECT_EQ(error_of(kHead + "0,0,0,0,0\n2,0,0,0,0\n"), "my.csv:4: \"2,0,0,0,0\", expected laser 1");
  EXPECT_EQ(error_of(kHead + "0,0,0,0,60\n"), "my.csv:1: cycle_us: 55.296, expected more than the last firing_us, 60");
  EXPECT_EQ(load_beam_table("vlp61").error().str(),
            "lidar.beams: unknown beam table \"vlp61\" (did you mean \"vlp16\"?), expected one of grid16, hdl32e, "
            "hdl64e, mid360, os1_128, os1_64, vlp16, grid:LASERS:MIN_DEG:MAX_DEG, or the path of a .csv file");
  EXPECT_EQ(load_beam_table("no_such.csv").error().exit_code, 2);
}

}  // namespace
}  // namespace canyon::lidar

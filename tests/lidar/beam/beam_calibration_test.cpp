// The built-in tables against the calibration files they were transcribed from.
#include <cmath>
#include <regex>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/beam_table.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::lidar {
namespace {

constexpr double kEps = 2.3e-16;

/// The numbers that follow `name` in the text, in order.
std::vector<double> numbers_after(const std::string& text, const std::string& name) {
  std::vector<double> out;
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
    out.push_back(std::stod(text.substr(at + name.size(), 40)));
  return out;
}

/// The numbers of a JSON list.
std::vector<double> json_list(const std::string& text, const std::string& key) {
  const std::size_t begin = text.find('[', text.find('"' + key + '"'));
  const std::string list = text.substr(begin + 1, text.find(']', begin) - begin - 1);
  std::vector<double> out;
  const std::regex number("-?[0-9.]+");
  for (std::sregex_iterator it(list.begin(), list.end(), number), end; it != end; ++it)
    out.push_back(std::stod(it->str()));
  return out;
}

TEST(BeamCalibration, Vlp16EqualsTheCalibrationFileOfTheRosDriver) {
  CANYON_REAL_DATA(path, "lidar/calib/VLP16db.yaml");
  const std::string text = *read_text_file(path);
  const auto ids = numbers_after(text, " laser_id: ");
  const auto elevations = numbers_after(text, " vert_correction: ");
  const auto azimuths = numbers_after(text, " rot_correction: ");
  const BeamTable table = *load_beam_table("vlp16");
  ASSERT_EQ(elevations.size(), table.beams.size());
  for (std::size_t j = 0; j < elevations.size(); ++j) {
    EXPECT_EQ(ids[j], static_cast<double>(j));
    EXPECT_NEAR(table.beams[j].elevation_rad, elevations[j], 4 * kEps) << j;
    EXPECT_EQ(table.beams[j].azimuth_offset_rad, azimuths[j]) << j;
  }
}

TEST(BeamCalibration, Vlp16EqualsTheManufacturersCalibrationFile) {
  CANYON_REAL_DATA(path, "lidar/calib/velodyne_default_calib_VLP-16.xml");
  const std::string text = *read_text_file(path);
  const auto elevations = numbers_after(text, "<vertCorrection_>");
  const auto azimuths = numbers_after(text, "<rotCorrection_>");
  const BeamTable table = *load_beam_table("vlp16");
  ASSERT_GE(elevations.size(), table.beams.size());  // the file has room for 64
  for (std::size_t j = 0; j < table.beams.size(); ++j) {
    EXPECT_NEAR(table.beams[j].elevation_rad, elevations[j] * kDegree, 4 * kEps) << j;
    EXPECT_EQ(table.beams[j].azimuth_offset_rad, azimuths[j]) << j;
  }
}

TEST(BeamCalibration, Hdl32eEqualsBothFiles) {
  CANYON_REAL_DATA(yaml, "lidar/calib/32db.yaml");
  CANYON_REAL_DATA(xml, "lidar/calib/velodyne_default_calib_HDL-32.xml");
  const auto radians = numbers_after(*read_text_file(yaml), "vert_correction: ");
  const auto degrees = numbers_after(*read_text_file(xml), "<vertCorrection_>");
  const BeamTable table = *load_beam_table("hdl32e");
  ASSERT_EQ(table.beams.size(), 32u);
  ASSERT_EQ(radians.size(), 32u);
  ASSERT_GE(degrees.size(), 32u);
  for (std::size_t j = 0; j < 32; ++j) {
    EXPECT_NEAR(table.beams[j].elevation_rad / kDegree, degrees[j], 1e-6) << j << ": printed in single precision";
    EXPECT_NEAR(table.beams[j].elevation_rad, radians[j], 1e-7) << j;
    EXPECT_NEAR(table.beams[j].firing_s, 1.152e-6 * static_cast<double>(j), 1e-15) << j;
  }
  EXPECT_DOUBLE_EQ(table.cycle_s, 46.08e-6);
}

TEST(BeamCalibration, Hdl64eEqualsItsUnitsFile) {
  CANYON_REAL_DATA(path, "lidar/calib/64e_s3-xiesc.yaml");
  const std::string text = *read_text_file(path);
  const auto elevation = numbers_after(text, " vert_correction: "), azimuth = numbers_after(text, "rot_correction: ");
  const auto up = numbers_after(text, "vert_offset_correction: "),
             left = numbers_after(text, "horiz_offset_correction: ");
  const BeamTable table = *load_beam_table("hdl64e");
  ASSERT_EQ(table.beams.size(), 64u);
  ASSERT_EQ(elevation.size(), 64u);
  for (std::size_t j = 0; j < 64; ++j) {
    const Beam& beam = table.beams[j];
    // Printed to 1e-6 deg and 0.1 um.
    EXPECT_NEAR(beam.elevation_rad, elevation[j], 1e-6 * kDegree) << j;
    EXPECT_NEAR(beam.azimuth_offset_rad, -azimuth[j], 1e-6 * kDegree) << j;
    // The driver's formula for a target at 10 m, head at 0: x left, y forward of a frame that looks along y.
    const double d = 10.0, ce = std::cos(elevation[j]), se = std::sin(elevation[j]);
    const double level = d * ce - up[j] * se;
    const double forward = level * std::cos(-azimuth[j]) + left[j] * std::sin(-azimuth[j]);
    const double right = level * std::sin(-azimuth[j]) - left[j] * std::cos(-azimuth[j]);
    EXPECT_NEAR(beam.origin_out_m + d * std::cos(beam.elevation_rad) * std::cos(beam.azimuth_offset_rad), forward,
                1e-6);
    EXPECT_NEAR(-beam.origin_left_m + d * std::cos(beam.elevation_rad) * std::sin(beam.azimuth_offset_rad), right,
                1e-6);
    EXPECT_NEAR(beam.origin_up_m + d * std::sin(beam.elevation_rad), d * se + up[j] * ce, 1e-6);
  }
}

void expect_ouster(const std::string& path, const std::string& name, std::size_t lasers) {
  const std::string text = *read_text_file(path);
  const auto elevation = json_list(text, "beam_altitude_angles"), azimuth = json_list(text, "beam_azimuth_angles");
  const double out_mm = numbers_after(text, "\"lidar_origin_to_beam_origin_mm\":").at(0);
  const BeamTable table = *load_beam_table(name);
  ASSERT_EQ(table.beams.size(), lasers);
  ASSERT_EQ(elevation.size(), lasers);
  ASSERT_EQ(azimuth.size(), lasers);
  for (std::size_t j = 0; j < lasers; ++j) {
    EXPECT_NEAR(table.beams[j].elevation_rad / kDegree, elevation[j], 1e-6) << j;
    EXPECT_NEAR(table.beams[j].azimuth_offset_rad / kDegree, azimuth[j], 1e-6) << j;
    EXPECT_NEAR(table.beams[j].origin_out_m * 1e3, out_mm, 1e-9) << j;
  }
}

TEST(BeamCalibration, Os1EqualsItsMetadata) {
  CANYON_REAL_DATA(os64, "lidar/calib/ouster_os1-64_metadata_fw2.1.2.json");
  CANYON_REAL_DATA(os128, "lidar/ouster/OS-1-128_v2.3.0_1024x10.json");
  expect_ouster(os64, "os1_64", 64);
  expect_ouster(os128, "os1_128", 128);
}

/// The twin that needs no recording: what the data sheets say of the fields of view.
TEST(BeamCalibration, FieldsOfViewAreTheSheets) {
  const auto field = [](const char* name) {
    double low = 90, high = -90;
    const BeamTable table = *load_beam_table(name);
    for (const Beam& b : table.beams) {
      low = std::min(low, b.elevation_rad / kDegree), high = std::max(high, b.elevation_rad / kDegree);
    }
    return std::pair(low, high);
  };
  EXPECT_NEAR(field("hdl32e").first, -30.67, 1e-9);
  EXPECT_NEAR(field("hdl32e").second, 10.67, 1e-9);
  EXPECT_NEAR(field("hdl64e").first, -24.8, 1.0) << "one unit";
  EXPECT_NEAR(field("hdl64e").second, 2.0, 1.0);
  EXPECT_NEAR(field("os1_64").second - field("os1_64").first, 33.2, 0.5);
  EXPECT_NEAR(field("os1_128").second - field("os1_128").first, 42.8, 0.5);
  const auto grid = load_beam_table("grid:5:-10:10");
  ASSERT_TRUE(grid.ok());
  for (std::size_t j = 0; j < 5; ++j)
    EXPECT_NEAR(grid->beams[j].elevation_rad / kDegree, -10 + 5.0 * static_cast<double>(j), 1e-12);
  EXPECT_EQ(load_beam_table("grid:0:-1:1").error().str(),
            "lidar.beams: \"grid:0:-1:1\", expected grid:LASERS:MIN_DEG:MAX_DEG, such as grid:32:-25:15");
}

TEST(BeamCalibration, RosetteMistakesAreNamed) {
  const auto error = [](const std::string& text) {
    const auto table = parse_beam_table(text, "my.csv");
    return table.ok() ? std::string("no error") : table.error().str();
  };
  const std::string good = "rosette\nlasers,4\npoints_per_s,1000\nhead_hz,10\nswing_hz,150\nelevation_min_deg,-7\n";
  EXPECT_EQ(error(good + "elevation_max_deg,52\n"), "no error");
  EXPECT_EQ(error(good), "my.csv: the file ends early, expected elevation_max_deg,VALUE");
  EXPECT_EQ(error(good + "elevation_max_deg,-8\n"),
            "my.csv:6: elevation_min_deg: -7, expected less than elevation_max_deg, -8");
  EXPECT_EQ(error("rosette\nheads,4\n"), "my.csv:2: \"heads,4\", expected lasers,VALUE");
}

}  // namespace
}  // namespace canyon::lidar

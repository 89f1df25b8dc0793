// canyon gnss orbit-error, as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::apps {
namespace {

using ::testing::HasSubstr;

using OrbitErrorVerb = testing::CommandLineTest;

TEST_F(OrbitErrorVerb, Mistakes) {
  EXPECT_EQ(canyon("gnss orbit-error --nav no.nav --sp3 no.sp3"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("no.nav: "));
  write("empty.sp3", "");
  write("empty.nav", "");
  EXPECT_EQ(canyon("gnss orbit-error --nav empty.nav --sp3 empty.sp3"), 2);
  EXPECT_EQ(read("stderr"), "empty.nav:1: the file is empty, expected a RINEX 2, 3 or 4 navigation file\n");
  EXPECT_EQ(canyon("gnss orbit-error --nav empty.nav --sp3 empty.sp3 --systems GX"), 2);
  EXPECT_EQ(read("stderr"),
            "--systems: unknown satellite system \"X\", expected letters of G (GPS), R (GLONASS), E (Galileo), C "
            "(BeiDou), J (QZSS), for example GREC\n");
}

TEST_F(OrbitErrorVerb, RealDay) {
  CANYON_REAL_DATA(nav, "gnss/orbit_2010_182/brdc1820.10n");
  CANYON_REAL_DATA(sp3, "gnss/orbit_2010_182/igs15904.sp3");
  const std::string files = "gnss orbit-error --nav '" + nav + "' --sp3 '" + sp3 + "' ";
  ASSERT_EQ(canyon(files + "--antex none --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(json["satellites"], 30);
  EXPECT_EQ(json["samples"], 2878);
  EXPECT_NEAR(json["along_rms_m"].get<double>(), 1.48, 0.05 * 1.48);
  EXPECT_NEAR(json["cross_rms_m"].get<double>(), 0.52, 0.05 * 0.52);
  for (const char* key : {"radial_rms_m", "rms_3d_m", "sisre_m"}) EXPECT_TRUE(json[key].is_number()) << key;
  EXPECT_EQ(json["by_satellite"].size(), 30u);
  EXPECT_THAT(read("stderr"), HasSubstr("warning: "));  // of the record of G01 that belongs to another satellite

  ASSERT_EQ(canyon(files + "--out errors"), 0) << read("stderr");
  EXPECT_THAT(read("stdout"), HasSubstr("  all G      30    2878"));
  EXPECT_THAT(read("errors/orbit_error.csv"), HasSubstr("gps_week,sow,satellite,radial_m,along_m,cross_m,clock_m\n"));
  EXPECT_EQ(canyon(files + "--out errors"), 2);  // exists already
}

}  // namespace
}  // namespace canyon::apps

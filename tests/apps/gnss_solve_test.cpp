// canyon gnss solve: as a user calls it, on files that canyon gnss simulate wrote.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

using ::testing::HasSubstr;

class GnssSolveTest : public testing::CommandLineTest {
 protected:
  void SetUp() override {
    CommandLineTest::SetUp();
    write("vacuum.toml", "ionosphere = \"none\"\ntroposphere = \"none\"\nsmoothing_s = 0.0\nshared_ionosphere = 0.0\n");
    ASSERT_EQ(canyon("gnss simulate --at 32.35,-90.88,60 --duration 60 --errors none --rinex-obs given.rnx --rinex-nav "
                     "given.nav"),
              0)
        << read("stderr");
  }
  static constexpr const char* kTruth = "--truth-ecef=-82832.8838,-5393009.5926,3393436.0361";
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

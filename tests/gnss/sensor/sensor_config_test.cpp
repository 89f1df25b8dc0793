#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/tests/gnss/sensor/pseudorange_sensor_fixture.h"

namespace canyon::gnss {
namespace {

using ::testing::HasSubstr;
using testing::PseudorangeSensorTest;

TEST_F(PseudorangeSensorTest, ConfigurationErrorsWordForWord) {
  GnssConfig c;
  c.model.name = "gps";
  EXPECT_EQ(error_of(c),
            "gnss.model: unknown name \"gps\", expected one of \"pseudorange\", \"truth_plus_isotropic\", "
            "\"truth_plus_white\", \"satellite_count\"");
  c = GnssConfig{};
  c.ionosphere.name = "iri";
  EXPECT_EQ(
      error_of(c),
      "gnss.ionosphere: unknown name \"iri\", expected one of \"none\", \"single_layer\", \"klobuchar\", \"ionex\", "
      "\"paper\", \"paper_printed\"");
  c = GnssConfig{};
  c.position.solver.name = "trilateration";
  EXPECT_EQ(error_of(c),
            "gnss.receiver_clock, gnss.solver: solver \"trilateration\" has no unknown for the receiver clock "
            "\"tcxo\", expected gnss.receiver_clock = \"none\", or another gnss.solver");
}

TEST(GnssConfig, ReadsAndRefuses) {
  GnssConfig c;
  const auto good = ConfigNode::parse("mode = \"single\"\nmultipath_rule = \"correlator\"\nrate_hz = 5\n", "m.toml");
  ASSERT_TRUE(good.ok());
  EXPECT_TRUE(read_config(&*good, "gnss", c).ok());
  EXPECT_EQ(c.mode.name, "single");
  EXPECT_EQ(c.rate_hz, 5.0);
  const auto bad = ConfigNode::parse("\nmultipath_rule = \"corelator\"\n", "m.toml");
  const auto status = read_config(&*bad, "gnss", c);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().str(), HasSubstr("m.toml:2: gnss.multipath_rule:"));
  EXPECT_THAT(status.error().str(), HasSubstr("correlator"));
}

}  // namespace
}  // namespace canyon::gnss

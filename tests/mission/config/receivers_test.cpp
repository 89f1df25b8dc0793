// A receiver of the catalogue in a mission.
#include <gtest/gtest.h>

#include "canyon/core/config/config.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::mission {
namespace {

std::string keys_of(MissionConfig config) {
  return fields_as_json([&config](FieldVisitor& f) { visit(f, config); });
}

MissionConfig with(const std::string& gnss, const std::string& fidelity) {
  const auto file = MissionFile::parse("base = \"vicksburg\"\n" + gnss, "m.toml");
  EXPECT_TRUE(file.ok()) << file.error().str();
  const auto config = file->resolve(fidelity);
  EXPECT_TRUE(config.ok()) << config.error().str();
  return *config;
}

std::string keys_of(gnss::GnssConfig config) {
  return fields_as_json([&config](FieldVisitor& f) { visit(f, config); });
}

// One that a builder of robots would have bought in 2010, in the street as it was measured.
TEST(MissionReceivers, HighHasTheDgps2010InTheStreetAsMeasured) {
  const MissionConfig c = with("", "high");
  EXPECT_EQ(c.gnss.receiver, "dgps_2010");
  EXPECT_EQ(c.gnss.satellites.systems, "GR");
  EXPECT_TRUE(c.gnss.propagation.reflection_borders);
  EXPECT_EQ(c.gnss.propagation.diffraction.name, "wedge");
  EXPECT_EQ(c.gnss.propagation.scatter.name, "directive");
  EXPECT_EQ(c.gnss.propagation.clutter.name, "street");
  EXPECT_EQ(c.fusion.filter, "naive");
}

TEST(MissionReceivers, ModernHasTheChannelOfHigh) {
  const MissionConfig high = with("", "high"), modern = with("", "modern");
  EXPECT_EQ(modern.gnss.propagation.paths.name, high.gnss.propagation.paths.name);
  EXPECT_EQ(modern.gnss.propagation.reflection_borders, high.gnss.propagation.reflection_borders);
  EXPECT_EQ(modern.gnss.propagation.diffraction.name, high.gnss.propagation.diffraction.name);
  EXPECT_EQ(modern.gnss.propagation.scatter.name, high.gnss.propagation.scatter.name);
  EXPECT_EQ(modern.gnss.propagation.clutter.name, high.gnss.propagation.clutter.name);
}

TEST(MissionReceivers, HighAidedIsHighButForItsFilter) {
  MissionConfig aided = with("[fidelity.high.gnss]\nmask_deg = 12.5\n", "high_aided");
  EXPECT_EQ(aided.fusion.filter, "vehicle");
  aided.fusion.filter = "naive";
  EXPECT_EQ(keys_of(aided), keys_of(with("[fidelity.high.gnss]\nmask_deg = 12.5\n", "high")));
}

// What `high` was until 2026-11-25, by its keys then: every key that acts is the same, but the receiver's name.
TEST(MissionReceivers, TheFormerHighIsReachable) {
  const MissionConfig former = with(R"([fidelity.former]
base = "low"
[fidelity.former.gnss]
model = "pseudorange"
mode = "dgps"
ephemeris_error = "orbit_clock_2010"
paths = "specular2"
diffraction = "double_knife_edge"
multipath_rule = "correlator"
correlator_spacing_chips = 0.1
front_end_mhz = 16.0
code_loop_hz = 0.25
tracking_threshold_dbhz = 28.0
antenna = "survey"
weighting = "elevation_cn0"
raim = "greedy"
raim_false_alarm = 1e-3
max_gdop = 30.0
)",
                                    "former");
  MissionConfig named = with(
      "[gnss]\nreceiver = \"snapshot_gps\"\ndiffraction = \"double_knife_edge\"\nscatter = \"none\"\n"
      "clutter = \"none\"\nreflection_borders = false\n",
      "high");
  EXPECT_EQ(named.gnss.receiver, "snapshot_gps");
  named.gnss.receiver.clear();
  // Of a filter that it does not have, what the receiver under it says.
  ASSERT_EQ(named.gnss.position.estimator, gnss::Estimator::kLeastSquares);
  named.gnss.position.estimator_acceleration_m_s2 = former.gnss.position.estimator_acceleration_m_s2;
  EXPECT_EQ(keys_of(named.gnss), keys_of(former.gnss));
}

TEST(MissionReceivers, SingleKeysOverride) {
  const MissionConfig c =
      with("[gnss]\nreceiver = \"f9p\"\nsmoothing_s = 5.0\n[fidelity.high.gnss]\nmask_deg = 12.5\n", "high");
  EXPECT_EQ(c.gnss.satellites.systems, "GREC");
  EXPECT_EQ(c.gnss.position.smoothing_s, 5.0);
  EXPECT_EQ(c.gnss.mask_deg, 12.5);
}

// A later layer's receiver replaces an earlier one's figures, and what was set for them.
TEST(MissionReceivers, ALaterNameReplacesTheWholeReceiver) {
  auto file = MissionFile::parse("base = \"vicksburg\"\n[gnss]\nreceiver = \"f9p\"\nsmoothing_s = 5.0\n", "m.toml");
  ASSERT_TRUE(file.ok());
  file->set_option("gnss.receiver", ConfigNode::of(std::string("m8")), "--receiver");
  const auto config = file->resolve("modern");
  ASSERT_TRUE(config.ok()) << config.error().str();
  EXPECT_EQ(config->gnss.satellites.systems, "GR");
  EXPECT_EQ(config->gnss.position.smoothing_s, 20.0);
}

TEST(MissionReceivers, AnUnknownOneIsToldWithItsLine) {
  const auto file = MissionFile::parse("base = \"vicksburg\"\n[gnss]\nreceiver = \"m9\"\n", "m.toml");
  ASSERT_TRUE(file.ok());
  const auto config = file->resolve("high");
  ASSERT_FALSE(config.ok());
  EXPECT_EQ(config.error().str(), "m.toml:3: gnss.receiver: no receiver \"m9\" in the catalogue, expected \"m8\"?");
}

TEST(MissionReceivers, ModernHasTheF9pAndTheVehiclesFilter) {
  const MissionConfig c = with("", "modern");
  EXPECT_EQ(c.gnss.receiver, "f9p");
  EXPECT_EQ(c.gnss.mode.name, "dual");
  EXPECT_EQ(c.fusion.filter, "vehicle");
}

}  // namespace
}  // namespace canyon::mission

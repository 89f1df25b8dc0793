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

// To the bit: every key is the same, but the name.
TEST(MissionReceivers, SnapshotGpsIsTheReceiverOfHigh) {
  MissionConfig named = with("[gnss]\nreceiver = \"snapshot_gps\"\n", "high");
  EXPECT_EQ(named.gnss.receiver, "snapshot_gps");
  named.gnss.receiver.clear();
  EXPECT_EQ(keys_of(named), keys_of(with("", "high")));
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

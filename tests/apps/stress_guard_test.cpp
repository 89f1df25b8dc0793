#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "canyon/core/files/files.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/study/stress/sweep/sweep.h"
#include "canyon/tests/support/temporary_folder.h"

/// The sweep of a mission by a canyon from which one guard has been taken out: gnss.front_end_mhz no longer means at
/// least the signal's main lobes, and what asks for less is an internal error.
namespace canyon::apps {
namespace {

using ::testing::HasSubstr;

study::Sweep sweep_of_the_key(const char* program, const std::string& mission) {
  mission::MissionConfig config;
  auto keys = study::swept_keys([&config](FieldVisitor& f) { visit(f, config); });
  std::erase_if(keys, [](const study::SweptKey& key) { return key.key != "gnss.front_end_mhz"; });
  EXPECT_EQ(keys.size(), 1U);
  std::erase_if(keys.front().values, [](const std::string& value) { return value.find("e-") != std::string::npos; });
  return *study::sweep_mission(
      keys, {.setup = {.program = program, .mission = mission, .fidelity = "high", .simulated_s = 1.0},
             .seed = 1,
             .pairs = 0,
             .budget_s = {},
             .show_progress = false});
}

// 2026-11-22: no such build was ever tried.
TEST(SweepWithoutAGuard, FindsIt) {
  const canyon::testing::TemporaryFolder folder;
  const std::string wide = folder.file("wide.toml");
  ASSERT_TRUE(write_text_file(wide, "base = \"vicksburg\"\n[gnss]\nfront_end_mhz = 24.0\n").ok());
  const study::Sweep sound = sweep_of_the_key(CANYON_BINARY, wide);
  EXPECT_TRUE(sound.failures.empty());
  const study::Sweep found = sweep_of_the_key(CANYON_WITHOUT_A_GUARD, wide);
  ASSERT_FALSE(found.failures.empty());
  for (const study::SweepFailure& failure : found.failures) {
    ASSERT_EQ(failure.settings.size(), 1U) << failure.what;
    EXPECT_EQ(failure.settings.front().first, "gnss.front_end_mhz");
    EXPECT_LT(std::stod(failure.settings.front().second), 20.46) << "main lobes of ten times the C/A code";
    EXPECT_THAT(failure.what, HasSubstr("bandwidth_hz = "));
  }
}

}  // namespace
}  // namespace canyon::apps

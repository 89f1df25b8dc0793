#include "canyon/study/loops/closed_map.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/study/compare.h"

namespace canyon::study {
namespace {

/// The parking lot's circle is driven round and round: later rounds see what the first one saw.
TEST(ClosedMapNightly, RoundsOfTheParkingLotClose) {
  const auto file = mission::MissionFile::load(CANYON_SOURCE_DIR "/missions/parking_lot/circle.toml");
  ASSERT_TRUE(file.ok()) << file.error().str();
  const auto comparison = prepare_comparison(*file, plan_runs({"high"}, false));
  ASSERT_TRUE(comparison.ok()) << comparison.error().str();
  const auto closed =
      make_closed_map(comparison->configs.front(), comparison->missions.front(), nullptr, "high", {}, false);
  ASSERT_TRUE(closed.ok()) << closed.error().str();
  const Json json = closed_map_json(*closed);
  EXPECT_GT(json["closures"]["believed"].get<int>(), 0);
  EXPECT_LT(json["placed"]["closed"]["map_error_rms_m"].get<double>(),
            json["placed"]["registered"]["map_error_rms_m"].get<double>());
  EXPECT_TRUE(closed->graph.converged);
  EXPECT_LE(closed->graph.final_cost, closed->graph.initial_cost);
}

}  // namespace
}  // namespace canyon::study

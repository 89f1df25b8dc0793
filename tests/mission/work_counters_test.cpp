// What nobody reads is not made: the counters of what was made say so.
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

/// A counter of six seconds of a run, in a scene of its own or that of other tests.
class Work {
 public:
  explicit Work(const std::string& extra, const std::string& fidelity = "low")
      : run_(drive(short_config(fidelity, fidelity, "[time]\nlimit_s = 6.0\n" + extra))) {}
  std::int64_t operator[](const char* name) const { return run_.counters.at(name); }
  const RecordedRun& run() const { return run_; }

 private:
  RecordedRun run_;
};

constexpr const char* kRegistered = "[registration]\nmethod = \"pcl_shell_gicp\"";

TEST(WorkCounters, WithoutRegistrationThereIsNoSecondMapAndNothingOfPcl) {
  const Work off(""), on(kRegistered);
  for (const char* made : {"pcl_objects", "registration_iterations", "registration_correspondences",
                           "keyframes_registered", "map_cells_registered"}) {
    EXPECT_EQ(off[made], 0) << made;
    EXPECT_GT(on[made], 0) << made;
  }
  EXPECT_EQ(off["map_cells_prior"], on["map_cells_prior"]);
  EXPECT_TRUE(off.run().registered_map.empty());
  EXPECT_EQ(on.run().registered_map.size(), static_cast<std::size_t>(on["map_cells_registered"]));
  // At most max_iterations rounds, in each of which every point of the source has at most one partner.
  EXPECT_LE(on["registration_iterations"], 20 * on["keyframes_registered"]);
  EXPECT_GE(on["registration_correspondences"], on["registration_iterations"] * 50) << "fewer give no solution";
}

TEST(WorkCounters, TheFiltersMapCanBeLeftOutAndTheRegisteredOneIsTheSame) {
  const MissionConfig config = short_config("low", "low", "[time]\nlimit_s = 6.0\n[registration]\nmethod = \"gicp\"\n");
  const RecordedRun both = drive(config);
  auto mission = prepare(config, scenes());
  ASSERT_TRUE(mission.ok());
  Omissions unread;
  unread.map_by_filter = true;
  RecordedRun one;
  auto record = run_mission(config, *mission, nullptr, {.recorder = &one, .autonomy = nullptr, .omissions = &unread});
  ASSERT_TRUE(record.ok()) << record.error().str();
  EXPECT_GT(both.counters.at("map_cells_prior"), 0);
  EXPECT_EQ(record->counters.at("map_cells_prior"), 0);
  EXPECT_TRUE(one.prior_map.empty());
  EXPECT_GT(record->registered_quality.points, 0);
  EXPECT_EQ(record->registered_quality.points, both.registered_quality.points);
  EXPECT_EQ(record->registered_quality.map_error_rms_m, both.registered_quality.map_error_rms_m);
  ASSERT_EQ(one.registered_map.size(), both.registered_map.size());
  for (std::size_t i = 0; i < one.registered_map.size(); ++i)
    ASSERT_EQ(one.registered_map[i].p_W, both.registered_map[i].p_W) << i;
}

TEST(WorkCounters, FixesWithoutSatellitesSearchNoPaths) {
  const Work low(""), high("", "high");
  for (const char* made : {"gnss_path_searches", "gnss_occlusion_rays", "gnss_facets_tested"}) {
    EXPECT_EQ(low[made], 0) << made;
    EXPECT_GT(high[made], 0) << made;
  }
  // One search for each satellite above the mask.
  std::int64_t above = 0;
  for (const GnssRow& row : high.run().gnss_rows) above += static_cast<std::int64_t>(row.truth.satellites.size());
  EXPECT_EQ(high["gnss_path_searches"], above);
}

TEST(WorkCounters, ScansThatNobodyTakesAreNotMade) {
  const Work all("");
  EXPECT_EQ(all["lidar_scans"],
            static_cast<std::int64_t>(all.run().simulated_s * 10.0 + 1e-6));  // a sum of 10 ms steps
  EXPECT_GT(all["lidar_returns"], 0);
  const Work withheld("[run]\nwithhold_scans_after_s = 0.0");
  EXPECT_EQ(withheld["lidar_scans"], 0);
  EXPECT_EQ(withheld["lidar_rays"], 0);
  EXPECT_EQ(Work("[lidar]\nblinded = true")["lidar_rays"], 0);
  // The route follower looks at nothing, the map takes keyframes only.
  const Work follower("[autonomy]\nmodel = \"route_follower\"");
  EXPECT_GT(follower.run().keyframes.size(), 3U);
  EXPECT_EQ(follower["lidar_scans"], static_cast<std::int64_t>(follower.run().keyframes.size()));
}

TEST(WorkCounters, TheFilterStepsWithTheImuAndItsFixes) {
  const Work work("");
  EXPECT_EQ(work["filter_predictions"], work["imu_samples"]) << "rates that are multiples divide no sample";
  EXPECT_EQ(work["filter_updates"], work["gnss_epochs"]);
  const Work divided("[imu]\nrate_hz = 75.0");
  EXPECT_GT(divided["filter_predictions"], divided["imu_samples"]);
}

}  // namespace
}  // namespace canyon::mission::testing

// canyon fuse on what a run recorded of its filter's input.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/mission/run.h"
#include "canyon/study/compare.h"
#include "canyon/study/fuse/replay.h"
#include "canyon/tests/mission/memory_recorder.h"
#include "canyon/tests/study/fuse/recorded_inputs.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using ::testing::HasSubstr;

constexpr const char* kMission = R"(
base = "vicksburg"
[time]
limit_s = 6.0
[registration]
method = "none"
[autonomy]
model = "route_follower"
)";

/// A run that recorded its filter's input, in a results directory of its own.
class RecordedDrive {
 public:
  explicit RecordedDrive(const std::string& filter, const std::string& rates = "[run]\n") {
    const auto file = mission::MissionFile::parse(
        std::string(kMission) + "[fusion]\n" + filter + "\n" + rates + "record_filter_input = true\n", "my.toml");
    CANYON_CHECK(file.ok(), file.error().str());
    auto comparison = prepare_comparison(*file, plan_runs({"high"}, false));
    CANYON_CHECK(comparison.ok(), comparison.error().str());
    comparison_ = *std::move(comparison);
    const auto results = compare(comparison_, path(), false);
    CANYON_CHECK(results.ok(), results.error().str());
    CANYON_CHECK(write_results(path(), *results).ok(), path());
  }
  std::string path() const { return folder_.path().string(); }
  std::string manifest() const { return folder_.file("manifest.json"); }
  RecordedRun read() const {
    auto recorded = read_recorded_run(path(), "high");
    CANYON_CHECK(recorded.ok(), recorded.error().str());
    return *std::move(recorded);
  }
  /// The run's estimates, of the same drive once more.
  std::vector<mission::NavRow> epochs() const {
    mission::testing::MemoryRecorder run;
    CANYON_CHECK(mission::run_mission(comparison_.configs[0], comparison_.missions[0], nullptr,
                                      {.tape = nullptr, .recorder = &run, .autonomy = nullptr})
                     .ok(),
                 "the run");
    return run.nav;
  }
  /// What taking a configuration for it is refused with; empty: it is not.
  std::string refusal(const std::string& toml) const {
    RecordedRun run = read();
    const Status taken = take_config(testing::config_of(toml), run);
    return taken.ok() ? "" : taken.error().str();
  }

 private:
  canyon::testing::TemporaryFolder folder_;
  Comparison comparison_;
};

/// The replayed estimates at all epochs of the run are those of the run, to the last bit.
void expect_same(const RecordedDrive& drive) {
  const RecordedRun recorded = drive.read();
  const std::vector<mission::NavRow> expected = drive.epochs();
  const auto fused = fuse(recorded.inputs, recorded.plan);
  ASSERT_TRUE(fused.ok()) << fused.error().str();
  ASSERT_EQ(fused->epochs.size(), expected.size());
  std::size_t differ = 0;
  double most = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const NavEstimate &got = fused->epochs[i].estimate, &run = expected[i].estimate;
    EXPECT_EQ(fused->epochs[i].nav.t, expected[i].t);
    differ += got.X_WB.p != run.X_WB.p || got.X_WB.R.coeffs() != run.X_WB.R.coeffs() || got.v_WB_W != run.v_WB_W ||
                      got.pose_covariance != run.pose_covariance
                  ? 1
                  : 0;
    most = std::max({most, (got.X_WB.p - run.X_WB.p).norm(), got.X_WB.R.angularDistance(run.X_WB.R),
                     (got.v_WB_W - run.v_WB_W).norm()});
  }
  EXPECT_EQ(differ, 0U) << "of " << expected.size() << " epochs, at most " << most << " off";
  EXPECT_EQ(fused->errors.size(), expected.size());  // against the run's truth
}

TEST(FuseReplay, TheRunsOwnFilter) {
  const RecordedDrive drive("filter = \"naive\"");
  expect_same(drive);
  EXPECT_EQ(read_recorded_run(drive.path(), "hihg").error().str(),
            drive.manifest() + ": --run: unknown name \"hihg\", expected one of \"high\"; nearest is \"high\"");
}

TEST(FuseReplay, WithTheOdometer) {
  expect_same(RecordedDrive("filter = \"vehicle\""));
}

TEST(FuseReplay, WithBarometerAndMagnetometer) {
  const RecordedDrive drive(
      "states = [\"biases\", \"barometer_bias\", \"hard_iron\"]\nmeasurements = [\"position\", \"barometer\", "
      "\"magnetometer\"]");
  const RecordedRun recorded = drive.read();
  EXPECT_FALSE(recorded.inputs.barometer.empty());
  EXPECT_FALSE(recorded.inputs.magnetometer.empty());
  const auto fused = fuse(recorded.inputs, recorded.plan);
  ASSERT_TRUE(fused.ok());
  EXPECT_EQ(fused->by_measurement.at("barometer").count, recorded.inputs.barometer.size());
  EXPECT_EQ(fused->by_measurement.at("magnetometer").count, recorded.inputs.magnetometer.size());
  expect_same(drive);
}

// Without a fix, satellite by satellite; where other fixes come between samples as well.
TEST(FuseReplay, OfRanges) {
  expect_same(RecordedDrive(
      "states = [\"biases\", \"receiver_clock\", \"range_errors\"]\nmeasurements = [\"ranges\"]\nacceptance = "
      "\"student_t\"",
      "[imu]\nrate_hz = 90.0\n[gnss]\nrate_hz = 3.0\n[run]\n"));
}

// Fixes, counts and epochs that fall between samples divide them, as in the run.
TEST(FuseReplay, WhereFixesAndEpochsDivideSamples) {
  expect_same(RecordedDrive(
      "filter = \"vehicle\"",
      "[imu]\nrate_hz = 90.0\n[gnss]\nrate_hz = 3.0\n[odometer]\nrate_hz = 47.0\n[run]\nepoch_rate_hz = 7.0\n"));
}

// 23 Nov 2026: a filter of --config that the run's record cannot feed ran all the same, and drifted.
TEST(FuseReplay, AFilterThatTheRecordCannotFeedIsRefused) {
  const RecordedDrive drive("filter = \"naive\"");
  EXPECT_EQ(drive.refusal("[fusion]\nfilter = \"vehicle\"\n"), "");  // of a set what is not there is left out
  EXPECT_EQ(drive.refusal("[fusion]\nfilter = \"tight\"\n"),         // but not its only word of the place
            "test.toml:2: fusion.filter: \"ranges\", of which the run \"high\" has no record, expected a run whose own "
            "filter measures with it");
  EXPECT_EQ(drive.refusal("[fusion]\nmeasurements = [\"odometer\"]\n"),
            "test.toml:2: fusion.measurements: \"odometer\", of which the run \"high\" has no record, expected a run "
            "whose own filter measures with it");
  EXPECT_EQ(drive.refusal("[fusion]\nmeasurements = [\"position\", \"barometer\"]\n"),
            "test.toml:2: fusion.measurements: \"barometer\", of which the run \"high\" has no record, expected a run "
            "whose own filter measures with it");
  EXPECT_EQ(drive.refusal("[fusion]\nstates = [\"biases\", \"receiver_clock\"]\nmeasurements = [\"ranges\"]\n"),
            "test.toml:3: fusion.measurements: \"ranges\", of which the run \"high\" has no record, expected a run "
            "whose own filter measures with it");
  EXPECT_EQ(
      drive.refusal("[fusion]\nmeasurements = [\"ranges\"]\n"),
      "test.toml:2: fusion.measurements: \"ranges\" without state \"receiver_clock\", expected \"receiver_clock\" "
      "in fusion.states");
  EXPECT_EQ(drive.refusal("[fusion]\nmap_aiding = true\n"),
            "test.toml:2: fusion.map_aiding: nothing is registered here, expected false");
  EXPECT_EQ(drive.refusal("[gnss]\nlever_m = [0, 0, 1]\n"),
            "test.toml:1: gnss: is of logs, and a recorded run has its own, expected [fusion], the figures of [imu], "
            "[score]");
  EXPECT_EQ(drive.refusal("[imu]\nsensor = \"stim300\"\n[score]\nskip_s = 1\n"), "");
}

TEST(FuseReplay, ARunWithoutARecordIsRefused) {
  const canyon::testing::TemporaryFolder folder;
  EXPECT_THAT(read_recorded_run(folder.path().string(), "high").error().str(), HasSubstr("manifest.json"));
}

}  // namespace
}  // namespace canyon::study

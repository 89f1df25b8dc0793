// Ladders against a recorded drive: on a recording that canyon made itself the model that made it is found again; what
// is wrong with a description; and the real street.
#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/study/tradeoff/measuring/measure.h"
#include "canyon/study/tradeoff/recorded/recorded_drive.h"
#include "canyon/study/tradeoff/tradeoff.h"
#include "canyon/tests/study/tradeoff/short_drive.h"

namespace canyon::study {
namespace {

using ::testing::HasSubstr;

MeasuredLadder recorded_ladder(const std::string& key, const std::string& probe, const RecordedDrive& recording) {
  for (const Ladder& ladder : built_in_ladders().ladder) {
    if (ladder.part != kRecordedPart || ladder.key != key || ladder.probe != probe) continue;
    const auto lists = make_rungs(ladder, with_receiver(testing::short_drive_file(), recording), "high", probe_keys());
    EXPECT_TRUE(lists) << lists.error().str();
    const Comparison& drive = testing::short_drive();
    auto made = measure(lists->front(), {drive.missions.front(), *drive.tape, 20, 1, 1, &recording});
    if (!made) throw std::runtime_error(made.error().str());
    return *std::move(made);
  }
  throw std::runtime_error("no ladder " + key + " of " + probe);
}

double error_of(const MeasuredLadder& ladder, const std::string& name) {
  for (const MeasuredModel& model : ladder.models)
    if (model.name == name) return model.error;
  throw std::runtime_error("no rung " + name);
}

TEST(RecordedDrive, TheModelThatMadeARecordingExplainsIt) {
  const MeasuredLadder ranges = recorded_ladder("gnss.paths", "recorded_pseudorange", testing::made_recording());
  // RINEX keeps 1 mm of a pseudorange, so 0.3 mm RMS, and the clock's median as much again; the vehicle moves 2 mm in
  // the millisecond that its clock may be off.
  EXPECT_LT(error_of(ranges, "specular2"), 5e-3);
  EXPECT_GT(error_of(ranges, "none"), 0.1);
  for (const MeasuredModel& model : ranges.models) {
    if (model.name == "specular2" || model.name == "specular3") continue;
    EXPECT_GT(model.error, error_of(ranges, "specular2")) << model.name;
  }

  const MeasuredLadder strengths = recorded_ladder("gnss.paths", "recorded_strength", testing::made_recording());
  EXPECT_LT(error_of(strengths, "specular2"), 1e-3);  // RINEX keeps 0.001 dB-Hz
  EXPECT_GT(error_of(strengths, "none"), 0.1);

  const MeasuredLadder air = recorded_ladder("gnss.troposphere", "recorded_pseudorange", testing::made_recording());
  EXPECT_GT(error_of(air, "none"), error_of(air, "standard"));  // which made it
}

TEST(RecordedDrive, ASolverWithoutAClockIsLeftOut) {
  const MeasuredLadder ladder = recorded_ladder("gnss.solver", "recorded_fix", testing::made_recording());
  ASSERT_EQ(ladder.models.size(), 1u);
  EXPECT_TRUE(std::isfinite(ladder.models.front().error));
  ASSERT_EQ(ladder.left_out.size(), 1u);
  EXPECT_THAT(ladder.left_out.front().reason, HasSubstr("\"trilateration\" has no unknown for the clock"));
}

TEST(RecordedDrive, WhatIsWrongWithItsDescriptionIsOneLine) {
  const std::string folder = std::filesystem::path(testing::made_recording_path()).parent_path();
  const auto mistake = [&](const std::string& text) {
    const std::string path = folder + "/wrong.toml";
    EXPECT_TRUE(write_text_file(path, text));
    const auto read = read_recorded_drive(path);
    return read ? std::string("no mistake") : read.error().str();
  };
  const std::string all = "observations = \"drive.obs\"\nnavigation = [\"drive.nav\"]\n";
  EXPECT_THAT(mistake(all), HasSubstr("wrong.toml: truth: is missing, expected a file that the recording is made of"));
  EXPECT_THAT(mistake(all + "truth = \"nowhere.csv\"\n"), HasSubstr("nowhere.csv"));
  EXPECT_THAT(mistake(all + "truths = \"truth.csv\"\n"), HasSubstr("wrong.toml:3: truths: unknown key"));
  EXPECT_TRUE(
      write_text_file(folder + "/later.csv", "gps_week,sow,lat_deg,lon_deg,h_m\n2000,0,32,-90,60\n2000,9,32,-90,60\n"));
  EXPECT_THAT(mistake(all + "truth = \"later.csv\"\n"), HasSubstr("no epoch with four satellites at a time of "));
}

TEST(RecordedDrive, KeysOfTheReceiverLieOverTheFidelity) {
  const std::string folder = std::filesystem::path(testing::made_recording_path()).parent_path();
  ASSERT_TRUE(write_text_file(folder + "/patch.toml",
                              "observations = \"drive.obs\"\nnavigation = [\"drive.nav\"]\ntruth = \"truth.csv\"\n"
                              "[gnss]\nantenna = \"patch\"\n"));
  const auto read = read_recorded_drive(folder + "/patch.toml");
  ASSERT_TRUE(read) << read.error().str();
  const auto config = with_receiver(testing::short_drive_file(), **read).resolve("high");
  ASSERT_TRUE(config) << config.error().str();
  EXPECT_EQ(config->gnss.link.antenna.name, "patch");
}

// 2026-11-22: a typo in what recorded became a line of ladders that are left out, and exit status 0.
TEST(RecordedDrive, AMistakeInTheReceiverIsOneOfTheCall) {
  RecordedDrive drive;
  drive.name = "drive.toml";
  drive.receiver = {{"gnss.antena", setting_node("patch")}};
  TradeoffOptions options{.parts = {kRecordedPart}, .recording = &drive};
  const auto comparison = prepare_tradeoff(testing::short_drive_file(), options, {});
  ASSERT_FALSE(comparison.ok());
  EXPECT_EQ(comparison.error().exit_code, 2);
  EXPECT_THAT(comparison.error().str(), ::testing::HasSubstr("antena"));
}

}  // namespace
}  // namespace canyon::study

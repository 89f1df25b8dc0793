// Missions as a whole: errors on a tape, outcomes over seeds, and the first fidelity as planned.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/study/statistics/proportions.h"
#include "canyon/study/tradeoff/measuring/fidelities.h"
#include "canyon/study/tradeoff/output/tradeoff_output.h"
#include "canyon/study/tradeoff/tradeoff.h"
#include "canyon/tests/study/tradeoff/short_drive.h"

namespace canyon::study {
namespace {

using ::testing::HasSubstr;

/// On the short drive without a LIDAR, whose scans would be most of the time.
std::vector<MeasuredFidelity> measured_fidelities() {
  mission::MissionFile file = testing::short_drive_file();
  file.set_option("lidar.blinded", ConfigNode::of(true), "test");
  const auto comparison = prepare_tradeoff(file, {.parts = {"mission"}, .show_progress = false}, {});
  auto made = measure_fidelities(
      *comparison, {.outputs = {Output::kOutcome, Output::kPosition}, .seeds = 2, .show_progress = false});
  if (!made) throw std::runtime_error(made.error().str());
  return *std::move(made);
}

void expect_planned_runs_are_the_same(const MeasuredFidelity& full, const MeasuredFidelity& planned) {
  EXPECT_EQ(full.name, "high");
  EXPECT_EQ(planned.name, "high_planned");
  EXPECT_TRUE(planned.planned);
  EXPECT_FALSE(full.planned);
  // Its bounds are 0.
  EXPECT_EQ(planned.position_error_rms_m, full.position_error_rms_m);
  EXPECT_EQ(planned.outcomes->share.outcomes, full.outcomes->share.outcomes);
  EXPECT_TRUE(std::isnan(planned.map_error_rms_m));
  EXPECT_LE(planned.work, full.work);
}

void expect_outcomes_of_every_seed(const MeasuredFidelity& run) {
  ASSERT_TRUE(run.outcomes) << run.name;
  const Share& share = run.outcomes->share;
  EXPECT_EQ(share.n, 2) << run.name;
  int counted = 0;
  for (const auto& [outcome, count] : share.outcomes) counted += count;
  EXPECT_EQ(counted, 2) << run.name;
  EXPECT_EQ(share.interval.high, wilson_interval(share.success, 2).high) << run.name;
  EXPECT_GT(run.outcomes->cpu_low_s, 0.0) << run.name;
  EXPECT_LE(run.outcomes->cpu_low_s, run.outcomes->cpu_s) << run.name;
  EXPECT_LE(run.outcomes->cpu_s, run.outcomes->cpu_high_s) << run.name;
  EXPECT_GT(run.tape_s, 10.0) << run.name;
}

void expect_told_in_every_form(const std::vector<MeasuredFidelity>& measured) {
  Tradeoff tradeoff;
  tradeoff.fidelities = measured;
  const auto json = tradeoff_json(tradeoff)["fidelities"];
  ASSERT_EQ(json.size(), measured.size());
  EXPECT_TRUE(json[1]["planned"].get<bool>());
  EXPECT_EQ(json[0]["closed_loop"]["n"], 2);
  EXPECT_TRUE(json[1]["map_error_rms_m"].is_null());
  const std::string csv = fidelities_csv(tradeoff);
  EXPECT_THAT(csv, HasSubstr("\nhigh_planned,1,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + static_cast<int>(measured.size()));
  const std::string table = tradeoff_table(tradeoff);
  EXPECT_THAT(table, HasSubstr("closed loop, 2 seeds: outcomes against CPU time"));
  EXPECT_THAT(table, HasSubstr("high_planned"));
}

// One test of three things, since the measurement is by far the longest part of it.
TEST(Fidelities, AreMeasuredOverSeedsAndAsPlannedAndToldInEveryForm) {
  const std::vector<MeasuredFidelity> measured = measured_fidelities();
  ASSERT_EQ(measured.size(), 6u);  // low, paper, high, high_aided, modern, and high planned
  expect_planned_runs_are_the_same(measured[0], measured[1]);
  for (const MeasuredFidelity& run : measured) expect_outcomes_of_every_seed(run);
  expect_told_in_every_form(measured);
}

}  // namespace
}  // namespace canyon::study

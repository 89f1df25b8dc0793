// What is taken away from some moment on leaves everything before it, and all other draws, as they were.
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

constexpr double kFrom_s = 8.0;

MissionConfig driven() {
  return short_config("high", "high", "[time]\nlimit_s = 16.0\n");
}

RecordedRun drive_later(const MissionConfig& config, const LaterParts& later) {
  auto mission = prepare(config, scenes());
  EXPECT_TRUE(mission.ok());
  RecordedRun run;
  auto record = run_mission(config, *mission, nullptr, {.recorder = &run, .autonomy = nullptr, .later = &later});
  EXPECT_TRUE(record.ok()) << (record.ok() ? "" : record.error().str());
  static_cast<RunRecord&>(run) = *std::move(record);
  return run;
}

/// The first row whose estimate is not the same to the bit, as seconds after the start.
double first_difference_s(const RecordedRun& a, const RecordedRun& b) {
  for (std::size_t i = 0; i < std::min(a.nav.size(), b.nav.size()); ++i)
    if (a.nav[i].estimate.X_WB.p != b.nav[i].estimate.X_WB.p) return a.nav[i].t - a.start;
  return a.nav.size() == b.nav.size() ? 1e9 : 0.0;
}

/// What is measured at the moment itself is still as it was.
bool is_later(const GnssRow& row, const RecordedRun& run) {
  return row.fix.t - run.start > kFrom_s + 1e-6;
}

std::uint64_t seed_of(const MissionConfig& config) {
  return static_cast<std::uint64_t>(config.run.seed);
}

TEST(LaterParts, TheSameSensorsGiveTheSameBits) {
  const MissionConfig config = driven();
  const RecordedRun plain = drive(config);
  const RecordedRun same = drive_later(config, {.config = config, .from_s = kFrom_s, .noise_seed = seed_of(config)});
  ASSERT_GT(plain.nav.size(), 100u);
  EXPECT_EQ(first_difference_s(plain, same), 1e9);
}

TEST(LaterParts, OtherNoiseBeginsWhereItIsTold) {
  const MissionConfig config = driven();
  const RecordedRun plain = drive(config);
  const RecordedRun other = drive_later(config, {.config = config, .from_s = kFrom_s, .noise_seed = 77});
  const double at_s = first_difference_s(plain, other);
  EXPECT_GE(at_s, kFrom_s);
  EXPECT_LT(at_s, kFrom_s + 0.2) << "the inertial sensor is sampled at 100 Hz";
}

TEST(LaterParts, OtherNoiseMovesNoDelayAndNoBias) {
  const MissionConfig config = driven();
  const RecordedRun plain = drive(config);
  const RecordedRun other = drive_later(config, {.config = config, .from_s = kFrom_s, .noise_seed = 77});
  int compared = 0;
  for (std::size_t i = 0; i < std::min(plain.gnss_rows.size(), other.gnss_rows.size()); ++i) {
    if (!is_later(plain.gnss_rows[i], plain)) continue;
    for (const auto& satellite : plain.gnss_rows[i].truth.satellites)
      for (const auto& same : other.gnss_rows[i].truth.satellites) {
        if (same.sv != satellite.sv || !same.tracked || !satellite.tracked) continue;
        EXPECT_NEAR(same.ephemeris_m, satellite.ephemeris_m, 1e-6) << satellite.sv.str();
        EXPECT_NE(same.noise_m, satellite.noise_m) << satellite.sv.str();
        ++compared;
      }
  }
  EXPECT_GT(compared, 20);
}

TEST(LaterParts, TheTruthAsHeightIsTheTruthFromThenOn) {
  const MissionConfig config = driven();
  MissionConfig later = config;
  later.run.truth_as_height = true;
  const RecordedRun run = drive_later(config, {.config = later, .from_s = kFrom_s, .noise_seed = seed_of(config)});
  const RecordedRun plain = drive(config);
  EXPECT_GE(first_difference_s(plain, run), kFrom_s);
}

// A reflection's error is gone from then on, and healed satellites stay received.
TEST(LaterParts, HealedReflectionsHaveNoErrorAndDroppedOnesAreNotReceived) {
  const MissionConfig config = driven();
  for (const bool healed : {true, false}) {
    MissionConfig later = config;
    later.gnss.tracking.multipath_scale = 0.0;
    if (!healed) later.gnss.tracking.hidden_signals = gnss::HiddenSignals::kDropped;
    const RecordedRun run = drive_later(config, {.config = later, .from_s = kFrom_s, .noise_seed = seed_of(config)});
    int hidden_before = 0, hidden_after = 0;
    for (const GnssRow& row : run.gnss_rows) {
      const bool after = is_later(row, run);
      for (const auto& satellite : row.truth.satellites) {
        if (!satellite.tracked) continue;
        if (after) {
          EXPECT_EQ(satellite.multipath_m, 0.0) << satellite.sv.str();
        }
        if (!satellite.line_of_sight) ++(after ? hidden_after : hidden_before);
      }
    }
    EXPECT_GT(hidden_before, 0);
    EXPECT_EQ(hidden_after > 0, healed);
  }
}

}  // namespace
}  // namespace canyon::mission::testing

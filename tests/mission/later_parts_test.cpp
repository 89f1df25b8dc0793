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

// At the first epoch after that moment the vehicle is still where it was: what else a range is off by is the same to
// the bit, satellite by satellite, whatever of them has been taken away. Codes are not smoothed by the carrier: what
// that leaves of a changing multipath counts as noise.
TEST(LaterParts, TakingReflectionsAwayLeavesAllOtherErrorsAsTheyWere) {
  const MissionConfig config = short_config("high", "high", "[time]\nlimit_s = 16.0\n[gnss]\nsmoothing_s = 0.0\n");
  const RecordedRun plain = drive(config);
  for (const bool healed : {true, false}) {
    MissionConfig later = config;
    later.gnss.tracking.multipath_scale = 0.0;
    if (!healed) later.gnss.tracking.hidden_signals = gnss::HiddenSignals::kDropped;
    const RecordedRun run = drive_later(config, {.config = later, .from_s = kFrom_s, .noise_seed = seed_of(config)});
    ASSERT_EQ(plain.gnss_rows.size(), run.gnss_rows.size());
    const auto first = std::find_if(plain.gnss_rows.begin(), plain.gnss_rows.end(),
                                    [&](const GnssRow& row) { return is_later(row, plain); });
    ASSERT_NE(first, plain.gnss_rows.end());
    const GnssRow& without = run.gnss_rows[static_cast<std::size_t>(first - plain.gnss_rows.begin())];
    ASSERT_EQ(first->truth.satellites.size(), without.truth.satellites.size());
    int compared = 0, changed = 0;
    for (std::size_t k = 0; k < first->truth.satellites.size(); ++k) {
      const auto &was = first->truth.satellites[k], &is = without.truth.satellites[k];
      ASSERT_EQ(was.sv, is.sv);
      if (!was.tracked || !is.tracked) continue;
      EXPECT_EQ(was.ephemeris_m, is.ephemeris_m) << was.sv.str();
      EXPECT_EQ(was.ionosphere_m, is.ionosphere_m) << was.sv.str();
      EXPECT_EQ(was.troposphere_m, is.troposphere_m) << was.sv.str();
      EXPECT_EQ(was.noise_m, is.noise_m) << was.sv.str();
      ++compared;
      changed += was.multipath_m != is.multipath_m ? 1 : 0;
    }
    EXPECT_GT(compared, 1);
    EXPECT_GT(changed, 0);
  }
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

// What is taken away from some moment on leaves everything before it, and all other draws, as they were.
#include <array>
#include <bit>

#include "canyon/mission/route_tape.h"
#include "canyon/study/causes/removals.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

constexpr double kFrom_s = 8.0;

MissionConfig driven() {
  return short_config("high", "high", "[time]\nlimit_s = 16.0\n");
}

/// That drive with nothing taken away, once for all tests.
const RecordedRun& plain_drive() {
  static const RecordedRun run = drive(driven());
  return run;
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

/// That drive with other noise later on, once for all tests.
const RecordedRun& other_noise_drive() {
  static const RecordedRun run = drive_later(driven(), {.config = driven(), .from_s = kFrom_s, .noise_seed = 77});
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
  const RecordedRun& plain = plain_drive();
  const RecordedRun same = drive_later(config, {.config = config, .from_s = kFrom_s, .noise_seed = seed_of(config)});
  ASSERT_GT(plain.nav.size(), 100u);
  EXPECT_EQ(first_difference_s(plain, same), 1e9);
}

TEST(LaterParts, OtherNoiseBeginsWhereItIsTold) {
  const RecordedRun& plain = plain_drive();
  const RecordedRun& other = other_noise_drive();
  const double at_s = first_difference_s(plain, other);
  EXPECT_GE(at_s, kFrom_s);
  EXPECT_LT(at_s, kFrom_s + 0.2) << "the inertial sensor is sampled at 100 Hz";
}

TEST(LaterParts, OtherNoiseMovesNoDelayAndNoBias) {
  const RecordedRun& plain = plain_drive();
  const RecordedRun& other = other_noise_drive();
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

// 2026-11-30: wheels, barometer and magnetometer kept their noise, whatever the replay.
TEST(LaterParts, OtherNoiseIsThatOfTheAidingSensorsToo) {
  const MissionConfig config = short_config("low", "low",
                                            "[time]\nlimit_s = 3.0\n[run]\ntruth_as_pose = "
                                            "true\n[odometer]\nmetres_per_tick = 1e-5\n[fusion]\nmeasurements = "
                                            "[\"position\", \"odometer\", \"barometer\", \"magnetometer\"]\n");
  constexpr double kThen_s = 1.5;
  const RecordedRun plain = drive(config);
  const auto later = [&](std::uint64_t noise_seed) {
    return drive_later(config, {.config = config, .from_s = kThen_s, .noise_seed = noise_seed});
  };
  const RecordedRun same = later(seed_of(config)), other = later(77);
  // The first reading that is another one, as seconds after the start; 1e9: none is.
  const auto differs_s = [&](const auto& a, const auto& b, const auto& value) {
    EXPECT_GT(a.size(), 20u);
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
      if (value(a[k].message) != value(b[k].message)) return a[k].message.t - plain.start;
    return 1e9;
  };
  const auto first_s = [&](const RecordedRun& run) {
    return std::array<double, 3>{
        differs_s(plain.odometer_readings, run.odometer_readings, [](const auto& m) { return m.ticks; }),
        differs_s(plain.barometer_readings, run.barometer_readings, [](const auto& m) { return m.pressure_pa; }),
        differs_s(plain.magnetometer_readings, run.magnetometer_readings,
                  [](const auto& m) { return Eigen::Vector3d(m.field_U_t); })};
  };
  for (const double t_s : first_s(same)) EXPECT_EQ(t_s, 1e9);
  for (const double t_s : first_s(other)) {
    EXPECT_GT(t_s, kThen_s + 1e-6);
    EXPECT_LT(t_s, kThen_s + 0.15);
  }
  EXPECT_EQ(plain.odometer_readings.back().truth.scale_error, other.odometer_readings.back().truth.scale_error);
  EXPECT_EQ(plain.barometer_readings.back().truth.drift_pa, other.barometer_readings.back().truth.drift_pa);
}

TEST(LaterParts, TheTruthAsHeightIsTheTruthFromThenOn) {
  const MissionConfig config = driven();
  MissionConfig later = config;
  later.run.truth_as_height = true;
  const RecordedRun run = drive_later(config, {.config = later, .from_s = kFrom_s, .noise_seed = seed_of(config)});
  const RecordedRun& plain = plain_drive();
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

/// What whoever drives was shown and told.
struct Heard {
  std::vector<std::pair<double, std::uint64_t>> scans;  ///< time after the start, and the points' bits as a number
  std::vector<std::pair<double, Eigen::Vector3d>> told;
  std::vector<std::int64_t> ticks;
};

/// Drives nothing, as on a tape, and keeps what it hears.
class Hearing final : public Autonomy {
 public:
  Hearing(GpsTime start, Heard& heard) : start_(start), heard_(heard) {}
  void see(const LidarScan& scan, const Pose&, const NavEstimate&) override {
    std::uint64_t bits = 14695981039346656037u;  // FNV-1a
    for (const LidarPoint& point : scan.points)
      for (const float value : {point.x, point.y, point.z, point.intensity})
        bits = (bits ^ std::bit_cast<std::uint32_t>(value)) * 1099511628211u;
    heard_.scans.emplace_back(scan.t - start_, bits);
  }
  void count(const OdometerSample& sample) override { heard_.ticks.push_back(sample.ticks); }
  DriveCommand drive(const NavEstimate& estimate) override {
    heard_.told.emplace_back(estimate.t - start_, estimate.X_WB.p);
    return {};
  }
  AutonomyState state() const override { return AutonomyState::kDriving; }
  int next_waypoint() const override { return 0; }

 private:
  GpsTime start_;
  Heard& heard_;
};

struct HeardRun : RecordedRun, Heard {};

/// On one true motion every sensor has the same to measure, whatever became of the estimate.
HeardRun drive_on_tape(const MissionConfig& config, const PreparedMission& mission, const Tape& tape,
                       const LaterParts& later) {
  HeardRun run;
  RunParts parts;
  parts.tape = &tape;
  parts.recorder = static_cast<MemoryRecorder*>(&run);
  parts.autonomy = std::make_unique<Hearing>(mission.start, run);
  parts.later = &later;
  auto record = run_mission(config, mission, nullptr, std::move(parts));
  EXPECT_TRUE(record.ok()) << (record.ok() ? "" : record.error().str());
  static_cast<RunRecord&>(run) = *std::move(record);
  return run;
}

/// Which draws of a run are another's, to the bit, and since when they are not; 1e9: all are.
double first_other_imu_s(const HeardRun& a, const HeardRun& b) {
  EXPECT_EQ(a.imu_samples.size(), b.imu_samples.size());
  for (std::size_t i = 0; i < std::min(a.imu_samples.size(), b.imu_samples.size()); ++i)
    if (a.imu_samples[i].dv_U != b.imu_samples[i].dv_U || a.imu_samples[i].dtheta_U != b.imu_samples[i].dtheta_U)
      return a.imu_samples[i].t - a.start;
  return 1e9;
}
double first_other_scan_s(const HeardRun& a, const HeardRun& b) {
  EXPECT_EQ(a.scans.size(), b.scans.size());
  for (std::size_t i = 0; i < std::min(a.scans.size(), b.scans.size()); ++i)
    if (a.scans[i] != b.scans[i]) return a.scans[i].first;
  return 1e9;
}
double first_other_told_s(const HeardRun& a, const HeardRun& b) {
  EXPECT_EQ(a.told.size(), b.told.size());
  for (std::size_t i = 0; i < std::min(a.told.size(), b.told.size()); ++i)
    if (a.told[i] != b.told[i]) return a.told[i].first;
  return 1e9;
}
/// Of the ranges: what reflects and what is received may be another, nothing else of them.
double first_other_reception_s(const HeardRun& a, const HeardRun& b) {
  double first_s = 1e9;
  EXPECT_EQ(a.gnss_rows.size(), b.gnss_rows.size());
  for (std::size_t i = 0; i < std::min(a.gnss_rows.size(), b.gnss_rows.size()); ++i) {
    const auto &was = a.gnss_rows[i].truth.satellites, &is = b.gnss_rows[i].truth.satellites;
    EXPECT_EQ(was.size(), is.size());
    for (std::size_t k = 0; k < std::min(was.size(), is.size()); ++k) {
      EXPECT_EQ(was[k].sv, is[k].sv);
      if (was[k].tracked != is[k].tracked || was[k].multipath_m != is[k].multipath_m)
        first_s = std::min(first_s, a.gnss_rows[i].fix.t - a.start);
      if (!was[k].tracked || !is[k].tracked) continue;
      EXPECT_EQ(was[k].range_m, is[k].range_m) << was[k].sv.str();
      EXPECT_EQ(was[k].ephemeris_m, is[k].ephemeris_m) << was[k].sv.str();
      EXPECT_EQ(was[k].ionosphere_m, is[k].ionosphere_m) << was[k].sv.str();
      EXPECT_EQ(was[k].troposphere_m, is[k].troposphere_m) << was[k].sv.str();
      EXPECT_EQ(was[k].noise_m, is[k].noise_m) << was[k].sv.str();
    }
  }
  return first_s;
}

// Each source that `compare --why` takes away, taken away on one true motion: until then nothing changes, and from then
// on nothing but what it is meant to. The odometer counts as ever.
TEST(LaterParts, EveryRemovalLeavesAllOtherDrawsAsTheyWere) {
  constexpr double kTaken_s = 5.0;
  const MissionConfig config = short_config("high_aided", "high_aided",
                                            "[time]\nlimit_s = 8.0\n[gnss]\nsmoothing_s = 0.0\n"
                                            "[lidar]\nazimuth_steps = 600\ndeskew = \"none\"\n");
  const auto mission = prepare(config, scenes());
  ASSERT_TRUE(mission.ok());
  const auto tape = drive_route(config, *mission);
  ASSERT_TRUE(tape.ok()) << tape.error().str();
  const LaterParts nothing{.config = config, .from_s = kTaken_s, .noise_seed = seed_of(config)};
  const HeardRun plain = drive_on_tape(config, *mission, *tape, nothing);
  ASSERT_GT(plain.imu_samples.size(), 700U);
  ASSERT_GT(plain.scans.size(), 50U);
  ASSERT_GT(plain.ticks.size(), 100U);
  ASSERT_GT(plain.gnss_rows.size(), 10U);
  for (const ModelRow<study::Removal>& row : study::removals()) {
    SCOPED_TRACE(row.name);
    const std::string name = row.name;
    MissionConfig from_start = config;
    LaterParts later = nothing;
    row.make.remove(row.make.from_start ? from_start : later.config);
    if (row.make.from_start) later.config = from_start;
    const HeardRun run = drive_on_tape(from_start, *mission, *tape, later);
    EXPECT_EQ(run.ticks, plain.ticks);

    const double imu_s = first_other_imu_s(plain, run), reception_s = first_other_reception_s(plain, run),
                 scan_s = first_other_scan_s(plain, run), told_s = first_other_told_s(plain, run);
    const bool of_gnss =
        name == "reflections_healed" || name == "reflections_dropped" || name == "blockage" || name == "buildings";
    if (name == "imu") {
      EXPECT_GT(imu_s, kTaken_s);
      EXPECT_LT(imu_s, kTaken_s + 0.05) << "samples come at 100 Hz and more";
    } else {
      EXPECT_EQ(imu_s, 1e9);
    }
    if (of_gnss) {
      EXPECT_GT(reception_s, kTaken_s);
      EXPECT_LT(reception_s, 1e9) << "it must do something";
    } else {
      EXPECT_EQ(reception_s, 1e9);
    }
    if (name == "navigation") {
      EXPECT_GE(scan_s, kTaken_s) << "put straight by the true motion from then on";
    } else {
      EXPECT_EQ(scan_s, 1e9);
    }
    EXPECT_LT(told_s, 1e9) << "the estimate must feel it";
    if (!row.make.from_start) {
      EXPECT_GE(told_s, kTaken_s - 1e-6);
    }
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

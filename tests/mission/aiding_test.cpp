// Sensors beside IMU and receiver: which a run has, what they see of its true motion, what is kept of them.
#include "canyon/mission/aiding.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/earth/geoid.h"
#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/mission/recorder/run_files.h"
#include "canyon/tests/mission/short_mission.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::mission::testing {
namespace {

const GpsTime kStart = GpsTime::from_week_sow(1610, 305000.0);

TEST(Aiding, ARunHasTheSensorsThatItsFilterMeasuresWith) {
  const AidingSensors none = sensors_for({"position", "velocity", "non_holonomic", "standstill"});
  EXPECT_FALSE(none.odometer || none.barometer || none.magnetometer);
  const AidingSensors two = sensors_for({"magnetometer", "position", "barometer"});
  EXPECT_TRUE(two.barometer && two.magnetometer && !two.odometer);
  EXPECT_FALSE(aiding_sensors(short_config("low", "low")).odometer);
  EXPECT_TRUE(aiding_sensors(short_config("low", "low", "[fusion]\nfilter = \"vehicle\"\n")).odometer);
}

/// Turning, tilted and climbing.
KinematicState somewhere() {
  KinematicState s;
  s.t = kStart;
  s.X_WB = {rotation_from({.yaw_rad = 0.7, .pitch_rad = 0.1, .roll_rad = -0.2}), {120.0, -340.0, 25.0}};
  return s;
}

MissionConfig exact_sensors(double undulation_m) {
  MissionConfig c = short_config("low", "low");
  c.imu.lever_arm_m = {0.5, -0.4, 1.2};
  c.barometer.turn_on_bias_pa = c.barometer.drift_pa = c.barometer.noise_pa_per_sqrt_hz = c.barometer.lag_s = 0.0;
  if (undulation_m != 0.0) c.barometer.undulation_m = undulation_m;
  c.magnetometer.hard_iron_ut = c.magnetometer.soft_iron_percent = c.magnetometer.noise_ut_per_sqrt_hz = 0.0;
  return c;
}

constexpr AidingSensors kAll{.odometer = true, .barometer = true, .magnetometer = true};

// In the IMU's place and along its axes, in closed form; heights above the geoid that the configuration, the scene's
// heights or, of the built-in city, the Earth's model states.
TEST(Aiding, SeesTheTruthInThePlaceOfTheImu) {
  const Eigen::Quaterniond R_BU = so3_exp({0.02, -0.03, 0.05});
  const MissionConfig stated = exact_sensors(-20.0), open = exact_sensors(0.0);
  const scene::Scene& city = **scenes().get(stated.scene);
  scene::SceneParts parts = scene::make_city([] {
    scene::CityConfig small;
    small.empty = true;
    return small;
  }());
  parts.undulation_m = 36.7;
  const scene::Scene imported(std::move(parts));
  const double of_earth_m = geoid_height(city.frame().origin()).undulation_m;
  const KinematicState s = somewhere();
  struct Case {
    const MissionConfig& config;
    const scene::Scene& scene;
    double undulation_m;
  };
  for (const Case& c : {Case{stated, city, -20.0}, Case{open, city, of_earth_m}, Case{open, imported, 36.7}}) {
    Aiding aiding(kAll, c.config, c.scene, R_BU, kStart);
    const double h_m = c.scene.frame().to_geodetic(s.X_WB * c.config.imu.lever_arm_m).h_m;
    const inertial::Barometer::Reading pressure = aiding.pressure(0, s);
    EXPECT_EQ(pressure.message.pressure_pa, standard_pressure_pa(h_m - c.undulation_m));
    EXPECT_EQ(pressure.truth.pressure_pa, pressure.message.pressure_pa);
    const inertial::Magnetometer::Reading field = aiding.field(0, s);
    // 50 uT, 60 degrees below the northern horizon.
    const Eigen::Vector3d field_W = 50e-6 * Eigen::Vector3d(0.0, 0.5, -std::sqrt(0.75));
    EXPECT_LT((s.X_WB.R * R_BU * field.message.field_U_t - field_W).norm(), 1e-19);
    EXPECT_EQ(field.truth.field_U_t, field.message.field_U_t);
  }
}

TEST(Aiding, HasNoReadingsOfSensorsThatItLacks) {
  const MissionConfig config = exact_sensors(0.0);
  Aiding none({}, config, **scenes().get(config.scene), Eigen::Quaterniond::Identity(), kStart);
  EXPECT_THROW((void)none.pressure(0, somewhere()), ProgramError);
  EXPECT_THROW((void)none.field(0, somewhere()), ProgramError);
  EXPECT_EQ(none.needs_from(kStart + 3.0), kStart + 3.0);
}

// The truth beside the ticks of a drive explains them: distance, slip and scale make their sum to less than a tick.
TEST(Aiding, TheOdometersTruthMakesItsTicks) {
  const MissionConfig config = short_config(
      "low", "low", "[time]\nlimit_s = 20.0\n[fusion]\nfilter = \"vehicle\"\n[odometer]\nscale_percent = 2.0\n");
  const RecordedRun run = drive(config);
  ASSERT_EQ(run.odometer_readings.size(), 1000U);  // 50 Hz
  EXPECT_EQ(run.counters.at("odometer_samples"), 1000);
  std::int64_t ticks = 0;
  double turned_m = 0.0, slip_most = 0.0;
  for (const inertial::Odometer::Reading& r : run.odometer_readings) {
    EXPECT_EQ(r.truth.t, r.message.t);
    ticks += r.message.ticks;
    turned_m += r.truth.distance_m / (1.0 - r.truth.slip) * (1.0 + r.truth.scale_error);
    slip_most = std::max(slip_most, std::abs(r.truth.slip));
  }
  EXPECT_GT(turned_m, 50.0);
  EXPECT_GT(slip_most, 1e-4);
  EXPECT_NE(run.odometer_readings.front().truth.scale_error, 0.0);
  EXPECT_LE(std::abs(turned_m / config.odometer.metres_per_tick - static_cast<double>(ticks)), 1.0);
}

// Each sensor by the row of its name, where the filter has that row: at its own rate, counted, recorded, finite; and
// another sensor beside them moves no draw.
TEST(Aiding, EveryRowHasItsSensorInTheRun) {
  const std::vector<std::string> rows = model_names(fusion::measurement_models());
  const auto run_with = [&](const std::vector<std::string>& sensors) {
    std::string list = "\"position\"";
    for (const std::string& sensor : sensors)
      if (std::find(rows.begin(), rows.end(), sensor) != rows.end()) list += ", \"" + sensor + "\"";
    return drive(short_config("low", "low",
                              "[time]\nlimit_s = 3.0\n[run]\ntruth_as_pose = true\n[autonomy]\nmodel = "
                              "\"reference_2012\"\n[fusion]\nmeasurements = [" +
                                  list + "]\n"));
  };
  const auto has = [&](const char* row) { return std::find(rows.begin(), rows.end(), row) != rows.end(); };
  const RecordedRun all = run_with({"odometer", "barometer", "magnetometer"});
  const RecordedRun alone[] = {run_with({"odometer"}), run_with({"barometer"}), run_with({"magnetometer"})};
  const auto count = [](const RecordedRun& run, const char* counter) {
    const auto found = run.counters.find(counter);
    return found == run.counters.end() ? std::int64_t{0} : found->second;
  };
  EXPECT_EQ(count(all, "odometer_samples"), 150);
  EXPECT_EQ(count(all, "barometer_samples"), has("barometer") ? 30 : 0);
  EXPECT_EQ(count(all, "magnetometer_samples"), has("magnetometer") ? 60 : 0);
  EXPECT_EQ(count(alone[0], "barometer_samples"), 0);
  ASSERT_EQ(all.odometer_readings.size(), alone[0].odometer_readings.size());
  for (std::size_t i = 0; i < all.odometer_readings.size(); ++i)
    EXPECT_EQ(all.odometer_readings[i].truth.slip, alone[0].odometer_readings[i].truth.slip);
  ASSERT_EQ(all.barometer_readings.size(), alone[1].barometer_readings.size());
  for (std::size_t i = 0; i < all.barometer_readings.size(); ++i)
    EXPECT_EQ(all.barometer_readings[i].message.pressure_pa, alone[1].barometer_readings[i].message.pressure_pa);
  ASSERT_EQ(all.magnetometer_readings.size(), alone[2].magnetometer_readings.size());
  for (std::size_t i = 0; i < all.magnetometer_readings.size(); ++i)
    EXPECT_EQ(all.magnetometer_readings[i].message.field_U_t, alone[2].magnetometer_readings[i].message.field_U_t);
}

/// The lines of a CSV file.
std::vector<std::string> lines_of(const CsvWriter& csv) {
  std::vector<std::string> lines(1);
  for (const char c : csv.text())
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  lines.pop_back();
  return lines;
}

// Every digit that the bits need, times from the start, truth behind the message.
TEST(EpochFiles, AidingSensorsWithTheirTruth) {
  const RowPlace run{.frame = LocalFrame(), .start = kStart};
  CsvWriter ticks(kOdometerColumns), pressure(kBarometerColumns), field(kMagnetometerColumns);
  write(
      ticks,
      inertial::Odometer::Reading{.message = {.t = kStart + 0.02, .dt_s = 0.02, .ticks = -3, .speed_m_s = -3.0},
                                  .truth = {.t = kStart + 0.02, .distance_m = -0.1, .slip = 1e-3, .scale_error = 5e-3}},
      run);
  write(pressure,
        inertial::Barometer::Reading{.message = {.t = kStart + 0.1, .pressure_pa = 101325.1},
                                     .truth = {.t = kStart + 0.1, .pressure_pa = 101300.0, .drift_pa = 25.5}},
        run);
  write(field,
        inertial::Magnetometer::Reading{.message = {.t = kStart + 0.05, .field_U_t = {1e-5, -2.5e-5, 0.1}},
                                        .truth = {.t = kStart + 0.05, .field_U_t = {0.0, -2e-5, 0.25}}},
        run);
  EXPECT_EQ(lines_of(ticks), (std::vector<std::string>{kOdometerColumns, "20000000,0.02,-3,-3,-0.1,0.001,0.005"}));
  EXPECT_EQ(lines_of(pressure), (std::vector<std::string>{kBarometerColumns, "100000000,101325.1,101300,25.5"}));
  EXPECT_EQ(lines_of(field),
            (std::vector<std::string>{kMagnetometerColumns, "50000000,1e-05,-2.5e-05,0.1,0,-2e-05,0.25"}));
}

}  // namespace
}  // namespace canyon::mission::testing

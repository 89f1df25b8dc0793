// What a run records of its filter's input is enough to run the filter again, or another one.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/mission/run.h"
#include "canyon/study/compare.h"
#include "canyon/tests/mission/memory_recorder.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

constexpr const char* kMission = R"(
base = "vicksburg"
[time]
limit_s = 6.0
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[registration]
method = "none"
[run]
record_filter_input = true
record_covariance = true
withhold_fixes_after_s = 5.0
[autonomy]
[[autonomy.waypoint]]
name = "house"
p_m = [213.9, 150.0]
observe = "building 273"
)";

/// Rows of a CSV file by column; empty fields are NaN, words too.
std::vector<std::map<std::string, double>> read_csv(const std::string& path) {
  std::ifstream in(path);
  std::string line, field;
  std::vector<std::string> columns;
  std::getline(in, line);
  for (std::istringstream names(line); std::getline(names, field, ',');) columns.push_back(field);
  std::vector<std::map<std::string, double>> rows;
  while (std::getline(in, line)) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (const std::string& column : columns) {
      field.clear();
      std::getline(fields, field, ',');
      char* end = nullptr;
      const double value = std::strtod(field.c_str(), &end);
      rows.back()[column] = end != field.c_str() ? value : kNaN;
    }
  }
  return rows;
}

Eigen::Vector3d vector_of(const std::map<std::string, double>& row, const char* a, const char* b, const char* c) {
  return {row.at(a), row.at(b), row.at(c)};
}

GpsTime time_of(const std::map<std::string, double>& row, GpsTime start) {
  start.ns += static_cast<std::int64_t>(row.at("t_ns"));
  return start;
}

ImuSample sample_of(const std::map<std::string, double>& row, GpsTime start) {
  ImuSample sample;
  sample.t = time_of(row, start);
  sample.dt_s = row.at("dt_s");
  sample.dtheta_U = vector_of(row, "gx_rad", "gy_rad", "gz_rad");
  sample.dv_U = vector_of(row, "ax_m_s", "ay_m_s", "az_m_s");
  sample.lost = row.at("lost") != 0.0;
  return sample;
}

GnssFix fix_of(const std::map<std::string, double>& row, GpsTime start) {
  GnssFix fix;
  fix.t = time_of(row, start);
  fix.p_A_E = vector_of(row, "x_m", "y_m", "z_m");
  fix.status = fix.p_A_E.allFinite() ? FixStatus::kSingle : FixStatus::kNone;
  fix.v_A_E = vector_of(row, "vx_m_s", "vy_m_s", "vz_m_s");
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const std::string axes{"xyz"[std::min(i, j)], "xyz"[std::max(i, j)]};
      fix.covariance_E(i, j) = row.at(axes + "_m2");
      fix.velocity_covariance_E(i, j) = row.at("v" + axes + "_m2_s2");
    }
  }
  return fix;
}

OdometerSample count_of(const std::map<std::string, double>& row, GpsTime start) {
  return {.t = time_of(row, start),
          .dt_s = row.at("dt_s"),
          .ticks = static_cast<std::int64_t>(row.at("ticks")),
          .speed_m_s = row.at("speed_m_s")};
}

BarometerSample pressure_of(const std::map<std::string, double>& row, GpsTime start) {
  return {.t = time_of(row, start), .pressure_pa = row.at("pressure_pa")};
}

MagnetometerSample field_of(const std::map<std::string, double>& row, GpsTime start) {
  return {.t = time_of(row, start), .field_U_t = vector_of(row, "x_t", "y_t", "z_t")};
}

/// A sensor's file, handed to the filter row by row up to a time.
template <class Message>
struct AidingLog {
  std::vector<std::map<std::string, double>> rows;
  Message (*message_of)(const std::map<std::string, double>& row, GpsTime start);
  std::size_t next = 0;

  void give(fusion::ErrorStateFilter& filter, GpsTime until, GpsTime start) {
    for (; next < rows.size() && time_of(rows[next], start) <= until; ++next)
      filter.update(fusion::AidingMessage(message_of(rows[next], start)));
  }
};

/// What a run records of its estimate's covariance: the replayed filter's own, and what RUN_nav.csv says of it.
void compare_covariances(const fusion::ErrorStateFilter& filter, const std::map<std::string, double>& recorded,
                         const std::map<std::string, double>& nav) {
  Eigen::Matrix<double, 9, 9> P;
  for (int i = 0; i < 9; ++i)
    for (int j = i; j < 9; ++j) P(i, j) = P(j, i) = recorded.at("p_" + std::to_string(i) + "_" + std::to_string(j));
  EXPECT_EQ(recorded.at("t_s"), nav.at("t_s"));
  EXPECT_EQ(P.llt().info(), Eigen::Success);
  const char* const sigmas[] = {"sigma_e_m", "sigma_n_m", "sigma_u_m"};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(P(i, i)), nav.at(sigmas[i]), 0.51e-4);  // of four decimals
  EXPECT_NEAR(std::sqrt(P(8, 8)) / kDegree, nav.at("sigma_yaw_deg"), 0.51e-4);
  // The other way round: from W's axes back to B's, to rounding.
  const Eigen::Matrix3d R_BW = filter.estimate().X_WB.R.toRotationMatrix().transpose();
  Eigen::Matrix<double, 9, 9> J = Eigen::Matrix<double, 9, 9>::Zero();
  J.block<3, 3>(0, 6) = J.block<3, 3>(3, 0) = R_BW;
  J.block<3, 3>(6, 3).setIdentity();
  const Eigen::Matrix<double, 9, 9> own = filter.body_covariance(), back = J * P * J.transpose();
  const Eigen::Matrix<double, 9, 1> sigma = own.diagonal().cwiseSqrt();
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j)
      EXPECT_NEAR(back(i, j), own(i, j), 1e-12 * sigma.norm() * sigma.norm()) << i << "," << j;
}

fusion::ErrorStateFilter filter_of(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                   const nlohmann::json& initial) {
  fusion::ErrorStateFilter filter(config.fusion, *noise_told_to_filter(config), mission.scene->frame(),
                                  config.imu.lever_arm_m, config.gnss.lever_arm_m);
  const auto numbers = [&](const char* key) { return initial.at(key).get<std::vector<double>>(); };
  const auto p = numbers("position_m"), q = numbers("attitude_wxyz"), v = numbers("velocity_m_s");
  const Pose X_WB{Eigen::Quaterniond(q[0], q[1], q[2], q[3]), Eigen::Vector3d(p[0], p[1], p[2])};
  filter.initialize(mission.start, X_WB, Eigen::Vector3d(v[0], v[1], v[2]));
  return filter;
}

// Bit for bit: the numbers are written with as many digits as they need, and the built-in rates are multiples of one
// another, so that no fix divides an IMU sample.
void replay(const std::string& fusion, const mission::AidingSensors& has) {
  const auto file = mission::MissionFile::parse(std::string(kMission) + "[fusion]\n" + fusion + "\n", "my.toml");
  ASSERT_TRUE(file.ok()) << file.error().str();
  for (const char* fidelity : {"low", "high"}) {
    const auto comparison = prepare_comparison(*file, plan_runs({fidelity}, false));
    ASSERT_TRUE(comparison.ok()) << comparison.error().str();
    const canyon::testing::TemporaryFolder folder;
    const auto results = compare(*comparison, folder.path().string(), false);
    ASSERT_TRUE(results.ok()) << results.error().str();
    ASSERT_TRUE(write_results(folder.path().string(), *results).ok());
    mission::testing::MemoryRecorder run;
    const mission::PreparedMission& mission = comparison->missions[0];
    ASSERT_TRUE(mission::run_mission(comparison->configs[0], mission, nullptr,
                                     {.tape = nullptr, .recorder = &run, .autonomy = nullptr})
                    .ok());

    const std::string stem = std::string("epochs/") + fidelity;
    const auto samples = read_csv(folder.file(stem + "_imu.csv")), fixes = read_csv(folder.file(stem + "_fixes.csv"));
    const auto nav = read_csv(folder.file(stem + "_nav.csv")),
               covariances = read_csv(folder.file(stem + "_nav_covariance.csv"));
    ASSERT_EQ(nav.size(), run.nav.size());
    ASSERT_EQ(covariances.size(), nav.size());
    const auto rows_of = [&](const char* sensor, bool there) {
      const std::string path = folder.file(stem + sensor);
      EXPECT_EQ(std::filesystem::exists(path), there) << path;
      return there ? read_csv(path) : decltype(samples){};
    };
    AidingLog<OdometerSample> ticks{rows_of("_odometer.csv", has.odometer), count_of};
    AidingLog<BarometerSample> pressures{rows_of("_barometer.csv", has.barometer), pressure_of};
    AidingLog<MagnetometerSample> fields{rows_of("_magnetometer.csv", has.magnetometer), field_of};
    ASSERT_EQ(samples.size(), run.imu_samples.size());
    ASSERT_EQ(fixes.size(), run.gnss_rows.size());
    ASSERT_EQ(run.nav.size(), 60U);
    const auto manifest = nlohmann::json::parse(*read_text_file(folder.file("manifest.json")));
    fusion::ErrorStateFilter filter =
        filter_of(comparison->configs[0], mission, manifest["initial_estimates"][fidelity]);
    std::size_t fix = 0, epoch = 0, withheld = 0;
    for (const auto& row : samples) {
      const ImuSample sample = sample_of(row, mission.start);
      filter.predict(sample);
      ticks.give(filter, sample.t, mission.start);
      pressures.give(filter, sample.t, mission.start);
      fields.give(filter, sample.t, mission.start);
      for (; fix < fixes.size() && time_of(fixes[fix], mission.start) <= sample.t; ++fix) {
        ASSERT_EQ(time_of(fixes[fix], mission.start), sample.t);
        if (fixes[fix].at("offered") != 0.0)
          filter.update(fix_of(fixes[fix], mission.start));
        else
          ++withheld;
      }
      for (; epoch < run.nav.size() && run.nav[epoch].t == sample.t; ++epoch) {
        const NavEstimate got = filter.estimate(), &expected = run.nav[epoch].estimate;
        ASSERT_EQ(got.X_WB.p, expected.X_WB.p) << fidelity << ", epoch " << epoch;
        ASSERT_EQ(got.X_WB.R.coeffs(), expected.X_WB.R.coeffs()) << fidelity << ", epoch " << epoch;
        ASSERT_EQ(got.v_WB_W, expected.v_WB_W) << fidelity << ", epoch " << epoch;
        ASSERT_EQ(got.pose_covariance, expected.pose_covariance) << fidelity << ", epoch " << epoch;
        ASSERT_EQ(filter.body_covariance(), run.nav[epoch].covariance) << fidelity << ", epoch " << epoch;
        compare_covariances(filter, covariances[epoch], nav[epoch]);
      }
    }
    EXPECT_EQ(epoch, run.nav.size());
    EXPECT_EQ(fix, fixes.size());
    EXPECT_EQ(ticks.next, has.odometer ? 300U : 0U);       // 50 Hz
    EXPECT_EQ(pressures.next, has.barometer ? 60U : 0U);   // 10 Hz
    EXPECT_EQ(fields.next, has.magnetometer ? 120U : 0U);  // 20 Hz
    EXPECT_GT(withheld, 0U);
  }
}

TEST(FilterReplay, TheRecordedInputGivesTheRunsEstimates) {
  replay("filter = \"naive\"", {});
}

TEST(FilterReplay, TheOdometerIsPartOfIt) {
  replay("filter = \"vehicle\"", {.odometer = true});
}

TEST(FilterReplay, SoAreBarometerAndMagnetometer) {
  replay(R"(filter = "vehicle"
states = ["biases", "gains", "wheel_scale", "fix_error", "barometer_bias", "hard_iron"]
measurements = ["position", "velocity", "non_holonomic", "standstill", "odometer", "barometer", "magnetometer"])",
         {.odometer = true, .barometer = true, .magnetometer = true});
}

}  // namespace
}  // namespace canyon::study

#include "canyon/tests/fusion/recorded_run.h"

#include <cstring>
#include <sstream>

#include "canyon/core/check.h"
#include "canyon/core/files/files.h"
#include "canyon/core/units.h"

namespace canyon::testing {
namespace {

constexpr int kWeek = 2200;  // the logs give seconds of week only; any week will do

/// Raw little-endian numbers, six per row.
template <class Number>
std::vector<Eigen::Matrix<double, 6, 1>> read_rows(const std::string& path) {
  const std::string bytes = *read_text_file(path);
  const std::size_t row_bytes = 6 * sizeof(Number);
  CANYON_CHECK(bytes.size() % row_bytes == 0, path, " has ", bytes.size(), " bytes");
  std::vector<Eigen::Matrix<double, 6, 1>> rows(bytes.size() / row_bytes);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Number row[6];
    std::memcpy(row, bytes.data() + i * row_bytes, row_bytes);
    for (int j = 0; j < 6; ++j) rows[i][j] = static_cast<double>(row[j]);
  }
  return rows;
}

std::vector<Eigen::Matrix<double, 6, 1>> read_rows_by_name(const std::string& path) {
  return path.substr(path.size() - 4) == ".f64" ? read_rows<double>(path) : read_rows<float>(path);
}

ReferencePoint reference_point(GpsTime t, const double* lat_lon_h, const double* v_ned, const double* rpy_deg) {
  const Geodetic at{lat_lon_h[0] * kDegree, lat_lon_h[1] * kDegree, lat_lon_h[2]};
  ReferencePoint p;
  p.t = t;
  p.R_E_ned = rotation_E_from_ned(at);
  p.state.t = t;
  p.state.p_EU_E = ecef_from_geodetic(at);
  p.state.v_EU_E = p.R_E_ned * Eigen::Vector3d(v_ned[0], v_ned[1], v_ned[2]);
  p.state.R_EU = attitude_from_ned_frd(at, rpy_deg[0] * kDegree, rpy_deg[1] * kDegree, rpy_deg[2] * kDegree);
  return p;
}

GnssFix make_fix(GpsTime t, const double* lat_lon_h, const Eigen::Vector3d& sigma_ned) {
  const Geodetic at{lat_lon_h[0] * kDegree, lat_lon_h[1] * kDegree, lat_lon_h[2]};
  const Eigen::Matrix3d R = rotation_E_from_ned(at);
  GnssFix fix;
  fix.t = t;
  fix.status = FixStatus::kDifferential;
  fix.p_A_E = ecef_from_geodetic(at);
  fix.covariance_E = R * sigma_ned.cwiseAbs2().asDiagonal() * R.transpose();
  return fix;
}

}  // namespace

Eigen::Matrix3d rotation_E_from_ned(const Geodetic& at) {
  Eigen::Matrix3d enu_from_ned;
  enu_from_ned << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  return rotation_E_from_enu(at) * enu_from_ned;
}

Eigen::Quaterniond attitude_from_ned_frd(const Geodetic& at, double roll_rad, double pitch_rad, double yaw_rad) {
  const Eigen::Quaterniond R_ned_frd = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                                       Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
                                       Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX());
  const Eigen::Quaterniond frd_from_flu(0.0, 1.0, 0.0, 0.0);  // half a turn about x
  return (Eigen::Quaterniond(rotation_E_from_ned(at)) * R_ned_frd * frd_from_flu).normalized();
}

std::vector<std::vector<double>> read_number_csv(const std::string& path) {
  std::istringstream lines(*read_text_file(path));
  std::string line;
  std::getline(lines, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    std::vector<double> row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}

RecordedRun read_sim_leador(const std::string& imu_path, const std::string& gnss_path, const std::string& truth_path) {
  RecordedRun run;
  const GpsTime start = GpsTime::from_week_sow(kWeek, 457000.0);
  const auto imu_rows = read_rows_by_name(imu_path);
  for (std::size_t k = 0; k < imu_rows.size(); ++k) {
    const auto& row = imu_rows[k];
    ImuSample sample;
    sample.t = tick(start, static_cast<std::int64_t>(k) + 1, 100.0);
    sample.dt_s = 0.01;
    sample.dtheta_U = flu_from_frd(row.head<3>());
    sample.dv_U = flu_from_frd(row.tail<3>());
    run.imu.push_back(sample);
  }
  for (const auto& row : read_number_csv(gnss_path)) {
    run.fixes.push_back(make_fix(GpsTime::from_week_sow(kWeek, row[0]), &row[1], {row[4], row[5], row[6]}));
  }
  for (const auto& row : read_number_csv(truth_path)) {
    run.truth.push_back(reference_point(GpsTime::from_week_sow(kWeek, row[0]), &row[1], &row[4], &row[7]));
  }
  return run;
}

RecordedRun read_navego(const std::string& imu_path, const std::string& gnss_path, const std::string& truth_path) {
  RecordedRun run;
  const GpsTime start = GpsTime::from_week_sow(kWeek, 0.0);
  const auto rates = read_rows_by_name(imu_path);
  const double dt_s = 0.005;
  for (std::size_t k = 1; k < rates.size(); ++k) {
    const Eigen::Matrix<double, 6, 1> mean = 0.5 * dt_s * (rates[k - 1] + rates[k]);
    ImuSample sample;
    sample.t = tick(start, static_cast<std::int64_t>(k), 200.0);
    sample.dt_s = dt_s;
    sample.dtheta_U = flu_from_frd(mean.head<3>());
    sample.dv_U = flu_from_frd(mean.tail<3>());
    run.imu.push_back(sample);
  }
  for (const auto& row : read_number_csv(gnss_path)) {
    run.fixes.push_back(make_fix(start + row[0], &row[1], {5.0, 5.0, 10.0}));
  }
  for (const auto& row : read_number_csv(truth_path)) {
    run.truth.push_back(reference_point(start + row[0], &row[1], &row[4], &row[7]));
  }
  return run;
}

}  // namespace canyon::testing

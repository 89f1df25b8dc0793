#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <span>
#include <string_view>

#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

constexpr std::size_t kPosesPerLook = 4096;  // at whether the user wants to stop

/// Unit quaternion from four numbers of a file, written with at least three digits.
Result<Eigen::Quaterniond> parse_quaternion(const LineReader& in, double w, double x, double y, double z) {
  Eigen::Quaterniond q(w, x, y, z);
  const double norm = q.norm();
  if (std::abs(norm - 1.0) > 0.01)
    return in.error("quaternion of norm " + (norm < 1e9 ? std::to_string(norm) : "1e9 or more"), "norm 1");
  // What is normalised up to rounding stays as it is, so that a written file reads back to the same bits.
  if (std::abs(norm - 1.0) > 1e-15) q.normalize();
  return q;
}

Status append_in_order(const LineReader& in, Trajectory& trajectory, GpsTime t, const Pose& X_WB) {
  if (trajectory.poses().size() % kPosesPerLook == 0) throw_if_cancelled();
  if (!trajectory.empty())
    CANYON_TRY_STATUS(check_time_order(in, trajectory.poses().front().t, trajectory.poses().back().t, t,
                                       "poses in the order of time"));
  trajectory.append({t, X_WB});
  return Ok{};
}

/// After a blank the shortest text that reads back to the same bits.
void append_number(std::string& out, double value) {
  char buffer[32];
  const auto [end, status] = std::to_chars(buffer, buffer + sizeof buffer, value);
  out.append(1, ' ').append(buffer, end);
}

/// Seconds with nine decimals from whole nanoseconds.
void append_seconds(std::string& out, std::int64_t ns) {
  char buffer[32];
  const std::int64_t magnitude = ns < 0 ? -ns : ns;
  std::snprintf(buffer, sizeof buffer, "%s%lld.%09lld", ns < 0 ? "-" : "",
                static_cast<long long>(magnitude / kNsPerSecond), static_cast<long long>(magnitude % kNsPerSecond));
  out += buffer;
}

}  // namespace

Result<Trajectory> read_tum(const std::string& path) {
  CANYON_TRY(std::string text, read_text_file(path));
  LineReader in(path, std::move(text));
  Trajectory trajectory;
  std::string_view line;
  while (in.next(line)) {
    const auto fields = split(line, " \t,", true);
    if (fields.size() != 8) return in.error(std::to_string(fields.size()) + " columns", "8: t x y z qx qy qz qw");
    CANYON_TRY(const std::int64_t ns, parse_seconds(in, fields[0]));
    std::array<double, 7> v{};
    for (std::size_t i = 0; i < 7; ++i) {
      CANYON_TRY(v[i], i < 3 ? parse_coordinate(in, fields[i + 1]) : parse_number(in, fields[i + 1]));
    }
    CANYON_TRY(const Eigen::Quaterniond q, parse_quaternion(in, v[6], v[3], v[4], v[5]));
    CANYON_TRY_STATUS(append_in_order(in, trajectory, GpsTime{ns}, {q, {v[0], v[1], v[2]}}));
  }
  if (trajectory.empty()) return in.empty_file("poses");
  return trajectory;
}

Status write_tum(const std::string& path, const Trajectory& trajectory) {
  std::string out = "# t_s x_m y_m z_m qx qy qz qw; t in GPS seconds since 1980-01-06\n";
  for (const StampedPose& pose : trajectory.poses()) {
    const Eigen::Vector3d& p = pose.X_WB.p;
    const Eigen::Quaterniond& q = pose.X_WB.R;
    append_seconds(out, pose.t.ns);
    for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) append_number(out, value);
    out += '\n';
  }
  return write_text_file(path, out);
}

Result<Trajectory> read_kitti(const std::string& path, GpsTime start, double rate_hz) {
  CANYON_TRY(std::string text, read_text_file(path));
  LineReader in(path, std::move(text));
  Trajectory trajectory;
  std::string_view line;
  while (in.next(line)) {
    const auto fields = split(line, " \t,", true);
    if (fields.size() != 12)
      return in.error(std::to_string(fields.size()) + " columns", "12: a 3 x 4 matrix, row by row");
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    for (std::size_t i = 0; i < 12; ++i) {
      CANYON_TRY(T(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)),
                 i % 4 == 3 ? parse_coordinate(in, fields[i]) : parse_number(in, fields[i]));
    }
    const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
    // First by itself: of numbers whose squares overflow the products are no numbers.
    const bool small = R.cwiseAbs().maxCoeff() < 2.0;
    const double defect = small ? (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() : 1.0;
    if (defect > 0.01 || R.determinant() < 0.0)
      return in.error("first three columns are not a rotation", "orthonormal axes");
    const auto k = static_cast<std::int64_t>(trajectory.poses().size());
    CANYON_TRY_STATUS(append_in_order(in, trajectory, tick(start, k, rate_hz), Pose::from_matrix(T)));
  }
  if (trajectory.empty()) return in.empty_file("poses");
  return trajectory;
}

/// Numbers read back to the same bits; times are not kept, as the format has none.
Status write_kitti(const std::string& path, const Trajectory& trajectory) {
  std::string out;
  for (const StampedPose& pose : trajectory.poses()) {
    const Eigen::Matrix3d R = pose.X_WB.R.toRotationMatrix();
    std::string line;
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) append_number(line, R(i, j));
      append_number(line, pose.X_WB.p[i]);
    }
    out.append(line, 1).append(1, '\n');
  }
  return write_text_file(path, out);
}

namespace {

constexpr std::array<std::string_view, 9> kCsvColumns = {"gps_week", "sow", "x_m", "y_m", "z_m",
                                                         "qw",       "qx",  "qy",  "qz"};

/// What a mission writes into epochs/RUN_nav.csv of its true poses.
constexpr std::array<std::string_view, 8> kMissionColumns = {
    "gps_week", "sow", "true_x_m", "true_y_m", "true_z_m", "true_yaw_deg", "true_pitch_deg", "true_roll_deg"};

std::string csv_header() {
  std::string header;
  for (const std::string_view column : kCsvColumns) header += (header.empty() ? "" : ",") + std::string(column);
  return header;
}

}  // namespace

/// Columns are found by their names, so further ones and another order do no harm.
Result<Trajectory> read_csv_trajectory(const std::string& path) {
  CANYON_TRY(std::string text, read_text_file(path));
  LineReader in(path, std::move(text));
  std::string_view line;
  if (!in.next(line)) return in.empty_file("poses");
  const auto names = split(line, ",", false);
  const bool of_mission = line.find(",true_x_m,") != std::string_view::npos;
  const std::span<const std::string_view> columns =
      of_mission ? std::span<const std::string_view>(kMissionColumns) : kCsvColumns;
  std::array<std::size_t, kCsvColumns.size()> place{};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    while (place[c] < names.size() && trimmed(names[place[c]]) != columns[c]) ++place[c];
    if (place[c] == names.size()) {
      return in.error("no column \"" + std::string(columns[c]) + "\"", "the header " + csv_header());
    }
  }
  Trajectory trajectory;
  while (in.next(line)) {
    const auto fields = split(line, ",", false);
    if (fields.size() != names.size()) {
      return in.error(std::to_string(fields.size()) + " columns", std::to_string(names.size()) + " as in the header");
    }
    CANYON_TRY(const double week, parse_number(in, fields[place[0]]));
    if (week != std::floor(week) || week < 0.0 || week > 14000.0) {
      return in.error("\"" + std::string(fields[place[0]]) + "\" is not a GPS week", "a whole number from 0 to 14000");
    }
    CANYON_TRY(const std::int64_t sow_ns, parse_seconds(in, fields[place[1]]));
    std::array<double, 7> v{};
    for (std::size_t i = 0; i + 2 < columns.size(); ++i) {
      const std::string_view field = fields[place[i + 2]];
      CANYON_TRY(v[i], i < 3 ? parse_coordinate(in, field) : parse_number(in, field));
    }
    Eigen::Quaterniond q = rotation_from({v[3] * kDegree, v[4] * kDegree, v[5] * kDegree});
    if (!of_mission) {
      CANYON_TRY(q, parse_quaternion(in, v[3], v[4], v[5], v[6]));
    }
    CANYON_TRY(const GpsTime t, gps_instant(in, static_cast<int>(week), sow_ns));
    CANYON_TRY_STATUS(append_in_order(in, trajectory, t, {q, {v[0], v[1], v[2]}}));
  }
  if (trajectory.empty()) return in.empty_file("poses");
  return trajectory;
}

}  // namespace canyon

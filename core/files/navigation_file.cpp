#include "canyon/core/files/navigation_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

constexpr std::size_t kRecordsPerLook = 4096;  // at whether the user wants to stop: some 10 ms
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Columns in the order of the KF-GINS format, with the names a CSV may give them.
constexpr std::array<std::array<std::string_view, 3>, 11> kColumns = {{{"gps_week", "week"},
                                                                       {"sow", "t_s"},
                                                                       {"lat_deg"},
                                                                       {"lon_deg"},
                                                                       {"h_m"},
                                                                       {"vn", "vn_m_s"},
                                                                       {"ve", "ve_m_s"},
                                                                       {"vd", "vd_m_s"},
                                                                       {"roll_deg"},
                                                                       {"pitch_deg"},
                                                                       {"heading_deg", "yaw_deg"}}};
constexpr const char* kExpected =
    "11 columns, week sow lat lon h vN vE vD roll pitch heading, or a header with sow,lat_deg,lon_deg,h_m,vn,ve,vd,"
    "roll_deg,pitch_deg,heading_deg";

bool may_be_missing(std::size_t column) {
  return column == 0 || (column >= 5 && column <= 7);
}

Eigen::Matrix3d rotation_E_from_ned(const Geodetic& at) {
  const Eigen::Matrix3d enu = rotation_E_from_enu(at);
  Eigen::Matrix3d ned;
  ned << enu.col(1), enu.col(0), -enu.col(2);
  return ned;
}

const Eigen::Quaterniond kFrdFromFlu(0.0, 1.0, 0.0, 0.0);  // half a turn about x

bool is_header(std::string_view line) {
  return line.find_first_of("abcdfghijklmnopqrstuvwxyzABCDFGHIJKLMNOPQRSTUVWXYZ_") != std::string_view::npos;
}

/// Place of each column in a line; npos: the file has none.
using Places = std::array<std::size_t, 11>;

Result<Places> places_of(const LineReader& in, std::string_view header) {
  const auto names = split(header, ",", false);
  Places places;
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    places[c] = std::string_view::npos;
    for (std::size_t i = 0; i < names.size(); ++i)
      for (const std::string_view name : kColumns[c])
        if (!name.empty() && trimmed(names[i]) == name) places[c] = i;
    if (places[c] == std::string_view::npos && !may_be_missing(c))
      return in.error("no column \"" + std::string(kColumns[c][0]) + "\"", kExpected);
  }
  return places;
}

Result<NavigationRecord> record_of(const LineReader& in, const std::vector<std::string_view>& fields,
                                   const Places& places) {
  std::array<double, 11> v{};
  for (std::size_t c = 0; c < v.size(); ++c) {
    if (places[c] == std::string_view::npos) {
      v[c] = c == 0 ? 0.0 : kNone;
      continue;
    }
    if (places[c] >= fields.size()) return in.error(std::to_string(fields.size()) + " columns", kExpected);
    const std::string_view field = fields[places[c]];
    CANYON_TRY(v[c], c == 4             ? parse_coordinate(in, field)
                     : c >= 5 && c <= 7 ? parse_speed(in, field)
                                        : parse_number(in, field));
  }
  if (v[0] != std::floor(v[0]) || v[0] < 0.0 || v[0] > 14000.0)
    return in.error("GPS week " + std::string(fields[places[0]]), "a whole number from 0 to 14000");
  if (std::abs(v[2]) > 90.0) return in.error("latitude " + std::string(fields[places[2]]), "degrees from -90 to 90");
  if (std::abs(v[3]) > 360.0)
    return in.error("longitude " + std::string(fields[places[3]]), "degrees from -360 to 360");
  CANYON_TRY(const std::int64_t sow_ns, parse_seconds(in, fields[places[1]]));
  const Geodetic at{v[2] * kDegree, v[3] * kDegree, v[4]};
  NavigationRecord record;
  CANYON_TRY(record.t, gps_instant(in, static_cast<int>(v[0]), sow_ns));
  record.X_EU.p = ecef_from_geodetic(at);
  record.X_EU.R = attitude_from_ned(at, v[8] * kDegree, v[9] * kDegree, v[10] * kDegree);
  record.v_EU_E = rotation_E_from_ned(at) * Eigen::Vector3d(v[5], v[6], v[7]);
  return record;
}

/// The word after "# gravity" among the comments, and its line.
void read_stated_gravity(std::string_view text, NavigationFile& file) {
  constexpr std::string_view kKey = "# gravity ";
  const std::size_t at = text.find(kKey);
  if (at == std::string_view::npos) return;
  const std::string_view rest = text.substr(at + kKey.size());
  file.gravity = std::string(trimmed(rest.substr(0, rest.find_first_of("\r\n"))));
  file.gravity_line =
      1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

}  // namespace

Eigen::Quaterniond attitude_from_ned(const Geodetic& at, double roll_rad, double pitch_rad, double heading_rad) {
  const Eigen::Quaterniond R_ned_frd =
      rotation_from({.yaw_rad = heading_rad, .pitch_rad = pitch_rad, .roll_rad = roll_rad});
  return (Eigen::Quaterniond(rotation_E_from_ned(at)) * R_ned_frd * kFrdFromFlu).normalized();
}

NedAttitude ned_attitude(const Geodetic& at, const Eigen::Quaterniond& R_EU) {
  const YawPitchRoll a =
      yaw_pitch_roll(Eigen::Quaterniond(rotation_E_from_ned(at)).conjugate() * R_EU * kFrdFromFlu.conjugate());
  const double heading = a.yaw_rad < 0.0 ? a.yaw_rad + 2.0 * kPi : a.yaw_rad;
  return {a.roll_rad, a.pitch_rad, heading < 2.0 * kPi ? heading : 0.0};
}

Result<NavigationFile> read_navigation_file(const std::string& path) {
  CANYON_TRY(std::string text, read_text_or_gzip_file(path));
  NavigationFile file;
  read_stated_gravity(text, file);
  LineReader in(path, std::move(text));
  Places places{};
  for (std::size_t c = 0; c < places.size(); ++c) places[c] = c;
  std::string_view line;
  for (bool first = true; in.next(line); first = false) {
    if (file.records.size() % kRecordsPerLook == 0) throw_if_cancelled();
    if (first && is_header(line)) {
      CANYON_TRY(places, places_of(in, line));
      continue;
    }
    const bool commas = line.find(',') != std::string_view::npos;
    CANYON_TRY(const NavigationRecord record, record_of(in, split(line, commas ? "," : " \t", !commas), places));
    if (!file.records.empty())
      CANYON_TRY_STATUS(check_time_order(in, file.records.front().t, file.records.back().t, record.t,
                                         "records in the order of time"));
    file.records.push_back(record);
  }
  if (file.records.empty()) return in.empty_file("navigation records");
  return file;
}

Status write_navigation_file(const std::string& path, const NavigationFile& file) {
  std::string out = "# week sow lat_deg lon_deg h_m vN vE vD roll_deg pitch_deg heading_deg; the IMU, FRD in NED\n";
  if (!file.gravity.empty()) out += "# gravity " + file.gravity + "\n";
  for (std::size_t k = 0; k < file.records.size(); ++k) {
    if (k % kRecordsPerLook == 0) throw_if_cancelled();
    const NavigationRecord& record = file.records[k];
    const Geodetic at = geodetic_from_ecef(record.X_EU.p);
    const Eigen::Vector3d v = rotation_E_from_ned(at).transpose() * record.v_EU_E;
    const NedAttitude a = ned_attitude(at, record.X_EU.R);
    char row[320];
    std::snprintf(row, sizeof row, "%d %lld.%09lld %.13f %.13f %.7f %.9f %.9f %.9f %.12f %.12f %.12f\n",
                  record.t.week(), static_cast<long long>(record.t.sow_ns() / kNsPerSecond),
                  static_cast<long long>(record.t.sow_ns() % kNsPerSecond), at.lat_rad / kDegree, at.lon_rad / kDegree,
                  at.h_m, v.x(), v.y(), v.z(), a.roll_rad / kDegree, a.pitch_rad / kDegree, a.heading_rad / kDegree);
    out += row;
  }
  return write_text_file(path, out);
}

}  // namespace canyon

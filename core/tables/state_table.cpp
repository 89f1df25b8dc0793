#include "canyon/core/tables/state_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/files/navigation_file.h"
#include "canyon/core/lower_case.h"
#include "canyon/core/tables/column_names.h"
#include "canyon/core/tables/rtklib_header.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kEarthAtLeast_m = 1e6;
constexpr const char* kExpected =
    "a time (sow or t_s) and a place (lat_deg,lon_deg,h_m or x_m,y_m,z_m) among the columns";

// clang-format off
enum Target {
  kWeek, kTime, kDate, kClock,
  kLat, kLon, kH, kX, kY, kZ,
  kSdN, kSdE, kSdU, kXX, kXY, kXZ, kYY, kYZ, kZZ,
  kVn, kVe, kVd, kVu, kVx, kVy, kVz,
  kSdVn, kSdVe, kSdVu, kVxx, kVxy, kVxz, kVyy, kVyz, kVzz,
  kRoll, kPitch, kHeading, kSdRoll, kSdPitch, kSdHeading, kQw, kQx, kQy, kQz,
  kQuality, kStatus, kOffered,
  kTargets
};
using Q = Quantity;
constexpr KnownColumn kColumns[] = {
    {"gps_week", Q::kPlain, kWeek}, {"week", Q::kPlain, kWeek},
    {"sow", Q::kTime, kTime}, {"gps_sow", Q::kTime, kTime}, {"t", Q::kTime, kTime}, {"time", Q::kTime, kTime},
    {"timestamp", Q::kTime, kTime}, {"date", Q::kPlain, kDate}, {"clock", Q::kPlain, kClock},
    {"lat", Q::kAngle, kLat, "deg"}, {"latitude", Q::kAngle, kLat, "deg"},
    {"lon", Q::kAngle, kLon, "deg"}, {"longitude", Q::kAngle, kLon, "deg"},
    {"h", Q::kLength, kH}, {"height", Q::kLength, kH}, {"alt", Q::kLength, kH},
    {"x", Q::kLength, kX}, {"y", Q::kLength, kY}, {"z", Q::kLength, kZ},
    {"x_ecef", Q::kLength, kX}, {"y_ecef", Q::kLength, kY}, {"z_ecef", Q::kLength, kZ},
    {"sd_n", Q::kLength, kSdN}, {"sigma_n", Q::kLength, kSdN}, {"sd_e", Q::kLength, kSdE}, {"sigma_e", Q::kLength, kSdE},
    {"sd_u", Q::kLength, kSdU}, {"sd_d", Q::kLength, kSdU}, {"sigma_u", Q::kLength, kSdU}, {"sigma_d", Q::kLength, kSdU},
    {"xx", Q::kArea, kXX}, {"xy", Q::kArea, kXY}, {"xz", Q::kArea, kXZ},
    {"yy", Q::kArea, kYY}, {"yz", Q::kArea, kYZ}, {"zz", Q::kArea, kZZ},
    {"vn", Q::kSpeed, kVn}, {"ve", Q::kSpeed, kVe}, {"vd", Q::kSpeed, kVd}, {"vu", Q::kSpeed, kVu},
    {"vx", Q::kSpeed, kVx}, {"vy", Q::kSpeed, kVy}, {"vz", Q::kSpeed, kVz},
    {"sd_vn", Q::kSpeed, kSdVn}, {"sigma_vn", Q::kSpeed, kSdVn}, {"sd_ve", Q::kSpeed, kSdVe},
    {"sigma_ve", Q::kSpeed, kSdVe}, {"sd_vd", Q::kSpeed, kSdVu}, {"sd_vu", Q::kSpeed, kSdVu},
    {"sigma_vu", Q::kSpeed, kSdVu}, {"sigma_vd", Q::kSpeed, kSdVu},
    {"vxx", Q::kSpeedSquared, kVxx}, {"vxy", Q::kSpeedSquared, kVxy}, {"vxz", Q::kSpeedSquared, kVxz},
    {"vyy", Q::kSpeedSquared, kVyy}, {"vyz", Q::kSpeedSquared, kVyz}, {"vzz", Q::kSpeedSquared, kVzz},
    {"roll", Q::kAngle, kRoll, "deg"}, {"pitch", Q::kAngle, kPitch, "deg"},
    {"yaw", Q::kAngle, kHeading, "deg"}, {"heading", Q::kAngle, kHeading, "deg"},
    {"sd_roll", Q::kAngle, kSdRoll, "deg"}, {"sigma_roll", Q::kAngle, kSdRoll, "deg"},
    {"sd_pitch", Q::kAngle, kSdPitch, "deg"}, {"sigma_pitch", Q::kAngle, kSdPitch, "deg"},
    {"sd_yaw", Q::kAngle, kSdHeading, "deg"}, {"sigma_yaw", Q::kAngle, kSdHeading, "deg"},
    {"sd_heading", Q::kAngle, kSdHeading, "deg"}, {"sigma_heading", Q::kAngle, kSdHeading, "deg"},
    {"qw", Q::kPlain, kQw}, {"qx", Q::kPlain, kQx}, {"qy", Q::kPlain, kQy}, {"qz", Q::kPlain, kQz},
    {"q", Q::kPlain, kQuality}, {"status", Q::kPlain, kStatus}, {"offered", Q::kPlain, kOffered},
};
// clang-format on

constexpr ModelRow<const char*> kLayouts[] = {
    {"kf_gins_gnss", "sow,lat_deg,lon_deg,h_m,sd_n_m,sd_e_m,sd_d_m", "KF-GINS text of fixes"},
    {"tum", "t_s,x_m,y_m,z_m,qx,qy,qz,qw", "TUM trajectories"},
    {"kf_gins_nav", "week,sow,lat_deg,lon_deg,h_m,vn_m_s,ve_m_s,vd_m_s,roll_deg,pitch_deg,heading_deg",
     "KF-GINS text of references"},
    {"kf_gins_gnss_vel",
     "sow,lat_deg,lon_deg,h_m,sd_n_m,sd_e_m,sd_d_m,vn_m_s,ve_m_s,vd_m_s,sd_vn_m_s,sd_ve_m_s,sd_vd_m_s",
     "the same with velocities, as KF-GINS for Matlab has it"},
};

struct Place {
  std::size_t field = std::string::npos;
  double factor = 1.0;
  bool seconds = true;  ///< of the time: as whole digits
  bool nanoseconds = false;
  bool there() const { return field != std::string::npos; }
};

/// A line in the making.
class RowReader {
 public:
  RowReader(const LineReader& in, const std::array<Place, kTargets>& places, bool utc)
      : in_(in), places_(places), utc_(utc) {}

  bool has(Target target) const { return places_[target].there(); }

  /// nullopt: the row says nothing, or nothing that is a number.
  Result<std::optional<StateRow>> read(const std::vector<std::string_view>& fields);

 private:
  Result<double> number(Target target);
  Result<Eigen::Vector3d> three(Target first);
  Result<Eigen::Matrix3d> square(Target first);
  Result<GpsTime> time();
  Status read_place(StateRow& row);
  Status read_velocity(StateRow& row, const Eigen::Matrix3d& R_ned);
  Status read_attitude(StateRow& row);
  std::string_view text(Target target) const { return trimmed((*fields_)[places_[target].field]); }

  const LineReader& in_;
  const std::array<Place, kTargets>& places_;
  bool utc_;
  const std::vector<std::string_view>* fields_ = nullptr;
  Eigen::Matrix3d R_enu_ = Eigen::Matrix3d::Identity();  ///< in the axes of the row's places
  Geodetic at_;
  bool geodetic_ = false;
};

bool says_none(std::string_view word) {
  const std::string lower = lower_case(word);
  return lower.empty() || lower == "nan" || lower == "-nan" || lower == "null" || lower == "inf" || lower == "-inf";
}

/// NaN where the file has no such column, or an empty field.
Result<double> RowReader::number(Target target) {
  const Place& place = places_[target];
  if (!place.there() || says_none(text(target))) return kNone;
  CANYON_TRY(const double value, parse_number(in_, (*fields_)[place.field]));
  return value * place.factor;
}

Result<Eigen::Vector3d> RowReader::three(Target first) {
  Eigen::Vector3d out;
  for (int i = 0; i < 3; ++i) {
    CANYON_TRY(out[i], number(static_cast<Target>(first + i)));
  }
  return out;
}

/// From the upper triangle, row by row.
Result<Eigen::Matrix3d> RowReader::square(Target first) {
  Eigen::Matrix3d out;
  int k = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      CANYON_TRY(const double value, number(static_cast<Target>(first + k++)));
      out(i, j) = out(j, i) = value;
    }
  return out;
}

Result<GpsTime> RowReader::time() {
  if (has(kDate)) {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0;
    double second = 0.0;
    const std::string words = std::string(text(kDate)) + " " + std::string(text(kClock));
    if (std::sscanf(words.c_str(), "%d/%d/%d %d:%d:%lf", &year, &month, &day, &hour, &minute, &second) != 6 ||
        year < 1980 || year > 2250 || month < 1 || month > 12 || day < 1 || day > 31 || hour < 0 || hour > 23 ||
        minute < 0 || minute > 59 || !(second >= 0.0 && second < 61.0))
      return in_.error("\"" + words + "\" is no time", "YYYY/MM/DD HH:MM:SS");
    if (!utc_) return GpsTime::from_calendar(year, month, day, hour, minute, second);
    const GpsTime as_gps = GpsTime::from_calendar(year, month, day, hour, minute, second);
    return as_gps + as_gps.leap_seconds();
  }
  const Place& place = places_[kTime];
  std::int64_t ns = 0;
  if (place.seconds) {
    CANYON_TRY(ns, parse_seconds(in_, (*fields_)[place.field]));
  } else if (place.nanoseconds && text(kTime).find('.') == std::string_view::npos) {
    const auto [end, status] = std::from_chars(text(kTime).begin(), text(kTime).end(), ns);
    if (status != std::errc() || end != text(kTime).end())
      return in_.error("\"" + std::string(text(kTime)) + "\" is no time", "whole nanoseconds");
  } else {
    CANYON_TRY(const double t_s, number(kTime));
    if (!(std::abs(t_s) < 9.2e9)) return in_.error("\"" + std::string(text(kTime)) + "\" is no time", "seconds");
    ns = (GpsTime{} + t_s).ns;
  }
  double week = 0.0;
  if (has(kWeek)) {
    CANYON_TRY(week, number(kWeek));
    if (!(week >= 0.0 && week <= 14000.0) || week != std::floor(week))
      return in_.error("GPS week " + std::string(text(kWeek)), "a whole number from 0 to 14000");
  }
  return gps_instant(in_, static_cast<int>(week), ns);
}

Status RowReader::read_place(StateRow& row) {
  if (has(kLat)) {
    CANYON_TRY(const Eigen::Vector3d g, three(kLat));
    if (std::abs(g.x()) > 0.5 * kPi * (1.0 + 1e-12))
      return in_.error("latitude " + std::string(text(kLat)), "degrees from -90 to 90");
    if (std::abs(g.y()) > 2.0 * kPi * (1.0 + 1e-12))
      return in_.error("longitude " + std::string(text(kLon)), "degrees from -360 to 360");
    if (std::abs(g.z()) > 1e9) return in_.error("height " + std::string(text(kH)), "metres from -1e9 to 1e9");
    geodetic_ = true;
    at_ = {g.x(), g.y(), g.z()};
    row.p = g.allFinite() ? ecef_from_geodetic(at_) : Eigen::Vector3d::Constant(kNone);
  } else {
    CANYON_TRY(row.p, three(kX));
    if (row.p.cwiseAbs().maxCoeff() > 1e9) return in_.error("a place beyond 1e9 m", "metres");
    geodetic_ = row.p.norm() > kEarthAtLeast_m;
    if (geodetic_) at_ = geodetic_from_ecef(row.p);
  }
  if (geodetic_ && row.p.allFinite()) R_enu_ = rotation_E_from_enu(at_);
  CANYON_TRY(row.p_covariance, square(kXX));
  if (row.p_covariance.allFinite()) return Ok{};
  CANYON_TRY(const Eigen::Vector3d sd, three(kSdN));
  row.p_covariance = R_enu_ * Eigen::Vector3d(sd.y(), sd.x(), sd.z()).cwiseAbs2().asDiagonal() * R_enu_.transpose();
  return Ok{};
}

Status RowReader::read_velocity(StateRow& row, const Eigen::Matrix3d& R_enu) {
  CANYON_TRY(row.v, three(kVx));
  CANYON_TRY(row.v_covariance, square(kVxx));
  if (has(kVn)) {
    CANYON_TRY(const double n, number(kVn));
    CANYON_TRY(const double e, number(kVe));
    CANYON_TRY(double u, number(kVu));
    if (!has(kVu)) {
      CANYON_TRY(const double d, number(kVd));
      u = -d;
    }
    row.v = R_enu * Eigen::Vector3d(e, n, u);
  }
  if (!row.v_covariance.allFinite()) {
    CANYON_TRY(const Eigen::Vector3d sd, three(kSdVn));
    row.v_covariance = R_enu * Eigen::Vector3d(sd.y(), sd.x(), sd.z()).cwiseAbs2().asDiagonal() * R_enu.transpose();
  }
  // Nobody measures faster: it is a number of something else.
  if (row.v.allFinite() && row.v.norm() > 3e8) return in_.error("a velocity of more than 3e8 m/s", "m/s");
  return Ok{};
}

Status RowReader::read_attitude(StateRow& row) {
  CANYON_TRY(row.attitude_sigma_rad, three(kSdRoll));
  if (has(kRoll) && has(kPitch) && has(kHeading)) {
    CANYON_TRY(const Eigen::Vector3d a, three(kRoll));
    if (!a.allFinite()) return Ok{};
    if (geodetic_) {
      row.R = attitude_from_ned(at_, a.x(), a.y(), a.z());
    } else {
      row.R = rotation_from({.yaw_rad = yaw_from_heading(a.z()), .pitch_rad = -a.y(), .roll_rad = a.x()});
    }
  } else if (has(kQw)) {
    CANYON_TRY(const double w, number(kQw));
    CANYON_TRY(const Eigen::Vector3d v, three(kQx));
    Eigen::Quaterniond q(w, v.x(), v.y(), v.z());
    if (!q.coeffs().allFinite()) return Ok{};
    if (std::abs(q.norm() - 1.0) > 0.01) return in_.error("a quaternion of another norm than 1", "norm 1");
    row.R = q.normalized();
  }
  return Ok{};
}

Result<std::optional<StateRow>> RowReader::read(const std::vector<std::string_view>& fields) {
  for (const Place& place : places_)
    if (place.there() && place.field >= fields.size())
      return in_.error(std::to_string(fields.size()) + " fields", std::to_string(place.field + 1) + " or more");
  fields_ = &fields;
  if (has(kTime) && says_none(text(kTime))) return std::optional<StateRow>{};
  StateRow row;
  row.line = in_.number();
  CANYON_TRY(row.t, time());
  CANYON_TRY_STATUS(read_place(row));
  CANYON_TRY_STATUS(read_velocity(row, R_enu_));
  CANYON_TRY_STATUS(read_attitude(row));
  if (has(kQuality)) {
    CANYON_TRY(const double quality, number(kQuality));
    row.quality = quality >= 0.0 && quality < 100.0 ? static_cast<int>(quality) : 0;
  }
  if (has(kOffered)) {
    CANYON_TRY(const double offered, number(kOffered));
    row.offered = offered != 0.0;
  }
  row.solved = row.p.allFinite() && !(has(kStatus) && lower_case(text(kStatus)) == "none");
  if (!row.solved) row.p.setConstant(kNone);
  if (!row.solved && !has(kStatus)) return std::optional<StateRow>{};
  return std::optional<StateRow>(row);
}

Result<std::array<Place, kTargets>> places_of(std::string_view names, const Error& at) {
  CANYON_TRY(const auto placed, place_columns(split(names, ",", false), kColumns, at));
  std::array<Place, kTargets> out;
  for (const PlacedColumn& column : placed) {
    Place& place = out[static_cast<std::size_t>(column.target)];
    place = {.field = column.field, .factor = column.factor};
    place.seconds = column.factor == 1.0;
    place.nanoseconds = column.unit == "ns" && column.factor == 1e-9;
  }
  const auto has3 = [&](Target first) {
    const auto i = static_cast<std::size_t>(first);
    return out[i].there() && out[i + 1].there() && out[i + 2].there();
  };
  const bool timed = out[kTime].there() || (out[kDate].there() && out[kClock].there());
  const char* lacking = !timed ? "no time" : !(has3(kLat) || has3(kX)) ? "no place" : nullptr;
  if (lacking != nullptr) {
    Error error = at;
    error.what = std::string(lacking) + " among the columns";
    error.expected = kExpected;
    return error;
  }
  if (!has3(kLat)) out[kLat] = {};
  return out;
}

}  // namespace

ModelTable<const char*> state_layouts() {
  return kLayouts;
}

Result<StateTable> read_state_table(const std::string& path, const std::string& columns, double late_s) {
  CANYON_TRY(std::string content, read_text_or_gzip_file(path));
  LineReader in(path, std::move(content));
  StateTable table;
  std::array<Place, kTargets> places;
  bool known = false, utc = false;
  if (!columns.empty()) {
    const auto* layout = find_model(state_layouts(), columns);
    CANYON_TRY(places, places_of(layout != nullptr ? layout->make : columns, in.error("", "")));
    known = true;
  }
  std::string percent_line;
  std::vector<std::string_view> fields;
  std::string_view line;
  std::optional<RowReader> reader;
  const auto latest_s = [&table] { return table.rows.empty() ? kNone : table.stated_s(table.rows.back().came); };
  for (bool first = true; in.next(line);) {
    if (line.front() == '%') {
      if (is_rtklib_header(line)) percent_line = line.substr(1);
      continue;
    }
    const bool commas = line.find(',') != std::string_view::npos;
    split(line, commas ? "," : " \t;", !commas, fields);
    if (first) {
      first = false;
      if (percent_line.empty() && is_header_line(line) && fields.size() > 1) {
        if (!known) {
          std::string names;
          for (const std::string_view field : fields) names += (names.empty() ? "" : ",") + std::string(field);
          CANYON_TRY(places, places_of(names, in.error("", "")));
          known = true;
        }
        continue;
      }
      if (!known && !percent_line.empty()) {
        const RtklibHeader header = rtklib_header(percent_line, line);
        CANYON_TRY(places, places_of(header.columns, in.error("", "")));
        utc = header.utc;
        known = true;
      }
      for (const auto& layout : kLayouts)
        if (!known && split(layout.make, ",", false).size() == fields.size()) {
          CANYON_TRY(places, places_of(layout.make, in.error("", "")));
          known = true;
        }
      if (!known)
        return in.error(std::to_string(fields.size()) + " columns without a header",
                        "a header of names, or 7, 8, 11 or 13 columns as of KF-GINS and TUM");
    }
    if (!reader) reader.emplace(in, places, utc);
    table.has_week = places[kWeek].there() || places[kDate].there();
    CANYON_TRY(const auto row, reader->read(fields));
    if (!row) {
      table.passed_over.not_finite.add(in.number(), kNone, latest_s());
      continue;
    }
    const bool behind = !table.rows.empty() && !(table.rows.back().came < row->t);
    if (behind && !(late_s > 0.0 && table.rows.back().came - row->t <= late_s)) {
      const bool same = row->t == table.rows.back().came;
      (same ? table.passed_over.duplicates : table.passed_over.reversed)
          .add(in.number(), table.stated_s(row->t), latest_s());
      // Of two in the wrong order the one ahead goes: one stamp of the far future must not end the file.
      if (same || table.rows.size() < 2 || !(table.rows[table.rows.size() - 2].came < row->t)) continue;
      table.rows.pop_back();
    }
    table.rows.push_back(*row);
    const std::size_t rows = table.rows.size();
    table.rows.back().came = rows > 1 ? std::max(row->t, table.rows[rows - 2].came) : row->t;
  }
  std::stable_sort(table.rows.begin(), table.rows.end(),
                   [](const StateRow& a, const StateRow& b) { return a.t < b.t; });
  if (table.rows.empty()) return in.empty_file("solutions");
  for (const StateRow& row : table.rows)
    if (row.p.allFinite()) table.local = row.p.norm() < kEarthAtLeast_m;
  for (const StateRow& row : table.rows)
    if (row.p.allFinite() && (row.p.norm() < kEarthAtLeast_m) != table.local)
      return Error{path, row.line, "", "a place in another frame than those of other lines", "one frame"};
  return table;
}

}  // namespace canyon

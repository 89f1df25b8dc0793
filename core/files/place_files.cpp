#include "canyon/core/files/place_files.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

constexpr const char* kExpectedRow = "gps_week,sow,lat_deg,lon_deg,h_m or gps_week,sow,x_m,y_m,z_m";
constexpr double kEcefAtLeast_m = 1e6;

/// Which columns hold what.
struct Columns {
  std::size_t week = 0, sow = 1, place[3] = {2, 3, 4};
  std::optional<bool> geodetic;  ///< not said: by magnitude
};

bool is_header_of_places(std::string_view line) {
  return line.find_first_of("abcdfghijklmnopqrstuvwxyzABCDFGHIJKLMNOPQRSTUVWXYZ_") != std::string_view::npos;
}

Result<Columns> columns_of_header(const LineReader& in, std::string_view line) {
  const auto names = split(line, ",", false);
  const auto find = [&](std::string_view name) -> std::optional<std::size_t> {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (trimmed(names[i]) == name) return i;
    return std::nullopt;
  };
  Columns out;
  const auto week = find("gps_week"), sow = find("sow");
  const auto lat = find("lat_deg"), lon = find("lon_deg"), h = find("h_m");
  const auto x = find("x_m"), y = find("y_m"), z = find("z_m");
  if (!week || !sow || !((lat && lon && h) || (x && y && z)))
    return in.error("header without the columns needed", kExpectedRow);
  out.week = *week;
  out.sow = *sow;
  out.geodetic = lat && lon && h;
  const std::size_t g[3] = {lat.value_or(0), lon.value_or(0), h.value_or(0)},
                    e[3] = {x.value_or(0), y.value_or(0), z.value_or(0)};
  for (int i = 0; i < 3; ++i) out.place[i] = *out.geodetic ? g[i] : e[i];
  return out;
}

Result<StampedPlace> parse_place_line(const LineReader& in, std::string_view line, const Columns& columns) {
  const auto fields =
      split(line, line.find(',') != std::string_view::npos ? "," : " \t", line.find(',') == std::string_view::npos);
  const std::size_t most = std::max({columns.week, columns.sow, columns.place[0], columns.place[1], columns.place[2]});
  if (fields.size() <= most)
    return in.error(std::to_string(fields.size()) + " fields",
                    "at least " + std::to_string(most + 1) + ": " + kExpectedRow);
  CANYON_TRY(const double week, parse_number(in, fields[columns.week]));
  CANYON_TRY(const std::int64_t sow_ns, parse_seconds(in, fields[columns.sow]));
  if (week < 0.0 || week > 15000.0 || week != std::floor(week) || sow_ns < 0 || sow_ns > 604'800 * kNsPerSecond)
    return in.error("no such time", "a GPS week and seconds of week");
  Eigen::Vector3d p;
  for (int i = 0; i < 3; ++i) {
    CANYON_TRY(p[i], parse_number(in, fields[columns.place[static_cast<std::size_t>(i)]]));
  }
  StampedPlace out{GpsTime{static_cast<std::int64_t>(week) * 604'800 * kNsPerSecond + sow_ns}, p, in.number()};
  if (columns.geodetic.value_or(p.norm() < kEcefAtLeast_m)) {
    if (std::abs(p.x()) > 90.0 || std::abs(p.y()) > 360.0) return in.error("no such place", "degrees, degrees, metres");
    out.p_E = ecef_from_geodetic({p.x() * kDegree, p.y() * kDegree, p.z()});
  }
  return out;
}

std::vector<StampedPlace> places_of(const Trajectory& trajectory, const LocalFrame& frame,
                                    const Eigen::Vector3d& lever_arm_B) {
  std::vector<StampedPlace> places;
  for (const StampedPose& pose : trajectory.poses())
    places.push_back({pose.t, frame.to_E(pose.X_WB.p + pose.X_WB.R * lever_arm_B), 0});
  return places;
}

}  // namespace

Result<std::vector<StampedPlace>> read_places(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  LineReader in(path, text);
  std::vector<StampedPlace> out;
  Columns columns;
  std::string_view line;
  for (bool first = true; in.next(line); first = false) {
    if (first && is_header_of_places(line)) {
      CANYON_TRY(columns, columns_of_header(in, line));
      continue;
    }
    CANYON_TRY(const StampedPlace place, parse_place_line(in, line, columns));
    if (!out.empty() && place.t <= out.back().t)
      return in.error("time does not increase", "places in the order of time");
    out.push_back(place);
  }
  if (out.empty()) return in.empty_file("places");
  return out;
}

PlacePath::PlacePath(std::vector<StampedPlace> places) : places_(std::move(places)) {
  CANYON_CHECK(!places_.empty(), "a path without places");
  for (std::size_t i = 1; i < places_.size(); ++i)
    CANYON_CHECK(places_[i - 1].t < places_[i].t, "time does not increase at place ", i);
}

PlacePath::PlacePath(const Trajectory& trajectory, const LocalFrame& frame, const Eigen::Vector3d& lever_arm_B)
    : PlacePath(places_of(trajectory, frame, lever_arm_B)) {}

Eigen::Vector3d PlacePath::slope(std::size_t i) const {
  const auto between = [&](std::size_t a, std::size_t b) -> Eigen::Vector3d {
    return (places_[b].p_E - places_[a].p_E) / (places_[b].t - places_[a].t);
  };
  if (i == 0) return between(0, 1);
  if (i + 1 == places_.size()) return between(i - 1, i);
  // Of the parabola through the three.
  const double h0 = places_[i].t - places_[i - 1].t, h1 = places_[i + 1].t - places_[i].t;
  return (h1 * between(i - 1, i) + h0 * between(i, i + 1)) / (h0 + h1);
}

std::optional<PlacePath::State> PlacePath::at(GpsTime t) const {
  if (places_.size() == 1) return State{places_.front().p_E, Eigen::Vector3d::Zero()};
  if (t < first() || t > last()) return std::nullopt;
  const auto after = std::upper_bound(places_.begin() + 1, places_.end() - 1, t,
                                      [](GpsTime at, const StampedPlace& place) { return at < place.t; });
  const auto i = static_cast<std::size_t>(after - places_.begin()) - 1;
  const double h = places_[i + 1].t - places_[i].t, u = (t - places_[i].t) / h;
  const Eigen::Vector3d m0 = h * slope(i), m1 = h * slope(i + 1), d = places_[i + 1].p_E - places_[i].p_E;
  State out;
  out.p_E = places_[i].p_E + u * (m0 + u * (3.0 * d - 2.0 * m0 - m1 + u * (m0 + m1 - 2.0 * d)));
  out.v_E = (m0 + u * (2.0 * (3.0 * d - 2.0 * m0 - m1) + u * 3.0 * (m0 + m1 - 2.0 * d))) / h;
  return out;
}

}  // namespace canyon

#include "canyon/gnss/products/ionex_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "canyon/core/files/files.h"
#include "canyon/core/messages.h"
#include "canyon/core/units.h"
#include "canyon/gnss/rinex/calendar_fields.h"
#include "canyon/gnss/rinex/reader_warnings.h"
#include "canyon/gnss/rinex/text_lines.h"

namespace canyon::gnss {
namespace {

constexpr const char* kExpectedMap = "an IONEX 1.0 or 1.1 file";
constexpr int kNoValue = 9999;

std::string_view label_of(std::string_view line) {
  return columns(line, 60, 20);
}

/// Three numbers of six columns after two blanks: first, last, step.
std::optional<std::array<double, 3>> range_of(std::string_view line) {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = fortran_number(columns(line, 2 + 6 * i, 6));
    if (!value) return std::nullopt;
    out[i] = *value;
  }
  return out;
}

class IonexReader {
 public:
  IonexReader(std::string_view text, const std::string& file)
      : lines_(text), file_(file), warnings_(file, "damaged lines") {}

  Result<IonexMaps> read() {
    out_.name = file_;
    CANYON_TRY_STATUS(header());
    while (lines_.next()) {
      const std::string_view name = label_of(lines_.line());
      if (name == "START OF TEC MAP") map();
      if (name == "END OF FILE") break;
    }
    if (out_.maps.empty())
      return Error{file_, std::max(lines_.number(), 1), "", "no usable TEC map",
                   "\"START OF TEC MAP\" and what belongs to it"};
    std::stable_sort(out_.maps.begin(), out_.maps.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
    out_.maps.erase(
        std::unique(out_.maps.begin(), out_.maps.end(), [](const auto& a, const auto& b) { return a.t == b.t; }),
        out_.maps.end());
    out_.warnings = warnings_.list();
    return out_;
  }

 private:
  Status header() {
    if (!lines_.next()) return Error{file_, 1, "", "the file is empty", kExpectedMap};
    const auto version = fortran_number(columns(lines_.line(), 0, 8));
    if (label_of(lines_.line()) != "IONEX VERSION / TYPE" || !version)
      return Error{file_, 1, "", "not an IONEX file: the first line has no version and \"IONEX VERSION / TYPE\"",
                   kExpectedMap};
    if (!(*version >= 1.0 && *version < 1.2))
      return Error{file_, 1, "", "IONEX version " + join_values(*version) + " is not supported", "1.0 or 1.1"};
    bool lat = false, lon = false;
    while (lines_.next()) {
      const std::string_view line = lines_.line(), name = label_of(line);
      if (name == "END OF HEADER") {
        if (!lat || !lon)
          return Error{file_, lines_.number(), "", "the header has no grid",
                       "\"LAT1 / LAT2 / DLAT\" and \"LON1 / LON2 / DLON\""};
        return Ok{};
      }
      if (name == "MAP DIMENSION" && whole_number(columns(line, 0, 6)) != 2)
        return Error{file_, lines_.number(), "MAP DIMENSION", "\"" + printable(columns(line, 0, 6)) + "\"", "2"};
      if (name == "EXPONENT") {
        const auto exponent = whole_number(columns(line, 0, 6));
        if (!exponent || std::abs(*exponent) > 6) return unreadable("EXPONENT", "a whole number, -6 to 6");
        exponent_ = *exponent;
      } else if (name == "BASE RADIUS") {
        const auto radius_km = fortran_number(columns(line, 0, 8));
        if (!radius_km || !(*radius_km > 6000.0 && *radius_km < 7000.0))
          return unreadable("BASE RADIUS", "6000 to 7000 km");
        out_.base_radius_m = 1e3 * *radius_km;
      } else if (name == "HGT1 / HGT2 / DHGT") {
        const auto range = range_of(line);
        if (!range || !((*range)[0] > 100.0 && (*range)[0] < 2000.0)) return unreadable("HGT1", "100 to 2000 km");
        out_.shell_height_m = 1e3 * (*range)[0];
      } else if (name == "LAT1 / LAT2 / DLAT") {
        CANYON_TRY_STATUS(axis(line, 90.0, out_.lat_first_deg, out_.lat_step_deg, out_.latitudes));
        lat = true;
      } else if (name == "LON1 / LON2 / DLON") {
        CANYON_TRY_STATUS(axis(line, 360.0, out_.lon_first_deg, out_.lon_step_deg, out_.longitudes));
        lon = true;
      }
    }
    return Error{file_, lines_.number(), "", "the file ends inside its header", "a line \"END OF HEADER\""};
  }

  Error unreadable(const char* key, const char* expected) const {
    return Error{file_, lines_.number(), key, "cannot be read", expected};
  }

  Status axis(std::string_view line, double limit_deg, double& first_deg, double& step_deg, std::size_t& count) {
    const auto range = range_of(line);
    const double span = range ? (*range)[1] - (*range)[0] : 0.0;
    const double steps = range ? span / (*range)[2] : 0.0;
    if (!range || !(steps >= 1.0 && steps <= 3600.0) || std::abs(steps - std::round(steps)) > 1e-6 ||
        std::abs((*range)[0]) > limit_deg || std::abs((*range)[1]) > limit_deg)
      return Error{file_, lines_.number(), std::string(label_of(line)), "is no grid",
                   "first, last and step in degrees, at least two points"};
    first_deg = (*range)[0];
    step_deg = (*range)[2];
    count = static_cast<std::size_t>(std::lround(steps)) + 1;
    return Ok{};
  }

  void map() {
    const int first_line = lines_.number();
    IonexMaps::Map map;
    std::optional<GpsTime> t;
    std::string problem;
    map.vtec_tecu.assign(out_.latitudes * out_.longitudes, kNaN);
    std::size_t rows = 0;
    bool ended = false;
    while (!ended && lines_.next()) {
      const std::string_view line = lines_.line(), name = label_of(line);
      if (name == "END OF TEC MAP") {
        ended = true;
      } else if (name == "EPOCH OF CURRENT MAP") {
        const auto utc = time_of_words(columns(line, 0, 36));
        if (utc) t = gps_time_of_utc(*utc);
      } else if (name == "EXPONENT") {
        exponent_ = std::clamp(whole_number(columns(line, 0, 6)).value_or(exponent_), -6, 6);
      } else if (name == "LAT/LON1/LON2/DLON/H") {
        const auto lat_deg = fortran_number(columns(line, 2, 6));
        const double place = lat_deg ? (*lat_deg - out_.lat_first_deg) / out_.lat_step_deg : -1.0;
        const bool fits = std::abs(place - std::round(place)) < 1e-6 && place > -0.5 &&
                          place < static_cast<double>(out_.latitudes) - 0.5;
        if (!fits || !row(&map.vtec_tecu[static_cast<std::size_t>(std::lround(place)) * out_.longitudes])) {
          if (problem.empty()) problem = std::to_string(lines_.number());
        } else {
          ++rows;
        }
      }
    }
    if (!ended)
      warnings_.note(lines_.number(), "the file ends inside a TEC map, which is skipped");
    else if (!t)
      warnings_.note(first_line, "the epoch of the map cannot be read; the map is skipped");
    else if (!problem.empty())
      warnings_.note(first_line, "the map is damaged at line " + problem + " and is skipped");
    else if (rows != out_.latitudes)
      warnings_.note(first_line, "the map has " + std::to_string(rows) + " latitudes, not " +
                                     std::to_string(out_.latitudes) + "; the map is skipped");
    else {
      map.t = *t;
      out_.maps.push_back(std::move(map));
    }
  }

  /// One latitude: 16 values of five columns a line.
  bool row(double* out) {
    const double scale = std::pow(10.0, exponent_);
    for (std::size_t i = 0; i < out_.longitudes; ++i) {
      if (i % 16 == 0) {
        if (!label_of(lines_.peek()).empty() &&
            columns(lines_.peek(), 60, 20).find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") != std::string_view::npos)
          return false;  // the next label_of comes too early
        if (!lines_.next()) return false;
      }
      const auto value = whole_number(columns(lines_.line(), 5 * (i % 16), 5));
      if (!value) return false;
      out[i] = *value == kNoValue ? kNaN : scale * *value;
    }
    return true;
  }

  TextLines lines_;
  const std::string& file_;
  ReaderWarnings warnings_;
  IonexMaps out_;
  int exponent_ = -1;
};

/// Bilinear; the longitude wraps around.
double value_at(const IonexMaps& maps, const IonexMaps::Map& map, double lat_deg, double lon_deg) {
  const double row =
      std::clamp((lat_deg - maps.lat_first_deg) / maps.lat_step_deg, 0.0, static_cast<double>(maps.latitudes - 1));
  const auto i = std::min(static_cast<std::size_t>(row), maps.latitudes - 2);
  const double turn = 360.0 / std::abs(maps.lon_step_deg);  // columns of a whole turn
  double column = (lon_deg - maps.lon_first_deg) / maps.lon_step_deg;
  column -= turn * std::floor(column / turn);
  const auto j = std::min(static_cast<std::size_t>(column), maps.longitudes - 1);
  // A grid that stops one step short of a whole turn continues with its first column.
  const std::size_t k = j + 1 < maps.longitudes ? j + 1 : 0;
  if (k == 0 && std::abs(turn - static_cast<double>(maps.longitudes)) > 1e-6 && column - static_cast<double>(j) > 1e-9)
    return kNaN;  // a regional map ends here
  const double u = row - static_cast<double>(i), v = column - static_cast<double>(j);
  const auto at = [&](std::size_t r, std::size_t c) { return map.vtec_tecu[r * maps.longitudes + c]; };
  const double low = v == 0.0 ? at(i, j) : (1.0 - v) * at(i, j) + v * at(i, k);
  const double high = v == 0.0 ? at(i + 1, j) : (1.0 - v) * at(i + 1, j) + v * at(i + 1, k);
  if (u == 0.0) return low;
  return u == 1.0 ? high : (1.0 - u) * low + u * high;
}

}  // namespace

double IonexMaps::vtec_tecu(double lat_rad, double lon_rad, GpsTime t) const {
  const auto after =
      std::lower_bound(maps.begin(), maps.end(), t, [](const Map& map, GpsTime time) { return map.t < time; });
  if (after == maps.end()) return kNaN;
  const double lat_deg = lat_rad / kDegree, lon_deg = lon_rad / kDegree;
  if (after->t == t) return value_at(*this, *after, lat_deg, lon_deg);
  if (after == maps.begin()) return kNaN;
  const auto before = std::prev(after);
  // The ionosphere stays below the Sun while the Earth turns under it.
  const auto turned = [&](const Map& map) {
    return value_at(*this, map, lat_deg, lon_deg + (t - map.t) * 360.0 / 86400.0);
  };
  const double share = (t - before->t) / (after->t - before->t);
  return (1.0 - share) * turned(*before) + share * turned(*after);
}

Result<IonexMaps> parse_ionex_file(std::string_view text, const std::string& file_name) {
  return IonexReader(text, file_name).read();
}

Result<IonexMaps> read_ionex_file(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  return parse_ionex_file(text, path);
}

}  // namespace canyon::gnss

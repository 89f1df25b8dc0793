#include "canyon/gnss/products/almanac_file.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/gnss/rinex/reader_warnings.h"
#include "canyon/gnss/rinex/text_lines.h"
#include "canyon/gnss/satellites/ephemerides/ephemeris_limits.h"

namespace canyon::gnss {
namespace {

constexpr double kValidS = 14.0 * 86400.0;
constexpr double kSemicircle = kPi;
namespace limits = ephemeris_limits;

/// Words of a line.
std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return out;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    out.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

std::optional<SatelliteId> satellite(double number) {
  if (number >= 1.0 && number <= 63.0) return SatelliteId{GnssSystem::kGps, static_cast<std::uint8_t>(number)};
  if (number >= 193.0 && number <= 202.0)
    return SatelliteId{GnssSystem::kQzss, static_cast<std::uint8_t>(number - 192.0)};
  return std::nullopt;
}

class AlmanacReader {
 public:
  AlmanacReader(std::string_view text, const std::string& file, GpsTime near)
      : lines_(text), file_(file), near_(near), warnings_(file, "damaged lines") {}

  Result<NavigationData> read() {
    while (lines_.next() && columns(lines_.line(), 0, lines_.line().size()).empty()) {
    }
    const std::string_view first = columns(lines_.line(), 0, lines_.line().size());
    out_.files.push_back({file_, 0.0});
    if (first.starts_with("*"))
      yuma();
    else if (const auto count = words(first); !count.empty() && whole_number(count[0]).has_value())
      sem();
    else
      return Error{file_, std::max(lines_.number(), 1), "", "neither a YUMA nor a SEM almanac",
                   "\"******** Week ... almanac for PRN-...\" (YUMA) or a number of records (SEM)"};
    if (out_.kepler.empty())
      return Error{file_, std::max(lines_.number(), 1), "", "no usable almanac record", "a YUMA or SEM almanac of GPS"};
    out_.warnings = warnings_.list();
    return out_;
  }

 private:
  /// The week of `week` modulo 1024 in which `toa_s` comes nearest to near_.
  GpsTime applicability(double week, double toa_s) const {
    constexpr double kTurnS = 1024.0 * kSecondsPerWeek;
    const GpsTime once = GpsTime::from_week_sow(static_cast<int>(week), toa_s);
    const double turns = std::max(std::round((near_ - once) / kTurnS), -std::floor(week / 1024.0));
    return once + turns * kTurnS;
  }

  static std::string beyond_limits(const KeplerEphemeris& r) {
    struct Field {
      const char* name;
      double value, limit;
    };
    for (const Field& f : {Field{"af0", r.af0_s, limits::kClockS}, Field{"af1", r.af1, limits::kClockRate},
                           Field{"orbital inclination", r.i0_rad, limits::kAngleRad},
                           Field{"rate of right ascension", r.omega_dot_rad_s, limits::kRateRadS},
                           Field{"right ascension", r.omega0_rad, limits::kAngleRad},
                           Field{"argument of perigee", r.argument_of_perigee_rad, limits::kAngleRad},
                           Field{"mean anomaly", r.m0_rad, limits::kAngleRad}})
      if (!(std::abs(f.value) < f.limit)) return f.name + (" = " + join_values(f.value));
    return "";
  }

  /// Keeps the record if it can be one; `line` is where it begins.
  void keep(KeplerEphemeris r, double number, double week, double toa_s, double health, int line) {
    const auto sv = satellite(number);
    std::string what;
    if (!sv)
      what = "satellite number " + join_values(number);
    else if (!(r.e >= 0.0 && r.e < 1.0))
      what = "e = " + join_values(r.e);
    else if (!(r.sqrt_a >= 1000.0 && r.sqrt_a <= 10000.0))
      what = "sqrt(A) = " + join_values(r.sqrt_a);
    else if (!(week >= 0.0 && week < 8192.0 && toa_s >= 0.0 && toa_s <= kSecondsPerWeek))
      what = "time of applicability: week " + join_values(week) + ", " + join_values(toa_s) + " s";
    else if (!(health >= 0.0 && health <= 255.0))
      what = "health = " + join_values(health);
    else
      what = beyond_limits(r);
    if (what.empty()) {
      r.sv = *sv;
      r.message = NavigationMessage::kAlmanac;
      r.toe = r.toc = applicability(week, toa_s);
      if (const double radius_m = limits::radius_at_toe_m(r); !limits::is_sane_radius(radius_m))
        what = "distance from the Earth's centre = " + join_values(radius_m) + " m";
    }
    if (!what.empty()) {
      warnings_.note(line, what + " cannot be; the record is skipped");
      return;
    }
    r.health = static_cast<int>(health);
    r.valid_before_s = r.valid_after_s = kValidS;
    out_.kepler.push_back(r);
  }

  /// Thirteen lines "name: value" after each line of asterisks.
  void yuma() {
    bool more = true;
    while (more) {
      const int first_line = lines_.number();
      KeplerEphemeris r;
      double number = 0.0, week = 0.0, toa_s = 0.0, health = 0.0;
      struct Field {
        const char* name;
        double* value;
        bool seen = false;
      };
      Field fields[] = {{"ID", &number},
                        {"Health", &health},
                        {"Eccentricity", &r.e},
                        {"Time of Applicability", &toa_s},
                        {"Orbital Inclination", &r.i0_rad},
                        {"Rate of Right Ascen", &r.omega_dot_rad_s},
                        {"SQRT(A)", &r.sqrt_a},
                        {"Right Ascen at Week", &r.omega0_rad},
                        {"Argument of Perigee", &r.argument_of_perigee_rad},
                        {"Mean Anom", &r.m0_rad},
                        {"Af0", &r.af0_s},
                        {"Af1", &r.af1},
                        {"week", &week}};
      bool damaged = false;
      while ((more = lines_.next()) && !lines_.line().starts_with("*")) {
        const std::string_view line = columns(lines_.line(), 0, lines_.line().size());
        if (line.empty()) continue;
        const std::size_t colon = line.find(':');
        const auto value =
            colon == std::string_view::npos ? std::nullopt : fortran_number(columns(line, colon + 1, line.size()));
        Field* field = nullptr;
        for (Field& f : fields)
          if (line.starts_with(f.name)) field = &f;
        if (field == nullptr || !value || field->seen) {
          if (!damaged)
            warnings_.note(lines_.number(), "\"" + printable(line.substr(0, 40)) +
                                                "\" is no line of a YUMA almanac; the "
                                                "record is skipped");
          damaged = true;
          continue;
        }
        *field->value = *value;
        field->seen = true;
      }
      if (damaged) continue;
      const auto missing = std::find_if(std::begin(fields), std::end(fields), [](const Field& f) { return !f.seen; });
      if (missing != std::end(fields))
        warnings_.note(first_line, std::string("the record has no \"") + missing->name + "\" and is skipped");
      else
        keep(r, number, week, toa_s, health, first_line);
    }
  }

  /// The numbers of the next line that is not blank; empty where they cannot be read or are not `count`.
  std::vector<double> numbers(std::size_t count) {
    while (lines_.next()) {
      const auto found = words(lines_.line());
      if (found.empty()) continue;
      std::vector<double> out;
      for (const auto word : found)
        if (const auto value = fortran_number(word)) out.push_back(*value);
      if (out.size() == found.size() && out.size() == count) return out;
      return {};
    }
    return {};
  }

  /// Week and time of applicability, then eight lines for each satellite; angles in semicircles.
  void sem() {
    const auto time = numbers(2);
    if (time.empty()) {
      warnings_.note(lines_.number(), "week and time of applicability cannot be read");
      return;
    }
    constexpr std::size_t kShape[] = {1, 1, 1, 3, 3, 3, 1, 1};
    while (!lines_.at_end()) {
      std::vector<std::vector<double>> rows;
      int first_line = 0;
      for (const std::size_t count : kShape) {
        rows.push_back(numbers(count));
        if (rows.size() == 1) first_line = lines_.number();
        if (rows.back().empty()) break;
      }
      if (rows.back().empty()) {
        // Without its place a record cannot be told from the next: the rest is lost.
        if (!lines_.at_end() || rows.size() > 1)
          warnings_.note(lines_.number(), "a line of a SEM almanac cannot be read; it and what follows are skipped");
        return;
      }
      KeplerEphemeris r;
      r.e = rows[3][0];
      r.i0_rad = (0.30 + rows[3][1]) * kSemicircle;
      r.omega_dot_rad_s = rows[3][2] * kSemicircle;
      r.sqrt_a = rows[4][0];
      r.omega0_rad = rows[4][1] * kSemicircle;
      r.argument_of_perigee_rad = rows[4][2] * kSemicircle;
      r.m0_rad = rows[5][0] * kSemicircle;
      r.af0_s = rows[5][1];
      r.af1 = rows[5][2];
      keep(r, rows[0][0], time[0], time[1], rows[6][0], first_line);
    }
  }

  TextLines lines_;
  const std::string& file_;
  GpsTime near_;
  ReaderWarnings warnings_;
  NavigationData out_;
};

}  // namespace

Result<NavigationData> parse_almanac_file(std::string_view text, const std::string& file_name, GpsTime near) {
  if (text.empty()) return Error{file_name, 1, "", "the file is empty", "a YUMA or SEM almanac"};
  return AlmanacReader(text, file_name, near).read();
}

Result<NavigationData> read_almanac_file(const std::string& path, GpsTime near) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  return parse_almanac_file(text, path, near);
}

}  // namespace canyon::gnss

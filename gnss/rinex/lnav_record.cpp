#include "gnss/rinex/lnav_record.h"

#include <algorithm>
#include <cmath>

#include "gnss/rinex/text_lines.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kLines = 8;
constexpr std::size_t kWidth = 19;  // of every number after the epoch

/// Takes fields out of a record and remembers the first thing that is wrong.
class RecordFields {
 public:
  RecordFields(const std::vector<std::string_view>& lines, int first_line, const std::string& file, std::string who)
      : lines_(lines), first_line_(first_line), file_(file), who_(std::move(who)) {}

  double number(std::size_t line, std::size_t column, const char* name, bool required = true) {
    const std::string_view text = columns(lines_[line], column, kWidth);
    if (text.empty() && !required) return 0.0;  // RINEX: blank = not known
    const auto value = fortran_number(text);
    if (!value)
      fail(line,
           text.empty() ? std::string(name) + " is missing" : std::string(name) + " = \"" + printable(text) + "\"",
           text.empty() ? "" : "a number");
    return value.value_or(0.0);
  }

  void require(bool condition, std::size_t line, std::string what, std::string expected) {
    if (!condition) fail(line, std::move(what), std::move(expected));
  }

  bool ok() const { return ok_; }
  const Error& error() const { return error_; }

 private:
  void fail(std::size_t line, std::string what, std::string expected) {
    if (!ok_) return;
    ok_ = false;
    error_ = Error{file_, first_line_ + static_cast<int>(line), "", who_ + ": " + what, std::move(expected)};
  }

  const std::vector<std::string_view>& lines_;
  int first_line_;
  const std::string& file_;
  std::string who_;
  bool ok_ = true;
  Error error_;
};

std::optional<GpsTime> parse_epoch(std::string_view line, bool version3) {
  const auto year = whole_number(version3 ? columns(line, 4, 4) : columns(line, 3, 2));
  const std::size_t at = version3 ? 8 : 5;
  const auto month = whole_number(columns(line, at, 3)), day = whole_number(columns(line, at + 3, 3));
  const auto hour = whole_number(columns(line, at + 6, 3)), minute = whole_number(columns(line, at + 9, 3));
  const auto second = fortran_number(version3 ? columns(line, 20, 3) : columns(line, 17, 5));
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  const int full_year = version3 ? *year : *year + (*year < 80 ? 2000 : 1900);
  if (full_year < 1980 || full_year > 2200 || *month < 1 || *month > 12 || *day < 1 || *day > 31 || *hour < 0 ||
      *hour > 24 || *minute < 0 || *minute > 59 || *second < 0.0 || *second >= 61.0)
    return std::nullopt;
  return GpsTime::from_calendar(full_year, *month, *day, *hour, *minute, *second);
}

/// The instant with that second of week nearest to `near`. The week field is not trusted: some writers roll it over at
/// 1024.
GpsTime nearest_with_sow(double sow_s, GpsTime near) {
  double ahead_s = std::remainder(sow_s - near.sow_s(), kSecondsPerWeek);
  return near + ahead_s;
}

}  // namespace

Result<LnavEphemeris> parse_lnav_record(const std::vector<std::string_view>& lines, int first_line,
                                        const std::string& file_name, const LnavLayout& layout) {
  const std::string_view head = lines.front();
  const auto prn = whole_number(layout.version3 ? columns(head, 1, 2) : columns(head, 0, 2));
  if (!prn || *prn < 1 || *prn > 63)
    return Error{file_name, first_line, "", "satellite number \"" + printable(columns(head, 0, 3)) + "\"",
                 "G01 to G63"};

  LnavEphemeris r;
  r.sv = {GnssSystem::kGps, static_cast<std::uint8_t>(*prn)};
  if (lines.size() != kLines)
    return Error{file_name, first_line, "", r.sv.str() + ": the record has " + std::to_string(lines.size()) + " lines",
                 "8"};
  RecordFields f(lines, first_line, file_name, r.sv.str());

  const auto toc = parse_epoch(head, layout.version3);
  f.require(toc.has_value(), 0, "its epoch cannot be read", "year month day hour minute second");
  r.toc = toc.value_or(GpsTime{});
  const std::size_t c = layout.clock_column();
  r.af0_s = f.number(0, c, "af0");
  r.af1 = f.number(0, c + kWidth, "af1");
  r.af2_per_s = f.number(0, c + 2 * kWidth, "af2");

  const auto orbit = [&](std::size_t line, std::size_t index, const char* name, bool required = true) {
    return f.number(line, layout.orbit_column() + index * kWidth, name, required);
  };
  const double iode = orbit(1, 0, "IODE", false);
  r.crs_m = orbit(1, 1, "Crs");
  r.delta_n_rad_s = orbit(1, 2, "delta n");
  r.m0_rad = orbit(1, 3, "M0");
  r.cuc_rad = orbit(2, 0, "Cuc");
  r.e = orbit(2, 1, "e");
  r.cus_rad = orbit(2, 2, "Cus");
  r.sqrt_a = orbit(2, 3, "sqrt(A)");
  const double toe_sow_s = orbit(3, 0, "toe");
  r.cic_rad = orbit(3, 1, "Cic");
  r.omega0_rad = orbit(3, 2, "OMEGA0");
  r.cis_rad = orbit(3, 3, "Cis");
  r.i0_rad = orbit(4, 0, "i0");
  r.crc_m = orbit(4, 1, "Crc");
  r.argument_of_perigee_rad = orbit(4, 2, "omega");
  r.omega_dot_rad_s = orbit(4, 3, "OMEGA DOT");
  r.idot_rad_s = orbit(5, 0, "IDOT");
  r.accuracy_m = orbit(6, 0, "accuracy", false);
  const double health = orbit(6, 1, "health");
  r.tgd_s = orbit(6, 2, "TGD", false);
  const double fit_h = orbit(7, 1, "fit interval", false);

  f.require(r.e >= 0.0 && r.e < 1.0, 2, "e = " + join_values(r.e), "at least 0 and less than 1");
  f.require(r.sqrt_a >= 1000.0 && r.sqrt_a <= 10000.0, 2, "sqrt(A) = " + join_values(r.sqrt_a),
            "1000 to 10000 m^0.5 (GPS: 5154)");
  f.require(toe_sow_s >= 0.0 && toe_sow_s <= kSecondsPerWeek, 3, "toe = " + join_values(toe_sow_s),
            "0 to 604800 s of the week");
  f.require(health >= 0.0 && health <= 255.0, 6, "health = " + join_values(health), "0 to 255");
  f.require(std::abs(r.af0_s) < 1.0, 0, "af0 = " + join_values(r.af0_s), "less than 1 s");
  if (f.ok()) {
    r.toe = nearest_with_sow(toe_sow_s, r.toc);
    f.require(std::abs(r.toe - r.toc) <= 86400.0, 3,
              "toe is " + join_values((r.toe - r.toc) / 3600.0) + " h from the clock's epoch", "within a day");
  }
  if (!f.ok()) return f.error();

  r.health = static_cast<int>(health);
  r.iode = static_cast<int>(std::clamp(iode, 0.0, 1e6));
  // 0 = not known; 1 comes from writers that store IS-GPS-200's fit flag. Either way at least the standard four hours.
  r.fit_interval_s = 3600.0 * std::clamp(fit_h, 4.0, 194.0);
  return r;
}

}  // namespace canyon::gnss

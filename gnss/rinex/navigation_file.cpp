#include "gnss/rinex/navigation_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/files.h"
#include "gnss/rinex/lnav_record.h"
#include "gnss/rinex/text_lines.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kLabelColumn = 60;
constexpr std::size_t kMaxWarnings = 20;  // listed one by one; the rest are counted

std::string_view label(std::string_view line) {
  return columns(line, kLabelColumn, 20);
}

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

Status parse_first_line(TextLines& lines, NavigationFile& out) {
  if (!lines.next()) return Error{out.name, 1, "", "the file is empty", "a RINEX 2 or 3 navigation file"};
  const std::string_view line = lines.line();
  const auto version = fortran_number(columns(line, 0, 9));
  if (label(line) != "RINEX VERSION / TYPE" || !version)
    return Error{out.name, 1, "", "not a RINEX file: the first line has no version and \"RINEX VERSION / TYPE\"",
                 "a RINEX 2 or 3 navigation file"};
  out.version = *version;
  if (!(out.version >= 2.0 && out.version < 4.0))
    return Error{out.name, 1, "", "RINEX version " + fixed(out.version, 2) + " is not supported", "2.x or 3.x"};

  const char type = line.size() > 20 ? line[20] : ' ';
  const char system = line.size() > 40 ? line[40] : ' ';
  if (type != 'N')
    return Error{out.name, 1, "", "RINEX file type \"" + printable({&type, 1}) + "\"", "\"N\", GPS navigation data"};
  if (out.version >= 3.0 && system != 'G' && system != 'M' && system != ' ')
    return Error{out.name, 1, "", "navigation data of system \"" + printable({&system, 1}) + "\"",
                 "\"G\" (GPS) or \"M\" (mixed)"};
  return Ok{};
}

/// Four numbers of `width` columns from `first`; nullopt if one does not parse.
std::optional<std::array<double, 4>> four_numbers(std::string_view line, std::size_t first) {
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto value = fortran_number(columns(line, first + 12 * i, 12));
    if (!value) return std::nullopt;
    values[i] = *value;
  }
  return values;
}

Status parse_header(TextLines& lines, NavigationFile& out) {
  CANYON_TRY_STATUS(parse_first_line(lines, out));
  std::optional<std::array<double, 4>> alpha, beta;
  bool ended = false;
  while (!ended && lines.next()) {
    const std::string_view line = lines.line(), name = label(line);
    if (name == "ION ALPHA" || (name == "IONOSPHERIC CORR" && line.starts_with("GPSA"))) {
      alpha = four_numbers(line, name == "ION ALPHA" ? 2 : 5);
      if (!alpha) return Error{out.name, lines.number(), "ION ALPHA", "cannot be read", "four numbers"};
    } else if (name == "ION BETA" || (name == "IONOSPHERIC CORR" && line.starts_with("GPSB"))) {
      beta = four_numbers(line, name == "ION BETA" ? 2 : 5);
      if (!beta) return Error{out.name, lines.number(), "ION BETA", "cannot be read", "four numbers"};
    } else if (name == "LEAP SECONDS") {
      out.leap_seconds = whole_number(columns(line, 0, 6));
      if (!out.leap_seconds) return Error{out.name, lines.number(), "LEAP SECONDS", "cannot be read", "a whole number"};
    }
    ended = name == "END OF HEADER";
  }
  if (!ended) return Error{out.name, lines.number(), "", "the file ends inside its header", "a line \"END OF HEADER\""};
  if (alpha && beta) out.klobuchar = KlobucharCoefficients{*alpha, *beta};
  return Ok{};
}

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t") == std::string_view::npos;
}

/// A record's first line begins with a satellite; the lines that continue it begin with blanks.
bool starts_record(std::string_view line, bool version3) {
  if (line.empty()) return false;
  return version3 ? line[0] != ' ' : (line[0] != ' ' || (line.size() > 1 && line[1] != ' '));
}

class RecordReader {
 public:
  RecordReader(TextLines& lines, NavigationFile& out) : lines_(lines), out_(out), version3_(out.version >= 3.0) {}

  void read_all() {
    while (lines_.next()) {
      if (is_blank(lines_.line())) continue;
      if (!starts_record(lines_.line(), version3_)) {
        warn(Error{out_.name, lines_.number(), "", "a line that belongs to no record", "a satellite number first"});
        skip_continuation();
        continue;
      }
      read_record();
    }
    if (damaged_ > kMaxWarnings)
      out_.warnings.push_back(out_.name + ": " + std::to_string(damaged_ - kMaxWarnings) +
                              " more damaged records were skipped");
  }
  std::size_t damaged() const { return damaged_; }

 private:
  void read_record() {
    const int first_line = lines_.number();
    const char system = version3_ ? lines_.line()[0] : 'G';
    std::vector<std::string_view> record{lines_.line()};
    while (!lines_.at_end() && !starts_record(lines_.peek(), version3_)) {
      lines_.next();
      if (!is_blank(lines_.line())) record.push_back(lines_.line());
    }
    if (system != 'G' && std::string_view("RECJSI").find(system) != std::string_view::npos) {
      ++out_.other_system_records;
      return;
    }
    auto parsed = system == 'G' ? parse_lnav_record(record, first_line, out_.name, LnavLayout{version3_})
                                : Error{out_.name, first_line, "", "a line that belongs to no record",
                                        "a satellite number first"};
    if (parsed.ok())
      out_.gps.push_back(*parsed);
    else
      warn(parsed.error());
  }

  void skip_continuation() {
    while (!lines_.at_end() && !starts_record(lines_.peek(), version3_)) lines_.next();
  }

  void warn(const Error& error) {
    if (++damaged_ <= kMaxWarnings) out_.warnings.push_back(error.str() + "; skipped");
  }

  TextLines& lines_;
  NavigationFile& out_;
  bool version3_;
  std::size_t damaged_ = 0;
};

}  // namespace

Result<NavigationFile> parse_navigation_file(std::string_view text, const std::string& file_name) {
  NavigationFile out;
  out.name = file_name;
  TextLines lines(text);
  CANYON_TRY_STATUS(parse_header(lines, out));
  RecordReader reader(lines, out);
  reader.read_all();
  if (out.gps.empty()) {
    std::string what = "no usable GPS record";
    if (!out.warnings.empty())
      what += " (" + std::to_string(reader.damaged()) + " damaged, the first: " + out.warnings.front() + ")";
    if (out.other_system_records > 0) what += " (" + std::to_string(out.other_system_records) + " of other systems)";
    return Error{file_name, std::max(lines.number(), 1), "", what, "GPS broadcast ephemerides"};
  }
  return out;
}

Result<NavigationFile> read_navigation_file(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  return parse_navigation_file(text, path);
}

Status check_coverage(const NavigationFile& file, GpsTime start, GpsTime end, const std::string& key) {
  std::optional<GpsTime> first, last;
  for (const auto& r : file.gps) {
    if (!r.healthy()) continue;
    const GpsTime begin = r.toe - 0.5 * r.fit_interval_s, finish = r.toe + 0.5 * r.fit_interval_s;
    first = first ? std::min(*first, begin) : begin;
    last = last ? std::max(*last, finish) : finish;
  }
  if (!first)
    return Error{file.name, 0, key, "no GPS satellite in it is healthy", "a navigation file of the mission's day"};
  const std::string span = first->iso(0) + " to " + last->iso(0);
  if (start < *first || end > *last)
    return Error{file.name, 0, key,
                 "covers " + span + " GPS time, not the mission's " + start.iso(0) + " to " + end.iso(0),
                 "a navigation file of the mission's day"};

  const auto constellation = make_broadcast_gps(file.gps);
  constexpr double kStepS = 300.0;
  const double length_s = end - start;
  const int steps = static_cast<int>(std::ceil(length_s / kStepS));
  for (int k = 0; k <= steps; ++k) {
    const GpsTime t = start + std::min(k * kStepS, length_s);
    const auto valid = std::count_if(constellation->satellites().begin(), constellation->satellites().end(),
                                     [&](SatelliteId sv) { return constellation->state(sv, t).has_value(); });
    if (valid < 4)
      return Error{file.name, 0, key,
                   "only " + std::to_string(valid) + " GPS satellites have a valid ephemeris at " + t.iso(0) +
                       " (the file covers " + span + ")",
                   "at least 4"};
  }
  return Ok{};
}

}  // namespace canyon::gnss

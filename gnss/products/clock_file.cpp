#include "canyon/gnss/products/clock_file.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/files/files.h"
#include "canyon/gnss/rinex/calendar_fields.h"
#include "canyon/gnss/rinex/reader_warnings.h"
#include "canyon/gnss/rinex/satellite_name.h"
#include "canyon/gnss/rinex/text_lines.h"

namespace canyon::gnss {
namespace {

constexpr const char* kExpectedClock = "a RINEX clock file of version 2 or 3";

/// Header up to END OF HEADER; whether its times are UTC.
Result<bool> read_header(TextLines& lines, const std::string& file) {
  if (!lines.next()) return Error{file, 1, "", "the file is empty", kExpectedClock};
  const auto label = [&] { return columns(lines.line(), 60, 20); };
  const auto version = fortran_number(columns(lines.line(), 0, 9));
  if (label() != "RINEX VERSION / TYPE" || !version || columns(lines.line(), 20, 1) != "C")
    return Error{file, 1, "", "not a RINEX clock file: the first line has no version and type \"C\"", kExpectedClock};
  if (!(*version >= 2.0 && *version < 3.045))  // later versions move the columns
    return Error{file, 1, "", "RINEX clock version " + join_values(*version) + " is not supported", "2.00 to 3.04"};
  bool utc = false;
  while (lines.next()) {
    if (label() == "TIME SYSTEM ID") utc = columns(lines.line(), 3, 3) == "UTC";
    if (label() == "END OF HEADER") return utc;
  }
  return Error{file, lines.number(), "", "the file ends inside its header", "a line \"END OF HEADER\""};
}

double most_frequent_step_s(const std::map<SatelliteId, std::vector<ClockSample>>& satellites) {
  std::map<std::int64_t, int> steps;
  for (const auto& [sv, samples] : satellites)
    for (std::size_t i = 1; i < samples.size(); ++i) ++steps[samples[i].t.ns - samples[i - 1].t.ns];
  const auto most =
      std::max_element(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == steps.end() ? 0.0 : 1e-9 * static_cast<double>(most->first);
}

}  // namespace

double ClockFile::clock_s(SatelliteId sv, GpsTime t) const {
  const auto found = satellites.find(sv);
  if (found == satellites.end()) return kNaN;
  const auto& samples = found->second;
  const auto after = std::lower_bound(samples.begin(), samples.end(), t,
                                      [](const ClockSample& s, GpsTime time) { return s.t < time; });
  if (after == samples.end()) return kNaN;
  if (after->t == t) return after->clock_s;
  if (after == samples.begin()) return kNaN;
  const auto before = std::prev(after);
  const double step_s = after->t - before->t;
  if (step_s > 1.5 * interval_s) return kNaN;
  return before->clock_s + (after->clock_s - before->clock_s) * ((t - before->t) / step_s);
}

Result<ClockFile> parse_clock_file(std::string_view text, const std::string& file_name) {
  TextLines lines(text);
  CANYON_TRY(const bool utc, read_header(lines, file_name));
  ClockFile out;
  out.name = file_name;
  ReaderWarnings warnings(file_name, "damaged lines");
  while (lines.next()) {
    const std::string_view line = lines.line();
    if (!line.starts_with("AS ")) continue;  // receivers, calibrations, continuation lines
    const auto sv = satellite_of_name(columns(line, 3, 4));
    if (!sv && system_of_letter(line.size() > 3 ? line[3] : ' ') == std::nullopt) continue;  // other systems
    const auto t = time_of_words(columns(line, 8, 26));
    const auto clock = fortran_number(columns(line, 40, 19));
    if (!sv || !t || !clock || std::abs(*clock) > 1.0) {
      warnings.note(lines.number(), "the clock of " + printable(columns(line, 3, 4)) + " cannot be read; skipped");
      continue;
    }
    out.satellites[*sv].push_back({utc ? gps_time_of_utc(*t) : *t, *clock});
  }
  if (out.satellites.empty())
    return Error{file_name, std::max(lines.number(), 1), "", "no satellite clock", "lines that start with \"AS\""};
  for (auto& [sv, samples] : out.satellites) {
    std::stable_sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
    samples.erase(std::unique(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.t == b.t; }),
                  samples.end());
  }
  out.interval_s = most_frequent_step_s(out.satellites);
  out.warnings = warnings.list();
  return out;
}

Result<ClockFile> read_clock_file(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  return parse_clock_file(text, path);
}

}  // namespace canyon::gnss

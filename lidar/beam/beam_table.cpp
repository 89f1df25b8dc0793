#include "canyon/lidar/beam/beam_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "canyon/core/config/config.h"
#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/process/embedded.h"
#include "canyon/core/units.h"

namespace canyon::lidar {
namespace {

constexpr std::string_view kFolder = "lidar/beams/";
constexpr std::string_view kHeader = "laser,elevation_deg,azimuth_offset_deg,origin_up_mm,firing_us";

struct Field {
  const char* name;
  double min, max;
};
// A firing cycle longer than 100 ms would not fit into the slowest revolution.
constexpr std::size_t kShortFields = 5;
constexpr std::string_view kMoreHeader = ",origin_out_mm,origin_left_mm";
constexpr std::array<Field, 7> kFields{{{"laser", 0, 1023},
                                        {"elevation_deg", -90, 90},
                                        {"azimuth_offset_deg", -180, 180},
                                        {"origin_up_mm", -1000, 1000},
                                        {"firing_us", 0, 1e5},
                                        {"origin_out_mm", -1000, 1000},
                                        {"origin_left_mm", -1000, 1000}}};
constexpr Field kCycle{"cycle_us", 0, 1e5};

std::string_view trim(std::string_view s) {
  while (!s.empty() && s.back() == '\r') s.remove_suffix(1);
  return trimmed(s);
}

std::vector<std::string_view> split(std::string_view line) {
  auto parts = canyon::split(line, ",", false);
  for (std::string_view& part : parts) part = trimmed(part);
  return parts;
}

Result<double> number(std::string_view text, const Field& field, const std::string& file, int line) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool parsed = code == std::errc() && end == text.data() + text.size();
  if (!parsed || !(value >= field.min && value <= field.max)) {
    return Error{file, line, field.name, '"' + std::string(text) + '"', range_text({field.min, field.max}, false)};
  }
  return value;
}

/// A text file's lines without comments and blanks, with their numbers.
struct Line {
  int number;
  std::string_view text;
};
std::vector<Line> content_lines(std::string_view text) {
  std::vector<Line> lines;
  for (int number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    const std::string_view line = trim(text.substr(0, end));
    if (!line.empty() && line.front() != '#') lines.push_back({number, line});
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

constexpr std::array<Field, 6> kRosetteFields{{{"lasers", 1, 1024},
                                               {"points_per_s", 1, 1e8},
                                               {"head_hz", 0.01, 1e4},
                                               {"swing_hz", 0.01, 1e5},
                                               {"elevation_min_deg", -90, 90},
                                               {"elevation_max_deg", -90, 90}}};

Result<BeamTable> parse_rosette(const std::vector<Line>& lines, const std::string& file_name) {
  std::array<double, kRosetteFields.size()> values{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Field& field = kRosetteFields[k];
    const std::string expected = std::string(field.name) + ",VALUE";
    if (k + 1 >= lines.size()) return Error{file_name, 0, "", "the file ends early", expected};
    const auto parts = split(lines[k + 1].text);
    if (parts.size() != 2 || parts[0] != field.name)
      return Error{file_name, lines[k + 1].number, "", '"' + std::string(lines[k + 1].text) + '"', expected};
    CANYON_TRY(values[k], number(parts[1], field, file_name, lines[k + 1].number));
  }
  if (lines.size() > values.size() + 1) {
    const Line& extra = lines[values.size() + 1];
    return Error{file_name, extra.number, "", '"' + std::string(extra.text) + '"', "nothing more"};
  }
  if (!(values[4] < values[5]))
    return Error{file_name, lines[5].number, "elevation_min_deg", number_text(values[4]),
                 "less than elevation_max_deg, " + number_text(values[5])};
  if (values[0] != std::floor(values[0]))
    return Error{file_name, lines[1].number, "lasers", number_text(values[0]), "a whole number"};
  BeamTable table;
  const auto lasers = static_cast<std::size_t>(values[0]);
  table.cycle_s = static_cast<double>(lasers) / values[1];
  for (std::size_t k = 0; k < lasers; ++k) table.beams.push_back({.firing_s = static_cast<double>(k) / values[1]});
  table.rosette = Rosette{.points_per_s = values[1],
                          .head_hz = values[2],
                          .swing_hz = values[3],
                          .elevation_min_rad = values[4] * kDegree,
                          .elevation_max_rad = values[5] * kDegree};
  return table;
}

/// "grid:LASERS:MIN_DEG:MAX_DEG"
Result<BeamTable> grid(const std::string& text) {
  const auto parts = canyon::split(text, ":", false);
  const auto wrong = [&] {
    return Error{"", 0, "lidar.beams", '"' + text + '"', "grid:LASERS:MIN_DEG:MAX_DEG, such as grid:32:-25:15"};
  };
  if (parts.size() != 4) return wrong();
  const auto lasers = number(parts[1], {"lasers", 1, 1024}, "", 0);
  const auto min_deg = number(parts[2], {"min", -90, 90}, "", 0), max_deg = number(parts[3], {"max", -90, 90}, "", 0);
  if (!lasers || !min_deg || !max_deg || *lasers != std::floor(*lasers) || *min_deg > *max_deg) return wrong();
  BeamTable table;
  table.name = text;
  const auto n = static_cast<std::size_t>(*lasers);
  for (std::size_t j = 0; j < n; ++j) {
    const double share = n == 1 ? 0.5 : static_cast<double>(j) / static_cast<double>(n - 1);
    table.beams.push_back({.elevation_rad = (*min_deg + share * (*max_deg - *min_deg)) * kDegree});
  }
  return table;
}

}  // namespace

double BeamTable::last_firing_s() const {
  double last = 0;
  for (const Beam& beam : beams) last = std::max(last, beam.firing_s);
  return last;
}

Result<BeamTable> parse_beam_table(std::string_view csv, const std::string& file_name) {
  const std::vector<Line> lines = content_lines(csv);
  const auto wrong = [&](std::size_t i, std::string expected) {
    const bool there = i < lines.size();
    return Error{file_name, there ? lines[i].number : 0, "",
                 there ? '"' + std::string(lines[i].text) + '"' : "the file ends early", std::move(expected)};
  };
  if (!lines.empty() && lines[0].text == "rosette") return parse_rosette(lines, file_name);
  BeamTable table;
  if (lines.empty() || !lines[0].text.starts_with("cycle_us,")) return wrong(0, "cycle_us,VALUE");
  CANYON_TRY(const double cycle_us, number(trim(lines[0].text.substr(9)), kCycle, file_name, lines[0].number));
  table.cycle_s = cycle_us * 1e-6;
  const std::string long_header = std::string(kHeader) + std::string(kMoreHeader);
  const bool more = lines.size() > 1 && lines[1].text == long_header;
  if (!more && (lines.size() < 2 || lines[1].text != kHeader)) return wrong(1, std::string(kHeader));
  const std::size_t columns = more ? kFields.size() : kShortFields;
  if (lines.size() < 3) return wrong(2, "one line per laser");
  double last_firing_us = 0;
  for (std::size_t i = 2; i < lines.size(); ++i) {
    const auto parts = split(lines[i].text);
    if (parts.size() != columns)
      return wrong(i, std::to_string(columns) + " values: " + (more ? long_header : std::string(kHeader)));
    std::array<double, kFields.size()> values{};
    for (std::size_t k = 0; k < columns; ++k) {
      CANYON_TRY(values[k], number(parts[k], kFields[k], file_name, lines[i].number));
    }
    if (values[0] != static_cast<double>(i - 2)) return wrong(i, join_values("laser ", i - 2));
    last_firing_us = std::max(last_firing_us, values[4]);
    table.beams.push_back({.elevation_rad = values[1] * kDegree,
                           .azimuth_offset_rad = values[2] * kDegree,
                           .origin_up_m = values[3] * 1e-3,
                           .firing_s = values[4] * 1e-6,
                           .origin_out_m = values[5] * 1e-3,
                           .origin_left_m = values[6] * 1e-3});
  }
  if (cycle_us > 0 && last_firing_us >= cycle_us) {
    return Error{file_name, lines[0].number, "cycle_us", number_text(cycle_us),
                 "more than the last firing_us, " + number_text(last_firing_us)};
  }
  return table;
}

Result<BeamTable> load_beam_table(const std::string& name_or_path) {
  if (name_or_path.ends_with(".csv")) {
    CANYON_TRY(const std::string text, read_text_file(name_or_path));
    CANYON_TRY(BeamTable table, parse_beam_table(text, name_or_path));
    table.name = name_or_path;
    return table;
  }
  if (name_or_path.starts_with("grid:")) return grid(name_or_path);
  const std::string key = std::string(kFolder) + name_or_path + ".csv";
  if (const auto text = embedded_file(key)) {
    CANYON_TRY(BeamTable table, parse_beam_table(*text, key));
    table.name = name_or_path;
    return table;
  }
  std::string known;
  for (const std::string& name : builtin_beam_tables()) known += (known.empty() ? "" : ", ") + name;
  const std::string nearest = nearest_word(name_or_path, builtin_beam_tables());
  return Error{
      "", 0, "lidar.beams",
      "unknown beam table \"" + name_or_path + '"' + (nearest.empty() ? "" : " (did you mean \"" + nearest + "\"?)"),
      "one of " + known + ", grid:LASERS:MIN_DEG:MAX_DEG, or the path of a .csv file"};
}

std::vector<std::string> builtin_beam_tables() {
  std::vector<std::string> names;
  for (std::string_view key : embedded_files(kFolder)) {
    if (key.ends_with(".csv")) names.emplace_back(key.substr(kFolder.size(), key.size() - kFolder.size() - 4));
  }
  return names;
}

}  // namespace canyon::lidar

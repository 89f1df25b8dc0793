#include "canyon/gnss/products/antex_file.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/gnss/rinex/calendar_fields.h"
#include "canyon/gnss/rinex/reader_warnings.h"
#include "canyon/gnss/rinex/satellite_name.h"
#include "canyon/gnss/rinex/text_lines.h"

namespace canyon::gnss {
namespace {

std::string_view label(std::string_view line) {
  return columns(line, 60, 20);
}

class AntexReader {
 public:
  AntexReader(std::string_view text, const std::string& file)
      : lines_(text), file_(file), warnings_(file, "damaged lines") {}

  Result<AntexFile> read() {
    out_.name = file_;
    if (!lines_.next()) return Error{file_, 1, "", "the file is empty", "an ANTEX 1.3 or 1.4 file"};
    const auto version = fortran_number(columns(lines_.line(), 0, 8));
    if (label(lines_.line()) != "ANTEX VERSION / SYST" || !version)
      return Error{file_, 1, "", "not an ANTEX file: the first line has no version and \"ANTEX VERSION / SYST\"",
                   "an ANTEX 1.3 or 1.4 file"};
    if (!(*version >= 1.3 && *version < 1.45))
      return Error{file_, 1, "", "ANTEX version " + join_values(*version) + " is not supported", "1.3 or 1.4"};
    while (lines_.next())
      if (label(lines_.line()) == "START OF ANTENNA") antenna();
    if (out_.antennas.empty())
      return Error{file_, lines_.number(), "", "no usable antenna", "\"START OF ANTENNA\" and what belongs to it"};
    out_.warnings = warnings_.list();
    return out_;
  }

 private:
  void antenna() {
    Antenna a;
    AntennaPattern common;
    double zenith_last_deg = 0.0;
    std::string problem;
    const auto complain = [&](const std::string& what) {
      if (problem.empty()) warnings_.note(lines_.number(), what + "; the antenna is skipped");
      if (problem.empty()) problem = what;
    };
    while (lines_.next()) {
      const std::string_view line = lines_.line(), name = label(line);
      if (name == "END OF ANTENNA") {
        if (problem.empty()) out_.antennas.push_back(std::move(a));
        return;
      }
      if (name == "TYPE / SERIAL NO") {
        a.type = columns(line, 0, 20);
        // Satellites bear their name in the second field and the space vehicle's number in the third.
        if (!columns(line, 40, 10).empty()) a.sv = satellite_of_name(columns(line, 20, 3));
      } else if (name == "DAZI") {
        common.azimuth_step_deg = number(columns(line, 2, 6), "DAZI", complain);
      } else if (name == "ZEN1 / ZEN2 / DZEN") {
        common.zenith_first_deg = number(columns(line, 2, 6), "ZEN1", complain);
        zenith_last_deg = number(columns(line, 8, 6), "ZEN2", complain);
        common.zenith_step_deg = number(columns(line, 14, 6), "DZEN", complain);
      } else if (name == "VALID FROM" || name == "VALID UNTIL") {
        const auto t = time_of_words(columns(line, 0, 43));
        if (!t) complain(std::string(name) + " cannot be read");
        (name == "VALID FROM" ? a.valid_from : a.valid_to) = t;
      } else if (name == "START OF FREQUENCY") {
        const double span_deg = zenith_last_deg - common.zenith_first_deg;
        if (!(common.zenith_step_deg > 0.0 && span_deg >= 0.0 && span_deg <= 180.0 && common.azimuth_step_deg >= 0.0 &&
              span_deg / common.zenith_step_deg < 1000.0))
          complain("the zenith angles make no grid");
        const auto width =
            problem.empty() ? static_cast<std::size_t>(std::lround(span_deg / common.zenith_step_deg)) + 1 : 0;
        frequency(std::string(columns(line, 3, 3)), common, width, a, complain);
      }
    }
    warnings_.note(lines_.number(), "the file ends inside an antenna, which is skipped");
  }

  template <class Complain>
  void frequency(const std::string& code, AntennaPattern pattern, std::size_t width, Antenna& a, Complain& complain) {
    while (lines_.next()) {
      const std::string_view line = lines_.line(), name = label(line);
      if (name == "END OF FREQUENCY" || name == "END OF ANTENNA") break;
      // The lines of the pattern have no label, but numbers in its columns.
      if (name == "NORTH / EAST / UP") {
        for (Eigen::Index i = 0; i < 3; ++i)
          pattern.offset_m[i] =
              1e-3 * number(columns(line, static_cast<std::size_t>(10 * i), 10), "NORTH / EAST / UP", complain);
      } else if (columns(line, 0, 8) == "NOAZI") {
        pattern.no_azimuth_m = values(line, width, complain);
      } else if (pattern.azimuth_step_deg > 0.0 && fortran_number(columns(line, 0, 8))) {
        pattern.by_azimuth_m.push_back(values(line, width, complain));
      }
    }
    if (label(lines_.line()) != "END OF FREQUENCY") complain("a frequency without END OF FREQUENCY");
    const auto rows = pattern.azimuth_step_deg > 0.0
                          ? static_cast<std::size_t>(std::lround(360.0 / pattern.azimuth_step_deg)) + 1
                          : 0;
    if (!pattern.by_azimuth_m.empty() && pattern.by_azimuth_m.size() != rows)
      complain("frequency " + printable(code) + " has " + std::to_string(pattern.by_azimuth_m.size()) +
               " azimuths, not " + std::to_string(rows));
    a.patterns.emplace(code, std::move(pattern));
  }

  template <class Complain>
  double number(std::string_view text, const char* what, Complain& complain) {
    const auto value = fortran_number(text);
    if (!value) complain(std::string(what) + " = \"" + printable(text) + "\" is not a number");
    return value.value_or(0.0);
  }

  template <class Complain>
  std::vector<double> values(std::string_view line, std::size_t width, Complain& complain) {
    std::vector<double> out;
    for (std::size_t i = 0; i < width; ++i)
      out.push_back(1e-3 * number(columns(line, 8 + 8 * i, 8), "phase centre variation", complain));
    return out;
  }

  TextLines lines_;
  const std::string& file_;
  ReaderWarnings warnings_;
  AntexFile out_;
};

/// Linear between the values at i and i + 1, i + fraction = place.
double between(const std::vector<double>& row, double place) {
  const double last = static_cast<double>(row.size() - 1);
  const double at = std::clamp(place, 0.0, last);
  const auto i = static_cast<std::size_t>(std::min(std::floor(at), std::max(last - 1.0, 0.0)));
  const std::size_t j = std::min(i + 1, row.size() - 1);
  return row[i] + (at - static_cast<double>(i)) * (row[j] - row[i]);
}

}  // namespace

double AntennaPattern::variation_m(double zenith_rad, double azimuth_rad) const {
  const double place = (zenith_rad / kDegree - zenith_first_deg) / zenith_step_deg;
  if (by_azimuth_m.empty()) return no_azimuth_m.empty() ? 0.0 : between(no_azimuth_m, place);
  const double turns = azimuth_rad / (2.0 * kPi);
  const double row = (turns - std::floor(turns)) * 360.0 / azimuth_step_deg;
  const auto i = std::min(static_cast<std::size_t>(row), by_azimuth_m.size() - 1);
  const std::size_t j = std::min(i + 1, by_azimuth_m.size() - 1);
  const double low = between(by_azimuth_m[i], place), high = between(by_azimuth_m[j], place);
  return low + (row - static_cast<double>(i)) * (high - low);
}

const AntennaPattern* Antenna::pattern(const std::string& frequency) const {
  const auto found = patterns.find(frequency);
  return found == patterns.end() ? nullptr : &found->second;
}

const Antenna* AntexFile::satellite(SatelliteId sv, GpsTime t) const {
  for (const Antenna& a : antennas)
    if (a.sv == sv && (!a.valid_from || t >= *a.valid_from) && (!a.valid_to || t <= *a.valid_to)) return &a;
  return nullptr;
}

const Antenna* AntexFile::receiver(const std::string& type) const {
  const auto find = [&](std::string_view wanted) -> const Antenna* {
    for (const Antenna& a : antennas)
      if (!a.sv && a.type == wanted) return &a;
    return nullptr;
  };
  std::string full = type;
  while (full.ends_with(' ')) full.pop_back();
  if (const Antenna* exact = find(full)) return exact;
  std::string bare = full.substr(0, 16);  // name in 16 columns, radome in 4
  bare.resize(16, ' ');
  return find(bare + "NONE");
}

Result<AntexFile> parse_antex_file(std::string_view text, const std::string& file_name) {
  return AntexReader(text, file_name).read();
}

Result<AntexFile> read_antex_file(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  return parse_antex_file(text, path);
}

}  // namespace canyon::gnss

#include "canyon/gnss/rinex/navigation/navigation_header.h"

#include <array>
#include <cstdio>
#include <map>

namespace canyon::gnss {
namespace {

constexpr const char* kExpectedFile = "a RINEX 2, 3 or 4 navigation file";

std::string_view label(std::string_view line) {
  return columns(line, 60, 20);
}

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

Status parse_first_line(TextLines& lines, const std::string& file, NavigationHeader& out) {
  if (!lines.next()) return Error{file, 1, "", "the file is empty", kExpectedFile};
  const std::string_view line = lines.line();
  const auto version = fortran_number(columns(line, 0, 9));
  if (label(line) != "RINEX VERSION / TYPE" || !version)
    return Error{file, 1, "", "not a RINEX file: the first line has no version and \"RINEX VERSION / TYPE\"",
                 kExpectedFile};
  out.version = *version;
  if (!(out.version >= 2.0 && out.version < 5.0))
    return Error{file, 1, "", "RINEX version " + fixed(out.version, 2) + " is not supported", "2.x, 3.x or 4.x"};

  const char type = line.size() > 20 ? line[20] : ' ';
  const char system = line.size() > 40 ? line[40] : ' ';
  const bool glonass2 = out.version2() && type == 'G';
  if (type != 'N' && !glonass2)
    return Error{file, 1, "", "RINEX file type \"" + printable({&type, 1}) + "\"",
                 "\"N\", navigation data, or \"G\", GLONASS navigation data of RINEX 2"};
  out.system = out.version2() ? (glonass2 ? 'R' : 'G') : system;
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

class HeaderReader {
 public:
  HeaderReader(TextLines& lines, const std::string& file, NavigationHeader& out)
      : lines_(lines), file_(file), out_(out) {}

  Status read_all() {
    while (lines_.next()) {
      const std::string_view name = label(lines_.line());
      if (name == "END OF HEADER") {
        for (const auto& [system, pair] : klobuchar_)
          if (pair.alpha && pair.beta) out_.klobuchar.push_back({system, {}, {*pair.alpha, *pair.beta}});
        return Ok{};
      }
      if (name == "ION ALPHA" || name == "ION BETA" || name == "IONOSPHERIC CORR")
        ionosphere(name);
      else if (name == "LEAP SECONDS") {
        out_.leap_seconds = whole_number(columns(lines_.line(), 0, 6));
        if (!out_.leap_seconds) return unreadable("LEAP SECONDS", "a whole number");
      }
    }
    return Error{file_, lines_.number(), "", "the file ends inside its header", "a line \"END OF HEADER\""};
  }

 private:
  struct Pair {
    std::optional<std::array<double, 4>> alpha, beta;
  };

  Error unreadable(const std::string& what, const std::string& expected) const {
    return Error{file_, lines_.number(), what, "cannot be read", expected};
  }

  /// RINEX 2: two lines of GPS. RINEX 3: GPSA, GPSB, BDSA, ...; of several (BDSA by hour) the first counts. Galileo's
  /// NeQuick is not used. A line that cannot be read is left out: the ephemerides are good without it.
  void ionosphere(std::string_view name) {
    const std::string_view line = lines_.line();
    const bool version2 = name != "IONOSPHERIC CORR";
    const std::string_view code = version2 ? (name == "ION ALPHA" ? "GPSA" : "GPSB") : columns(line, 0, 4);
    static const std::map<std::string_view, GnssSystem> systems = {
        {"GPS", GnssSystem::kGps}, {"QZS", GnssSystem::kQzss}, {"BDS", GnssSystem::kBeidou}};
    const auto system = systems.find(code.substr(0, 3));
    if (system == systems.end() || code.size() != 4) return;  // GAL, NavIC and whatever comes
    const auto values = four_numbers(line, version2 ? 2 : 5);
    const bool alpha = code.back() == 'A';
    const bool sane =
        values && is_sane(alpha ? KlobucharCoefficients{*values, {}} : KlobucharCoefficients{{}, *values});
    if (!sane) {
      const std::string expected = alpha ? "four numbers up to 1e-4" : "four numbers up to 1e8";
      out_.warnings.push_back(unreadable(std::string(code), expected).str() + "; skipped");
      return;
    }
    Pair& pair = klobuchar_[system->second];
    auto& half = alpha ? pair.alpha : pair.beta;
    if (!half) half = values;
  }

  TextLines& lines_;
  const std::string& file_;
  NavigationHeader& out_;
  std::map<GnssSystem, Pair> klobuchar_;
};

}  // namespace

Result<NavigationHeader> parse_navigation_header(TextLines& lines, const std::string& file_name) {
  NavigationHeader out;
  CANYON_TRY_STATUS(parse_first_line(lines, file_name, out));
  CANYON_TRY_STATUS(HeaderReader(lines, file_name, out).read_all());
  return out;
}

}  // namespace canyon::gnss

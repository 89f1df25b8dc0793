#include "canyon/gnss/rinex/observation/observation_header.h"

#include <cstdio>

namespace canyon::gnss {
namespace {

constexpr int kMostTypes = 999;

std::string fixed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

std::optional<Eigen::Vector3d> three_numbers(std::string_view line) {
  Eigen::Vector3d out;
  for (int i = 0; i < 3; ++i) {
    const auto value = fortran_number(columns(line, 14 * static_cast<std::size_t>(i), 14));
    if (!value) return std::nullopt;
    out[i] = *value;
  }
  return out;
}

}  // namespace

Error ObservationHeaderReader::cannot_read(const char* label, int number, const char* expected) const {
  return Error{file_, number, label, "cannot be read", expected};
}

Status ObservationHeaderReader::first_line(std::string_view line, int number) {
  const auto version = fortran_number(columns(line, 0, 9));
  if (columns(line, 60, 20) != "RINEX VERSION / TYPE" || !version)
    return Error{file_, number, "", "not a RINEX file: the first line has no version and \"RINEX VERSION / TYPE\"",
                 "a RINEX 2, 3 or 4 observation file"};
  header_.version = *version;
  if (!(*version >= 2.0 && *version < 5.0))
    return Error{file_, number, "", "RINEX version " + fixed(*version) + " is not supported", "2.x, 3.x or 4.x"};
  const char type = line.size() > 20 ? line[20] : ' ';
  if (type != 'O' && type != 'o')
    return Error{file_, number, "", "RINEX file type \"" + printable({&type, 1}) + "\"", "\"O\", observation data"};
  header_.system = line.size() > 40 && line[40] != ' ' ? line[40] : 'G';
  if (header_.system == 'R') header_.time_system = "GLO";
  if (header_.system == 'C') header_.time_system = "BDT";
  return Ok{};
}

Status ObservationHeaderReader::line(std::string_view line, int number) {
  const std::string_view label = columns(line, 60, 20);
  if (label == "SYS / # / OBS TYPES") return types3(line, number);
  if (label == "# / TYPES OF OBSERV") return types2(line, number);
  if (label == "SYS / SCALE FACTOR") return scale_factor(line, number);
  if (label == "GLONASS SLOT / FRQ #") return glonass_slots(line, number);
  if (label == "MARKER NAME") header_.marker_name = columns(line, 0, 60);
  if (label == "REC # / TYPE / VERS") header_.receiver = columns(line, 20, 20);
  if (label == "ANT # / TYPE") header_.antenna = columns(line, 20, 20);
  if (label == "APPROX POSITION XYZ" && !columns(line, 0, 60).empty()) {
    const auto position = three_numbers(line);
    if (!position) return cannot_read("APPROX POSITION XYZ", number, "three numbers");
    // Moving receivers write zeros, which is the Earth's centre, not a position.
    if (position->norm() > 1e6) header_.approx_position_E = *position;
  }
  if (label == "INTERVAL") header_.interval_s = fortran_number(columns(line, 0, 10));
  if (label == "LEAP SECONDS") header_.leap_seconds = whole_number(columns(line, 0, 6));
  if (label == "TIME OF FIRST OBS") {
    const std::string_view system = columns(line, 48, 3);
    if (system == "GPS" || system == "GLO" || system == "GAL" || system == "QZS" || system == "BDT") {
      header_.time_system = system;
    } else if (!system.empty()) {
      return Error{file_, number, "TIME OF FIRST OBS", "time system \"" + printable(system) + "\"",
                   "GPS, GLO, GAL, QZS or BDT"};
    }
  }
  return Ok{};
}

Status ObservationHeaderReader::types3(std::string_view line, int number) {
  if (!version3()) return Ok{};
  if (!line.empty() && line[0] != ' ') {
    letter_ = line[0];
    const auto count = whole_number(columns(line, 1, 5));
    if (letter_ < 'A' || letter_ > 'Z' || !count || *count < 0 || *count > kMostTypes)
      return cannot_read("SYS / # / OBS TYPES", number, "a system's letter and the number of its codes");
    counts_[static_cast<std::size_t>(letter_ - 'A')] = static_cast<std::size_t>(*count);
    listed_ = 0;
    if (const auto system = system_of_letter(letter_)) codes_[static_cast<std::size_t>(*system)].clear();
  }
  if (letter_ == ' ') return cannot_read("SYS / # / OBS TYPES", number, "a system's letter first");
  const auto system = system_of_letter(letter_);
  for (std::size_t i = 0; i < 13; ++i) {
    const std::string_view text = columns(line, 7 + 4 * i, 3);
    if (text.empty()) continue;
    ++listed_;
    auto code = parse_observation_code(text);
    if (!code)
      return Error{file_, number, "SYS / # / OBS TYPES", "\"" + printable(text) + "\" is not an observation code",
                   "a code like C1C"};
    // RINEX 3.02 wrote BeiDou's B1I as band 1.
    if (system == GnssSystem::kBeidou && header_.version < 3.025 && code->band == '1') code->band = '2';
    if (system) codes_[static_cast<std::size_t>(*system)].push_back(*code);
  }
  if (listed_ > counts_[static_cast<std::size_t>(letter_ - 'A')])
    return Error{file_, number, "SYS / # / OBS TYPES", "more codes of " + std::string(1, letter_) + " than announced",
                 std::to_string(counts_[static_cast<std::size_t>(letter_ - 'A')])};
  return Ok{};
}

Status ObservationHeaderReader::types2(std::string_view line, int number) {
  if (version3()) return Ok{};
  if (const std::string_view count = columns(line, 0, 6); !count.empty()) {
    const auto n = whole_number(count);
    if (!n || *n < 0 || *n > kMostTypes)
      return cannot_read("# / TYPES OF OBSERV", number, "the number of observation types");
    expected2_ = static_cast<std::size_t>(*n);
    names2_.clear();
  }
  for (std::size_t i = 0; i < 9; ++i)
    if (const std::string_view name = columns(line, 6 + 6 * i, 6); !name.empty()) names2_.emplace_back(name);
  return Ok{};
}

Status ObservationHeaderReader::scale_factor(std::string_view line, int number) {
  if (!line.empty() && line[0] != ' ') {
    scale_letter_ = line[0];
    const auto factor = whole_number(columns(line, 2, 4));
    if (!factor || *factor <= 0) return cannot_read("SYS / SCALE FACTOR", number, "1, 10, 100 or 1000");
    scale_value_ = *factor;
  }
  const auto system = system_of_letter(scale_letter_);
  if (!system || scale_letter_ == ' ') return Ok{};
  const auto& codes = codes_[static_cast<std::size_t>(*system)];
  auto& scale = scale_[static_cast<std::size_t>(*system)];
  scale.resize(codes.size(), 1.0);
  bool named = false;
  for (std::size_t i = 0; i < 12; ++i) {
    const auto code = parse_observation_code(columns(line, 11 + 4 * i, 3));
    for (std::size_t k = 0; code && k < codes.size(); ++k)
      if (codes[k] == *code) scale[k] = scale_value_;
    named = named || code.has_value();
  }
  if (!named) scale.assign(codes.size(), scale_value_);  // no list: all codes of the system
  return Ok{};
}

Status ObservationHeaderReader::glonass_slots(std::string_view line, int number) {
  for (std::size_t i = 0; i < 8; ++i) {
    const std::string_view slot = columns(line, 4 + 7 * i, 3), channel = columns(line, 8 + 7 * i, 2);
    if (slot.empty()) continue;
    const auto prn = whole_number(slot.substr(1)), k = whole_number(channel);
    if (slot[0] != 'R' || !prn || !k || *k < -7 || *k > 13)
      return cannot_read("GLONASS SLOT / FRQ #", number, "slots and frequency numbers like R01  1");
    header_.glonass_channels[*prn] = *k;
  }
  return Ok{};
}

std::size_t ObservationHeaderReader::count(char letter) const {
  if (!version3()) return names2_.size();
  return letter >= 'A' && letter <= 'Z' ? counts_[static_cast<std::size_t>(letter - 'A')] : 0;
}

Status ObservationHeaderReader::finish(int number) {
  if (!version3()) {
    if (names2_.size() != expected2_)
      return Error{file_, number, "# / TYPES OF OBSERV", std::to_string(names2_.size()) + " observation types listed",
                   std::to_string(expected2_) + " as announced"};
    for (const GnssSystem system : kGnssSystems) {
      auto& codes = codes_[static_cast<std::size_t>(system)];
      codes.clear();
      for (const auto& name : names2_)
        codes.push_back(convert_rinex2_code(name, system).value_or(ObservationCode{'?', '0', '?'}));
    }
  }
  bool any = false;
  for (const GnssSystem system : kGnssSystems) {
    const auto& codes = codes_[static_cast<std::size_t>(system)];
    scale_[static_cast<std::size_t>(system)].resize(codes.size(), 1.0);
    any = any || !codes.empty();
    const std::size_t announced = count(system_letter(system));
    if (version3() && codes.size() != announced)
      return Error{file_, number, "SYS / # / OBS TYPES",
                   std::to_string(codes.size()) + " codes of " + std::string(1, system_letter(system)) + " listed",
                   std::to_string(announced) + " as announced"};
  }
  if (!any)
    return Error{file_, number, version3() ? "SYS / # / OBS TYPES" : "# / TYPES OF OBSERV",
                 "no observation types in the header", "at least one"};
  return Ok{};
}

}  // namespace canyon::gnss

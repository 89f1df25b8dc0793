#include "canyon/gnss/rinex/observation/observation_code.h"

namespace canyon::gnss {
namespace {

bool is_kind(char c) {
  return c == 'C' || c == 'L' || c == 'D' || c == 'S';
}

char gps_attribute(char kind, char band) {
  if (band == '1') return kind == 'P' ? 'W' : 'C';
  // P2, and phase and Doppler of the second frequency, are of the encrypted code; C2 is the civil one.
  if (band == '2') return kind == 'C' ? 'X' : 'W';
  return 'X';
}

char attribute_of(char kind, char band, GnssSystem system) {
  switch (system) {
    case GnssSystem::kGps:
      return gps_attribute(kind, band);
    case GnssSystem::kGlonass:
      return kind == 'P' ? 'P' : 'C';
    case GnssSystem::kGalileo:
      return 'X';
    case GnssSystem::kBeidou:
      return 'I';
    case GnssSystem::kQzss:
      return band == '1' ? 'C' : 'X';
    case GnssSystem::kSbas:
      return band == '1' ? 'C' : 'X';
  }
  return ' ';
}

}  // namespace

std::optional<ObservationCode> parse_observation_code(std::string_view text) {
  if (text.size() != 3 || text[1] < '1' || text[1] > '9' || text[2] < 'A' || text[2] > 'Z') return std::nullopt;
  if (!is_kind(text[0]) && text[0] != 'X' && text[0] != 'I') return std::nullopt;
  return ObservationCode{text[0], text[1], text[2]};
}

std::optional<ObservationCode> convert_rinex2_code(std::string_view name, GnssSystem system) {
  if (name.size() != 2) return std::nullopt;
  const char kind = name[0], band = name[1];
  if (band >= 'A' && band <= 'D') {  // RINEX 2.12: A = L1 C/A, B = L1C, C = L2C, D = GLONASS L2 C/A
    if (!is_kind(kind)) return std::nullopt;
    constexpr std::string_view kBands = "1122", kAttributes = "CXXC";
    const auto i = static_cast<std::size_t>(band - 'A');
    return ObservationCode{kind, kBands[i], kAttributes[i]};
  }
  if (band < '1' || band > '9' || !(is_kind(kind) || kind == 'P')) return std::nullopt;
  const char rinex3_band = system == GnssSystem::kBeidou && band == '1' ? '2' : band;
  return ObservationCode{kind == 'P' ? 'C' : kind, rinex3_band, attribute_of(kind, band, system)};
}

std::optional<GnssSystem> system_of_letter(char letter) {
  switch (letter) {
    case ' ':
    case 'G':
      return GnssSystem::kGps;
    case 'R':
      return GnssSystem::kGlonass;
    case 'E':
      return GnssSystem::kGalileo;
    case 'C':
      return GnssSystem::kBeidou;
    case 'J':
      return GnssSystem::kQzss;
    case 'S':
      return GnssSystem::kSbas;
    default:
      return std::nullopt;
  }
}

}  // namespace canyon::gnss

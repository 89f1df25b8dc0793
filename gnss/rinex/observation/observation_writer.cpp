#include "canyon/gnss/rinex/observation/observation_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "canyon/core/check.h"
#include "canyon/core/process/version.h"
#include "canyon/gnss/rinex/written_lines.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

constexpr std::string_view kKinds = "CLDS";

char attribute(GnssSystem system, int band) {
  switch (system) {
    case GnssSystem::kGps:
    case GnssSystem::kQzss:
      return band == 2 ? 'L' : band == 5 ? 'Q' : 'C';
    case GnssSystem::kGlonass:
      return 'C';
    case GnssSystem::kGalileo:
      return band == 1 || band == 6 ? 'C' : 'Q';
    case GnssSystem::kBeidou:
      return band == 1 || band == 5 ? 'P' : 'I';
    case GnssSystem::kSbas:
      return band == 5 ? 'I' : 'C';
  }
  return 'C';
}

/// F14.3 and the two flags.
std::string field(double value, bool slipped, double cn0_dbhz) {
  if (!std::isfinite(value)) return std::string(16, ' ');
  std::string out = formatted("%14.3f", value);
  if (out.size() != 14 || value == 0.0) return std::string(16, ' ');  // 0.000 would read as missing
  out += slipped ? '1' : ' ';
  // RINEX: 1 is below 12 dB-Hz, 9 from 54 on.
  out += std::isfinite(cn0_dbhz) ? static_cast<char>('0' + std::clamp(static_cast<int>(cn0_dbhz / 6.0), 1, 9)) : ' ';
  return out;
}

struct Measured {
  std::array<double, 4> values;  // C L D S
  bool slipped;
};

std::optional<Measured> of_band(const GnssObservation& o, int band) {
  if (o.band == band) return Measured{{o.pseudorange_m, o.carrier_phase_cycles, o.doppler_hz, o.cn0_dbhz}, o.slipped};
  const GnssSecondSignal& s = o.second;
  if (s.band == band && band != 0)
    return Measured{{s.pseudorange_m, s.carrier_phase_cycles, s.doppler_hz, s.cn0_dbhz}, s.slipped};
  return std::nullopt;
}

std::string time_of(GpsTime t) {
  const CalendarTime c = calendar(t);
  return formatted("%6d%6d%6d%6d%6d%13.7f     GPS", c.year, c.month, c.day, c.hour, c.minute, c.second);
}

/// The tag in the file has 100 ns.
GpsTime rounded(GpsTime t) {
  return GpsTime{(t.ns + 50) / 100 * 100};
}

}  // namespace

ObservationCode ObservationWriter::code(char kind, GnssSystem system, int band) {
  return {kind, static_cast<char>('0' + band), attribute(system, band)};
}

ObservationWriter::ObservationWriter(ObservationWriterOptions options) : options_(std::move(options)) {
  std::set<GnssSystem> seen;
  CANYON_CHECK(!options_.bands.empty(), "no system to write");
  for (const auto& [system, bands] : options_.bands) {
    CANYON_CHECK(seen.insert(system).second, "system ", system_letter(system), " given twice");
    CANYON_CHECK(!bands.empty(), "system ", system_letter(system), " without a band");
    for (const int band : bands)
      CANYON_CHECK(std::isfinite(carrier_hz(system, band)), system_letter(system), " has no band ", band);
  }
}

std::string ObservationWriter::header() const {
  std::string out = labelled(
      formatted(
          "%9.2f           OBSERVATION DATA    %-20s", 3.04,
          options_.bands.size() > 1 ? "M: MIXED" : std::string(1, system_letter(options_.bands.front().first)).c_str()),
      "RINEX VERSION / TYPE");
  const CalendarTime c = calendar(options_.first);
  out += labelled(formatted("%-20s%-20s%04d%02d%02d %02d%02d%02d GPS", (std::string("canyon ") + kVersion).c_str(), "",
                            c.year, c.month, c.day, c.hour, c.minute, static_cast<int>(c.second)),
                  "PGM / RUN BY / DATE");
  out += labelled("simulated observations", "COMMENT");
  out += labelled(options_.marker.substr(0, 60), "MARKER NAME");
  out += labelled("", "OBSERVER / AGENCY");
  out += labelled(formatted("%-20s%-20s%-20s", "", "SIMULATED", kVersion), "REC # / TYPE / VERS");
  out += labelled(formatted("%-20s%-20s", "", "NONE"), "ANT # / TYPE");
  const Eigen::Vector3d p_E = options_.approx_position_E.value_or(Eigen::Vector3d::Zero());
  out += labelled(formatted("%14.4f%14.4f%14.4f", p_E.x(), p_E.y(), p_E.z()), "APPROX POSITION XYZ");
  out += labelled(formatted("%14.4f%14.4f%14.4f", 0.0, 0.0, 0.0), "ANTENNA: DELTA H/E/N");
  for (const auto& [system, bands] : options_.bands) {
    std::vector<std::string> codes;
    for (const int band : bands)
      for (const char kind : kKinds) codes.push_back(code(kind, system, band).str());
    for (std::size_t i = 0; i < codes.size(); i += 13) {
      std::string line = i == 0 ? formatted("%c  %3zu", system_letter(system), codes.size()) : std::string(6, ' ');
      for (std::size_t k = i; k < std::min(i + 13, codes.size()); ++k) line += " " + codes[k];
      out += labelled(line, "SYS / # / OBS TYPES");
    }
  }
  out += labelled("DBHZ", "SIGNAL STRENGTH UNIT");
  if (options_.interval_s) out += labelled(formatted("%10.3f", *options_.interval_s), "INTERVAL");
  out += labelled(time_of(rounded(options_.first)), "TIME OF FIRST OBS");
  for (const auto& [system, bands] : options_.bands)
    for (const int band : bands)
      out += labelled(formatted("%c %s", system_letter(system), code('L', system, band).str().c_str()),
                      "SYS / PHASE SHIFT");
  if (!options_.glonass_channels.empty()) {
    std::string line = formatted("%3zu ", options_.glonass_channels.size());
    int on_line = 0;
    for (const auto& [slot, channel] : options_.glonass_channels) {
      if (on_line == 8) {
        out += labelled(line, "GLONASS SLOT / FRQ #");
        line = "    ";
        on_line = 0;
      }
      line += formatted("R%02d %2d ", slot, channel);
      ++on_line;
    }
    out += labelled(line, "GLONASS SLOT / FRQ #");
    out += labelled(" C1C    0.000 C1P    0.000 C2C    0.000 C2P    0.000", "GLONASS COD/PHS/BIS");
  }
  out += labelled(formatted("%6d", options_.first.leap_seconds()), "LEAP SECONDS");
  return out + labelled("", "END OF HEADER");
}

std::string ObservationWriter::epoch(const GnssEpoch& epoch) const {
  std::string body;
  int count = 0;
  for (const auto& o : epoch.observations) {
    const auto known = std::find_if(options_.bands.begin(), options_.bands.end(),
                                    [&](const auto& entry) { return entry.first == o.sv.system; });
    if (known == options_.bands.end()) continue;
    std::string line = o.sv.str();
    for (const int band : known->second) {
      const auto m = of_band(o, band);
      for (std::size_t kind = 0; kind < kKinds.size(); ++kind)
        line +=
            m ? field(m->values[kind], kind == 1 && m->slipped, kind < 2 ? m->values[3] : kNaN) : std::string(16, ' ');
    }
    while (line.back() == ' ') line.pop_back();
    body += line + "\n";
    ++count;
  }
  const CalendarTime c = calendar(rounded(epoch.t));
  return formatted("> %04d %02d %02d %02d %02d%11.7f  0%3d\n", c.year, c.month, c.day, c.hour, c.minute, c.second,
                   count) +
         body;
}

}  // namespace canyon::gnss

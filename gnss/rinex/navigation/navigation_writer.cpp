#include "canyon/gnss/rinex/navigation/navigation_writer.h"

#include <algorithm>
#include <optional>

#include "canyon/core/process/version.h"
#include "canyon/gnss/rinex/written_lines.h"
#include "canyon/gnss/satellites/system_constants.h"

namespace canyon::gnss {
namespace {

std::string number(double value) {
  return formatted("%19.12E", value);
}

std::string row(double a, double b, double c, double d) {
  return "    " + number(a) + number(b) + number(c) + number(d) + "\n";
}

std::string epoch_line(SatelliteId sv, GpsTime own_time, double a, double b, double c) {
  const CalendarTime t = calendar(own_time);
  return sv.str() +
         formatted(" %04d %02d %02d %02d %02d %02d", t.year, t.month, t.day, t.hour, t.minute,
                   static_cast<int>(t.second)) +
         number(a) + number(b) + number(c) + "\n";
}

/// Field 2 of line 5: Galileo's data sources (RINEX 3.04 table A8): I/NAV from E1-B and E5b, clock of E5b and E1; F/NAV
/// from E5a, clock of E5a and E1. GPS: codes on L2, 1 = P.
double sources(const KeplerEphemeris& r) {
  if (r.message == NavigationMessage::kInav) return 517.0;
  if (r.message == NavigationMessage::kFnav) return 258.0;
  return r.sv.system == GnssSystem::kGps ? 1.0 : 0.0;
}

/// Field 2 of line 7: GPS hours; QZSS a flag, 1 = longer than two hours; BeiDou the age of the clock.
double fit_field(const KeplerEphemeris& r) {
  const double span_s = r.valid_before_s + r.valid_after_s;
  if (r.sv.system == GnssSystem::kGps) return span_s / 3600.0;
  if (r.sv.system == GnssSystem::kQzss) return span_s > 2.0 * 3600.0 ? 1.0 : 0.0;
  return 0.0;
}

std::string record(const KeplerEphemeris& r) {
  const double ahead_s = constants_of(r.sv.system).ahead_s;
  const GpsTime toe = r.toe - ahead_s, toc = r.toc - ahead_s;
  constexpr int kBeidouWeek0 = 1356;  // BDT counts from 2006-01-01
  const int week = toe.week() - (r.sv.system == GnssSystem::kBeidou ? kBeidouWeek0 : 0);
  const double sent_s = toe.sow_s() + (r.transmitted.value_or(r.toe) - r.toe);
  const bool two_delays = r.sv.system == GnssSystem::kGalileo || r.sv.system == GnssSystem::kBeidou;
  return epoch_line(r.sv, toc, r.af0_s, r.af1, r.af2_per_s) + row(r.iode, r.crs_m, r.delta_n_rad_s, r.m0_rad) +
         row(r.cuc_rad, r.e, r.cus_rad, r.sqrt_a) + row(toe.sow_s(), r.cic_rad, r.omega0_rad, r.cis_rad) +
         row(r.i0_rad, r.crc_m, r.argument_of_perigee_rad, r.omega_dot_rad_s) +
         row(r.idot_rad_s, sources(r), week, 0.0) +
         row(r.accuracy_m, r.health, r.tgd_s, two_delays ? r.tgd2_s : r.iode) + "    " + number(sent_s) +
         number(fit_field(r)) + "\n";
}

std::string record(const GlonassEphemeris& r) {
  const GpsTime utc = r.toe - static_cast<double>(r.toe.leap_seconds());
  std::string out = epoch_line(r.sv, utc, r.clock_s, r.clock_rate, utc.sow_s());
  const double last[3] = {static_cast<double>(r.health), static_cast<double>(r.frequency_channel), r.age_days};
  for (int i = 0; i < 3; ++i) out += row(1e-3 * r.p_E[i], 1e-3 * r.v_E[i], 1e-3 * r.a_E[i], last[i]);
  return out;
}

/// The first record whose epoch is no whole second.
template <class Record>
std::optional<Error> broken_second(const std::vector<Record>& records, GpsTime Record::*epoch,
                                   const NavigationData& data) {
  for (const Record& r : records)
    if ((r.*epoch).ns % kNsPerSecond != 0)
      return Error{data.names(), 0, "", r.sv.str() + ": the epoch " + (r.*epoch).iso(9) + " cannot be written",
                   "a whole second, as RINEX 3 has it"};
  return std::nullopt;
}

std::string ionosphere(const NavigationData& data) {
  std::string out;
  for (const auto& [system, name] :
       {std::pair(GnssSystem::kGps, "GPS"), {GnssSystem::kBeidou, "BDS"}, {GnssSystem::kQzss, "QZS"}}) {
    const auto found = std::find_if(data.klobuchar.begin(), data.klobuchar.end(),
                                    [s = system](const auto& k) { return k.system == s; });
    if (found == data.klobuchar.end()) continue;
    const auto& [a, b] = found->coefficients;
    out += labelled(formatted("%sA %12.4E%12.4E%12.4E%12.4E", name, a[0], a[1], a[2], a[3]), "IONOSPHERIC CORR");
    out += labelled(formatted("%sB %12.4E%12.4E%12.4E%12.4E", name, b[0], b[1], b[2], b[3]), "IONOSPHERIC CORR");
  }
  return out;
}

}  // namespace

bool is_in_rinex3(NavigationMessage m) {
  return m == NavigationMessage::kLnav || m == NavigationMessage::kInav || m == NavigationMessage::kFnav ||
         m == NavigationMessage::kD1 || m == NavigationMessage::kD2 || m == NavigationMessage::kFdma;
}

Result<std::string> navigation_file_text(const NavigationData& data) {
  std::vector<KeplerEphemeris> kepler;
  std::copy_if(data.kepler.begin(), data.kepler.end(), std::back_inserter(kepler),
               [](const auto& r) { return is_in_rinex3(r.message); });
  auto glonass = data.glonass;
  if (auto error = broken_second(kepler, &KeplerEphemeris::toc, data)) return *std::move(error);
  if (auto error = broken_second(glonass, &GlonassEphemeris::toe, data)) return *std::move(error);
  std::stable_sort(kepler.begin(), kepler.end(),
                   [](const auto& a, const auto& b) { return a.sv != b.sv ? a.sv < b.sv : a.toe < b.toe; });
  std::stable_sort(glonass.begin(), glonass.end(),
                   [](const auto& a, const auto& b) { return a.sv != b.sv ? a.sv < b.sv : a.toe < b.toe; });

  std::string out = labelled(formatted("%9.2f           NAVIGATION DATA     M: MIXED", 3.04), "RINEX VERSION / TYPE");
  out += labelled(formatted("%-20s%-20s", (std::string("canyon ") + kVersion).c_str(), ""), "PGM / RUN BY / DATE");
  out += ionosphere(data);
  const bool any = !kepler.empty() || !glonass.empty();
  if (any) {
    const GpsTime t = kepler.empty() ? glonass.front().toe : kepler.front().toe;
    out += labelled(formatted("%6d", t.leap_seconds()), "LEAP SECONDS");
  }
  out += labelled("", "END OF HEADER");
  for (const auto& r : kepler) out += record(r);
  for (const auto& r : glonass) out += record(r);
  return out;
}

}  // namespace canyon::gnss

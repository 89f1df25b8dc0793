#include "canyon/gnss/rinex/navigation/kepler_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "canyon/gnss/rinex/text_lines.h"
#include "canyon/gnss/satellites/ephemerides/ephemeris_limits.h"
#include "canyon/gnss/satellites/system_constants.h"

namespace canyon::gnss {
namespace {

using Message = NavigationMessage;
namespace limits = ephemeris_limits;

/// Where a number stands: line 1, 2, ... of the record and place 0..3 in it; line 0 = the message has no such number.
struct Place {
  std::size_t line = 0, index = 0;
};
struct Isc {
  std::size_t band = 0;
  Place place;
};

/// What differs between messages (RINEX 4.01, tables A7 to A35); all others of the orbit's numbers stand at the same
/// places in each.
struct Layout {
  Message message;
  const char* systems;  ///< RINEX letters
  std::size_t lines;
  bool modern;  ///< CNAV and its relatives: rates of A and delta n; accuracy is an index
  bool toe_is_toc;
  Place accuracy, health, tgd, tgd2, transmitted, iode;
  std::array<Isc, 3> isc{};
};

constexpr Layout kLayouts[] = {
    {Message::kLnav, "GJ", 8, false, false, {6, 0}, {6, 1}, {6, 2}, {}, {7, 0}, {1, 0}, {}},
    {Message::kCnav,
     "GJ",
     9,
     true,
     true,
     {6, 0},
     {6, 1},
     {6, 2},
     {},
     {8, 0},
     {},
     {{{1, {7, 0}}, {2, {7, 1}}, {5, {7, 2}}}}},
    {Message::kCnav2,
     "GJ",
     10,
     true,
     true,
     {6, 0},
     {6, 1},
     {6, 2},
     {},
     {9, 0},
     {},
     {{{1, {7, 0}}, {2, {7, 1}}, {5, {7, 2}}}}},
    {Message::kInav, "E", 8, false, false, {6, 0}, {6, 1}, {6, 2}, {6, 3}, {7, 0}, {1, 0}, {}},
    {Message::kFnav, "E", 8, false, false, {6, 0}, {6, 1}, {6, 2}, {6, 3}, {7, 0}, {1, 0}, {}},
    {Message::kD1, "C", 8, false, false, {6, 0}, {6, 1}, {6, 2}, {6, 3}, {7, 0}, {1, 0}, {}},
    {Message::kD2, "C", 8, false, false, {6, 0}, {6, 1}, {6, 2}, {6, 3}, {7, 0}, {1, 0}, {}},
    {Message::kBcnav1, "C", 10, true, false, {6, 0}, {8, 1}, {7, 2}, {7, 3}, {9, 0}, {9, 3}, {{{1, {7, 0}}, {}, {}}}},
    {Message::kBcnav2, "C", 10, true, false, {6, 0}, {8, 1}, {7, 2}, {7, 3}, {9, 0}, {9, 3}, {{{5, {7, 1}}, {}, {}}}},
};

const Layout& layout_of(Message message) {
  const auto* found = std::find_if(std::begin(kLayouts), std::end(kLayouts),
                                   [&](const Layout& layout) { return layout.message == message; });
  CANYON_CHECK(found != std::end(kLayouts), "message ", name_of(message), " has no Kepler record");
  return *found;
}

/// URA of an index: IS-GPS-200N 20.3.3.3.1.3 and 30.3.3.1.1.4; -1 where there is no prediction.
double accuracy_of_index_m(double index) {
  if (!(index > -16.0 && index < 15.0)) return -1.0;
  return index <= 6.0 ? std::exp2(1.0 + 0.5 * index) : std::exp2(index - 2.0);
}

Validity validity(const KeplerEphemeris& r, std::optional<double> fit_field) {
  const Validity standard = default_validity(r.sv.system, r.message);
  if (r.message != Message::kLnav || !fit_field) return standard;
  // QZSS: a flag, 0 = 2 h, 1 = longer (RINEX 4.01 table A14).
  if (r.sv.system == GnssSystem::kQzss)
    return *fit_field > 0.0 ? Validity{2.0 * standard.before_s, 2.0 * standard.after_s} : standard;
  // GPS: hours; 0 = not known; 1 comes from writers that store IS-GPS-200's fit flag. At least the standard four hours.
  const double half_s = 1800.0 * std::clamp(*fit_field, 4.0, 194.0);
  return {half_s, half_s};
}

/// A number that must stay below `limit` in size.
double bounded(RecordFields& f, std::size_t line, std::size_t index, const char* name, double limit) {
  const double value = f.orbit(line, index, name);
  char most[32];
  std::snprintf(most, sizeof most, "at most %g", limit);
  f.require(std::abs(value) <= limit, line, name + (" = " + join_values(value)), most);
  return value;
}

void read_orbit(RecordFields& f, KeplerEphemeris& r) {
  r.crs_m = bounded(f, 1, 1, "Crs", limits::kHarmonicM);
  r.delta_n_rad_s = bounded(f, 1, 2, "delta n", limits::kRateRadS);
  r.m0_rad = bounded(f, 1, 3, "M0", limits::kAngleRad);
  r.cuc_rad = bounded(f, 2, 0, "Cuc", limits::kHarmonicRad);
  r.e = f.orbit(2, 1, "e");
  r.cus_rad = bounded(f, 2, 2, "Cus", limits::kHarmonicRad);
  r.sqrt_a = f.orbit(2, 3, "sqrt(A)");
  r.cic_rad = bounded(f, 3, 1, "Cic", limits::kHarmonicRad);
  r.omega0_rad = bounded(f, 3, 2, "OMEGA0", limits::kAngleRad);
  r.cis_rad = bounded(f, 3, 3, "Cis", limits::kHarmonicRad);
  r.i0_rad = bounded(f, 4, 0, "i0", limits::kAngleRad);
  r.crc_m = bounded(f, 4, 1, "Crc", limits::kHarmonicM);
  r.argument_of_perigee_rad = bounded(f, 4, 2, "omega", limits::kAngleRad);
  r.omega_dot_rad_s = bounded(f, 4, 3, "OMEGA DOT", limits::kRateRadS);
  r.idot_rad_s = bounded(f, 5, 0, "IDOT", limits::kRateRadS);
  f.require(r.e >= 0.0 && r.e < 1.0, 2, "e = " + join_values(r.e), "at least 0 and less than 1");
  f.require(r.sqrt_a >= 1000.0 && r.sqrt_a <= 10000.0, 2, "sqrt(A) = " + join_values(r.sqrt_a),
            "1000 to 10000 m^0.5 (GPS: 5154)");
}

/// Toe, and the time of transmission: seconds of the system's own week near the clock's epoch.
void read_times(RecordFields& f, const Layout& layout, GpsTime toc_own, KeplerEphemeris& r) {
  const double ahead_s = constants_of(r.sv.system).ahead_s;
  r.toc = toc_own + ahead_s;
  r.toe = r.toc;
  if (!layout.toe_is_toc) {
    const double toe_sow_s = f.orbit(3, 0, "toe");
    f.require(toe_sow_s >= 0.0 && toe_sow_s <= kSecondsPerWeek, 3, "toe = " + join_values(toe_sow_s),
              "0 to 604800 s of the week");
    if (!f.ok()) return;
    r.toe = nearest_with_sow(toe_sow_s, toc_own) + ahead_s;
    f.require(std::abs(r.toe - r.toc) <= 86400.0, 3,
              "toe is " + join_values((r.toe - r.toc) / 3600.0) + " h from the clock's epoch", "within a day");
  }
  const auto sent = f.known(layout.transmitted.line, layout.transmitted.index, "time of transmission");
  // 0.9999E9 = not known; some writers count back into the week before.
  if (sent && std::abs(*sent) < 2.0 * kSecondsPerWeek) r.transmitted = nearest_with_sow(*sent, toc_own) + ahead_s;
}

}  // namespace

std::optional<Message> kepler_message(GnssSystem system, std::string_view name) {
  for (const Layout& layout : kLayouts)
    if (name == name_of(layout.message) &&
        std::string_view(layout.systems).find(system_letter(system)) != std::string_view::npos)
      return layout.message;
  return std::nullopt;
}

Message kepler_message_of_old_record(const RecordLines& record, SatelliteId sv) {
  if (sv.system == GnssSystem::kBeidou) return beidou_message(sv.prn);
  if (sv.system != GnssSystem::kGalileo) return Message::kLnav;
  if (record.lines.size() < 6) return Message::kInav;  // damaged, as its own reader will say
  const auto sources =
      fortran_number(columns(record.lines[5], record.orbit_column() + RecordFields::kWidth, RecordFields::kWidth));
  const auto bits = static_cast<unsigned>(std::clamp(sources.value_or(0.0), 0.0, 65535.0));
  constexpr unsigned kE1bData = 1u << 0, kE5aData = 1u << 1, kE5bData = 1u << 2, kE5aClock = 1u << 8,
                     kE5bClock = 1u << 9;  // RINEX 4.01 table A8
  if ((bits & kE5bClock) != 0) return Message::kInav;
  if ((bits & kE5aClock) != 0) return Message::kFnav;
  return (bits & kE5aData) != 0 && (bits & (kE1bData | kE5bData)) == 0 ? Message::kFnav : Message::kInav;
}

Result<KeplerEphemeris> parse_kepler_record(const RecordLines& record, SatelliteId sv, Message message) {
  const Layout& layout = layout_of(message);
  KeplerEphemeris r;
  r.sv = sv;
  r.message = message;
  if (record.lines.size() != layout.lines)
    return Error{record.file, record.first_line, "",
                 sv.str() + ": the record has " + std::to_string(record.lines.size()) + " lines",
                 std::to_string(layout.lines)};
  RecordFields f(record, sv.str());

  const GpsTime toc_own = f.epoch();
  r.af0_s = f.clock(0, "af0");
  r.af1 = f.clock(1, "af1");
  r.af2_per_s = f.clock(2, "af2");
  read_orbit(f, r);
  if (layout.modern) {
    r.a_dot_m_s = bounded(f, 1, 0, "A DOT", limits::kGrowthMS);
    r.delta_n_dot_rad_s2 = bounded(f, 5, 1, "delta n dot", limits::kRateOfRateRadS2);
  }
  read_times(f, layout, toc_own, r);

  const auto optional_at = [&](Place place, const char* name) {
    return place.line == 0 ? std::nullopt : f.known(place.line, place.index, name);
  };
  const double accuracy = optional_at(layout.accuracy, "accuracy").value_or(0.0);
  // B-CNAV's SISAI is an index whose metres its ICD leaves to a document of its own.
  r.accuracy_m = !layout.modern ? accuracy : sv.system == GnssSystem::kBeidou ? kNaN : accuracy_of_index_m(accuracy);
  const double health = f.orbit(layout.health.line, layout.health.index, "health");
  r.tgd_s = optional_at(layout.tgd, "TGD").value_or(0.0);
  r.tgd2_s = optional_at(layout.tgd2, "second TGD").value_or(0.0);
  for (const Isc& isc : layout.isc)
    if (isc.band != 0) r.isc_s[isc.band] = optional_at(isc.place, "ISC").value_or(0.0);
  const double iode = optional_at(layout.iode, "IODE").value_or(0.0);
  const auto fit = message == Message::kLnav ? f.known(7, 1, "fit interval") : std::nullopt;

  f.require(health >= 0.0 && health <= 511.0, layout.health.line, "health = " + join_values(health), "0 to 511");
  f.require(std::abs(r.af0_s) < limits::kClockS, 0, "af0 = " + join_values(r.af0_s), "less than 1 s");
  f.require(std::abs(r.af1) < limits::kClockRate, 0, "af1 = " + join_values(r.af1), "less than 1e-7");
  f.require(std::abs(r.af2_per_s) < limits::kClockRateOfRate, 0, "af2 = " + join_values(r.af2_per_s),
            "less than 1e-12 /s");
  const double longest_delay_s = std::max(
      {std::abs(r.tgd_s), std::abs(r.tgd2_s), std::abs(r.isc_s[1]), std::abs(r.isc_s[2]), std::abs(r.isc_s[5])});
  f.require(longest_delay_s < 1e-3, layout.tgd.line, "group delay = " + join_values(longest_delay_s) + " s",
            "less than 0.001 s");
  if (f.ok()) {
    const double radius_m = limits::radius_at_toe_m(r);
    f.require(limits::is_sane_radius(radius_m), 1, "distance from the Earth's centre = " + join_values(radius_m) + " m",
              "6300 to 100000 km");
  }
  if (!f.ok()) return f.error();

  r.health = static_cast<int>(health);
  r.iode = static_cast<int>(std::clamp(iode, 0.0, 1e6));
  const Validity valid = validity(r, fit);
  r.valid_before_s = valid.before_s;
  r.valid_after_s = valid.after_s;
  return r;
}

}  // namespace canyon::gnss

// What a recording's observations become: satellites taken, delays lent, warnings, the largest dilution, and keys.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/single_point/observed_ranges.h"
#include "canyon/gnss/single_point/single_point.h"
#include "canyon/gnss/stress/single_point/stated_variance.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

const Geodetic kObserver{0.8, 0.4, 250.0};
constexpr double kAway_m = 2.2e7;

/// Satellites that stand still where they are put, as a receiver sees them after the Earth's turn.
class PutSky final : public Constellation {
 public:
  SatelliteState& put(SatelliteId sv, double elevation_rad, double azimuth_rad) {
    const double c = std::cos(elevation_rad);
    const Vector3d enu(c * std::sin(azimuth_rad), c * std::cos(azimuth_rad), std::sin(elevation_rad));
    SatelliteState& s = states_[sv];
    s.p_E = turned_by_earth(ecef_from_geodetic(kObserver) + kAway_m * (rotation_E_from_enu(kObserver) * enu),
                            -kAway_m / kSpeedOfLight);
    s.v_E = Vector3d(100.0, 200.0, 300.0);
    all_.clear();
    for (const auto& [id, state] : states_) all_.push_back(id);
    return s;
  }
  const std::vector<SatelliteId>& satellites() const override { return all_; }
  std::optional<SatelliteState> state(SatelliteId sv, GpsTime) const override {
    const auto found = states_.find(sv);
    return found == states_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::map<SatelliteId, SatelliteState> states_;
  std::vector<SatelliteId> all_;
};

/// C, L, D and S of each system's first band.
ObservationFile file_of_codes() {
  ObservationFile file;
  file.name = "made.rnx";
  ObservationCodes codes;
  for (const GnssSystem system : kGnssSystems)
    for (const char kind : {'C', 'L', 'D', 'S'})
      codes[static_cast<std::size_t>(system)].push_back(
          {kind, system == GnssSystem::kBeidou ? '2' : '1', system == GnssSystem::kBeidou ? 'I' : 'C'});
  file.code_sets.push_back(codes);
  return file;
}

SatelliteObservations observed_at(SatelliteId sv, double range_m, double phase, double doppler_hz, double cn0_dbhz) {
  SatelliteObservations out{.sv = sv, .values = std::vector<ObservationValue>(4)};
  const double values[] = {range_m, phase, doppler_hz, cn0_dbhz};
  for (std::size_t k = 0; k < 4; ++k) out.values[k].value = values[k];
  return out;
}

const SatelliteId kG1{GnssSystem::kGps, 1}, kG2{GnssSystem::kGps, 2}, kG4{GnssSystem::kGps, 4},
    kG9{GnssSystem::kGps, 9}, kR3{GnssSystem::kGlonass, 3}, kC7{GnssSystem::kBeidou, 7}, kC8{GnssSystem::kBeidou, 8},
    kE5{GnssSystem::kGalileo, 5};
constexpr const char* kLent =
    ": the navigation message does not tell this band's group delay; that of the band beside it is used, and its "
    "ranges count for less";

/// Of two epochs: which satellites are used and which are told to be missing; a delay that is lent, in both epochs and
/// of another satellite in the second, adds its 3.3 ns of light; who has no channel has neither phase nor Doppler.
/// Roundings of 2e7 m.
StressFigure observed_and_lent() {
  Looks looks;
  PutSky sky;
  SatelliteState& g1 = sky.put(kG1, 0.5, 1.0);
  g1.clock_s = 1e-4, g1.clock_rate = 2e-11, g1.group_delay_s[1] = 5e-9, g1.accuracy_m = 2.0;
  sky.put(kG4, 9.9 * kDegree, 2.0), sky.put(kG9, 10.1 * kDegree, 3.0);
  sky.put(kR3, 0.7, 4.0).frequency_channel = kUnknownChannel;
  for (const SatelliteId sv : {kC7, kC8}) {
    SatelliteState& c = sky.put(sv, 0.9, 0.1 * sv.prn);
    c.group_delay_s[2] = -7e-9, c.borrowed_delay_bands = 1U << 2 | 1U << 6, c.accuracy_m = 2.0;
  }
  sky.put(kE5, 1.2, 5.0);
  ObservationFile file = file_of_codes();
  const GpsTime t = GpsTime::from_week_sow(2000, 345600.0);
  const double range_m = kAway_m + 5000.0;
  for (int k = 0; k < 2; ++k) {
    ObservationEpoch epoch;
    epoch.t = t + 30.0 * k, epoch.line = 10 + 20 * k;
    for (const SatelliteId sv : {kG1, kG2, kG4, kG9, kR3, kC7, kC8, kE5})
      if (sv != kC8 || k == 1) epoch.satellites.push_back(observed_at(sv, range_m, 1e8, -800.0, 42.0));
    if (k == 1) epoch.satellites[3].values[0].value = kNaN;
    file.epochs.push_back(epoch);
  }
  SinglePointConfig c;
  c.systems = "GRC", c.ionosphere = IonosphereCorrection::kNone, c.troposphere = "none";
  NavigationData navigation;
  navigation.files.push_back({"made.nav", 0.0});
  const SinglePointInputs inputs{sky, navigation};
  const Vector3d at_E = ecef_from_geodetic(kObserver);
  for (const bool differential : {false, true}) {
    RangeObserver observer(file, inputs, c, differential);
    for (std::size_t k = 0; k < 2; ++k) {
      auto taken = observer.usable(file.epochs[k]);
      std::string names;
      for (const ObservedRange& o : taken) names += o.sv.str();
      looks.right(names == (k == 0 ? "G01G04G09R03C07" : "G01G04R03C07C08"));
      for (ObservedRange& o : taken) o.base_m = 0.75, o.base_sigma_m = 0.4;
      GnssEpoch epoch;
      std::vector<RangeMeasurement> ranges;
      observer.correct(taken, file.epochs[k].t, at_E, epoch, ranges);
      names.clear();
      for (std::size_t i = 0; i < epoch.observations.size(); ++i) {
        const GnssObservation& o = epoch.observations[i];
        names += o.sv.str();
        const SatelliteState s = *sky.state(o.sv, {});
        const bool lent = o.sv.system == GnssSystem::kBeidou, unknown = o.sv == kR3;
        const double delay_s = s.group_delay_s[lent ? 2 : 1];
        looks.right(o.band == (lent ? 2 : 1) && o.pseudorange_m == range_m && o.cn0_dbhz == 42.0);
        looks.near(o.clock_m, kSpeedOfLight * (s.clock_s - delay_s), 4.0 * kEpsilon * 3e4);
        looks.right(o.correction_m == 0.75);
        looks.near((o.p_E - turned_by_earth(s.p_E, kAway_m / kSpeedOfLight)).norm(), 0.0, 3e-4);
        looks.right(unknown ? std::isnan(o.carrier_phase_cycles) && std::isnan(o.doppler_hz) && std::isnan(o.rate_m_s)
                            : o.carrier_phase_cycles == 1e8 && o.doppler_hz == -800.0);
        const double hz = lent ? 1561.098e6 : 1575.42e6;
        if (!unknown)
          looks.near(o.rate_m_s, 800.0 * kSpeedOfLight / hz + kSpeedOfLight * s.clock_rate, 8.0 * kEpsilon * 160.0);
        RangeQuality q;
        q.system = o.sv.system, q.elevation_rad = o.sv == kG1   ? 0.5
                                                  : o.sv == kG9 ? 10.1 * kDegree
                                                  : unknown     ? 0.7
                                                                : 0.9;
        q.cn0_dbhz = 42.0, q.accuracy_m = s.accuracy_m, q.differential = differential;
        const double own = std::sqrt(stated_variance("budget", q, 0.5));
        const double more = differential ? 0.4 : lent ? 299792458.0 * 3.3e-9 : 0.0;
        looks.near(o.sigma_m / std::hypot(own, more), 1.0, 1e-9);
        looks.right(ranges[i].sigma_m == o.sigma_m && ranges[i].system == o.sv.system && ranges[i].shared_m == 0.0);
        looks.near(ranges[i].range_m, range_m + o.clock_m - 0.75, 2.0 * kEpsilon * 2.3e7);
      }
      // Below ten degrees nobody looks.
      looks.right(names == (k == 0 ? "G01G09R03C07" : "G01R03C07C08"));
    }
    const auto told = observer.warnings();
    looks.right(told.size() == 3 && observer.anything_usable().ok());
    if (told.size() != 3) continue;
    looks.right(told[0] ==
                "made.rnx:10: G02 has no valid healthy ephemeris at " + t.iso(0) + " and 1 other epochs; not used");
    looks.right(told[1] == "made.rnx:10: R03: no one tells the GLONASS channel; phase and Doppler are not used");
    looks.right(told[2] == std::string("made.rnx:10: C07, C08") + kLent);
  }
  c.group_delay = GroupDelayModel::kNone, c.systems = "C";
  RangeObserver without(file, inputs, c, false);
  looks.right(without.usable(file.epochs[1])[1].group_delay_s == 0.0 && without.warnings().empty());
  c.systems = "J";
  RangeObserver nobody(file, inputs, c, false);
  looks.right(nobody.usable(file.epochs[0]).empty() &&
              nobody.anything_usable().error().str() ==
                  "made.rnx: systems: no pseudorange of the systems J in it, expected systems that were observed");
  const PutSky empty;
  const SinglePointInputs none{empty, navigation};
  c.systems = "G";
  RangeObserver blind(file, none, c, false);
  looks.right(blind.usable(file.epochs[0]).empty() &&
              blind.anything_usable().error().str() ==
                  "made.rnx:10: no satellite observed from " + t.iso(0) + " to " + (t + 30.0).iso(0) +
                      " has a valid ephemeris in made.nav, expected navigation files of the same day and systems");
  return looks.figure();
}

/// One satellite at the zenith and four around it of elevation e: GDOP^2 = 1 / cos^2 e + (3 + 2 sin^2 e) / (2 (1 - sin
/// e)^2). By the defaults one of 29.99 gives a fix and one of 30.01 none, and says so.
StressFigure largest_dilution() {
  Looks looks;
  for (const double gdop : {5.0, 29.99, 30.01, 60.0}) {
    double low = 0.2, high = 1.55;
    for (int k = 0; k < 60; ++k) {
      const double e = 0.5 * (low + high), s = std::sin(e), c = std::cos(e);
      (std::sqrt(1.0 / (c * c) + (3.0 + 2.0 * s * s) / (2.0 * (1.0 - s) * (1.0 - s))) < gdop ? low : high) = e;
    }
    PutSky sky;
    ObservationFile file = file_of_codes();
    ObservationEpoch epoch;
    epoch.t = GpsTime::from_week_sow(2000, 345600.0), epoch.line = 10;
    for (int k = 0; k < 5; ++k) {
      const SatelliteId sv{GnssSystem::kGps, static_cast<std::uint8_t>(k + 1)};
      sky.put(sv, k == 0 ? 0.5 * kPi : low, 0.5 * kPi * k).v_E.setZero();
      epoch.satellites.push_back(observed_at(sv, kAway_m, kNaN, kNaN, 45.0));
    }
    file.epochs.push_back(epoch);
    SinglePointConfig c;
    c.ionosphere = IonosphereCorrection::kNone, c.troposphere = "none", c.shared_ionosphere = 0.0;
    const NavigationData none;
    const auto r = solve_observations(file, {sky, none}, c);
    if (!r.ok() || r->epochs.size() != 1) return {stress::kInfinity, 1.0};
    const GnssFix& fix = r->epochs[0].fix;
    looks.right((fix.status == FixStatus::kSingle) == (gdop < 30.0) && r->solved() == (gdop < 30.0 ? 1 : 0));
    // Ranges to 4e-9 m put the place there to 1e-7 m, over 2.2e7 m nothing; the way there is not turned, 3e-4 m.
    looks.near(fix.dop.gdop / gdop, 1.0, 1e-6);
    looks.right(gdop < 30.0 ? fix.reason.empty()
                            : fix.reason == std::string("satellite geometry is singular: GDOP ") +
                                                (gdop > 31.0 ? "60" : "30") + " exceeds 30");
    if (gdop < 30.0) looks.near((fix.p_A_E - ecef_from_geodetic(kObserver)).norm(), 0.0, 4.0 * kEpsilon * 2.2e7 * gdop);
  }
  return looks.figure();
}

/// All keys as they come, as docs/gnss.md has them, with what may be given.
StressFigure keys_of_solutions() {
  SinglePointConfig c;
  const auto docs = documented_fields("", [&](FieldVisitor& f) { visit(f, c); });
  const struct {
    const char *key, *unit, *value, *range;
  } rows[] = {
      {"systems", "", "\"GREC\"", "a string"},
      {"mask_deg", "deg", "10", "a number from -10 to 89"},
      {"max_gdop", "", "30", "a number from 1 to 1e+06"},
      {"frequencies", "", "\"single\"", "one of \"single\", \"dual\""},
      {"ephemeris", "", "\"nearest_toe\"", "one of \"nearest_toe\", \"transmitted\""},
      {"group_delay", "", "\"broadcast\"", "one of \"none\", \"broadcast\", \"rtklib\""},
      {"ionosphere", "", "\"klobuchar\"", "one of \"none\", \"klobuchar\", \"klobuchar_own\", \"ionex\""},
      {"troposphere", "", "\"saastamoinen_niell\"",
       "one of \"none\", \"saastamoinen_niell\", \"saastamoinen_cosecant\""},
      {"shared_ionosphere", "", "0.5", "a number from 0 to 10"},
      {"smoothing_s", "s", "300", "a number from 0 to 86400"},
      {"estimator", "", "\"least_squares\"", "one of \"least_squares\", \"kalman\""},
      {"acceleration_m_s2", "m/s²", "1", "a number from 1e-06 to 1000"},
      {"reported_covariance", "", "\"geometry\"", "one of \"geometry\", \"residual_inflated\", \"environment\""},
      {"error_correlation_s", "s", "10", "a number from 0 to 3600"},
      {"light_variance_m2", "m²", "10", "a number from 0 to 1e+06"},
      {"light_variance_m2_hz", "m² Hz", "22500", "a number from 0 to 1e+09"},
      {"heavy_variance_m2", "m²", "500", "a number from 0 to 1e+06"},
      {"heavy_variance_m2_hz", "m² Hz", "1e+06", "a number from 0 to 1e+09"},
      {"base_age_s", "s", "30", "a number from 0 to 3600"},
      {"weighting", "", "\"budget\"",
       "one of \"uniform\", \"elevation\", \"cn0\", \"elevation_cn0\", \"budget\", \"rtklib\""},
      {"sigma_m", "m", "0.5", "a number from 0.001 to 1000"},
      {"doppler_sigma_m_s", "m/s", "0.05", "a number from 1e-04 to 100"},
      {"fault_exclusion", "", "\"greedy\"", "one of \"none\", \"detect\", \"greedy\", \"leave_one_out\""},
      {"false_alarm", "", "0.001", "a number from 1e-12 to 0.5"},
      {"max_exclusions", "", "8", "a whole number from 0 to 100"}};
  int wrong = docs.size() == sizeof rows / sizeof rows[0] ? 0 : 1;
  for (const auto& row : rows) {
    int found = 0;
    for (const FieldDoc& doc : docs) {
      if (doc.key != row.key) continue;
      ++found;
      wrong += doc.unit == row.unit && doc.default_value == row.value && doc.range == row.range ? 0 : 1;
    }
    wrong += found == 1 ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> observer_cases() {
  StressRows rows;
  rows.of(
      {StressGroup::kData, "what an observation becomes on its way to a range",
       "a delay that is lent once and then forgotten, a Doppler by a carrier that nobody knows, a mask of the others",
       "satellites put where they are, each figure by its definition: roundings; warnings word by word",
       "of the bound"});
  rows.add("observers/observed_and_lent", observed_and_lent).add("observers/largest_dilution", largest_dilution);
  rows.of({StressGroup::kData, "keys of recorded solutions", "a default or an end of a range of another power of ten",
           "as the manual states them: exact", "wrong"});
  rows.add("observers/keys_of_solutions", keys_of_solutions);
  return rows.take();
}

}  // namespace canyon::gnss

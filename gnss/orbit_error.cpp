#include "canyon/gnss/orbit_error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <set>

#include "canyon/core/math/median.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/gnss/products/clock_datum.h"
#include "canyon/gnss/satellites/system_constants.h"

namespace canyon::gnss {
namespace {

struct Weights {
  double radial, across_squared;
};

/// BeiDou's satellites in high orbits by number (BDS-SIS-ICD-B1I 3.0): GEO and inclined geosynchronous.
bool is_high(SatelliteId sv) {
  static const std::set<int> high = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 13, 16, 31, 38, 39, 40, 56, 59, 60, 61, 62, 63};
  return sv.system == GnssSystem::kQzss || (sv.system == GnssSystem::kBeidou && high.contains(sv.prn));
}

/// Montenbruck, Steigenberger, Hauschild: Broadcast versus precise ephemerides, GPS Solutions 19 (2015), table 4.
Weights weights_of(SatelliteId sv) {
  if (is_high(sv)) return {0.99, 1.0 / 126.0};
  switch (sv.system) {
    case GnssSystem::kGlonass:
      return {0.98, 1.0 / 45.0};
    case GnssSystem::kGalileo:
      return {0.98, 1.0 / 61.0};
    case GnssSystem::kBeidou:
      return {0.98, 1.0 / 54.0};
    default:
      return {0.98, 1.0 / 49.0};
  }
}

/// Subtracts from one value of each sample its median over the satellites of the epoch and system: the time scales of
/// systems may differ.
void remove_median(std::vector<OrbitErrorSample>& samples, double OrbitErrorSample::*value) {
  using Key = std::pair<GpsTime, GnssSystem>;
  std::map<Key, std::vector<double>> values;
  for (const auto& s : samples) values[{s.t, s.sv.system}].push_back(s.*value);
  std::map<Key, double> common;
  for (const auto& [key, all] : values) common[key] = median(all);
  for (auto& s : samples) s.*value -= common.at({s.t, s.sv.system});
}

}  // namespace

OrbitErrors orbit_errors(const Constellation& broadcast, const PreciseOrbits& precise, const PreciseOptions& options) {
  OrbitErrors out;
  for (const auto& [sv, track] : precise.satellites) {
    if (options.systems.find(system_letter(sv.system)) == std::string::npos) continue;
    for (const PreciseSample& sample : track) {
      throw_if_cancelled();
      const auto state = broadcast.state(sv, sample.t);
      if (!state) continue;
      const double clock_s = options.clocks != nullptr ? options.clocks->clock_s(sv, sample.t) : sample.clock_s;
      if (std::isnan(clock_s)) {
        ++out.without_clock;
        continue;
      }
      Eigen::Vector3d p_E = sample.p_E;
      if (options.antennas != nullptr) {
        const Antenna* antenna = options.antennas->satellite(sv, sample.t);
        if (antenna == nullptr) continue;
        p_E += satellite_offset_E(*antenna, sample.p_E, sample.t);
      }
      const double earth_rate = constants_of(GnssSystem::kGps).earth_rate_rad_s;
      const Eigen::Vector3d v_inertial = state->v_E + earth_rate * Eigen::Vector3d::UnitZ().cross(state->p_E);
      const Eigen::Vector3d radial = p_E.normalized(), cross = p_E.cross(v_inertial).normalized(),
                            along = cross.cross(radial);
      const Eigen::Vector3d error = state->p_E - p_E;
      const double relativity_s = -2.0 * state->p_E.dot(state->v_E) / (kSpeedOfLight * kSpeedOfLight);
      const double broadcast_s = state->clock_s - delay_of_precise_clock_s(sv.system, state->group_delay_s);
      OrbitErrorSample e{sv, sample.t, error.dot(radial), error.dot(along), error.dot(cross), 0.0, 0.0};
      e.clock_m = kSpeedOfLight * (broadcast_s - clock_s - relativity_s);
      e.range_m = weights_of(sv).radial * e.radial_m - e.clock_m;
      out.samples.push_back(e);
    }
  }
  remove_median(out.samples, &OrbitErrorSample::clock_m);
  remove_median(out.samples, &OrbitErrorSample::range_m);
  std::sort(out.samples.begin(), out.samples.end(),
            [](const auto& a, const auto& b) { return a.t != b.t ? a.t < b.t : a.sv < b.sv; });
  return out;
}

OrbitErrorFigures OrbitErrors::of_satellite(SatelliteId sv) const {
  std::vector<OrbitErrorSample> chosen;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(chosen), [sv](const auto& s) { return s.sv == sv; });
  return figures_of(chosen);
}

OrbitErrorFigures OrbitErrors::of_system(char letter) const {
  std::vector<OrbitErrorSample> chosen;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(chosen),
               [letter](const auto& s) { return system_letter(s.sv.system) == letter; });
  return figures_of(chosen);
}

std::map<char, std::vector<SatelliteId>> OrbitErrors::satellites() const {
  std::map<char, std::vector<SatelliteId>> out;
  for (const auto& s : samples) {
    auto& known = out[system_letter(s.sv.system)];
    if (std::find(known.begin(), known.end(), s.sv) == known.end()) known.push_back(s.sv);
  }
  for (auto& [letter, known] : out) std::sort(known.begin(), known.end());
  return out;
}

std::string orbit_error_csv(const OrbitErrors& errors) {
  std::string out = "gps_week,sow,satellite,radial_m,along_m,cross_m,clock_m\n";
  char line[128];
  for (const auto& s : errors.samples) {
    std::snprintf(line, sizeof line, "%d,%.3f,%s,%.4f,%.4f,%.4f,%.4f\n", s.t.week(), s.t.sow_s(), s.sv.str().c_str(),
                  s.radial_m, s.along_m, s.cross_m, s.clock_m);
    out += line;
  }
  return out;
}

OrbitErrorFigures OrbitErrors::figures_of(const std::vector<OrbitErrorSample>& samples) {
  OrbitErrorFigures out;
  out.samples = static_cast<int>(samples.size());
  if (samples.empty()) return out;
  double radial = 0.0, radial2 = 0.0, along2 = 0.0, cross2 = 0.0, clock2 = 0.0, range2 = 0.0, receiver2 = 0.0,
         across = 0.0;
  std::map<SatelliteId, std::vector<double>> range_of;
  for (const auto& s : samples) {
    const Weights w = weights_of(s.sv);
    const double range_m = w.radial * s.radial_m - s.clock_m;
    radial += s.radial_m;
    radial2 += s.radial_m * s.radial_m;
    along2 += s.along_m * s.along_m;
    cross2 += s.cross_m * s.cross_m;
    clock2 += s.clock_m * s.clock_m;
    range2 += range_m * range_m;
    receiver2 += s.range_m * s.range_m;
    across += w.across_squared * (s.along_m * s.along_m + s.cross_m * s.cross_m);
    range_of[s.sv].push_back(range_m);
  }
  double unbiased2 = 0.0;
  for (const auto& [sv, values] : range_of) {
    double mean = 0.0;
    for (const double v : values) mean += v / static_cast<double>(values.size());
    for (const double v : values) unbiased2 += (v - mean) * (v - mean);
  }
  const double n = static_cast<double>(samples.size());
  out.satellites = static_cast<int>(range_of.size());
  out.radial_mean_m = radial / n;
  out.radial_rms_m = std::sqrt(radial2 / n);
  out.along_rms_m = std::sqrt(along2 / n);
  out.cross_rms_m = std::sqrt(cross2 / n);
  out.rms_3d_m = std::sqrt((radial2 + along2 + cross2) / n);
  out.clock_rms_m = std::sqrt(clock2 / n);
  out.sisre_m = std::sqrt((range2 + across) / n);
  out.sisre_receiver_m = std::sqrt((receiver2 + across) / n);
  out.sisre_unbiased_m = std::sqrt((unbiased2 + across) / n);
  return out;
}

}  // namespace canyon::gnss

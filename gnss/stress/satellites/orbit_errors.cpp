// Figures of broadcast orbits and clocks against precise products.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/orbit_error.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/satellites/tabulated_orbits.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::Looks;

/// Figures of samples of all systems by their definition, with the weights of Montenbruck et al. 2015, table 4, of each
/// and of high orbits: 16 eps of sums of a hundred.
StressFigure figures_of_orbits() {
  Looks looks;
  const RandomStream draws(1, "stress.made");
  OrbitErrors errors;
  const SatelliteId all[] = {{GnssSystem::kGps, 1},     {GnssSystem::kGps, 2},    {GnssSystem::kGlonass, 5},
                             {GnssSystem::kGalileo, 7}, {GnssSystem::kBeidou, 1}, {GnssSystem::kBeidou, 20},
                             {GnssSystem::kBeidou, 38}, {GnssSystem::kQzss, 2},   {GnssSystem::kGalileo, 3}};
  std::uint64_t k = 0;
  for (int epoch = 0; epoch < 12; ++epoch)
    for (const SatelliteId sv : all) {
      ++k;
      errors.samples.push_back({sv, GpsTime::from_week_sow(2000, 900.0 * epoch), draws.normal(0, k),
                                2.0 * draws.normal(1, k), 1.5 * draws.normal(2, k), 0.7 + draws.normal(3, k),
                                draws.normal(4, k)});
    }
  const auto check = [&](const OrbitErrorFigures& found, auto wanted) {
    double n = 0.0, radial = 0.0, squares[4] = {}, range = 0.0, receiver = 0.0, across = 0.0;
    std::map<SatelliteId, std::vector<double>> of;
    for (const OrbitErrorSample& s : errors.samples) {
      if (!wanted(s.sv)) continue;
      const bool high = s.sv.system == GnssSystem::kQzss || (s.sv.system == GnssSystem::kBeidou && s.sv.prn != 20);
      const double w = high ? 0.99 : 0.98, part = high                                  ? 126.0
                                                  : s.sv.system == GnssSystem::kGps     ? 49.0
                                                  : s.sv.system == GnssSystem::kGlonass ? 45.0
                                                  : s.sv.system == GnssSystem::kGalileo ? 61.0
                                                                                        : 54.0;
      const double r = w * s.radial_m - s.clock_m;
      ++n, radial += s.radial_m, range += r * r, receiver += s.range_m * s.range_m;
      const double parts[4] = {s.radial_m, s.along_m, s.cross_m, s.clock_m};
      for (int i = 0; i < 4; ++i) squares[i] += parts[i] * parts[i];
      across += (s.along_m * s.along_m + s.cross_m * s.cross_m) / part;
      of[s.sv].push_back(r);
    }
    double unbiased = 0.0;
    for (const auto& [sv, values] : of)
      for (const double a : values)
        for (const double b : values) unbiased += (a - b) * (a - b) / (2.0 * static_cast<double>(values.size()));
    looks.right(found.samples == static_cast<int>(n) && found.satellites == static_cast<int>(of.size()));
    const double grain = 1e-13;
    looks.near(found.radial_mean_m, radial / n, grain),
        looks.near(found.radial_rms_m, std::sqrt(squares[0] / n), grain);
    looks.near(found.along_rms_m, std::sqrt(squares[1] / n), grain),
        looks.near(found.cross_rms_m, std::sqrt(squares[2] / n), grain);
    looks.near(found.clock_rms_m, std::sqrt(squares[3] / n), grain);
    looks.near(found.rms_3d_m, std::sqrt((squares[0] + squares[1] + squares[2]) / n), grain);
    looks.near(found.sisre_m, std::sqrt((range + across) / n), grain);
    looks.near(found.sisre_receiver_m, std::sqrt((receiver + across) / n), grain);
    looks.near(found.sisre_unbiased_m, std::sqrt((unbiased + across) / n), grain);
  };
  check(errors.figures(), [](SatelliteId) { return true; });
  for (const SatelliteId one : all) check(errors.of_satellite(one), [one](SatelliteId sv) { return sv == one; });
  for (const char letter : {'G', 'R', 'E', 'C', 'J'})
    check(errors.of_system(letter), [letter](SatelliteId sv) { return system_letter(sv.system) == letter; });
  looks.right(errors.satellites().at('C').size() == 3 && errors.satellites().at('E').front().prn == 3);
  looks.right(OrbitErrors{}.figures().samples == 0 && std::isnan(OrbitErrors{}.figures().sisre_m));
  return looks.figure();
}

/// What errs of a broadcast against products: orbits moved along their own axes, clocks by an error of their own beside
/// one that all have, delays of the combination, antennas; 1e-3 m where axes turn by a metre over 2.6e7 m and circles'
/// r . v is none.
StressFigure errors_of_broadcasts() {
  Looks looks;
  const GpsTime start = GpsTime::from_week_sow(2000, 0.0);
  const auto sky = make_nominal("GEC");
  PreciseOrbits orbits = tabulated(*sky, start, 4);
  AntexFile antennas;
  for (auto& [sv, track] : orbits.satellites) {
    Antenna antenna;
    antenna.sv = sv;
    const std::string letter(1, system_letter(sv.system));
    antenna.patterns[letter + (sv.system == GnssSystem::kBeidou ? "02" : "01")].offset_m = {0.0, 0.0, 1.5};
    antennas.antennas.push_back(antenna);
    for (PreciseSample& sample : track) {
      const SatelliteState s = *sky->state(sv, sample.t);
      const Vector3d v = s.v_E + Vector3d(0, 0, 7.2921151467e-5).cross(s.p_E), out = s.p_E.normalized(),
                     across = s.p_E.cross(v).normalized(), along = across.cross(out);
      // The mass lies 1.5 m farther out than the antenna.
      sample.p_E = s.p_E + 1.5 * out - 0.4 * out - 0.8 * along + 0.6 * across;
      sample.clock_s = -1e-9 * sv.prn - 5e-8 + (sv.system == GnssSystem::kGps ? 2e-7 : 0.0);
    }
  }
  orbits.satellites[{GnssSystem::kGps, 5}][1].clock_s = kNaN;
  PreciseOptions options;
  options.antennas = &antennas, options.systems = "GE";
  const OrbitErrors found = orbit_errors(*sky, orbits, options);
  looks.right(found.without_clock == 1 && found.samples.size() == 2 * 24 * 4 - 1);
  for (const OrbitErrorSample& e : found.samples) {
    looks.near(e.radial_m, 0.4, 1e-5), looks.near(e.along_m, 0.8, 1e-5), looks.near(e.cross_m, -0.6, 1e-5);
    // Against the middle of 24 satellites, or of 23 that lack the fifth: 13 then.
    const bool lacks = e.sv.system == GnssSystem::kGps && e.t == start + 300.0;
    const double clock_m = 0.299792458 * (e.sv.prn - (lacks ? 13.0 : 12.5));
    looks.near(e.clock_m, clock_m, 1e-4), looks.near(e.range_m, -clock_m, 1e-4);
  }
  looks.right(std::is_sorted(found.samples.begin(), found.samples.end(),
                             [](const auto& a, const auto& b) { return a.t < b.t || (a.t == b.t && a.sv < b.sv); }));
  ClockFile clocks;
  clocks.interval_s = 300.0;
  for (int k = 0; k < 4; ++k) clocks.satellites[{GnssSystem::kGps, 1}].push_back({start + 300.0 * k, 1e-8});
  options.clocks = &clocks;
  const OrbitErrors by_file = orbit_errors(*sky, orbits, options);
  looks.right(by_file.samples.size() == 4 && by_file.without_clock == 2 * 24 * 4 - 4);
  for (const OrbitErrorSample& e : by_file.samples) looks.near(e.clock_m, 0.0, 1e-4);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> orbit_error_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "figures of broadcasts against products",
           "a weight of the other system, a mean of the square", "definitions over samples that are known: roundings",
           "of the bound"});
  rows.add("made/figures_of_orbits", figures_of_orbits).add("made/errors_of_broadcasts", errors_of_broadcasts);
  return rows.take();
}

}  // namespace canyon::gnss

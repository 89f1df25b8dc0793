// Broadcast records fitted to orbits, and what orbits keep.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/orbit_error.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/satellites/ephemerides/ephemeris_fit.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kInfinity;
using stress::Worst;

const GpsTime kFitStart = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);

/// Records fitted to the built-in orbits over a span, each instant of which has one whose fit interval it is in: the
/// orbit to what the fits themselves leave (rounding of 1e-7 m, a hundred times of which weak directions make; GLONASS
/// 1 cm as documented), and no satellite is without a record at either end.
StressFigure fitted(const char* systems, double from_s, double span_s, double bound_m) {
  const auto orbits = make_nominal(systems);
  std::vector<SatelliteId> some;
  for (const SatelliteId sv : orbits->satellites())
    if (sv.prn % 8 == 3) some.push_back(sv);
  const GpsTime start = kFitStart + from_s, end = start + span_s;
  const NavigationData data = fit_navigation_data(*orbits, some, start, end);
  Worst worst;
  for (const SatelliteId sv : some)
    for (double t_s = 0.0; t_s <= span_s; t_s += span_s / 16.0) {
      const GpsTime t = start + t_s;
      const auto truth = orbits->state(sv, t);
      double best_m = kInfinity;
      for (const KeplerEphemeris& k : data.kepler)
        if (k.sv == sv && std::abs(t - k.toe) <= 3600.0) best_m = std::min(best_m, (k.at(t).p_E - truth->p_E).norm());
      for (const GlonassEphemeris& r : data.glonass)
        if (r.sv == sv && std::abs(t - r.toe) <= 450.0) best_m = std::min(best_m, (r.at(t).p_E - truth->p_E).norm());
      worst.look(best_m, bound_m);
    }
  return worst.figure();
}

/// In inertial space a built-in orbit is Kepler's but for what the Earth's flattening does in a day: the angular
/// momentum keeps its size and the energy its value to some J2 (R / a)^2, the pole turns by the node's drift, and the
/// radius stays between the apsides.
StressFigure conserved(const char* systems) {
  const auto orbits = make_nominal(systems);
  Worst worst;
  const Vector3d w(0.0, 0.0, 7.2921151467e-5);
  constexpr double kMu = 3.986004418e14;
  for (const SatelliteId sv : orbits->satellites()) {
    std::vector<Vector3d> momentum;
    std::vector<double> energy, radius;
    for (int k = 0; k <= 96; ++k) {
      const double t_s = 900.0 * k;
      const auto s = orbits->state(sv, kFitStart + t_s);
      const Eigen::AngleAxisd turn(7.2921151467e-5 * t_s, Vector3d::UnitZ());
      const Vector3d p = turn * s->p_E, v = turn * (s->v_E + w.cross(s->p_E));
      momentum.push_back(p.cross(v));
      energy.push_back(0.5 * v.squaredNorm() - kMu / p.norm());
      radius.push_back(p.norm());
    }
    const auto [least, most] = std::minmax_element(radius.begin(), radius.end());
    const double a = 0.5 * (*least + *most), flattening = 1.0826e-3 * std::pow(6378137.0 / a, 2);
    const double n = std::sqrt(kMu / (a * a * a));
    for (std::size_t k = 0; k < momentum.size(); ++k) {
      worst.look(momentum[k].norm() / momentum[0].norm() - 1.0, 6.0 * flattening);
      worst.look((momentum[k].normalized() - momentum[0].normalized()).norm(),
                 1.5 * flattening * n * 86400.0 + 6.0 * flattening);
      // a itself is known to the step between two looks, (n 450 s)^2 e / 2 of it.
      worst.look(energy[k] / (-0.5 * kMu / a) - 1.0, 12.0 * flattening + 2e-3 * (*most - *least) / a);
    }
  }
  return worst.figure();
}

/// Precise minus itself moved outwards, forwards and across: those figures, by name, to what an SP3 of a millimetre
/// says; of a clock common to all nothing is left.
StressFigure moved() {
  const auto truth = make_nominal("G");
  PreciseOrbits precise;
  precise.interval_s = 900.0;
  for (const SatelliteId sv : truth->satellites())
    for (int k = 0; k < 12; ++k) {
      const auto s = truth->state(sv, kFitStart + 900.0 * k);
      const Vector3d v = s->v_E + Vector3d(0, 0, 7.2921151467e-5).cross(s->p_E), out = s->p_E.normalized(),
                     across = s->p_E.cross(v).normalized(), along = across.cross(out);
      PreciseSample sample;
      sample.t = kFitStart + 900.0 * k;
      sample.p_E = s->p_E - 1.5 * out + 2.5 * along - 4.0 * across;
      // 30 ns that all satellites share; the shift's own relativity, 2 r . v / c, is below 0.2 mm.
      sample.clock_s = s->clock_s + 30e-9;
      precise.satellites[sv].push_back(sample);
    }
  const OrbitErrorFigures found = orbit_errors(*truth, precise).figures();
  Worst worst;
  // The axes turn by 4 m / a; circular orbits have r . v = 0 but for the shift.
  const double turn = 5.0 * 5.0 / 2.6e7;
  worst.look(found.samples == 24 * 12 && found.satellites == 24 ? 0.0 : kInfinity, 1.0);
  worst.look(found.radial_mean_m - 1.5, turn);
  worst.look(found.radial_rms_m - 1.5, turn);
  worst.look(found.along_rms_m - 2.5, turn);
  worst.look(found.cross_rms_m - 4.0, turn);
  worst.look(found.rms_3d_m - std::sqrt(1.5 * 1.5 + 2.5 * 2.5 + 16.0), turn);
  worst.look(found.clock_rms_m, 2e-4);
  worst.look(found.sisre_m - std::sqrt(std::pow(0.98 * 1.5, 2) + (2.5 * 2.5 + 16.0) / 49.0), 4e-4);
  worst.look(found.sisre_unbiased_m - std::sqrt((2.5 * 2.5 + 16.0) / 49.0), 4e-4);
  return worst.figure();
}

}  // namespace

std::vector<StressCase> fitted_orbit_cases() {
  StressRows rows;
  rows.of({StressGroup::kLong, "records fitted over a span",
           "a grid of times that ends before the span, elements that do not belong together",
           "the orbit everywhere in the span, to what the fit leaves", "of the bound"});
  for (const double from_s : {0.0, 3500.0, 7199.0})
    rows.add("files/fitted_from_" + stress::text(from_s) + "_s",
             [from_s] { return fitted("GEC", from_s, 7000.0, 1e-5); });
  rows.add("files/fitted_state_vectors", [] { return fitted("R", 400.0, 1500.0, 0.01); });
  rows.of({StressGroup::kLong, "what an orbit keeps in inertial space",
           "axes that are no frame, a rate that is not the radius's",
           "momentum, energy and pole to the Earth's flattening", "of the bound"});
  for (const char* systems : {"G", "R", "E", "C", "J"})
    rows.add(std::string("files/conserved_by_") + systems, [systems] { return conserved(systems); });
  rows.of({StressGroup::kGeometry, "orbits that are moved along their own axes",
           "an axis of another orbit, a mean for a root",
           "each figure what it was moved by, to the square of the shift over the radius", "of the bound"});
  rows.add("files/orbit_errors_by_axis", moved);
  return rows.take();
}

}  // namespace canyon::gnss

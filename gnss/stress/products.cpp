// Precise orbits at the borders of their tables, carrier and code products.
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;
constexpr double kRadius_m = 26559.7e3, kRate = 2.0 * 7.2921151467e-5;  // of the built-in GPS, within 1e-4 of it
const GpsTime kFirstOrbit = GpsTime::from_week_sow(1617, 600000.0);     // so that the week ends inside
const SatelliteId kG01{GnssSystem::kGps, 1};

PreciseOrbits sampled(double interval_s, int count) {
  const auto truth = make_nominal_gps();
  PreciseOrbits orbits;
  orbits.files = {"made.sp3"};
  orbits.interval_s = interval_s;
  for (int k = 0; k < count; ++k) {
    const GpsTime t = kFirstOrbit + k * interval_s;
    PreciseSample sample;
    sample.t = t;
    sample.p_E = truth->state(kG01, t)->p_E;
    sample.clock_s = 1e-4 + 1e-9 * k;
    orbits.satellites[kG01].push_back(sample);
  }
  return orbits;
}

/// Product of the distances to ten nodes, in steps, at x steps after the first of them, and the sum of the absolute
/// weights (Lebesgue's function), by which the samples' own rounding grows.
std::array<double, 2> nodes_at(double x) {
  double product = 1.0, lebesgue = 0.0;
  for (int i = 0; i < 10; ++i) product *= std::abs(x - i);
  for (int i = 0; i < 10; ++i) {
    double weight = 1.0;
    for (int j = 0; j < 10; ++j)
      if (j != i) weight *= (x - j) / (i - j);
    lebesgue += std::abs(weight);
  }
  return {product, lebesgue};
}

/// Truncation of degree 9: product (n h)^10 r / 10! of a circle; rounding: Lebesgue's function times 16 eps r. `place`
/// in steps after the first sample of `count`; its ten nodes lie around it, or at the end.
StressFigure interpolated(double interval_s, double place) {
  constexpr int kCount = 40;
  const auto precise = make_precise(sampled(interval_s, kCount));
  const GpsTime t = kFirstOrbit + place * interval_s;
  const auto found = precise->state(kG01, t);
  if (!found) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  const double first = std::clamp(std::floor(place) - 4.0, 0.0, kCount - 10.0);
  const auto [product, lebesgue] = nodes_at(place - first);
  const double truncation = product / 3628800.0 * std::pow(1.0002 * kRate * interval_s, 10) * kRadius_m;
  return {(found->p_E - make_nominal_gps()->state(kG01, t)->p_E).norm(),
          truncation + 16.0 * kEpsilon * kRadius_m * std::max(lebesgue, 1.0)};
}

/// No state beyond half an interval of a run, beside a missing epoch, before too short a run; a figure counts states.
StressFigure beside() {
  StressFigure out;
  const auto some = [&](const PreciseOrbits& orbits, double place) {
    return make_precise(orbits)->state(kG01, kFirstOrbit + place * 900.0).has_value();
  };
  const PreciseOrbits whole = sampled(900.0, 30);
  for (const double place : {-0.5000001, 29.5000001, -1e6, 1e6}) out.figure += some(whole, place) ? 1.0 : 0.0;
  for (const double place : {-0.5, 29.5}) out.figure += some(whole, place) ? 0.0 : 1.0;
  PreciseOrbits gap = whole;
  auto& samples = gap.satellites[kG01];
  samples.erase(samples.begin() + 15);
  out.figure += some(gap, 15.0) ? 1.0 : 0.0;
  out.figure += some(gap, 14.6) ? 1.0 : 0.0;
  out.figure += some(gap, 14.4) ? 0.0 : 1.0;
  out.figure += some(sampled(900.0, 9), 4.0) ? 1.0 : 0.0;
  out.figure += some(sampled(900.0, 10), 4.0) ? 0.0 : 1.0;
  PreciseOrbits moved = whole;
  moved.satellites[kG01][12].manoeuvre = true;
  // From 12 samples before it and 18 after it each side stands by itself.
  out.figure += some(moved, 11.4) && some(moved, 12.0) ? 0.0 : 1.0;
  PreciseOrbits jumped = whole;
  jumped.satellites[kG01][12].clock_event = true;
  jumped.satellites[kG01][20].clock_s = std::numeric_limits<double>::quiet_NaN();
  out.figure += some(jumped, 11.5) || some(jumped, 19.5) || some(jumped, 20.5) ? 1.0 : 0.0;
  out.figure += some(jumped, 12.5) && some(jumped, 18.9) ? 0.0 : 1.0;
  return out;
}

/// Where the ten nodes change by one, at each sample, the polynomial passes through the sample from either side: 2 ns
/// apart it moves by 4 km/s * 2 ns, and rounds.
StressFigure at_samples() {
  const auto precise = make_precise(sampled(900.0, 30));
  StressFigure out{0.0, 2e-9 * 4000.0 + 32.0 * kEpsilon * kRadius_m};
  for (int k = 1; k < 29; ++k) {
    const std::int64_t ns = (kFirstOrbit + k * 900.0).ns;
    const auto a = precise->state(kG01, GpsTime{ns - 1}), b = precise->state(kG01, GpsTime{ns + 1});
    take_worst(out, a && b ? (a->p_E - b->p_E).norm() : std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

}  // namespace

std::vector<StressCase> product_cases() {
  StressRows rows;
  rows.of(
      {StressGroup::kGeometry, "interpolation of an orbit's table, at its middle and its borders",
       "nodes to one side only: the product of distances grows a hundredfold; a table whose last ten are never reached",
       "product (n h)^10 r / 10! + 16 eps r Lebesgue's function", "m"});
  struct At {
    double interval, place;
    const char* name;
  };
  for (const At& at :
       {At{900.0, 20.5, "900_s_middle"}, At{900.0, 20.0, "900_s_at_a_sample"}, At{900.0, 0.5, "900_s_first_interval"},
        At{900.0, -0.5, "900_s_before_the_first"}, At{900.0, 39.5, "900_s_after_the_last"},
        At{300.0, 20.5, "300_s_middle"}, At{300.0, -0.5, "300_s_before_the_first"}, At{30.0, 20.5, "30_s_middle"},
        At{3600.0, 20.5, "3600_s_middle"}})
    rows.add(std::string("products/orbit_") + at.name, [at] { return interpolated(at.interval, at.place); });
  rows.of({StressGroup::kGeometry, "an interpolation whose nodes change", "a jump from one set of nodes to the next",
           "4 km/s times 2 ns and 32 eps r across each sample", "m"});
  rows.add("products/orbit_across_samples", at_samples);
  rows.of({StressGroup::kData, "an instant beside a table, a gap, a manoeuvre, a jump of a clock",
           "extrapolation: kilometres, told as a precise orbit", "no state there, a state just inside", "differences"});
  rows.add("products/no_state_beside_the_table", beside);
  return rows.take();
}

}  // namespace canyon::gnss

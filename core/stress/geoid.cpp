#include "canyon/core/earth/geoid.h"

#include <vector>

#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

using stress::Worst;

/// A hundred terms of at most 110 m, whose weights' magnitudes sum to below 9 (two polynomials of ten points each,
/// Lebesgue constant below 3 in the middle): rounding of the sum.
constexpr double kSum_m = 100.0 * stress::kEpsilon * 110.0 * 9.0;

double undulation_m(const Geoid& geoid, double lat_rad, double lon_rad) {
  return geoid.undulation_m({lat_rad, lon_rad, 0.0});
}

StressFigure one_height_at_a_pole() {
  const Geoid geoid = Geoid::built_in();
  Worst worst;
  for (const double pole : {-90.0, 90.0}) {
    const double first_m = undulation_m(geoid, pole * kDegree, 0.0);
    for (double lon = -kPi; lon <= kPi; lon += 0.1)
      worst.look(undulation_m(geoid, pole * kDegree, lon) - first_m, 2.0 * kSum_m);
  }
  return worst.figure();
}

/// The geoid's steepest slope is below 1e-3: beside the border it may have changed by as much as that times the way.
StressFigure across_borders() {
  const Geoid geoid = Geoid::built_in();
  Worst worst;
  constexpr double kStep_rad = 1e-12, kSlope_m = 2.0 * kStep_rad * 6.4e6 * 1e-3;
  for (double lat = -1.5; lat < 1.55; lat += 0.11) {
    for (const double lon : {kPi, 0.0, 0.5 * kDegree, -90.0 * kDegree})
      worst.look(undulation_m(geoid, lat, lon - kStep_rad) - undulation_m(geoid, lat, lon + kStep_rad),
                 kSlope_m + 2.0 * kSum_m);
    worst.look(undulation_m(geoid, lat, kPi) - undulation_m(geoid, lat, -kPi), 2.0 * kSum_m);
  }
  for (const double row_deg : {89.5, 0.0, -45.0, -89.5})
    worst.look(undulation_m(geoid, row_deg * kDegree - kStep_rad, 1.0) -
                   undulation_m(geoid, row_deg * kDegree + kStep_rad, 1.0),
               kSlope_m + 2.0 * kSum_m);
  return worst.figure();
}

StressFigure beyond_the_table() {
  const Geoid geoid = Geoid::built_in();
  int passed = 0;
  for (const double lat : {std::nextafter(0.5 * kPi, 2.0), -2.0, kPi, stress::kInfinity, std::nan("")})
    passed += stress::not_refused([&] { return undulation_m(geoid, lat, 0.0); });
  for (const double lon : {stress::kInfinity, std::nan("")})
    passed += stress::not_refused([&] { return undulation_m(geoid, 0.0, lon); });
  return {1.0 * passed, 0.0};
}

}  // namespace

std::vector<StressCase> geoid_cases() {
  const auto group = StressGroup::kGeometry;
  const StressMechanism border{
      group, "the border of a table",
      "the polynomial's points beyond a pole or the last column are read beside the table",
      "one height at a pole from all sides, and no jump over Greenwich, the antimeridian, a row or a "
      "column: rounding of "
      "a hundred terms, and slope",
      "of the bound"};
  const StressMechanism beyond{group, "an argument beyond the table",
                               "a latitude an ulp beyond the pole, or none at all, indexes memory",
                               "each of them is refused", "let through"};
  StressRows rows;
  rows.of(border)
      .add("geoid/one_height_at_a_pole", one_height_at_a_pole)
      .loose("on a row of the table all weights but ten are zero, so that little is summed");
  rows.of(border).add("geoid/across_its_borders", across_borders);
  rows.of(beyond).add("geoid/beyond_its_table", beyond_the_table);
  return rows.take();
}

}  // namespace canyon

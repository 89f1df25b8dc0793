#include "canyon/core/earth/geoid.h"

#include <string>
#include <vector>

#include "canyon/core/earth/geoid_grid.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

using stress::Worst;

/// Magnitudes of the weights of ten points, two polynomials of which are multiplied: in the middle, where they are
/// largest, 2 (39690 + 8820 + 2268 + 405 + 35) / 65536.
constexpr double kWeights = 102436.0 / 65536.0 * 102436.0 / 65536.0;

/// A hundred terms of at most 110 m: rounding of the sum.
constexpr double kSum_m = 100.0 * stress::kEpsilon * 110.0 * kWeights;

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

/// A smooth surface over the sphere, whose harmonics of third degree ten points 5 degrees apart meet to 1e-7 m.
double smooth_m(double lat, double lon) {
  const double c = std::cos(lat), s = std::sin(lat);
  return 3.0 + 20.0 * s + 15.0 * c * std::cos(lon - 0.4) + 12.0 * c * c * std::sin(2.0 * lon) +
         8.0 * s * c * c * std::cos(2.0 * lon);
}
std::string made_grid(int rows, double offset_m, double scale_m) {
  std::string out = "P5\n# a made grid\n# Offset " + std::to_string(offset_m) + "\n# Scale " + std::to_string(scale_m) +
                    "\n" + std::to_string(2 * (rows - 1)) + " " + std::to_string(rows) + "\n65535\n";
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < 2 * (rows - 1); ++column) {
      const double step = kPi / (rows - 1), lat = 0.5 * kPi - row * step, lon = column * step;
      const auto sample = static_cast<int>(std::lround((smooth_m(lat, lon) - offset_m) / scale_m));
      out += static_cast<char>(sample / 256), out += static_cast<char>(sample % 256);
    }
  return out;
}

/// Half a unit of the grid's scale by the weights' magnitudes, and the polynomials' own 1e-7 m; everywhere, over poles
/// and Greenwich too.
StressFigure made_surface() {
  Worst worst;
  const std::string text = made_grid(37, -60.0, 0.002);
  const GeoidGrid grid(text);
  for (double lat = -1.57; lat < 1.58; lat += 0.0317)
    for (double lon = -7.0; lon < 7.0; lon += 0.239)
      worst.look(grid.undulation_m({lat, lon, 0.0}) - smooth_m(lat, lon), 0.001 * kWeights + 1e-7);
  return worst.figure();
}

StressFigure grids_that_are_none() {
  int passed = 0;
  const std::string good = made_grid(7, -60.0, 0.002);
  for (const std::string& bad : {good.substr(1), good.substr(0, good.size() - 1), good + "x",
                                 std::string(good).replace(good.find("65535"), 5, "00255"),
                                 std::string(good).replace(good.find("Offset"), 6, "offset"),
                                 std::string(good).replace(good.find("Scale"), 5, "scale"),
                                 std::string(good).replace(good.find("12 7"), 4, "14 6")})
    passed += stress::not_refused([&] { return GeoidGrid(bad); });
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
  rows.of({group, "a surface that is known, on a grid",
           "weights of the points beside, a row for a column, bytes in the other order",
           "the surface itself, to half a unit of the grid's scale", "of the bound"});
  rows.add("geoid/made_surface", made_surface);
  rows.of({StressGroup::kData, "grids that are none", "a size that does not fit its samples", "each is refused",
           "let through"});
  rows.add("geoid/grids_that_are_none", grids_that_are_none);
  return rows.take();
}

}  // namespace canyon

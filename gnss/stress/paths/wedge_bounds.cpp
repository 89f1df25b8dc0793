// Bounds of what wedges and parts of edges make.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/diffraction/wedge.h"
#include "canyon/gnss/paths/diffraction/wedge_bound.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

/// Bounds of an edge's parts and of wedges' fields: never below what they bound, and over draws of all places not above
/// it by more than a few times, in the middle of them.
StressFigure bounds_of_wedges() {
  int wrong = 0;
  const RandomStream draws(5, "stress.shortcuts");
  std::vector<double> room, field_room;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    const double nu = std::pow(10.0, draws.uniform(-3.0, 1.2, 40, k)), u = draws.uniform(-20.0, 20.0, 41, k),
                 length = std::pow(10.0, draws.uniform(-2.0, 1.5, 42, k));
    const double most = largest_finite_edge_factor(nu, u, u + length),
                 is = std::abs(finite_edge_factor(nu, u, u + length));
    wrong += most >= is ? 0 : 1;
    // Beside the 1e-3 that is added.
    if (is > 0.02) room.push_back(most / is);
    WedgeWay way;
    way.n = draws.uniform(1.1, 1.95, 43, k);
    way.phi_in_rad = way.n * kPi * draws.uniform(44, k), way.phi_out_rad = way.n * kPi * draws.uniform(45, k);
    way.sine_beta = draws.uniform(0.1, 1.0, 46, k), way.distance_m = std::pow(10.0, draws.uniform(0.0, 2.5, 47, k));
    way.wavelength_m = draws.uniform(0.18, 0.26, 48, k);
    const std::complex<double> one = std::polar(draws.uniform(49, k), 6.3 * draws.uniform(50, k)),
                               two = std::polar(draws.uniform(51, k), 6.3 * draws.uniform(52, k));
    const double largest = largest_wedge_field(way);
    for (const auto& [first, second] : {std::pair{one, two},
                                        {std::complex<double>(1.0), std::complex<double>(1.0)},
                                        {std::complex<double>(-1.0), std::complex<double>(-1.0)}}) {
      const double field = std::abs(WedgeBorders(way).field(first, second));
      wrong += largest >= field ? 0 : 1;
      if (first.real() == -1.0) field_room.push_back(largest / field);
    }
  }
  const auto middle = [](std::vector<double> x) {
    std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2), x.end());
    return x[x.size() / 2];
  };
  wrong += room.size() > 300 && middle(room) < 2.0 && middle(field_room) < 5.0 ? 0 : 1;
  wrong +=
      largest_finite_edge_factor(0.0, -1.0, 1.0) <= 1.01 && largest_finite_edge_factor(1e-9, 5.0, 6.0) <= 1.01 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> wedge_bound_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "bounds of what wedges and parts of edges make",
           "a bound that is none, or so wide that it tells nothing",
           "above what they bound, by less than a few times in the middle", "wrong"});
  rows.add("shortcuts/bounds_of_wedges", bounds_of_wedges);
  return rows.take();
}

}  // namespace canyon::gnss

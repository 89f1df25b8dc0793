#include "canyon/gnss/paths/diffraction/wedge_bound.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"

namespace canyon::gnss {
namespace {

/// Even over the logarithm.
double spread(const RandomStream& draws, std::uint32_t i, std::uint32_t n, double from, double to) {
  return from * std::pow(to / from, draws.uniform(i, n));
}

// The least of the field behind a knife edge on which the bound of a piece stands. The field falls with nu, so that
// between two nodes it is no less than at the second: that one is held against the claim at the first.
TEST(WedgeBound, KnifeEdgeIsNoWeakerThanClaimed) {
  constexpr double kStep = 1e-4;
  for (double nu = 0.0; nu < 40.0; nu += kStep)
    ASSERT_GE(std::abs(knife_edge_field(nu + kStep)), 1.0 / (kPi * std::sqrt(2.0 * (nu * nu + 0.3)))) << nu;
}

TEST(WedgeBound, HoldsForEveryPieceOfAnEdge) {
  const RandomStream draws(17, "wedge_bound.piece");
  std::uint32_t near = 0;
  constexpr std::uint32_t kDraws = 100'000;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const double nu = spread(draws, i, 0, 1e-7, 30.0), length = spread(draws, i, 1, 1e-3, 100.0);
    const double middle = (draws.uniform(i, 2) < 0.5 ? -1.0 : 1.0) * spread(draws, i, 3, 1e-3, 100.0);
    const double is = std::abs(finite_edge_factor(nu, middle - 0.5 * length, middle + 0.5 * length));
    const double most = largest_finite_edge_factor(nu, middle - 0.5 * length, middle + 0.5 * length);
    ASSERT_LE(is, most) << nu << " " << middle << " " << length;
    near += most < 3.0 * is + 2e-3;  // it would be of no use if it were far off
  }
  EXPECT_GT(near, kDraws / 2);
}

TEST(WedgeBound, HoldsForEveryWedge) {
  const RandomStream draws(17, "wedge_bound.wedge");
  std::uint32_t near = 0;
  constexpr std::uint32_t kDraws = 200'000;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    WedgeWay way;
    way.n = 1.0 + spread(draws, i, 0, 0.02, 1.0);
    way.phi_in_rad = way.n * kPi * draws.uniform(i, 1);
    way.phi_out_rad = way.n * kPi * draws.uniform(i, 2);
    // Half of them at a border of the shadow or of a reflection, from far off to within rounding.
    const double off_rad = (draws.uniform(i, 3) < 0.5 ? -1.0 : 1.0) * spread(draws, i, 4, 1e-9, 1.0);
    const double border_rad[] = {way.phi_in_rad + kPi, way.phi_in_rad - kPi, kPi - way.phi_in_rad,
                                 (2.0 * way.n - 1.0) * kPi - way.phi_in_rad};
    if (i % 2 == 0) way.phi_out_rad = std::clamp(border_rad[i / 2 % 4] + off_rad, 0.0, way.n * kPi);
    way.sine_beta = spread(draws, i, 5, 1e-3, 1.0);
    way.distance_m = spread(draws, i, 6, 1e-2, 1e5);
    way.wavelength_m = 0.19 + 0.07 * draws.uniform(i, 7);
    const auto face = [&](std::uint32_t n) { return std::polar(1.0, 2.0 * kPi * draws.uniform(i, n)); };
    const double is = std::abs(WedgeBorders(way).field(face(8), face(9))), most = largest_wedge_field(way);
    ASSERT_LE(is, most) << way.n << " " << way.phi_in_rad << " " << way.phi_out_rad << " " << way.sine_beta << " "
                        << way.distance_m;
    near += most < 6.0 * is;
  }
  EXPECT_GT(near, kDraws / 2);
}

}  // namespace
}  // namespace canyon::gnss

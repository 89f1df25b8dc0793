// What a surface mirrors at most, by its reflectances: that nothing mirrors more, and what follows for ways over walls.
#include "canyon/gnss/paths/need/reflection_bound.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"

namespace canyon::gnss::testing {
namespace {

/// Of a wave of any polarization at that incidence, what one bounce leaves of its field.
double left_of(const scene::Material& material, double roughness_m, double cosine, double carrier_hz,
               const CircularField& wave) {
  const Eigen::Vector3d incoming(std::sqrt(1.0 - cosine * cosine), 0.0, -cosine);
  const Bounce b = bounce_off(material, incoming, Eigen::Vector3d::UnitZ(), roughness_m, carrier_hz);
  const auto right = b.coefficients.co * wave.copolar + b.coefficients.cross * wave.crosspolar;
  const auto left = b.coefficients.cross * wave.copolar + b.coefficients.co * wave.crosspolar;
  return b.factor * std::sqrt(std::norm(right) + std::norm(left));
}

/// Crowns and clothes are as air to radio.
bool reflects(const scene::Material& material) {
  return !material.rf_absorbing && material.permittivity(1.5e9) != 1.0;
}

// Of every material, polarization, incidence and carrier; and it is no more than twice the most that was found at that
// incidence, so that half of it is no bound. Thin sheets of glass and boards let nearly all through at some incidence,
// where the bound knows their faces alone.
TEST(ReflectionBound, NoWaveIsMirroredWithMore) {
  const RandomStream stream(3, "test.waves");
  int near_the_bound = 0, materials = 0;
  for (const scene::Material& material : scene::builtin_materials()) {
    const ReflectionBound bound(material, 0.01);
    double most_ratio = 0.0;
    for (std::uint64_t k = 0; k < 4000; ++k) {
      const double cosine = stream.uniform(0.0, 1.0, 0, k), carrier_hz = stream.uniform(1.15e9, 1.62e9, 1, k);
      const double share = stream.uniform(0.0, 1.0, 2, k), turn = stream.uniform(0.0, 2.0 * kPi, 3, k);
      const CircularField wave{std::sqrt(share), std::polar(std::sqrt(1.0 - share), turn)};
      const double left = left_of(material, 0.01, cosine, carrier_hz, wave), most = bound.from(cosine);
      ASSERT_LE(left, most + 1e-12) << material.name << " at " << cosine << ", " << carrier_hz;
      if (most > 0.0) most_ratio = std::max(most_ratio, left / most);
    }
    materials += reflects(material) ? 1 : 0;
    near_the_bound += most_ratio > 0.5 ? 1 : 0;
  }
  EXPECT_EQ(near_the_bound, materials) << "half the bound would do as well";
}

TEST(ReflectionBound, FallsAsTheIncidenceDoesAndAnAbsorberHasNone) {
  for (const scene::Material& material : scene::builtin_materials()) {
    const ReflectionBound bound(material, 0.0);
    if (!reflects(material)) {
      EXPECT_EQ(bound.from(0.0), 0.0);
      continue;
    }
    EXPECT_NEAR(bound.from(-0.1), 1.0, 1e-9) << material.name << ": all at grazing incidence";
    for (double cosine = 0.01; cosine <= 1.0; cosine += 0.01)
      EXPECT_LE(bound.from(cosine), bound.from(cosine - 0.01) + 1e-12) << material.name << " at " << cosine;
  }
}

}  // namespace
}  // namespace canyon::gnss::testing

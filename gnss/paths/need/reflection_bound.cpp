#include "canyon/gnss/paths/need/reflection_bound.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/diffraction/fresnel.h"

namespace canyon::gnss {

namespace {

constexpr double kLowest_hz = 1.15e9, kHighest_hz = 1.62e9;

/// What comes back of a field from a slab's far face at most.
double back_at_most(const scene::Material& material, double carrier_hz) {
  const double wavelength_m = kSpeedOfLight / carrier_hz;
  const std::complex<double> through =
      2.0 * kPi * material.thickness_m / wavelength_m * std::sqrt(material.permittivity(carrier_hz));
  return std::exp(-2.0 * std::abs(through.imag()));
}

}  // namespace

ReflectionBound::ReflectionBound(const scene::Material& material, double further_roughness_m) {
  if (material.rf_absorbing) return;
  const double roughness_m = std::hypot(material.roughness_m, further_roughness_m);
  double back = 0.0;
  if (material.thickness_m > 0.0)
    back = std::max(back_at_most(material, kLowest_hz), back_at_most(material, kHighest_hz));
  for (int i = 0; i <= kSteps; ++i) {
    const double cosine = static_cast<double>(i) / kSteps, incidence_rad = std::acos(cosine);
    double r = 0.0;
    for (const double carrier_hz : {kLowest_hz, kHighest_hz})
      r = std::max(r, std::abs(fresnel(material.permittivity(carrier_hz), incidence_rad).te));
    const double whole = r >= 1.0 ? 1.0 : std::min(1.0, r * (1.0 + back) / (1.0 - r * r * back));
    at_[static_cast<std::size_t>(i)] = whole * roughness_factor(roughness_m, cosine, kSpeedOfLight / kLowest_hz);
  }
}

double ReflectionBound::from(double least_cosine) const {
  return at_[static_cast<std::size_t>(kSteps * std::clamp(least_cosine, 0.0, 1.0))];
}

}  // namespace canyon::gnss

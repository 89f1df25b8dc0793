#include "canyon/gnss/paths/bounce.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

/// Unit vector across the plane of incidence; at normal incidence any direction across the way does.
Eigen::Vector3d across(const Eigen::Vector3d& way_W, const Eigen::Vector3d& normal_W) {
  const Eigen::Vector3d v = way_W.cross(normal_W);
  const double length = v.norm();
  return length > 1e-12 ? Eigen::Vector3d(v / length) : way_W.unitOrthogonal();
}

}  // namespace

Bounce bounce_off(const scene::Material& material, const Eigen::Vector3d& incoming_W, const Eigen::Vector3d& normal_W,
                  double further_roughness_m, double carrier_hz) {
  Bounce b{incoming_W, normal_W, {}, 1.0};
  if (material.rf_absorbing) return b;
  const double cosine = std::clamp(-incoming_W.dot(normal_W), 0.0, 1.0), incidence_rad = std::acos(cosine);
  const double wavelength_m = kSpeedOfLight / carrier_hz;
  const std::complex<double> permittivity = material.permittivity(carrier_hz);
  b.coefficients = material.thickness_m > 0.0
                       ? fresnel_slab(permittivity, material.thickness_m, wavelength_m, incidence_rad)
                       : fresnel(permittivity, incidence_rad);
  const double roughness_m = std::hypot(material.roughness_m, further_roughness_m);
  if (roughness_m > 0.0) b.factor = roughness_factor(roughness_m, cosine, wavelength_m);
  return b;
}

double finite_facet_factor(double area_m2, double cos_incidence, double wavelength_m, double distance_m) {
  return std::min(1.0, area_m2 * cos_incidence / (wavelength_m * distance_m));
}

double mirror_factor(const Eigen::Vector3d& normal_W, double scattered_share) {
  return std::abs(normal_W.z()) <= kUprightSlope ? std::sqrt(1.0 - scattered_share) : 1.0;
}

CircularField reflected_field(std::span<const Bounce> bounces) {
  CircularField field;
  // Basis after the bounce before; along x across = way.
  Eigen::Vector3d across_W = Eigen::Vector3d::Zero(), along_W = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < bounces.size(); ++i) {
    const Bounce& b = bounces[i];
    const Eigen::Vector3d new_across_W = across(b.incoming_W, b.normal_W);
    if (i > 0) {
      const Eigen::Vector3d new_along_W = new_across_W.cross(b.incoming_W);
      const double psi_rad = std::atan2(new_along_W.dot(across_W), new_along_W.dot(along_W));
      field.copolar *= std::polar(1.0, -psi_rad);
      field.crosspolar *= std::polar(1.0, psi_rad);
    }
    const auto right = b.coefficients.co * field.copolar + b.coefficients.cross * field.crosspolar;
    const auto left = b.coefficients.cross * field.copolar + b.coefficients.co * field.crosspolar;
    field.copolar = b.factor * right;
    field.crosspolar = b.factor * left;
    const Eigen::Vector3d way_W = b.incoming_W - 2.0 * b.incoming_W.dot(b.normal_W) * b.normal_W;
    across_W = new_across_W;
    along_W = across_W.cross(way_W);
  }
  return field;
}

double roughness_factor(double sigma_m, double cos_incidence, double wavelength_m) {
  const double phase = 2.0 * kPi * sigma_m * cos_incidence / wavelength_m;
  return std::exp(-2.0 * phase * phase);
}

}  // namespace canyon::gnss

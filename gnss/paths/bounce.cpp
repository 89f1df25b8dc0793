#include "gnss/paths/bounce.h"

#include <cmath>

#include <Eigen/Geometry>

#include "core/units.h"

namespace canyon::gnss {
namespace {

/// Unit vector across the plane of incidence; at normal incidence any direction across the way does.
Eigen::Vector3d across(const Eigen::Vector3d& way_W, const Eigen::Vector3d& normal_W) {
  const Eigen::Vector3d v = way_W.cross(normal_W);
  const double length = v.norm();
  return length > 1e-12 ? Eigen::Vector3d(v / length) : way_W.unitOrthogonal();
}

}  // namespace

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

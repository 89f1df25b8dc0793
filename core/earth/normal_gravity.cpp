#include <cmath>

#include <GeographicLib/NormalGravity.hpp>

#include "canyon/core/earth/earth.h"

namespace canyon {
namespace {

constexpr double kE2_m2 = Wgs84::a_m * Wgs84::a_m * Wgs84::e2;  // of the focal length
constexpr double kRate2 = Wgs84::rate_rad_s * Wgs84::rate_rad_s;
/// Down to here the series below hold every digit. Of smaller u, deep in the Earth, only the library's form is asked.
constexpr double kLeast_u_m = 6.2e6;

/// q and q' of Heiskanen & Moritz (1967), eqs. 2-57 and 2-67, divided by (E / u)^3 and (E / u)^2, for s = (E / u)^2.
/// As printed they lose all but six digits to cancellation here; these are their series in s, of which the first term
/// left out is below 1e-17 of the first.
struct Flattening {
  double q, q_prime;
};
Flattening flattening(double s) {
  // sum over k >= 1 of (-1)^(k+1) {2 k, 6} s^(k-1) / ((2 k + 1) (2 k + 3)).
  constexpr int kTerms = 8;
  Flattening f{0.0, 0.0};
  for (int k = kTerms; k >= 1; --k) {
    const double term = 1.0 / ((2 * k + 1) * (2 * k + 3));
    f.q = 2 * k * term - s * f.q;
    f.q_prime = 6 * term - s * f.q_prime;
  }
  return f;
}

}  // namespace

/// The gradient of the normal potential in ellipsoidal-harmonic coordinates (u, beta), Heiskanen & Moritz (1967), eq.
/// 2-62, put together along the axes of E, where neither the poles nor the square roots of the unit vectors remain.
Eigen::Vector3d gravity_E(const Eigen::Vector3d& p_E) {
  const double x = p_E.x(), y = p_E.y(), z = p_E.z();
  const double axial2 = x * x + y * y, Q = axial2 + z * z - kE2_m2;
  const double u2 = 0.5 * (Q + std::sqrt(Q * Q + 4.0 * kE2_m2 * z * z));
  if (!(u2 > kLeast_u_m * kLeast_u_m)) {
    Eigen::Vector3d g_E;
    GeographicLib::NormalGravity::WGS84().U(x, y, z, g_E.x(), g_E.y(), g_E.z());
    return g_E;
  }
  // On the ellipsoid u is its polar axis.
  constexpr double kPolar2_m2 = Wgs84::a_m * Wgs84::a_m - kE2_m2;
  static const Flattening level = flattening(kE2_m2 / kPolar2_m2);
  const double s = kE2_m2 / u2;
  const Flattening here = flattening(s);
  // w^2 a^2 q / q_0, and E q' in the same unit: q_0 holds (E / b)^3.
  static const double level_q = level.q * std::pow(kE2_m2 / kPolar2_m2, 1.5);
  const double u = std::sqrt(u2), ratio = std::sqrt(kE2_m2) / u;
  const double by_level = kRate2 * Wgs84::a_m * Wgs84::a_m / level_q;
  const double A = by_level * here.q * ratio * s, B = by_level * here.q_prime * s * std::sqrt(kE2_m2);
  const double v2 = u2 + kE2_m2, sine = z / u, sine2 = sine * sine, cosine2 = axial2 / v2;
  const double along_u = -(Wgs84::gm_m3_s2 + 0.5 * B * (sine2 - 1.0 / 3.0)) / v2;  // dV / du
  const double D = u2 + kE2_m2 * sine2;
  const double across = (along_u * u - A * sine2) / D + kRate2;
  return {across * x, across * y, sine * (along_u * v2 + A * u * cosine2) / D};
}

Eigen::Matrix3d gravity_gradient_E(const Eigen::Vector3d& p_E) {
  // Near the surface the third derivative is about 24 g / a^3 = 9e-19 1/(m s)^2: truncation at this step is 1.5e-15
  // 1/s^2 and rounding 1e-16, of gradients of 1.5e-6 to 3e-6.
  constexpr double kStepM = 100.0;
  Eigen::Matrix3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStepM * Eigen::Vector3d::Unit(axis);
    gradient.col(axis) = (gravity_E(p_E + step) - gravity_E(p_E - step)) / (2.0 * kStepM);
  }
  return gradient;
}

}  // namespace canyon

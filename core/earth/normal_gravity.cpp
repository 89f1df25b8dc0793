#include <cmath>

#include <GeographicLib/NormalGravity.hpp>

#include "canyon/core/earth/earth.h"

namespace canyon {
namespace {

constexpr double kRate2 = Wgs84::rate_rad_s * Wgs84::rate_rad_s;
/// Squares of the linear eccentricity E and of the polar axis b.
constexpr double kE2_m2 = Wgs84::a_m * Wgs84::a_m * Wgs84::e2, kB2_m2 = Wgs84::a_m * Wgs84::a_m - kE2_m2;
/// Down to here the series below hold every digit. Of smaller u, deep in the Earth, the library is asked.
constexpr double kLeast_u_m = 6.2e6;

/// q and q' of Heiskanen & Moritz (1967), chapter 2, divided by (E / u)^3 and (E / u)^2. Their closed forms lose six
/// digits to cancellation here; these are the series of the same in s = (E / u)^2, sum over k >= 1 of
/// (-1)^(k+1) {2 k, 6} s^(k-1) / ((2 k + 1) (2 k + 3)), whose first term left out is below 1e-17 of the first.
struct Flattening {
  double q = 0.0, q_prime = 0.0;
  explicit Flattening(double s) {
    constexpr int kTerms = 8;
    for (int k = kTerms; k >= 1; --k) {
      const double term = 1.0 / ((2 * k + 1) * (2 * k + 3));
      q = 2 * k * term - s * q;
      q_prime = 6 * term - s * q_prime;
    }
  }
};

/// w^2 a^2 / q_0, q_0 being q on the ellipsoid, where u = b.
double rotation_over_q0() {
  return kRate2 * Wgs84::a_m * Wgs84::a_m / (Flattening(kE2_m2 / kB2_m2).q * std::pow(kE2_m2 / kB2_m2, 1.5));
}

}  // namespace

/// The gradient of the normal potential in ellipsoidal-harmonic coordinates (u, beta), Heiskanen & Moritz (1967),
/// chapter 2, put together along the axes of E, where neither the poles nor the lengths of the unit vectors remain.
Eigen::Vector3d gravity_E(const Eigen::Vector3d& p_E) {
  const double x = p_E.x(), y = p_E.y(), z = p_E.z();
  const double axial2 = x * x + y * y, Q = axial2 + z * z - kE2_m2;
  const double u2 = 0.5 * (Q + std::sqrt(Q * Q + 4.0 * kE2_m2 * z * z));
  if (!(u2 > kLeast_u_m * kLeast_u_m)) {
    Eigen::Vector3d g_E;
    GeographicLib::NormalGravity::WGS84().U(x, y, z, g_E.x(), g_E.y(), g_E.z());
    return g_E;
  }
  static const double E = std::sqrt(kE2_m2), per_q0 = rotation_over_q0();
  const double u = std::sqrt(u2), s = kE2_m2 / u2;
  const Flattening series(s);
  const double q = per_q0 * (E / u) * s * series.q, q_prime = per_q0 * E * s * series.q_prime;
  const double v2 = u2 + kE2_m2, sine = z / u, sine2 = sine * sine, cosine2 = axial2 / v2;  // of beta
  const double along_u = -(Wgs84::gm_m3_s2 + 0.5 * q_prime * (sine2 - 1.0 / 3.0)) / v2;     // dV / du
  const double w2v2 = u2 + kE2_m2 * sine2;
  const double across = (along_u * u - q * sine2) / w2v2 + kRate2;
  return {across * x, across * y, sine * (along_u * v2 + q * u * cosine2) / w2v2};
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

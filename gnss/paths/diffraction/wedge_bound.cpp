#include "canyon/gnss/paths/diffraction/wedge_bound.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {

double largest_finite_edge_factor(double nu, double u1, double u2) {
  constexpr double kError = 1e-3;
  if (nu < 1e-6) return 1.0 + kError;
  const double per_whole = std::sqrt(0.5 * (nu * nu + 0.3));
  const auto height = [nu](double u) { return nu / (u * u + nu * nu); };
  const auto end = [&](double u) { return per_whole * height(u) / (kPi * u); };
  const auto rest = [&](double u) {
    return end(u) * std::min(1.0, 2.0 / kPi * (1.0 / (u * u) + 2.0 / (u * u + nu * nu)));
  };
  if (u1 < 0.0 && u2 > 0.0) {
    const auto beyond = [&](double u) { return std::min(end(u) + rest(u), 0.5 + per_whole * u / nu); };
    return std::min(1.0 + beyond(-u1) + beyond(u2), per_whole * (u2 - u1) / nu) + kError;
  }
  const double near = std::min(std::abs(u1), std::abs(u2)), far = std::max(std::abs(u1), std::abs(u2));
  const double flat = per_whole * (far - near) * height(near);
  return (near > 0.0 ? std::min(flat, end(near) + std::min(end(far), end(near)) + rest(near)) : flat) + kError;
}

double largest_wedge_field(const WedgeWay& w) {
  const double k = 2.0 * kPi / w.wavelength_m;
  const double most = std::sqrt(kPi * k * w.distance_m) * w.sine_beta;
  const auto term = [&](double beta_rad, int sign) {
    const double turns = std::round((sign * kPi + beta_rad) / (2.0 * kPi * w.n));
    const double a = 1.0 + std::cos(2.0 * kPi * w.n * turns - beta_rad);
    return std::min(1.0 / std::sqrt(a), most);
  };
  const double less = w.phi_out_rad - w.phi_in_rad, sum = w.phi_out_rad + w.phi_in_rad;
  // n of the terms and of the scale, 1 / (2 n sqrt(2 pi k) sin(beta)), cancel.
  const double terms = term(less, 1) + term(less, -1) + term(sum, 1) + term(sum, -1);
  return (1.0 + 1e-4) * terms / (2.0 * std::sqrt(kPi * k * w.distance_m) * w.sine_beta);
}

}  // namespace canyon::gnss

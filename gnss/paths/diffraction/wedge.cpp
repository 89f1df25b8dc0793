#include "canyon/gnss/paths/diffraction/wedge.h"

#include <array>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"

namespace canyon::gnss {
namespace {

using Wave = std::complex<double>;

/// cot((pi + sign beta) / (2 n)) F(k L a(beta)); at a border, where the one grows as the other vanishes, its limit.
Wave border_term(double beta_rad, int sign, double n, double k_l) {
  // The border that is nearest to 2 pi n N - beta = sign pi.
  const double turns = std::round((sign * kPi + beta_rad) / (2.0 * kPi * n));
  const double half = 0.5 * (2.0 * n * kPi * turns - beta_rad);
  const double a = 2.0 * std::cos(half) * std::cos(half);
  const double off_rad = kPi + sign * beta_rad - 2.0 * kPi * n * turns * sign;  // 0 at the border
  if (std::abs(off_rad) > 1e-5) return wedge_transition(k_l * a) / std::tan((kPi + sign * beta_rad) / (2.0 * n));
  // K&P eq. 33, with the next term of F.
  const Wave eighth = std::polar(1.0, 0.25 * kPi);
  const double side = off_rad < 0.0 ? -1.0 : 1.0;
  return n * (std::sqrt(2.0 * kPi * k_l) * side - 2.0 * k_l * off_rad * eighth) * eighth;
}

/// From 0 to u >= 0; `half`: its limit for u to infinity.
Wave edge_integral(double nu, double u, const Wave& half) {
  const auto turn = [nu](double v) { return std::polar(1.0, -0.5 * kPi * (v * v + nu * nu)); };
  const auto height = [nu](double v) { return nu / (v * v + nu * nu); };
  constexpr double kFar = 3.0;
  // Beyond, by parts from the end: two terms leave 1 / (pi u^2)^2 of what is left.
  if (u > kFar) {
    const Wave end = turn(u) * height(u);
    const double next = (1.0 / (u * u) + 2.0 / (u * u + nu * nu)) / kPi;
    return half - Wave(end.imag() / (kPi * u), -end.real() / (kPi * u)) * Wave(1.0, next);
  }
  // The peak at nu << 1 in closed form, the rest, which is smooth, by Simpson's rule.
  const int steps = 2 * static_cast<int>(std::ceil(5.0 * u + 1.0));
  const double step = u / steps;
  Wave sum = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double v = i * step, weight = i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum += weight * (turn(v) - 1.0) * height(v);
  }
  return sum * step / 3.0 + std::atan2(u, nu);
}

/// From u1 to u2.
Wave edge_integral(double nu, double u1, double u2, const Wave& half) {
  const auto to = [&](double u) {
    const Wave part = edge_integral(nu, std::abs(u), half);
    return u < 0.0 ? -part : part;
  };
  return to(u2) - to(u1);
}

/// knife_edge_field without its turn by -pi nu^2 / 2, which is smooth, between places where it is known.
Wave knife_edge_envelope(double nu) {
  constexpr double kStep = 0.02, kLast = 10.0;
  static const auto known = [] {
    std::array<Wave, static_cast<std::size_t>(kLast / kStep) + 2> at;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double x = kStep * static_cast<double>(i);
      at[i] = knife_edge_field(x) * std::polar(1.0, 0.5 * kPi * x * x);
    }
    return at;
  }();
  // Of the asymptotic series (DLMF 7.12.2 and 7.12.3) the first terms leave 3e-5 of it.
  if (nu >= kLast) return 0.5 * Wave(1.0, 1.0) * Wave(1.0 / (kPi * kPi * nu * nu * nu), -1.0 / (kPi * nu));
  const double place = nu / kStep;
  const auto i = static_cast<std::size_t>(place);
  return known[i] + (place - static_cast<double>(i)) * (known[i + 1] - known[i]);
}

}  // namespace

Wave wedge_transition(double x) {
  const double root = std::sqrt(x);
  // Integral of exp(-j t^2) from root(x) on, by the Fresnel integrals of exp(+j pi t^2 / 2).
  const Wave tail = std::sqrt(0.5 * kPi) * std::conj(Wave(0.5, 0.5) - fresnel_integral(root * std::sqrt(2.0 / kPi)));
  return Wave(0.0, 2.0 * root) * std::polar(1.0, x) * tail;
}

WedgeBorders::WedgeBorders(const WedgeWay& w) : root_distance_(std::sqrt(w.distance_m)) {
  const double k = 2.0 * kPi / w.wavelength_m;
  const double k_l = k * w.distance_m * w.sine_beta * w.sine_beta;
  const double less = w.phi_out_rad - w.phi_in_rad, sum = w.phi_out_rad + w.phi_in_rad;
  shadow_ = border_term(less, 1, w.n, k_l) + border_term(less, -1, w.n, k_l);
  mirror_0_ = border_term(sum, -1, w.n, k_l);
  mirror_n_ = border_term(sum, 1, w.n, k_l);
  scale_ = -std::polar(1.0, -0.25 * kPi) / (2.0 * w.n * std::sqrt(2.0 * kPi * k) * w.sine_beta);
}

Wave WedgeBorders::field(const Wave& face_0, const Wave& face_n) const {
  return scale_ * (shadow_ + (face_0 * mirror_0_ + face_n * mirror_n_)) / root_distance_;
}

Wave finite_edge_field(double nu, double u1, double u2) {
  if (nu < 1e-6) return 0.5 * finite_edge_factor(nu, u1, u2);
  const Wave half = kPi * knife_edge_envelope(nu) * std::polar(1.0, -0.5 * kPi * nu * nu);
  return edge_integral(nu, u1, u2, half) / (2.0 * kPi);
}

Wave finite_edge_factor(double nu, double u1, double u2) {
  if (nu < 1e-6) return 0.5 * ((u2 > 0.0 ? 1.0 : u2 < 0.0 ? -1.0 : 0.0) - (u1 > 0.0 ? 1.0 : u1 < 0.0 ? -1.0 : 0.0));
  const Wave half = kPi * knife_edge_field(nu);
  return edge_integral(nu, u1, u2, half) / (2.0 * half);
}

}  // namespace canyon::gnss

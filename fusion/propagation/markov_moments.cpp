#include "canyon/fusion/propagation/markov_moments.h"

#include <algorithm>
#include <cmath>

namespace canyon::fusion {
namespace {

/// phi_0 = e^-z, phi_k = (1 / (k-1)! - phi_(k-1)) / z: the k-fold integral of e^(-u / tau) from 0 is u^k phi_k(u /
/// tau).
std::array<double, 4> phi_functions(double z) {
  std::array<double, 4> phi{};
  if (z < 1.0) {
    // The recursion would cancel: phi_3 from its series, sum over m of (-z)^m / (m + 3)!, the others from it upwards.
    double term = 1.0 / 6.0;
    for (int m = 0; m < 18; ++m) {
      phi[3] += term;
      term *= -z / (m + 4);
    }
    phi[2] = 0.5 - z * phi[3];
    phi[1] = 1.0 - z * phi[2];
    phi[0] = 1.0 - z * phi[1];
    return phi;
  }
  phi[0] = std::exp(-z);
  phi[1] = (1.0 - phi[0]) / z;
  phi[2] = (1.0 - phi[1]) / z;
  phi[3] = (0.5 - phi[2]) / z;
  return phi;
}

/// [I_1, I_2, I_3, x] that a unit impulse in w makes of x after u_s.
Eigen::Vector4d response(double u_s, double tau_s) {
  const auto phi = phi_functions(u_s / tau_s);
  return {u_s * phi[1], u_s * u_s * phi[2], u_s * u_s * u_s * phi[3], phi[0]};
}

/// Abscissae and weights of Gauss-Legendre quadrature with 8 points on [-1, 1] (Abramowitz & Stegun table 25.4), exact
/// for polynomials up to degree 15.
constexpr std::array<double, 4> kAbscissae = {0.183434642495649805, 0.525532409916328986, 0.796666477413626740,
                                              0.960289856497536232};
constexpr std::array<double, 4> kWeights = {0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                            0.101228536290376259};
/// After so many correlation times e^(-u / tau) is below the rounding of what stands beside it, and the integrand a
/// polynomial.
constexpr double kForgotten = 40.0;

void add_panel(double from_s, double to_s, double tau_s, Eigen::Matrix4d& sum) {
  const double half = 0.5 * (to_s - from_s), middle = 0.5 * (to_s + from_s);
  for (std::size_t i = 0; i < 4; ++i) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector4d h = response(middle + side * half * kAbscissae[i], tau_s);
      sum += (half * kWeights[i]) * h * h.transpose();
    }
  }
}

}  // namespace

MarkovMoments::MarkovMoments(double dt_s, double tau_s) {
  const Eigen::Vector4d at_end = response(dt_s, tau_s);
  decay = at_end[3];
  carried = {at_end[0], at_end[1], at_end[2]};
  driven.setZero();
  double from_s = 0.0;
  while (from_s < dt_s) {
    const double to_s = from_s < kForgotten * tau_s ? std::min(from_s + tau_s, dt_s) : dt_s;
    add_panel(from_s, to_s, tau_s, driven);
    from_s = to_s;
  }
}

Eigen::Matrix3d white_moments(double dt_s) {
  const double dt2 = dt_s * dt_s, dt3 = dt2 * dt_s, dt4 = dt3 * dt_s, dt5 = dt4 * dt_s;
  Eigen::Matrix3d m;
  m << dt_s, dt2 / 2.0, dt3 / 6.0,      //
      dt2 / 2.0, dt3 / 3.0, dt4 / 8.0,  //
      dt3 / 6.0, dt4 / 8.0, dt5 / 20.0;
  return m;
}

}  // namespace canyon::fusion

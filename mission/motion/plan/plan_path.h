#pragma once

#include <cmath>

#include <Eigen/Core>

namespace canyon::mission {

/// Where a body comes from the origin over tau >= 0 whose direction, speed along it and speed across it (to the left)
/// are functions of the time: Gauss-Legendre quadrature of its velocity, five points, error below 1e-15 m over the
/// master step of a run.
template <class Yaw, class Forward, class Across>
Eigen::Vector2d displacement(double tau, const Yaw& yaw, const Forward& forward_m_s, const Across& across_m_s) {
  constexpr double kAbscissa[5] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                   0.9061798459386640};
  constexpr double kWeight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                 0.2369268850561891};
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < 5; ++i) {
    const double at = 0.5 * tau * (1.0 + kAbscissa[i]), direction = yaw(at);
    const Eigen::Vector2d forward(std::cos(direction), std::sin(direction)), left(-forward.y(), forward.x());
    sum += kWeight[i] * forward_m_s(at) * forward;
    sum += kWeight[i] * across_m_s(at) * left;
  }
  return 0.5 * tau * sum;
}

/// The polynomial of third degree that has these values and derivatives at both ends of a step.
struct CubicStep {
  double v_0 = 0.0, a_0 = 0.0, c_2 = 0.0, c_3 = 0.0;

  static CubicStep between(double v_0, double a_0, double v_1, double a_1, double dt_s) {
    const double mean = (v_1 - v_0) / dt_s;
    return {v_0, a_0, (3.0 * mean - 2.0 * a_0 - a_1) / dt_s, (a_0 + a_1 - 2.0 * mean) / (dt_s * dt_s)};
  }
  double value(double tau) const { return v_0 + (a_0 + (c_2 + c_3 * tau) * tau) * tau; }
  double change(double tau) const { return a_0 + (2.0 * c_2 + 3.0 * c_3 * tau) * tau; }
  double integral(double tau) const { return tau * (v_0 + tau * (a_0 / 2.0 + tau * (c_2 / 3.0 + tau * c_3 / 4.0))); }
};

}  // namespace canyon::mission

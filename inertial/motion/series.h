#pragma once

#include <cmath>

namespace canyon::inertial {

/// A function of time at an instant as its Taylor polynomial of third order: c[k] is the k-th derivative over k!. A
/// path written in such numbers brings its exact derivatives with it (automatic differentiation; Griewank & Walther,
/// Evaluating Derivatives, 13.2).
struct Series {
  double c[4] = {0.0, 0.0, 0.0, 0.0};

  constexpr Series() = default;
  constexpr Series(double constant) : c{constant, 0.0, 0.0, 0.0} {}  // NOLINT: implicit by intent
  constexpr Series(double c0, double c1, double c2, double c3) : c{c0, c1, c2, c3} {}
  /// Time itself, at t_s.
  static constexpr Series time(double t_s) { return {t_s, 1.0, 0.0, 0.0}; }

  double value() const { return c[0]; }
  double first() const { return c[1]; }
  double second() const { return 2.0 * c[2]; }
  /// The derivative as a function of time; its third derivative is not known and left 0.
  constexpr Series derivative() const { return {c[1], 2.0 * c[2], 3.0 * c[3], 0.0}; }
};

constexpr Series operator+(const Series& a, const Series& b) {
  return {a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2], a.c[3] + b.c[3]};
}
constexpr Series operator-(const Series& a, const Series& b) {
  return {a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2], a.c[3] - b.c[3]};
}
constexpr Series operator-(const Series& a) {
  return Series(0.0) - a;
}
constexpr Series operator*(const Series& a, const Series& b) {
  return {a.c[0] * b.c[0], a.c[0] * b.c[1] + a.c[1] * b.c[0], a.c[0] * b.c[2] + a.c[1] * b.c[1] + a.c[2] * b.c[0],
          a.c[0] * b.c[3] + a.c[1] * b.c[2] + a.c[2] * b.c[1] + a.c[3] * b.c[0]};
}
/// b != 0.
inline Series operator/(const Series& a, const Series& b) {
  Series q;
  for (int k = 0; k < 4; ++k) {
    double rest = a.c[k];
    for (int j = 0; j < k; ++j) rest -= q.c[j] * b.c[k - j];
    q.c[k] = rest / b.c[0];
  }
  return q;
}
/// a > 0.
inline Series sqrt(const Series& a) {
  Series r(std::sqrt(a.c[0]));
  r.c[1] = a.c[1] / (2.0 * r.c[0]);
  r.c[2] = (a.c[2] - r.c[1] * r.c[1]) / (2.0 * r.c[0]);
  r.c[3] = (a.c[3] - 2.0 * r.c[1] * r.c[2]) / (2.0 * r.c[0]);
  return r;
}

struct SineCosine {
  Series sine, cosine;
};
inline SineCosine sine_cosine(const Series& a) {
  SineCosine r{Series(std::sin(a.c[0])), Series(std::cos(a.c[0]))};
  for (int k = 1; k < 4; ++k) {
    for (int j = 1; j <= k; ++j) {
      r.sine.c[k] += j * a.c[j] * r.cosine.c[k - j] / k;
      r.cosine.c[k] -= j * a.c[j] * r.sine.c[k - j] / k;
    }
  }
  return r;
}
inline Series sin(const Series& a) {
  return sine_cosine(a).sine;
}
inline Series cos(const Series& a) {
  return sine_cosine(a).cosine;
}
/// Not both 0.
inline Series atan2(const Series& y, const Series& x) {
  const Series rate = (x * y.derivative() - y * x.derivative()) / (x * x + y * y);
  return {std::atan2(y.c[0], x.c[0]), rate.c[0], rate.c[1] / 2.0, rate.c[2] / 3.0};
}

}  // namespace canyon::inertial

// A path through recorded values, or smoothed beside them: what makes it the smoothest of all.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/quintic_spline.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using stress::Looks;

/// The polynomial of fifth degree of a piece, about its beginning, from six instants of it: Newton's divided
/// differences of the values alone.
std::array<double, 6> piece_of(const QuinticSpline& spline, double from_s, double to_s, Eigen::Index column) {
  std::array<double, 6> u{}, d{};
  for (std::size_t i = 0; i < 6; ++i) {
    // Beside the ends, so that it is this piece that answers.
    u[i] = (to_s - from_s) * (0.02 + 0.96 * static_cast<double>(i) / 5.0);
    d[i] = spline.at(from_s + u[i], column).value();
  }
  for (std::size_t order = 1; order < 6; ++order)
    for (std::size_t i = 5; i >= order; --i) d[i] = (d[i] - d[i - 1]) / (u[i] - u[i - order]);
  std::array<double, 6> c{d[5]};
  for (std::size_t i = 5; i-- > 0;) {
    for (std::size_t k = 5; k > 0; --k) c[k] = c[k - 1] - u[i] * c[k];
    c[0] = d[i] - u[i] * c[0];
  }
  return c;
}

/// Derivative of that order of the polynomial at u, over its own factorial nothing: s, s', s'', ...
double derivative_of(const std::array<double, 6>& c, std::size_t order, double u) {
  double sum = 0.0;
  for (std::size_t k = 6; k-- > order;) {
    double factor = 1.0;
    for (std::size_t j = 0; j < order; ++j) factor *= static_cast<double>(k - j);
    sum = sum * u + factor * c[k];
  }
  return sum;
}

/// The least of sum (y - s)^2 + lambda integral (s''')^2, lambda = smoothing^6 / ((2 pi)^6 mean interval), is known by
/// its pieces: four derivatives that go on from each to the next, the fifth jumping by (s - y) / lambda, third and
/// fourth none at either end (integration by parts). Without smoothing it passes through the values. A derivative that
/// is found from values of size 1 at a fifth of 0.96 of pieces of 0.6 s and more rounds by 2 over that, to its order,
/// and 256 epsilons: six differences, their polynomial, and the spline's own elimination.
StressFigure least_bent(double smoothing_s) {
  Looks looks;
  const RandomStream draws(9, "stress.splines");
  constexpr int kN = 41;
  std::vector<double> t;
  Eigen::MatrixXd y(kN, 2);
  for (int i = 0; i < kN; ++i) {
    t.push_back((i == 0 ? -3.0 : t.back()) + draws.uniform(0.6, 1.4, 0, i));
    y.row(i) << draws.uniform(-1.0, 1.0, 1, i), std::sin(0.8 * t.back());
  }
  const QuinticSpline spline(t, y, smoothing_s);
  const double mean_s = (t.back() - t.front()) / (kN - 1);
  const double lambda = std::pow(smoothing_s / (2.0 * kPi), 6) / mean_s;
  std::array<double, 6> rounding{};
  for (std::size_t order = 0; order < 6; ++order)
    rounding[order] = 256.0 * stress::kEpsilon * std::pow(2.0 / (0.6 * 0.96 / 5.0), order);
  for (Eigen::Index column = 0; column < 2; ++column) {
    std::array<double, 6> before{};
    for (int i = 0; i + 1 < kN; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const std::array<double, 6> c = piece_of(spline, t[at], t[at + 1], column);
      const double off = derivative_of(c, 0, 0.0) - y(i, column);
      if (smoothing_s == 0.0) looks.near(off, 0.0, rounding[0]);
      const double h = i == 0 ? 0.0 : t[at] - t[at - 1];
      for (std::size_t order = i == 0 ? 3 : 0; order < 5; ++order)
        looks.near(derivative_of(c, order, 0.0), i == 0 ? 0.0 : derivative_of(before, order, h), rounding[order]);
      if (smoothing_s > 0.0)
        looks.near(lambda * (derivative_of(c, 5, 0.0) - (i == 0 ? 0.0 : derivative_of(before, 5, h))), off,
                   rounding[0] + lambda * rounding[5]);
      // What is told of derivatives is of the same polynomial.
      const double u = 0.37 * (t[at + 1] - t[at]);
      const Series told = spline.at(t[at] + u, column);
      for (std::size_t order = 0; order < 4; ++order)
        looks.near(told.c[order] * (order == 3   ? 6.0
                                    : order == 2 ? 2.0
                                                 : 1.0),
                   derivative_of(c, order, u), rounding[order]);
      before = c;
    }
    const double h = t[kN - 1] - t[kN - 2];
    looks.near(derivative_of(before, 3, h), 0.0, rounding[3]);
    looks.near(derivative_of(before, 4, h), 0.0, rounding[4]);
    const double last = derivative_of(before, 0, h) - y(kN - 1, column);
    if (smoothing_s == 0.0) looks.near(last, 0.0, rounding[0]);
    if (smoothing_s > 0.0) looks.near(-lambda * derivative_of(before, 5, h), last, rounding[0] + lambda * rounding[5]);
  }
  return looks.figure();
}

/// What is left of an oscillation in evenly spaced values far from the ends: 1 / (1 + lambda' / sum_k (w + 2 pi k)^-6)
/// in units of the interval, by Poisson's sum over the least bent function of that frequency. The ends fade by
/// e^(-w_0 / 2) an interval, 200 of them; the sum's tail beyond 60 terms is 1e-13 of it; blocks
/// of up to 720 beside a weight round by as many times 64 epsilons.
StressFigure left_of_oscillations(double smoothing_s) {
  Looks looks;
  constexpr int kN = 401;
  constexpr double kStep = 0.05;
  const double smoothing = smoothing_s / kStep;  // in intervals
  for (const double periods : {0.5, 0.8, 1.0, 1.3, 2.0, 4.0}) {
    const double w = 2.0 * kPi / (periods * smoothing);
    if (w > kPi) continue;
    std::vector<double> t;
    Eigen::MatrixXd y(kN, 1);
    for (int i = 0; i < kN; ++i) {
      t.push_back(100.0 + kStep * i);
      y(i, 0) = std::cos(w * (i - 200));
    }
    const QuinticSpline spline(t, y, smoothing_s);
    double sum = 0.0;
    for (int k = -60; k <= 60; ++k) sum += std::pow(w + 2.0 * kPi * k, -6);
    const double weight = std::pow(2.0 * kPi / smoothing, 6), left = weight / (weight + 1.0 / sum);
    const double ends = 20.0 * std::exp(-200.0 * kPi / smoothing);
    looks.near(spline.at(t[200], 0).value(), left, 64.0 * stress::kEpsilon * 720.0 / std::min(weight, 720.0) + ends);
    // As it is documented, where the samples are dense.
    if (smoothing >= 8.0) looks.near(left, 1.0 / (1.0 + std::pow(periods, -6)), 2e-3);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> spline_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "the smoothest path through values, and beside them",
           "an interval of another power, a time in another unit, ends that are bent",
           "derivatives that go on, a fifth that jumps by (s - y) / lambda, none at the ends: their rounding",
           "of the bound"});
  for (const double smoothing_s : {0.0, 1.5, 4.0, 12.0})
    rows.add("splines/least_bent_at_" + stress::text(smoothing_s) + "_s", [=] { return least_bent(smoothing_s); });
  rows.of({StressGroup::kGeometry, "what smoothing leaves of an oscillation",
           "a period taken for its inverse, or for a frequency in hertz",
           "half at the period that is asked for, and the exact share of every other", "of the bound"});
  for (const double smoothing_s : {0.2, 0.5, 2.0})
    rows.add("splines/left_of_oscillations_at_" + stress::text(smoothing_s) + "_s",
             [=] { return left_of_oscillations(smoothing_s); });
  return rows.take();
}

}  // namespace canyon::inertial

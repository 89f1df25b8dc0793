// Moments of processes within a step, and the loops that move errors.
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress/looks.h"
#include "canyon/fusion/propagation/markov_moments.h"
#include "canyon/fusion/propagation/row_kernels.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::VectorXd;
using stress::kEpsilon;
using stress::Looks;

/// Moments of a process within a step: what it carries in closed form, in 64 bits of mantissa, and what drives it by
/// Simpson's rule over 8000 parts of its response, which leaves (z / 8000)^4 of a fast one; of white noise the powers.
StressFigure moments() {
  Looks looks;
  for (const double dt : {0.01, 2.0})
    for (const double z : {1e-9, 1e-3, 0.3, 0.99, 1.01, 4.0, 30.0, 60.0}) {
      const double tau = dt / z;
      const MarkovMoments found(dt, tau);
      const auto response = [&](long double u) {
        const long double x = u / tau;
        // Integrals of e^-x: series where they cancel.
        std::array<long double, 4> out{std::exp(-x), 0.0L, 0.0L, 0.0L};
        for (int k = 1; k <= 3; ++k) {
          long double sum = 0.0L, term = 1.0L;
          for (int i = 1; i <= k; ++i) term /= i;
          if (x < 2.0L) {
            for (int i = 0; i < 40; ++i) sum += term, term *= -x / (k + 1 + i);
            out[static_cast<std::size_t>(k)] = sum * std::pow(u, static_cast<long double>(k));
          } else {
            const long double factorial = k == 3 ? 2.0L : 1.0L;
            out[static_cast<std::size_t>(k)] =
                tau * (std::pow(u, static_cast<long double>(k - 1)) / factorial - out[static_cast<std::size_t>(k - 1)]);
          }
        }
        return std::array<long double, 4>{out[1], out[2], out[3], out[0]};
      };
      const auto end = response(dt);
      looks.near(found.decay, static_cast<double>(end[3]), 16.0 * kEpsilon);
      for (std::size_t k = 0; k < 3; ++k)
        looks.near(found.carried[k] / static_cast<double>(end[k]), 1.0, 64.0 * kEpsilon);
      constexpr int kParts = 8000;
      std::array<std::array<long double, 4>, 4> sum{};
      for (int i = 0; i <= kParts; ++i) {
        const auto h = response(static_cast<long double>(dt) * i / kParts);
        const long double weight = (i == 0 || i == kParts ? 1.0L : i % 2 == 1 ? 4.0L : 2.0L) * dt / (3.0L * kParts);
        for (std::size_t a = 0; a < 4; ++a)
          for (std::size_t b = 0; b < 4; ++b) sum[a][b] += weight * h[a] * h[b];
      }
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b)
          looks.near(
              found.driven(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) / static_cast<double>(sum[a][b]),
              1.0, 1e-12 + z * std::pow(z / kParts, 4));
    }
  for (const double dt : {1e-3, 0.7, 30.0}) {
    const Matrix3d found = white_moments(dt);
    const double factorial[] = {1.0, 1.0, 2.0};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        looks.close(found(i, j), std::pow(dt, i + j + 1) / (factorial[i] * factorial[j] * (i + j + 1)), 16.0);
  }
  return looks.figure();
}

/// The loops over rows against matrices: n roundings of their terms.
StressFigure loops() {
  Looks looks;
  DrawnNumbers draw(7);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (const int width : {4, 12, 36}) {
    const int states = width;
    const Rows errors = draw.any(states, width);
    std::vector<FeedTerm> terms;
    Rows fed = Rows::Zero(6, states);
    for (int k = 0; k < 9; ++k) {
      const FeedTerm term{k == 0 ? 4 : k % 5, (7 * k) % states, draw.next()};  // none of the last axis
      terms.push_back(term);
      fed(term.axis, term.state) += term.rate;
    }
    const double carried[3] = {0.9, 0.4, 0.13}, dt = 0.8;
    Rows integrals = draw.any(kIntegralRows, width);
    const Rows before = integrals;
    add_integrals(terms.data(), static_cast<int>(terms.size()), carried, dt, errors.data(), width, integrals.data(),
                  width);
    const Rows rates = fed * errors;
    const double of_gyro[] = {carried[0], carried[1], carried[2] - 0.5 * dt * carried[1]},
                 of_accel[] = {carried[0], carried[1] - 0.5 * dt * carried[0]};
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < 3; ++k)
        looks.near((integrals.row(3 * k + axis) - before.row(3 * k + axis) - of_gyro[k] * rates.row(axis)).norm(), 0.0,
                   1e-13);
      for (int k = 0; k < 2; ++k)
        looks.near(
            (integrals.row(9 + 3 * k + axis) - before.row(9 + 3 * k + axis) - of_accel[k] * rates.row(3 + axis)).norm(),
            0.0, 1e-13);
    }
    StepCoefficients step{};
    step.dt_s = dt;
    std::array<Matrix3d, 7> m;
    double* const to[] = {step.theta_theta, step.theta_gyro, step.v_theta, step.v_p,
                          step.v_v,         step.v_accel,    step.v_gyro};
    for (std::size_t k = 0; k < 7; ++k) {
      m[k] = draw.any(3, 3);
      for (int i = 0; i < 9; ++i) to[k][i] = m[k](i / 3, i % 3);
    }
    const Rows x = draw.any(9, width);
    Rows after = Rows::Zero(9, width);
    move_rows(step, x.data(), width, integrals.data(), after.data(), width);
    const Rows theta = x.topRows(3), p = x.middleRows(3, 3), v = x.bottomRows(3), g1 = integrals.topRows(3),
               g2 = integrals.middleRows(3, 3), g3 = integrals.middleRows(6, 3), a1 = integrals.middleRows(9, 3),
               a2 = integrals.bottomRows(3);
    const Rows next = m[2] * theta + m[3] * p + m[4] * v + m[5] * a1 + m[6] * g2;
    looks.near((after.topRows(3) - m[0] * theta - m[1] * g1).norm(), 0.0, 1e-12);
    looks.near((after.bottomRows(3) - next).norm(), 0.0, 1e-12);
    looks.near((after.middleRows(3, 3) - p - 0.5 * dt * (v + next) - m[5] * a2 - m[6] * g3).norm(), 0.0, 1e-12);
    Rows target = draw.any(7, width);
    const Rows was = target, left = draw.any(7, 3), right = draw.any(3, width);
    add_products(target.data(), 7, width, left.data(), right.data());
    looks.near((target - was - left * right).norm(), 0.0, 1e-13);
    Rows square = draw.any(width, width);
    const Rows old = square;
    const VectorXd factor = draw.any(width, 1);
    scale_both(square.data(), width, width - 1, factor.data());
    for (int i = 0; i < width; ++i)
      for (int j = 0; j < width; ++j)
        looks.near(square(i, j), old(i, j) * (i < width - 1 && j < width - 1 ? factor[i] * factor[j] : 1.0),
                   1e-14 * (1.0 + std::abs(old(i, j))));
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> process_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "processes within a step, and the loops that move errors",
           "a moment of another order, a panel too few, a row of another triad",
           "closed forms, quadrature of responses, matrices: roundings", "of the bound"});
  rows.add("states/moments", moments).add("states/loops_over_rows", loops);
  return rows.take();
}

}  // namespace canyon::fusion

// Links of the error chain that are noise: sums of their samples, against the variance of the continuous process.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress/looks.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/errors/flicker.h"
#include "canyon/inertial/stress/errors/one_link.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using made::Increments;
using made::kBlock;
using made::kStep_s;
using made::link_of;
using made::still;
using made::through;
using stress::Looks;

/// Variance of the sum of m samples from sample `first` on.
using SumVariance = std::function<double(const TriadFigures& figures, double first, double m)>;

/// Links of noise: the sum over m samples has the variance of the continuous process, from within a block and over its
/// border, for either triad; `together`: over how many samples noise hangs together. Five standard deviations.
StressFigure process_link(const std::string& name, const TriadFigures& gyro, const TriadFigures& accel, double together,
                          const SumVariance& variance) {
  Looks looks;
  LinkSetup setup{.figures = {}, .environment = {}, .seed = 0, .dt_s = kStep_s};
  setup.figures.gyro = gyro, setup.figures.accel = accel;
  constexpr int kUnits = 250;
  constexpr std::int64_t kFirst = kBlock;
  constexpr std::array<int, 4> kLengths = {1, 2, 5, 60};
  const std::vector<Increments> none = still(480);
  // By length, triad and place: sums from the block's beginning on, and products of neighbours.
  std::array<std::array<double, 2>, 4> squares{}, counts{};
  std::array<double, 2> mean{};
  double across = 0.0, crosses = 0.0;
  std::array<std::array<std::vector<double>, 2>, 4> expected;
  for (std::size_t l = 0; l < kLengths.size(); ++l)
    for (std::size_t t = 0; t < 2; ++t)
      for (int begin = 0; begin + kLengths[l] <= 480; begin += kLengths[l])
        expected[l][t].push_back(variance(t == 0 ? gyro : accel, static_cast<double>(kFirst) + begin, kLengths[l]));
  for (setup.seed = 1; setup.seed <= kUnits; ++setup.seed) {
    const auto link = link_of(name, setup);
    if (!link || link->memory() != 0) return {stress::kInfinity, 1.0};
    const auto e = through(*link, kFirst, none);
    for (std::size_t t = 0; t < 2; ++t)
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        mean[t] += e[100][t][axis] / (3.0 * kUnits);
        for (std::size_t l = 0; l < kLengths.size(); ++l) {
          const int m = kLengths[l];
          for (int begin = 0; begin + m <= 480; begin += m) {
            double sum = 0.0;
            for (int i = begin; i < begin + m; ++i) sum += e[static_cast<std::size_t>(i)][t][axis];
            squares[l][t] += sum * sum / expected[l][t][static_cast<std::size_t>(begin / m)];
            counts[l][t] += 1.0;
          }
        }
      }
    // Axes and triads have nothing to do with one another.
    for (const std::size_t k : {std::size_t{3}, std::size_t{200}, std::size_t{300}}) {
      const double a = expected[0][0][k], b = expected[0][1][k];
      across += e[k][0].x() * e[k][0].y() / a + e[k][0].y() * e[k][0].z() / a + e[k][1].z() * e[k][1].x() / b +
                e[k][0].x() * e[k][1].x() / std::sqrt(a * b) + e[k][0].z() * e[k][1].z() / std::sqrt(a * b);
      crosses += 5.0;
    }
  }
  for (std::size_t l = 0; l < kLengths.size(); ++l)
    for (std::size_t t = 0; t < 2; ++t) {
      // Sums beside one another share a sample of noise, and what lasts.
      const double independent = 3.0 * kUnits * std::max(1.0, 480.0 / (2.0 * kLengths[l] + together));
      looks.near(squares[l][t] / counts[l][t], 1.0, 5.0 * std::sqrt(2.0 / independent));
    }
  for (std::size_t t = 0; t < 2; ++t)
    looks.near(mean[t] / std::sqrt(expected[0][t][100]), 0.0, 5.0 / std::sqrt(3.0 * kUnits));
  looks.near(across / crosses, 0.0, 5.0 * std::sqrt(3.0 / crosses));
  return looks.figure();
}

/// Of a Gauss-Markov process of sigma and tau, integrated over m intervals.
double markov_sum(double sigma, double tau_s, double m) {
  const double x = m * kStep_s / tau_s;
  return 2.0 * sigma * sigma * tau_s * tau_s * (x + std::expm1(-x));
}

StressFigure white(double correlation) {
  TriadFigures gyro, accel;
  gyro.white_per_sqrt_hz = 0.3, accel.white_per_sqrt_hz = 2.0;
  gyro.neighbour_correlation = correlation, accel.neighbour_correlation = 0.6 * correlation;
  return process_link("white_noise", gyro, accel, 2.0, [](const TriadFigures& f, double, double m) {
    // Neighbours share rho of their variance, and the sum of many has N^2 t.
    const double each = f.white_per_sqrt_hz * f.white_per_sqrt_hz * kStep_s / (1.0 + 2.0 * f.neighbour_correlation);
    return each * (m + 2.0 * (m - 1.0) * f.neighbour_correlation);
  });
}

StressFigure quantized() {
  TriadFigures gyro, accel;
  gyro.quantization_noise = 1e-3, accel.quantization_noise = 0.02;
  return process_link("quantization_noise", gyro, accel, 2.0, [](const TriadFigures& f, double, double) {
    return 2.0 * f.quantization_noise * f.quantization_noise;
  });
}

StressFigure in_run(double tau_s) {
  TriadFigures gyro, accel;
  gyro.in_run_bias = 0.01, accel.in_run_bias = 0.2;
  gyro.in_run_bias_tau_s = tau_s, accel.in_run_bias_tau_s = 3.0 * tau_s;
  return process_link("in_run_bias", gyro, accel, 12.0 * tau_s / kStep_s, [](const TriadFigures& f, double, double m) {
    return markov_sum(f.in_run_bias, f.in_run_bias_tau_s, m);
  });
}

StressFigure flickering() {
  TriadFigures gyro, accel;
  gyro.bias_instability = 0.01, accel.bias_instability = 0.3;
  gyro.flicker_low_hz = 0.01, gyro.flicker_high_hz = 60.0, accel.flicker_low_hz = 0.2, accel.flicker_high_hz = 5.0;
  return process_link("flicker", gyro, accel, 480.0, [](const TriadFigures& f, double, double m) {
    double sum = 0.0;
    for (const FlickerPart& part : flicker_parts(f.bias_instability, f.flicker_low_hz, f.flicker_high_hz))
      sum += markov_sum(part.sigma, part.tau_s, m);
    return sum;
  });
}

StressFigure walking() {
  TriadFigures gyro, accel;
  gyro.rate_random_walk = 0.02, accel.rate_random_walk = 0.5;
  return process_link("rate_random_walk", gyro, accel, 480.0, [](const TriadFigures& f, double first, double m) {
    // Of the walk until then, and of what it adds on the way: t^3 / 3.
    const double t = m * kStep_s;
    return f.rate_random_walk * f.rate_random_walk * (first * kStep_s * t * t + t * t * t / 3.0);
  });
}

}  // namespace

std::vector<StressCase> noise_link_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "links of the error chain that are noise",
           "a density over the wrong interval, what is shared with the neighbour, a walk that does not begin at zero",
           "the variance of sums of 1 to 60 samples in closed form, five deviations of 250 units", "of the bound"});
  for (const double rho : {0.0, 0.3, 0.5})
    rows.add("links/white_noise_correlated_by_" + stress::text(rho), [rho] { return white(rho); });
  rows.add("links/quantization_noise", quantized);
  for (const double tau_s : {0.01, 0.3, 20.0})
    rows.add("links/in_run_bias_of_" + stress::text(tau_s) + "_s", [tau_s] { return in_run(tau_s); });
  rows.add("links/flicker", flickering).add("links/rate_random_walk", walking);
  return rows.take();
}

}  // namespace canyon::inertial

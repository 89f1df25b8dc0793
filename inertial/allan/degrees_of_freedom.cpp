#include "canyon/inertial/allan/degrees_of_freedom.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace canyon::inertial {
namespace {

constexpr double kLags = 64.0;

/// Generalized autocovariance of the phase's integrals, times a constant, by the noise of the phase's derivative.
double phase_covariance(NoiseType noise, double t) {
  const double a = std::abs(t);
  switch (noise) {
    case NoiseType::kQuantization:
      return -a;
    case NoiseType::kWhite:
      return a * a * a;
    case NoiseType::kFlicker:
      return a > 0.0 ? -a * a * a * a * std::log(a) : 0.0;
    case NoiseType::kRandomWalk:
      return -a * a * a * a * a;
  }
  return 0.0;
}

/// The same of the phase averaged over 1 / filter of tau.
double filtered_covariance(NoiseType noise, double filter, double t) {
  return filter * filter *
         (2.0 * phase_covariance(noise, t) - phase_covariance(noise, t - 1.0 / filter) -
          phase_covariance(noise, t + 1.0 / filter));
}

/// Of the d-th differences of it, spaced by tau.
double difference_covariance(NoiseType noise, double filter, int d, double t) {
  static constexpr double kBinomials[2][4] = {{6.0, -4.0, 1.0, 0.0}, {20.0, -15.0, 6.0, -1.0}};
  const double* c = kBinomials[d - 2];
  double sum = c[0] * filtered_covariance(noise, filter, t);
  for (int i = 1; i <= d; ++i)
    sum += c[i] * (filtered_covariance(noise, filter, t - i) + filtered_covariance(noise, filter, t + i));
  return sum;
}

/// 1 / sum of squared correlations of all overlapping differences of order d. `modified`: of the phase averaged over
/// tau.
double greenhall_riley(NoiseType noise, int d, bool modified, double samples, double m) {
  if (!modified && noise == NoiseType::kQuantization) {
    // Differences of white phase share points only at whole multiples of tau.
    const double count = samples + 1.0 - d * m;
    static constexpr std::array<double, 3> kShared = {-15.0 / 20.0, 6.0 / 20.0, -1.0 / 20.0};
    double sum = 1.0;
    for (int i = 1; i <= d; ++i)
      sum += 2.0 * std::max(0.0, 1.0 - i * m / count) * std::pow(kShared[static_cast<std::size_t>(i - 1)], 2);
    return std::max(1.0, count / sum);
  }
  const double thin = std::max(1.0, m / kLags), lags = m / thin;
  const double filter = modified ? 1.0 : lags;
  const double count = std::max(1.0, (samples + 1.0 - (modified ? 3.0 * m - 1.0 : d * m)) / thin);
  const double none = difference_covariance(noise, filter, d, 0.0);
  double sum = 1.0;
  for (double j = 1.0; j < std::min(count, (d + 1.0) * lags); j += 1.0)
    sum += 2.0 * (1.0 - j / count) * std::pow(difference_covariance(noise, filter, d, j / lags) / none, 2);
  return std::max(1.0, count / sum);
}

/// Sum over all lags of the squared covariance of second differences of a random walk's path, spaced by m1 and by m2.
double squared_covariances(double m1, double m2) {
  static constexpr double kDifference[3] = {1.0, -2.0, 1.0};
  const double step = std::max(1.0, std::min(m1, m2) / 16.0);
  double sum = 0.0;
  for (double lag = -step * std::ceil(2.0 * m2 / step); lag < 2.0 * m1 + step; lag += step) {
    double covariance = 0.0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) covariance -= kDifference[i] * kDifference[j] * std::abs(lag + j * m2 - i * m1);
    sum += step * covariance * covariance;
  }
  return sum;
}

}  // namespace

double overlapping_correlation(double m1, double m2) {
  constexpr double kFar = 64.0;
  if (m1 > kFar * m2 || m2 > kFar * m1) return 0.0;
  return squared_covariances(m1, m2) / std::sqrt(squared_covariances(m1, m1) * squared_covariances(m2, m2));
}

NoiseType noise_of_slope(double slope) {
  if (slope < -0.75) return NoiseType::kQuantization;
  if (slope < -0.25) return NoiseType::kWhite;
  return slope < 0.25 ? NoiseType::kFlicker : NoiseType::kRandomWalk;
}

double overlapping_degrees(NoiseType noise, double n, double m) {
  switch (noise) {
    case NoiseType::kQuantization:
      return std::max(1.0, (n + 1.0) * (n - 2.0 * m) / (2.0 * (n - m)));
    case NoiseType::kWhite:
      return std::max(1.0, (3.0 * (n - 1.0) / (2.0 * m) - 2.0 * (n - 2.0) / n) * 4.0 * m * m / (4.0 * m * m + 5.0));
    case NoiseType::kFlicker:
      return std::max(
          1.0, m == 1.0 ? 2.0 * (n - 2.0) * (n - 2.0) / (2.3 * n - 4.9) : 5.0 * n * n / (4.0 * m * (n + 3.0 * m)));
    case NoiseType::kRandomWalk:
      break;
  }
  const double q = (n - 1.0) * (n - 1.0) - 3.0 * m * (n - 1.0) + 4.0 * m * m;
  return std::max(1.0, (n - 2.0) / m * q / ((n - 3.0) * (n - 3.0)));
}

double modified_degrees(NoiseType noise, double samples, double m) {
  return greenhall_riley(noise, 2, true, samples, m);
}

double hadamard_degrees(NoiseType noise, double samples, double m) {
  return greenhall_riley(noise, 3, false, samples, m);
}

double total_degrees(NoiseType noise, double samples, double m) {
  const double ratio = samples / m;
  switch (noise) {
    case NoiseType::kQuantization:
      return overlapping_degrees(noise, samples, m);
    case NoiseType::kWhite:
      // The law is for many samples to an average; below, reflection adds next to nothing to the overlapping deviation.
      return m < 4.0 ? overlapping_degrees(noise, samples, m) : std::max(1.0, 1.5 * ratio);
    case NoiseType::kFlicker:
      return std::max(1.0, std::min(1.17 * ratio - 0.22, samples - 1.0));
    case NoiseType::kRandomWalk:
      break;
  }
  return std::max(1.0, std::min(0.93 * ratio - 0.36, samples - 1.0));
}

double total_bias(NoiseType noise, double samples, double m) {
  const double slope = noise == NoiseType::kFlicker ? 0.481 : noise == NoiseType::kRandomWalk ? 0.750 : 0.0;
  return 1.0 - slope * m / samples;
}

}  // namespace canyon::inertial

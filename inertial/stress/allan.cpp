// Allan variances and what is read off them: definitions over all samples, degrees of freedom from covariances, fits of
// curves that are known, motion in a log, flicker, and the linear plants of sensing elements.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/allan/degrees_of_freedom.h"
#include "canyon/inertial/allan/deviation.h"
#include "canyon/inertial/allan/motion_check.h"
#include "canyon/inertial/allan/noise_fit.h"
#include "canyon/inertial/allan/noise_terms.h"
#include "canyon/inertial/errors/flicker.h"
#include "canyon/inertial/imu_log.h"
#include "canyon/inertial/mems/linear_plant.h"
#include "canyon/inertial/mems/pick_off.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// Allan variance of samples with this autocovariance, by its definition.
double by_definition(int m, const std::function<double(int)>& covariance) {
  double sum = 0.0;
  for (int i = 0; i < 2 * m; ++i)
    for (int j = 0; j < 2 * m; ++j) sum += ((i < m) == (j < m) ? 1.0 : -1.0) * covariance(std::abs(i - j));
  return sum / (2.0 * m * m);
}

/// Each process against the sums over its samples' covariances; roundings of 4 m^2 terms that cancel. Random walk and
/// flicker have none: the walk by its increments, whose mean differences have a closed sum.
StressFigure laws() {
  Looks looks;
  for (const int m : {1, 2, 3, 7, 20, 64}) {
    const double grain = 4.0 * m * m * kEpsilon * 8.0;
    for (const double rho : {0.0, 0.2, 0.45}) {
      const auto pass = [&](int lag) { return (lag == 0 ? 1.0 : lag == 1 ? rho : 0.0) / (1.0 + 2.0 * rho); };
      looks.near(allan_variance(kWhite, 1.3, rho / (1.0 + 2.0 * rho), 0.5 * m, 0.5),
                 2.0 * 1.69 * by_definition(m, pass), grain);
    }
    // Increments of a rounding: variance 2 Q^2 / dt^2, neighbours minus half of it.
    const auto rounded = [&](int lag) { return lag == 0 ? 2.0 : lag == 1 ? -1.0 : 0.0; };
    looks.near(allan_variance(kQuantization, 0.7, 0.0, 0.5 * m, 0.5), 0.49 / 0.25 * by_definition(m, rounded), grain);
    for (const double f : {0.03, 0.11, 0.42}) {
      const auto wave = [&](int lag) { return 0.5 * 4.0 * std::cos(2.0 * kPi * f * 0.5 * lag); };
      for (const int term : {kSinusoid, kSecondSinusoid, kThirdSinusoid})
        looks.near(allan_variance(term, 2.0, f, 0.5 * m, 0.5), by_definition(m, wave), 4.0 * grain);
    }
    // Of rate averages of a Gauss-Markov process: its integral's variance 2 s^2 T^2 (t/T - 1 + e^(-t/T)).
    for (const double T : {0.4, 3.0, 50.0, 1e4}) {
      const double t = 0.5 * m;
      const long double x = static_cast<long double>(t) / T;
      // y - 1 + e^-y, by its series where that cancels.
      const auto V = [](long double y) {
        if (y > 0.5L) return y - 1.0L + std::exp(-y);
        long double sum = 0.0L, term = -y;
        for (int n = 2; n < 24; ++n) sum += term *= -y / n;
        return sum;
      };
      const long double exact = 1.21L * (4.0L * V(x) - V(2.0L * x)) / (x * x);
      // The closed form loses eps / x^2; the series below 1e-3 of Tc is cut off before 7/30 x^3.
      const auto xd = static_cast<double>(x);
      const double bound =
          xd < 1e-3 ? 0.3 * xd * xd * xd + 8.0 * kEpsilon * xd : 16.0 * kEpsilon * (1.0 / (xd * xd) + 1.0 / xd);
      looks.near(allan_variance(kGaussMarkov, 1.1, T, t, 0.5), static_cast<double>(exact), 1.21 * bound);
    }
    // A ramp: mean differences R tau; a walk in continuous time: K^2 tau / 3; the flicker's floor.
    looks.close(allan_variance(kRamp, 0.3, 0.0, 0.5 * m, 0.5), 0.5 * std::pow(0.3 * 0.5 * m, 2), 8.0);
    looks.close(allan_variance(kRateRandomWalk, 0.3, 0.0, 0.5 * m, 0.5), 0.09 * 0.5 * m / 3.0, 8.0);
    looks.close(allan_variance(kBiasInstability, 0.3, 0.0, 0.5 * m, 0.5), 0.09 * 2.0 * std::log(2.0) / kPi, 8.0);
  }
  return looks.figure();
}

/// Deviations of a drawn log in segments by their definitions; intervals by chi-square of their degrees of freedom.
StressFigure definitions(const std::string& kind) {
  Looks looks;
  const RandomStream draws(1, "stress.allan");
  std::vector<double> y;
  double walk = 0.0;
  for (std::uint64_t k = 0; k < 700; ++k) {
    walk += 0.1 * draws.normal(1, k);
    y.push_back(draws.normal(0, k) + walk + 0.002 * static_cast<double>(k));
  }
  const Sampling sampling{0.02, {{0, 150}, {150, 420}, {420, 700}}, 0.0};
  const std::vector<std::int64_t> factors{1, 2, 3, 5, 8, 17, 40};
  const auto points = deviation(kind, y, sampling, factors, 0.9);
  looks.right(points.size() >= 6);
  for (const DeviationPoint& p : points) {
    const auto m = static_cast<int>(p.m);
    double sum = 0.0, count = 0.0;
    for (const Segment& s : sampling.segments) {
      const auto n = static_cast<int>(s.end - s.begin);
      std::vector<double> x{0.0};  // phase in samples
      for (std::size_t k = s.begin; k < s.end; ++k) x.push_back(x.back() + y[k]);
      const auto at = [&](int i) {  // reflected at both ends
        if (i < 0) return 2.0 * x.front() - x[static_cast<std::size_t>(-i)];
        if (i > n) return 2.0 * x.back() - x[static_cast<std::size_t>(2 * n - i)];
        return x[static_cast<std::size_t>(i)];
      };
      if (kind == "overlapping")
        for (int j = 0; j + 2 * m <= n; ++j)
          sum += std::pow(at(j + 2 * m) - 2.0 * at(j + m) + at(j), 2), count += 2.0 * m * m;
      if (kind == "modified")
        for (int j = 0; j + 3 * m - 1 <= n; ++j) {
          double mean = 0.0;
          for (int i = j; i < j + m; ++i) mean += (at(i + 2 * m) - 2.0 * at(i + m) + at(i)) / m;
          sum += mean * mean, count += 2.0 * m * m;
        }
      if (kind == "hadamard")
        for (int j = 0; j + 3 * m <= n; ++j)
          sum += std::pow(at(j + 3 * m) - 3.0 * at(j + 2 * m) + 3.0 * at(j + m) - at(j), 2), count += 6.0 * m * m;
      if (kind == "total" && m < n)
        for (int j = 1; j < n; ++j) sum += std::pow(at(j + m) - 2.0 * at(j) + at(j - m), 2), count += 2.0 * m * m;
    }
    // Phases of 1e3: their second differences round by an eps of it, over 0.5 and more.
    looks.near(p.tau_s, 0.02 * m, 1e-15);
    looks.near(p.deviation / std::sqrt(sum / count), 1.0, 5e-13);
    looks.right(p.edf >= 1.0 && p.low < p.deviation && p.high > p.deviation);
    if (kind == "total") continue;
    looks.near(p.high / p.deviation, std::sqrt(p.edf / chi_square_threshold(0.95, p.edf)), 1e-9 * p.high / p.deviation);
    looks.near(p.low / p.deviation, std::sqrt(p.edf / chi_square_threshold(0.05, p.edf)), 1e-9);
  }
  return looks.figure();
}

/// Degrees of freedom of a mean square are (sum of variances)^2 / sum of squared covariances of what is squared. Of
/// differences of order d, spaced by m, of a phase that is white (quantization), a walk (white rate) or an integrated
/// walk: by the covariances of the phase's own increments.
double exact_degrees(NoiseType noise, int d, bool modified, int samples, int m) {
  const int points = samples + 1;
  // Weights of one squared term over the phase.
  std::vector<double> w(static_cast<std::size_t>(d * m + 1 + (modified ? m - 1 : 0)), 0.0);
  const double binomial[2][4] = {{1, -2, 1, 0}, {1, -3, 3, -1}};
  for (int shift = 0; shift < (modified ? m : 1); ++shift)
    for (int i = 0; i <= d; ++i) w[static_cast<std::size_t>(i * m + shift)] += binomial[d - 2][i];
  if (noise != NoiseType::kQuantization) {
    // As weights of the phase's increments (sums from behind), and once more for a walk of the rate.
    for (int times = noise == NoiseType::kWhite ? 1 : 2; times > 0; --times) {
      for (std::size_t k = w.size() - 1; k > 0; --k) w[k - 1] += w[k];
      w.erase(w.begin());
    }
  }
  const int terms = points - (d * m + (modified ? m - 1 : 0));
  const auto covariance = [&](int lag) {
    double c = 0.0;
    for (std::size_t k = static_cast<std::size_t>(lag); k < w.size(); ++k)
      c += w[k] * w[k - static_cast<std::size_t>(lag)];
    return c;
  };
  const double none = covariance(0);
  double sum = 1.0;
  for (int lag = 1; lag < terms && lag < static_cast<int>(w.size()); ++lag)
    sum += 2.0 * (1.0 - static_cast<double>(lag) / terms) * std::pow(covariance(lag) / none, 2);
  const double out = terms / sum;
  return out > 1.0 ? out : 1.0;
}

/// Sums of Greenhall and Riley are these but for a continuous walk in the place of one in steps; Howe's fits for the
/// overlapping deviation are good to some percent.
StressFigure degrees() {
  Looks looks;
  for (const NoiseType noise : {NoiseType::kQuantization, NoiseType::kWhite, NoiseType::kRandomWalk})
    for (const int samples : {300, 2000})
      for (const int m : {8, 20, 50}) {
        // Samples against a continuous phase: of second order in 1 / m where differences are smooth, else of first.
        const bool white = noise == NoiseType::kWhite, phase = noise == NoiseType::kQuantization;
        const double step = 1.0 / m;
        looks.near(modified_degrees(noise, samples, m) / exact_degrees(noise, 2, true, samples, m), 1.0,
                   phase ? 1e-9 : step * step);
        looks.near(hadamard_degrees(noise, samples, m) / exact_degrees(noise, 3, false, samples, m), 1.0,
                   phase   ? 1e-9
                   : white ? 1.2 * step
                           : step * step);
        looks.near(overlapping_degrees(noise, samples, m) / exact_degrees(noise, 2, false, samples, m), 1.0,
                   phase || white ? 0.03 : 0.12);
      }
  // Total: laws of Greenhall, Howe and Percival.
  for (const double ratio : {3.0, 10.0, 100.0}) {
    const double m = 16.0, n = ratio * m;
    looks.close(total_degrees(NoiseType::kWhite, n, m), 1.5 * ratio, 8.0);
    looks.close(total_degrees(NoiseType::kFlicker, n, m), 1.17 * ratio - 0.22, 8.0);
    looks.close(total_degrees(NoiseType::kRandomWalk, n, m), 0.93 * ratio - 0.36, 8.0);
    looks.close(total_bias(NoiseType::kFlicker, n, m), 1.0 - 0.481 / ratio, 8.0);
    looks.close(total_bias(NoiseType::kRandomWalk, n, m), 1.0 - 0.75 / ratio, 8.0);
    looks.close(total_bias(NoiseType::kWhite, n, m), 1.0, 1.0);
  }
  for (const auto& [slope, noise] :
       {std::pair(-1.5, NoiseType::kQuantization), std::pair(-1.0, NoiseType::kQuantization),
        std::pair(-0.5, NoiseType::kWhite), std::pair(0.0, NoiseType::kFlicker), std::pair(0.5, NoiseType::kRandomWalk),
        std::pair(1.0, NoiseType::kRandomWalk)})
    looks.right(noise_of_slope(slope) == noise);
  // Two averages of one white log: by their weights over the samples, long of both.
  for (const double m1 : {4.0, 16.0})
    for (const double ratio : {1.0, 1.5, 2.0, 4.0, 16.0}) {
      const double m2 = m1 * ratio;
      const auto sum = [&](double a, double b) {
        double total = 0.0;
        const int A = static_cast<int>(a), B = static_cast<int>(b);
        for (int lag = -2 * B; lag <= 2 * A; ++lag) {
          double c = 0.0;
          for (int i = 0; i < 2 * A; ++i) {
            const int j = i - lag;
            if (j >= 0 && j < 2 * B) c += (i < A ? -1.0 : 1.0) * (j < B ? -1.0 : 1.0);
          }
          total += c * c;
        }
        return total;
      };
      // The library thins the lags to a sixteenth of the shorter.
      looks.near(overlapping_correlation(m1, m2), sum(m1, m2) / std::sqrt(sum(m1, m1) * sum(m2, m2)), 0.02);
    }
  looks.right(overlapping_correlation(1.0, 65.0) == 0.0 && overlapping_correlation(65.0, 1.0) == 0.0);
  return looks.figure();
}

std::vector<DeviationPoint> curve(const std::vector<std::array<double, 3>>& terms, std::int64_t samples) {
  std::vector<DeviationPoint> points;
  for (const std::int64_t m : averaging_factors(samples, 4)) {
    DeviationPoint p;
    p.m = m, p.tau_s = 0.01 * static_cast<double>(m);
    double variance = 0.0;
    for (const auto& t : terms) variance += allan_variance(static_cast<int>(t[0]), t[1], t[2], p.tau_s, 0.01);
    p.edf = 1.5 * static_cast<double>(samples) / static_cast<double>(m);
    p.deviation = std::sqrt(variance * std::exp(-1.0 / p.edf));
    points.push_back(p);
  }
  return points;
}

/// Curves without statistical error give their coefficients back, to where the search for the least squares ends, and
/// nothing else is determined.
StressFigure fitted(const std::vector<std::array<double, 3>>& terms, std::int64_t samples, double within) {
  if (!can_fit_noise()) return {0.0, 1.0};
  const auto fit = fit_noise(curve(terms, samples), 4);
  if (!fit.ok()) return {kInfinity, 1.0};
  Looks looks;
  for (int term = 0; term < kNoiseTerms; ++term) {
    const auto of =
        std::find_if(terms.begin(), terms.end(), [&](const auto& t) { return static_cast<int>(t[0]) == term; });
    const FittedTerm& found = fit->term(kNoiseTermNames[term]);
    looks.right(found.determined == (of != terms.end()));
    if (of == terms.end()) {
      looks.right(found.value == 0.0);
      continue;
    }
    looks.near(found.value / (*of)[1], 1.0, within);
    looks.right(found.sigma > 0.0 && found.sigma < found.value / 2.0);
    if (term == kWhite)
      looks.near(found.second / (1.0 + 2.0 * found.second), (*of)[2], within);
    else if ((*of)[2] > 0.0)
      looks.near(found.second / (*of)[2], 1.0, within);
  }
  for (const DeviationPoint& p : curve(terms, samples))
    looks.near(fit->deviation_at(p.tau_s) / p.deviation, std::exp(0.5 / p.edf), 10.0 * within);
  looks.right(fit->chi_square_per_dof < 1.0);
  return looks.figure();
}

/// A log that rests, but for what is put in: turned away, shaken, or not at all.
StressFigure moving_logs() {
  Looks looks;
  const RandomStream draws(8, "stress.motion_check");
  const auto log_of = [&](const std::function<double(int, double)>& added) {
    ImuLog log;
    for (std::size_t k = 0; k < 6000; ++k) log.t_s.push_back(0.01 * static_cast<double>(k));
    for (int c = 0; c < 6; ++c) {
      auto& channel = log.channels[static_cast<std::size_t>(c)];
      for (std::size_t k = 0; k < 6000; ++k)
        channel.push_back((c < 3 ? 1e-4 : 2e-3) * draws.normal(static_cast<std::uint32_t>(c), k) +
                          (c == 5 ? 9.8 : 0.0) + added(c, log.t_s[k]));
    }
    return log;
  };
  looks.right(!find_motion(log_of([](int, double) { return 0.0; })).moves());
  // From 20 to 25 s: a mean beyond the limit, or below it.
  for (const int c : {0, 1, 2, 3, 4, 5}) {
    const double limit = c < 3 ? kDegree : 0.5;
    for (const double times : {0.7, 1.5}) {
      const MotionFound found =
          find_motion(log_of([&](int of, double t) { return of == c && t >= 20.0 && t < 25.0 ? times * limit : 0.0; }));
      looks.right(found.moves() == (times > 1.0));
      if (!found.moves()) continue;
      const MovingInterval& worst = found.worst();
      looks.right(worst.channel == c && !worst.shakes && found.intervals.size() == 1);
      // Whole seconds about the five.
      looks.near(worst.from_s, 20.0, 1.01), looks.near(worst.to_s, 25.0, 1.01);
      looks.near(worst.amount, times * limit, 0.05 * limit);
      looks.near(worst.excess, times, 0.05);
      looks.near(found.share, 5.0 / 60.0, 2.1 / 60.0);
    }
    // Shaken at 10 Hz from 40 to 50 s.
    const double shaken = c < 3 ? 0.5 * kDegree : 0.1;
    for (const double times : {0.8, 2.0}) {
      const MotionFound found = find_motion(log_of([&](int of, double t) {
        return of == c && t >= 40.0 && t < 50.0 ? times * shaken * std::sqrt(2.0) * std::sin(2.0 * kPi * 10.0 * t)
                                                : 0.0;
      }));
      looks.right(found.moves() == (times > 1.0));
      if (!found.moves()) continue;
      looks.right(found.worst().channel == c && found.worst().shakes);
      looks.near(found.worst().amount, times * shaken, 0.05 * shaken);
      looks.near(found.worst().from_s, 40.0, 1.01), looks.near(found.worst().to_s, 50.0, 1.01);
    }
  }
  return looks.figure();
}

/// Parts of flicker: density between its corners (0.3 % far from them, 0.8 % ten times inside) and variance.
StressFigure flicker_density() {
  Looks looks;
  for (const auto& [low, high] : {std::pair(1e-5, 0.1), std::pair(1e-3, 50.0), std::pair(0.02, 0.03)}) {
    const auto parts = flicker_parts(0.02, low, high);
    // The floor is 0.664 B.
    const double B = 0.02 / std::sqrt(2.0 * std::log(2.0) / kPi);
    double variance = 0.0;
    for (const FlickerPart& p : parts) variance += p.sigma * p.sigma, looks.right(p.tau_s > 0.0);
    looks.near(variance / (B * B / kPi * std::log(high / low)), 1.0, 1e-12);
    for (const FlickerPart& p : parts) looks.near(p.sigma / parts.front().sigma, 1.0, 1e-12);
    for (std::size_t k = 1; k < parts.size(); ++k) {
      const double step = parts[k].tau_s / parts[k - 1].tau_s, factor = step > 1.0 ? step : 1.0 / step;
      looks.right(factor <= 4.0 * (1.0 + 1e-12));
      looks.near(factor, std::pow(high / low, 1.0 / static_cast<double>(parts.size())), 1e-9);
    }
    if (high / low < 400.0) continue;
    for (double f = 10.0 * low; f < 0.1 * high; f *= 1.7) {
      double density = 0.0;
      for (const FlickerPart& p : parts)
        density += 2.0 * p.sigma * p.sigma * p.tau_s / (1.0 + std::pow(2.0 * kPi * f * p.tau_s, 2));
      const double expected = B * B / (2.0 * kPi * f) * 2.0 / kPi * (std::atan(high / f) - std::atan(low / f));
      looks.near(density / expected, 1.0, 0.008);
    }
  }
  return looks.figure();
}

/// Filters and plants in series by their gains; rests, integrals and roots by what they are.
StressFigure plants() {
  Looks looks;
  for (const int order : {1, 2, 3, 4})
    for (const double corner : {0.5, 80.0, 3000.0}) {
      const LinearPlant filter = butterworth(order, corner);
      looks.right(filter.size() == order && filter.intensity.norm() == 0.0);
      for (double f = 0.01 * corner; f < 50.0 * corner; f *= 1.9)
        looks.near(filter.gain(f) * std::sqrt(1.0 + std::pow(f / corner, 2 * order)), 1.0, 1e-11);
      looks.near(filter.C.dot(filter.rest(2.5)), 2.5, 1e-11);
      looks.near((filter.A * filter.rest(2.5) + filter.B * 2.5).norm() / (filter.B.norm() * 2.5), 0.0, 1e-12);
      LinearPlant noisy = butterworth(2, 200.0);
      noisy.intensity = Eigen::MatrixXd::Identity(2, 2) * 3.0;
      const LinearPlant both = in_series(noisy, filter);
      looks.right(both.size() == 2 + order);
      for (const double f : {0.3, 20.0, 700.0}) looks.near(both.gain(f) / (noisy.gain(f) * filter.gain(f)), 1.0, 1e-9);
      looks.near((both.intensity.topLeftCorner(2, 2) - noisy.intensity).norm(), 0.0, 1e-15);
      looks.near(both.intensity.norm(), noisy.intensity.norm(), 1e-14);
      const LinearPlant integrated = with_integral(filter);
      looks.right(integrated.size() == order + 1);
      Eigen::VectorXd s = Eigen::VectorXd::LinSpaced(order + 1, 1.0, 2.0);
      const Eigen::VectorXd change = integrated.A * s + integrated.B * 0.7;
      looks.near(change[order], filter.C.dot(s.head(order)), 1e-12 * (1.0 + std::abs(change[order])));
      looks.near((change.head(order) - filter.A * s.head(order) - filter.B * 0.7).norm() / change.norm(), 0.0, 1e-14);
    }
  for (const int rank : {1, 2, 4}) {
    const RandomStream draws(3, "stress.roots");
    Eigen::MatrixXd F(4, rank);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < rank; ++j)
        F(i, j) = draws.normal(static_cast<std::uint32_t>(i), static_cast<std::uint64_t>(j));
    const Eigen::MatrixXd P = F * F.transpose(), L = noise_root(P);
    // A zero eigenvalue is known to eps of the largest, its root to sqrt of that, squared again.
    looks.near((L * L.transpose() - P).norm(), 0.0, 64.0 * kEpsilon * P.norm());
  }
  Eigen::Matrix2d turn;
  turn << 0.6, -0.7, 0.7, 0.6;
  looks.close(spectral_radius(turn), std::sqrt(0.85), 16.0);
  // Pick-offs read what a small displacement is, and what each says of a large one stays odd and grows.
  for (const auto& row : pick_offs()) {
    const auto made = row.make(PickOffFigures{});
    for (const double x : {1e-12, 1e-10}) looks.near(made->reading_m(x) / x, 1.0, 1e-6);
    for (const double x : {1e-7, 5e-7, 1.5e-6}) looks.near(made->reading_m(-x) + made->reading_m(x), 0.0, 1e-20);
    looks.right(made->reading_m(1.5e-6) > made->reading_m(1e-6));
    looks.right(made->noise_m_sqrt_hz(300.0) > 0.0 && made->noise_m_sqrt_hz(400.0) >= made->noise_m_sqrt_hz(300.0));
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> allan_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "variances over averaging times, and what they are worth",
           .why = "a mean over one sample too many, a power of m, a law of another noise",
           .expected =
               "definitions over all samples and covariances of what is squared: roundings, or what a fitted law "
               "is said to be good to",
           .unit = "of the bound"});
  rows.add("allan/laws", laws).add("allan/degrees_of_freedom", degrees);
  for (const std::string& kind : deviation_kinds())
    rows.add("allan/definition_of_" + kind, [kind] { return definitions(kind); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "noise read off a curve that is known",
           .why = "a second parameter in another unit, a criterion that takes too many processes or too few",
           .expected = "the coefficients that the curve was made of, to where the search ends, and no others",
           .unit = "of the bound"});
  using Terms = std::vector<std::array<double, 3>>;
  const struct {
    const char* name;
    Terms terms;
    std::int64_t samples;
    double within;
  } curves[] = {
      {"white_flicker_walk",
       {{kWhite, 0.05, 0.0}, {kBiasInstability, 0.01, 0.0}, {kRateRandomWalk, 0.002, 0.0}},
       1000000,
       1e-9},
      {"rounding_white_ramp", {{kQuantization, 1e-3, 0.0}, {kWhite, 0.02, 0.0}, {kRamp, 1e-5, 0.0}}, 1000000, 1e-9},
      {"white_gauss_markov", {{kWhite, 0.05, 0.0}, {kGaussMarkov, 0.03, 60.0}}, 4000000, 1e-10},
      {"low_pass_and_a_line", {{kWhite, 0.05, 0.17 / 1.34}, {kSinusoid, 0.1, 0.56}}, 180000, 1e-6}};
  for (const auto& c : curves)
    rows.add(std::string("allan/fit_of_") + c.name,
             [terms = c.terms, n = c.samples, w = c.within] { return fitted(terms, n, w); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "a log that rests but for a few seconds",
           .why = "a limit in another unit, a window that is too long",
           .expected = "told from the limits on, when and on which channel: windows of a second",
           .unit = "of the bound"});
  rows.add("allan/logs_that_move", moving_logs);
  rows.of({.group = StressGroup::kStiff,
           .mechanism = "spectra of flicker and of filters",
           .why = "a corner in rad/s, an order that is off by one",
           .expected = "densities and gains in closed form",
           .unit = "of the bound"});
  rows.add("allan/flicker_density", flicker_density).add("allan/plants", plants);
  return rows.take();
}

}  // namespace canyon::inertial

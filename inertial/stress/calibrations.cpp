// From logs back to a unit's figures: what calibrations find, how sure they say to be, and the entry that comes of it.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/allan/noise_fit.h"
#include "canyon/inertial/calibration/fitted_entry.h"
#include "canyon/inertial/calibration/log_fits.h"
#include "canyon/inertial/calibration/resting_positions.h"
#include "canyon/inertial/calibration/triad_calibration.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

struct MadeTriad {
  Vector3d bias;
  Matrix3d gain;
  Vector3d measured(const Vector3d& truth) const { return truth + gain * truth + bias; }
};
MadeTriad made_triad(std::uint64_t seed, bool lower) {
  const RandomStream draws(seed, "stress.calibration");
  MadeTriad out{0.1 * draws.normal3(0), Matrix3d::Zero()};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      if (!lower || column <= row)
        out.gain(row, column) = 0.02 * draws.normal(1, static_cast<std::uint64_t>(3 * row + column));
  return out;
}

/// Beside true values without noise a triad comes back to the roundings of its least squares; with noise its errors
/// are of the size that is said: over 60 logs the mean square of each parameter's error over its sigma is 1 to five
/// deviations, and what is left of the samples is the noise, on fewer degrees of freedom.
StressFigure beside_truth() {
  Looks looks;
  double sum = 0.0, count = 0.0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomStream draws(seed, "stress.calibration_truth");
    const MadeTriad triad = made_triad(seed, false);
    std::vector<Vector3d> truth, exact, noisy;
    constexpr std::size_t kN = 80;
    constexpr double kNoise = 0.05;
    double before = 0.0;
    for (std::size_t k = 0; k < kN; ++k) {
      truth.push_back(Vector3d(1.0, 2.0, 0.5).cwiseProduct(draws.normal3(k)) + Vector3d(0.3, 0.0, 9.8));
      exact.push_back(triad.measured(truth.back()));
      noisy.push_back(exact.back() + kNoise * draws.normal3(k + 1000));
      before += (noisy.back() - truth.back()).squaredNorm() / (3.0 * kN);
    }
    const auto found = fit_to_reference(exact, truth), rough = fit_to_reference(noisy, truth);
    looks.right(found.ok() && rough.ok());
    if (!found || !rough) return looks.figure();
    looks.near((found->gain - triad.gain).norm() + (found->bias - triad.bias).norm(), 0.0, 1e4 * kEpsilon);
    looks.near((found->corrected(exact[3]) - truth[3]).norm(), 0.0, 1e5 * kEpsilon);
    looks.near(found->residual_rms, 0.0, 1e4 * kEpsilon);
    looks.right(found->used == kN);
    for (int row = 0; row < 3; ++row) {
      sum += std::pow((rough->bias[row] - triad.bias[row]) / rough->bias_sigma[row], 2), count += 1.0;
      for (int column = 0; column < 3; ++column)
        sum += std::pow((rough->gain(row, column) - triad.gain(row, column)) / rough->gain_sigma(row, column), 2),
            count += 1.0;
    }
    looks.near(rough->uncalibrated_rms, std::sqrt(before), 1e-12);
    // Of 240 residuals on 228 degrees of freedom.
    looks.near(std::pow(rough->residual_rms / kNoise, 2), 228.0 / 240.0, 5.0 * std::sqrt(2.0 / 228.0));
  }
  // Bias and gain of a row hang together, up to four as one.
  looks.near(sum / count, 1.0, 5.0 * std::sqrt(2.0 * 4.0 / count));
  std::vector<Vector3d> plane;
  for (int k = 0; k < 20; ++k) plane.emplace_back(std::sin(0.7 * k), std::cos(1.1 * k), 3.0);
  looks.right(!fit_to_reference(plane, plane) && !fit_to_reference(std::vector<Vector3d>(4), std::vector<Vector3d>(4)));
  return looks.figure();
}

std::vector<Vector3d> directions(std::size_t count, std::uint64_t seed) {
  const RandomStream draws(seed, "stress.calibration_ways");
  std::vector<Vector3d> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back(draws.direction(0, k));
  // Each axis up and down, then anywhere.
  for (std::size_t k = 0; k < 6 && k < count; ++k) {
    out[k].setZero();
    out[k][static_cast<Eigen::Index>(k / 2)] = k % 2 == 0 ? 1.0 : -1.0;
  }
  return out;
}

/// By gravity alone: a lower triangle comes back to where the search ends, 1e-9 of itself; a triad that is turned as a
/// whole shows no turn; and with noise sigmas as above, of nine parameters that may all hang together.
StressFigure by_gravity() {
  if (!can_fit_noise()) return {0.0, 1.0};
  Looks looks;
  constexpr double kGravity = 9.81, kSigma = 2e-3;
  double sum = 0.0;
  constexpr int kSeeds = 40;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RandomStream draws(seed, "stress.calibration_noise");
    const MadeTriad triad = made_triad(seed, true);
    std::vector<Vector3d> exact, noisy;
    double before = 0.0;
    for (const Vector3d& up : directions(24, seed)) {
      exact.push_back(triad.measured(kGravity * up));
      noisy.push_back(exact.back() + kSigma * draws.normal3(exact.size()));
      before += std::pow(noisy.back().norm() - kGravity, 2) / 24.0;
    }
    const auto found = fit_to_gravity(exact, kSigma, kGravity), rough = fit_to_gravity(noisy, kSigma, kGravity);
    looks.right(found.ok() && rough.ok());
    if (!found || !rough) return looks.figure();
    looks.near((found->gain - triad.gain).norm() + (found->bias - triad.bias).norm(), 0.0, 1e-8);
    looks.right(found->used == 24);
    looks.near(rough->uncalibrated_rms, std::sqrt(before), 1e-12);
    for (int row = 0; row < 3; ++row) {
      sum += std::pow((rough->bias[row] - triad.bias[row]) / rough->bias_sigma[row], 2);
      for (int column = 0; column < 3; ++column) {
        if (column > row) looks.right(rough->gain(row, column) == 0.0 && rough->gain_sigma(row, column) == 0.0);
        if (column <= row)
          sum += std::pow((rough->gain(row, column) - triad.gain(row, column)) / rough->gain_sigma(row, column), 2);
      }
    }
    // Of 24 magnitudes less nine parameters.
    looks.near(std::pow(rough->residual_rms / kSigma, 2), 15.0 / 24.0, 7.0 * std::sqrt(2.0 * 15.0) / 24.0);
  }
  // A sigma is widened where the residuals ask for it, by up to some third: never by less than 1.
  looks.right(sum / (9.0 * kSeeds) < 1.0 + 5.0 * std::sqrt(2.0 * 9.0 / (9.0 * kSeeds)) && sum / (9.0 * kSeeds) > 0.35);
  looks.right(!fit_to_gravity(directions(8, 1), kSigma, 1.0));
  std::vector<Vector3d> flat;
  for (int k = 0; k < 14; ++k) flat.push_back(kGravity * Vector3d(std::cos(0.5 * k), std::sin(0.5 * k), 0.0));
  looks.right(!fit_to_gravity(flat, kSigma, kGravity));
  return looks.figure();
}

void push(ImuLog& log, double t_s, const Vector3d& rate, const Vector3d& force) {
  log.t_s.push_back(t_s);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    log.channels[axis].push_back(rate[static_cast<Eigen::Index>(axis)]);
    log.channels[3 + axis].push_back(force[static_cast<Eigen::Index>(axis)]);
  }
}

/// A unit that is laid down in many positions and turned between them, with noise: as many rests as there are, each
/// within the window that its ends are cut by, with the means of what it holds; and the calibration that comes of them.
StressFigure laid_down() {
  if (!can_fit_noise()) return {0.0, 1.0};
  Looks looks;
  constexpr double kRate_hz = 100.0, kGravity = 9.80665, kForceNoise = 0.01, kRateNoise = 1e-3;
  const MadeTriad triad = made_triad(3, true);
  const RandomStream draws(3, "stress.laid_down");
  const Vector3d gyro_bias(2e-3, -3e-3, 1e-3);
  ImuLog log;
  std::vector<std::pair<std::size_t, std::size_t>> rests;
  std::uint64_t k = 0;
  const auto ways = directions(16, 3);
  for (std::size_t position = 0; position < ways.size(); ++position) {
    const std::size_t begin = log.size();
    for (int i = 0; i < 700 + 30 * static_cast<int>(position % 3); ++i, ++k)
      push(log, static_cast<double>(k) / kRate_hz, gyro_bias + kRateNoise * draws.normal3(k, 0),
           triad.measured(kGravity * ways[position]) + kForceNoise * draws.normal3(k, 1));
    rests.emplace_back(begin, log.size());
    for (int i = 0; i < 240; ++i, ++k)
      push(log, static_cast<double>(k) / kRate_hz, Vector3d(std::sin(0.1 * i), 0.8, 0.3),
           kGravity * ways[position] + 3.0 * Vector3d(std::sin(0.2 * i), std::cos(0.3 * i), 1.0));
  }
  const auto found = resting_positions(log);
  looks.right(found.size() == rests.size());
  if (found.size() != rests.size()) return looks.figure();
  for (std::size_t p = 0; p < found.size(); ++p) {
    // Windows of half a second on a grid of their own, half of one off either end.
    looks.right(found[p].begin >= rests[p].first && found[p].begin <= rests[p].first + 75);
    looks.right(found[p].end <= rests[p].second && found[p].end + 75 >= rests[p].second);
    Vector3d rate = Vector3d::Zero(), force = Vector3d::Zero();
    const auto n = static_cast<double>(found[p].end - found[p].begin);
    for (std::size_t i = found[p].begin; i < found[p].end; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        rate[static_cast<Eigen::Index>(axis)] += log.channels[axis][i] / n,
            force[static_cast<Eigen::Index>(axis)] += log.channels[3 + axis][i] / n;
    looks.near((found[p].rate - rate).norm(), 0.0, 1e-12), looks.near((found[p].force - force).norm(), 0.0, 1e-11);
  }
  looks.right(resting_positions(log, 5.0).size() == rests.size() && resting_positions(log, 9.0).empty());
  const auto unit = fit_to_positions({log, "some/where/laid_down.csv"}, given_gravity(kGravity));
  looks.right(unit.ok());
  if (!unit) return looks.figure();
  looks.right(unit->name == "laid_down" && unit->log == "laid_down.csv" && unit->noise.size() == 6);
  looks.near(unit->rate_hz, kRate_hz, 1e-9);
  looks.near(unit->bias[0], gyro_bias.norm() / std::sqrt(3.0), 5.0 * kRateNoise / std::sqrt(600.0 * 16.0));
  // Of means of some 650 samples: sixteen positions for nine parameters, three deviations each.
  const double mean_m_s2 = kForceNoise / std::sqrt(600.0);
  looks.near((unit->calibration[1]->bias - triad.bias).norm(), 0.0, 5.0 * mean_m_s2);
  looks.near((unit->calibration[1]->gain - triad.gain).norm(), 0.0, 5.0 * 2.0 * mean_m_s2 / kGravity * 3.0);
  looks.near(unit->calibration[1]->bias_sigma.norm() / mean_m_s2, 1.0, 0.9);
  return looks.figure();
}

/// A log beside a reference of another rate, whose means belong to other middles and which has a gap: of motions that
/// are straight lines in time the pairs are exact, none lies across the gap or beside the reference; the calibration
/// and its figures in units of the catalogue come back.
StressFigure another_rate() {
  Looks looks;
  const MadeTriad gyro = made_triad(5, false), accel = made_triad(6, false);
  const RandomStream draws(5, "stress.another_rate");
  // Rates whose mean over an interval is that at its middle.
  const auto rate = [](double t) { return Vector3d(0.02 * t, -0.5 + 0.01 * t, 0.3 - 0.015 * t); };
  const auto force = [](double t) { return Vector3d(1.0 - 0.1 * t, 0.05 * t, 9.8 + 0.02 * t); };
  ImuLog log, truth;
  for (int k = 1; k <= 4000; ++k) {
    const double t = 0.01 * k, middle = t - 0.005;
    push(log, t, gyro.measured(rate(middle)), accel.measured(force(middle)));
  }
  for (int k = 1; k <= 1000; ++k) {
    const double t = 1.0 + 0.037 * k, middle = t - 0.5 * 0.037;
    if (k > 400 && k < 420) continue;
    push(truth, t, rate(middle), force(middle));
  }
  const ReferencePairs pairs = reference_pairs(log, truth);
  looks.right(pairs.t_s.size() > 3200 && pairs.t_s.size() < 3800);
  for (std::size_t k = 0; k < pairs.t_s.size(); ++k) {
    const double middle = pairs.t_s[k] - 0.005;
    looks.near((pairs.truth[0][k] - rate(middle)).norm(), 0.0, 640.0 * kEpsilon);
    looks.near((pairs.truth[1][k] - force(middle)).norm(), 0.0, 640.0 * kEpsilon);
    looks.near((pairs.measured[1][k] - accel.measured(force(middle))).norm(), 0.0, 640.0 * kEpsilon);
    // The gap lies between the middles of samples 400 and 420.
    const double from = 1.0 + 0.037 * 399.5, to = 1.0 + 0.037 * 419.5;
    looks.right(middle <= from + 1e-9 || middle >= to - 1e-9);
  }
  return looks.figure();
}

/// White noise and constants of known size, six channels at rest for ten minutes: bias by the mean, the noise by its
/// curve; and the catalogue entry of it read back says so in the units of data sheets. White noise to what a curve's
/// fit states; constants to the six digits that are written.
StressFigure entry_of_rest() {
  if (!can_fit_noise()) return {0.0, 1.0};
  Looks looks;
  constexpr double kRate_hz = 20.0, kArw = 2e-4, kVrw = 3e-3;
  const RandomStream draws(8, "stress.entry");
  const Vector3d rate_bias(1e-3, -2e-3, 5e-4), force(0.3, -0.2, 9.9);
  ImuLog log;
  for (std::uint64_t k = 0; k < 12000; ++k)
    push(log, static_cast<double>(k) / kRate_hz, rate_bias + kArw * std::sqrt(kRate_hz) * draws.normal3(k, 0),
         force + kVrw * std::sqrt(kRate_hz) * draws.normal3(k, 1));
  const auto unit = fit_at_rest({log, "rest.csv"}, given_gravity(9.7));
  looks.right(unit.ok());
  if (!unit) return looks.figure();
  const double means_rate = kArw / std::sqrt(600.0), means_force = kVrw / std::sqrt(600.0);
  looks.near(unit->bias[0], rate_bias.norm() / std::sqrt(3.0), 5.0 * means_rate);
  looks.near(unit->bias[1], force.norm() - 9.7, 5.0 * means_force);
  looks.near(unit->duration_s, 600.0, 0.1);
  FittedUnit with = *unit;
  TriadCalibration calibration;
  calibration.gain << 1e-3, 2e-3, 0.0, -1e-3, 3e-3, 4e-3, 0.0, 5e-3, -2e-3;
  calibration.gain_sigma.setConstant(1e-5);
  calibration.gain_sigma(0, 2) = calibration.gain_sigma(2, 0) = 0.0;  // not looked for
  calibration.bias = Vector3d(3e-3, -4e-3, 12e-3);
  take_calibration(with, 0, calibration, "made");
  looks.near(with.bias[0], 13e-3 / std::sqrt(3.0), 1e-15);
  const auto text = catalogue_toml(with);
  looks.right(text.ok());
  if (!text) return looks.figure();
  const auto figure = [&](const std::string& table, const std::string& key) {
    const std::size_t at = text->find("[" + table + "]"), line = text->find("\n" + key + " = ", at);
    return line == std::string::npos ? stress::kInfinity : std::stod(text->substr(line + key.size() + 4));
  };
  // 12000 samples: the curve's shortest times tell white noise to 1 / sqrt(2 x 12000 x 3), 0.4 %; the fit to five of
  // it.
  looks.near(figure("gyro", "arw_deg_per_sqrt_hr") / (kArw / kDegree * 60.0), 1.0, 0.02);
  looks.near(figure("accel", "vrw_m_s_per_sqrt_hr") / (kVrw * 60.0), 1.0, 0.02);
  looks.near(figure("gyro", "turn_on_bias_deg_per_hr") / (13e-3 / std::sqrt(3.0) / kDegree * 3600.0), 1.0, 1e-5);
  looks.near(figure("accel", "turn_on_bias_mg") / (unit->bias[1] / kStandardGravity * 1000.0), 1.0, 1e-5);
  looks.near(figure("gyro", "scale_ppm") / (1e6 * std::sqrt((1.0 + 9.0 + 4.0) / 3.0) * 1e-3), 1.0, 1e-5);
  looks.near(figure("gyro", "misalignment_mrad") / (1e3 * std::sqrt((4.0 + 1.0 + 16.0 + 25.0) / 4.0) * 1e-3), 1.0,
             1e-5);
  looks.right(figure("accel", "scale_ppm") == 0.0);
  return looks.figure();
}

/// A whole unit beside a reference that moves on all axes: its triads, to five deviations of 4000 samples over motions
/// of 0.3 rad/s and 2 m/s^2; and what they leave is its own white noise, of known size: five deviations of so many
/// differences, 7 %, and gains of 2 % an element beside. A reference without a channel is none.
StressFigure against_reference() {
  if (!can_fit_noise()) return {0.0, 1.0};
  Looks looks;
  constexpr std::size_t kN = 4000;
  constexpr double kStep_s = 0.02, kNoise[2] = {1e-3, 2e-2};
  const std::array<MadeTriad, 2> triads{made_triad(11, false), made_triad(12, false)};
  const RandomStream draws(9, "stress.against_reference");
  ImuLog log, truth;
  for (std::size_t k = 0; k < kN; ++k) {
    const double t = kStep_s * static_cast<double>(k + 1);
    const Vector3d rate = 0.4 * Vector3d(std::sin(0.9 * t), std::cos(0.6 * t), std::sin(0.35 * t + 1.0)),
                   force = 3.0 * Vector3d(std::cos(0.8 * t), std::sin(0.5 * t), std::cos(1.1 * t)) +
                           Vector3d(0.0, 0.0, 9.8);
    push(truth, t, rate, force);
    push(log, t, triads[0].measured(rate) + kNoise[0] * draws.normal3(k, 0),
         triads[1].measured(force) + kNoise[1] * draws.normal3(k, 1));
  }
  const auto unit = fit_to_truth({log, "some/where/unit.csv"}, {truth, "else/where/reference.csv"});
  if (!unit) return {stress::kInfinity, 1.0};
  looks.right(unit->name == "unit" && unit->log == "unit.csv" && unit->noise.size() == 6);
  looks.near(unit->rate_hz, 50.0, 1e-9), looks.near(unit->duration_s, kN * kStep_s, 1e-9);
  for (std::size_t i = 0; i < 2; ++i) {
    if (!unit->calibration[i]) return {stress::kInfinity, 1.0};
    const TriadCalibration& found = *unit->calibration[i];
    const double mean = 5.0 * kNoise[i] / std::sqrt(1.0 * kN), size = i == 0 ? 0.4 : 3.0;
    // The accelerometer's bias goes with gravity times its gain.
    looks.near((found.bias - triads[i].bias).norm(), 0.0, 3.0 * mean * (i == 0 ? 1.0 : 1.0 + 9.8 / size));
    looks.near((found.gain - triads[i].gain).norm(), 0.0, 5.0 * mean / size);
    looks.near(unit->bias[i], found.bias.norm() / std::sqrt(3.0), 1e-15);
    looks.right(unit->calibration_source[i].find("unit.csv against the reference reference.csv") != std::string::npos);
    looks.right(found.used == kN);
  }
  for (const ChannelNoise& noise : unit->noise)
    looks.near(noise.points.front().deviation / kNoise[noise.channel < 3 ? 0 : 1], 1.0, 0.15);
  ImuLog lacking = truth;
  lacking.channels[4].clear();
  looks.right(!fit_to_truth({log, "unit.csv"}, {lacking, "reference.csv"}) &&
              !fit_to_truth({lacking, "unit.csv"}, {truth, "reference.csv"}));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> calibration_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "a unit's figures out of its own logs",
           "a gain of the other hand, a sigma without its degrees of freedom, means of other middles, a unit of time",
           "what the log was made of, and errors of the size that is said: five deviations", "of the bound"});
  rows.add("calibrations/beside_truth", beside_truth);
  rows.add("calibrations/by_gravity", by_gravity);
  rows.add("calibrations/laid_down", laid_down);
  rows.add("calibrations/beside_another_rate", another_rate);
  rows.add("calibrations/entry_of_a_rest", entry_of_rest);
  rows.add("calibrations/against_a_reference", against_reference);
  return rows.take();
}

}  // namespace canyon::inertial

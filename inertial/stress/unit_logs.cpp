// Logs of units whose errors are known: calibrated, looked through for what moves, and paired with a reference.
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/inertial/allan/motion_check.h"
#include "canyon/inertial/calibration/log_fits.h"
#include "canyon/inertial/calibration/resting_positions.h"
#include "canyon/inertial/calibration/triad_calibration.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Worst;

const Eigen::Matrix3d kGain = (Eigen::Matrix3d() << 0.01, 0.0, 0.0, 0.004, -0.02, 0.0, -0.003, 0.005, 0.015).finished();
const Vector3d kBias(0.3, -0.2, 0.1);
Vector3d measured(const Vector3d& truth) {
  return truth + kGain * truth + kBias;
}

/// A triad's bias and gains from samples without noise beside the truth: back to 32 roundings, and the
/// correction is the inverse. A force that is a million times smaller than its bias loses as many digits.
StressFigure to_reference(double size) {
  std::vector<Vector3d> truth, samples;
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.01 * k;
    truth.emplace_back(size * Vector3d(std::sin(t), std::cos(0.7 * t), 0.5 * std::sin(1.9 * t)));
    samples.push_back(measured(truth.back()));
  }
  const auto c = fit_to_reference(samples, truth);
  if (!c) return {kInfinity, 1.0};
  Worst worst;
  const double bound = 32.0 * kEpsilon * std::max(1.0, 1.0 / size);
  worst.look((c->bias - kBias).norm(), bound * std::max(1.0, size));
  worst.look((c->gain - kGain).norm(), bound);
  worst.look(c->residual_rms, 16.0 * bound * std::max(1.0, size));
  worst.look((c->corrected(samples[7]) - truth[7]).norm(), 16.0 * bound * std::max(1.0, size));
  double square = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) square += (samples[k] - truth[k]).squaredNorm();
  worst.look(c->uncalibrated_rms / std::sqrt(square / 3000.0) - 1.0, 1e-2);
  return worst.figure();
}

std::vector<Vector3d> orientations() {
  std::vector<Vector3d> out;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (const int n = std::abs(x) + std::abs(y) + std::abs(z); n == 1 || n == 2)
          out.push_back(Vector3d(x, y, z).normalized() * kStandardGravity);
  return out;
}

/// An accelerometer's from eighteen positions without noise: the sphere of gravity's size has one centre and one lower
/// triangle, and no residual is left: the last step ends at 256 roundings.
StressFigure to_gravity() {
  std::vector<Vector3d> positions;
  for (const Vector3d& f : orientations()) positions.push_back(measured(f));
  const auto c = fit_to_gravity(positions, 1e-3, kStandardGravity);
  if (!c) return {can_fit_noise() ? kInfinity : 0.0, 1.0};
  Worst worst;
  worst.look((c->bias - kBias).norm(), 256.0 * kEpsilon);
  worst.look((c->gain - kGain).norm(), 256.0 * kEpsilon);
  return worst.figure();
}

/// A log of a unit that lies in turn on each of eighteen sides, five seconds each: every rest is found, its means those
/// of the side to five sigma of 400 samples; what lies between is found as motion, from its first second to its last.
StressFigure turned_log() {
  ImuLog log;
  const RandomStream stream(8, "stress.positions");
  const auto where = orientations();
  std::uint64_t k = 0;
  const auto add = [&](const Vector3d& rate, const Vector3d& force) {
    const Vector3d f = measured(force) + 0.02 * stream.normal3(k, 0),
                   w = rate + Vector3d(0.01, 0.02, -0.01) + 0.002 * stream.normal3(k, 1);
    log.t_s.push_back(0.01 * static_cast<double>(k++));
    for (std::size_t i = 0; i < 3; ++i) {
      log.channels[i].push_back(w[static_cast<Eigen::Index>(i)]);
      log.channels[3 + i].push_back(f[static_cast<Eigen::Index>(i)]);
    }
  };
  for (std::size_t p = 0; p < where.size(); ++p) {
    for (int i = 0; i < 500; ++i) add(Vector3d::Zero(), where[p]);
    if (p + 1 == where.size()) break;
    for (int i = 0; i < 200; ++i) {
      const double share = i / 200.0;
      add({0.3, 0.5, 0.8},
          (1.0 - share) * where[p] + share * where[p + 1] + Vector3d(std::sin(0.3 * i), std::cos(0.2 * i), 0.5));
    }
  }
  Worst worst;
  const auto found = resting_positions(log);
  if (found.size() != where.size()) return {kInfinity, 1.0};
  for (std::size_t p = 0; p < found.size(); ++p) {
    const double from = 700.0 * static_cast<double>(p);
    worst.look((found[p].force - measured(where[p])).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
               5.0 * 0.02 / std::sqrt(400.0));
    worst.look((found[p].rate - Vector3d(0.01, 0.02, -0.01)).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
               5.0 * 0.002 / std::sqrt(400.0));
    // Half a window to either end is taken off, and one may be lost.
    worst.look(static_cast<double>(found[p].begin) - from - 50.0, 75.0);
    worst.look(static_cast<double>(found[p].end) - from - 450.0, 75.0);
  }
  const MotionFound motion = find_motion(log);
  worst.look(motion.moves() ? 0.0 : kInfinity, 1.0);
  const auto fit = fit_to_positions({log, "made"}, given_gravity(kStandardGravity));
  if (fit && fit->calibration[1]) {
    // 12 parameters of 18 means, each 0.02 / sqrt(400).
    worst.look((fit->calibration[1]->bias - kBias).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 6.0 * 1e-3);
    worst.look((fit->calibration[1]->gain - kGain).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 6.0 * 1e-3 / 9.8 * 3.0);
  } else {
    worst.look(can_fit_noise() ? kInfinity : 0.0, 1.0);
  }
  return worst.figure();
}

/// A log at rest with a turn of 20 deg/s from 30 to 40 s about one axis and a shake of 3 m/s^2 from 60 to 62 s: both
/// are found, to the second, by the channel that shows them, as what they are; and nothing else is.
StressFigure motion_found() {
  ImuLog log;
  const RandomStream stream(3, "stress.rest");
  for (std::size_t k = 0; k < 10'000; ++k) {
    const double t = 0.01 * static_cast<double>(k);
    log.t_s.push_back(t);
    for (std::size_t i = 0; i < 6; ++i) {
      double x = (i < 3 ? 0.001 : 0.01) * stream.normal(static_cast<std::uint32_t>(i), k) + (i == 5 ? 9.81 : 0.0);
      if (i == 1 && t >= 30.0 && t < 40.0) x += 20.0 * kDegree;
      if (i == 3 && t >= 60.0 && t < 62.0) x += 3.0 * std::sqrt(2.0) * std::sin(2.0 * kPi * 7.0 * t);
      log.channels[i].push_back(x);
    }
  }
  const MotionFound found = find_motion(log);
  if (found.intervals.size() != 2) return {kInfinity, 1.0};
  const MovingInterval &turn = found.intervals[0], &shake = found.intervals[1];
  Worst worst;
  worst.look(turn.channel == 1 && !turn.shakes && shake.channel == 3 && shake.shakes ? 0.0 : kInfinity, 1.0);
  worst.look(turn.from_s - 30.0, 1.0);
  worst.look(turn.to_s - 40.0, 1.0);
  worst.look(shake.from_s - 60.0, 1.0);
  worst.look(shake.to_s - 62.0, 1.0);
  // Of 100 samples, five sigma; and of ten whole windows two more may be half in it.
  worst.look(turn.amount - 20.0 * kDegree, 5.0 * 0.001 / 10.0 + 1e-3);
  worst.look(shake.amount - 3.0, 0.01);
  // Beside the degree that rest allows, four sigmas of a mean of 100.
  worst.look(turn.excess - 20.0 * kDegree / (kDegree + 4.0 * 0.001 / 10.0), 0.2);
  worst.look(found.share - 0.12, 0.011);
  return worst.figure();
}

/// A mean at the middles of a reference of another rate: linear motion is itself at any of them, to roundings; and a
/// gap of the reference has no pairs.
StressFigure pairs() {
  const auto log_of = [](double rate_hz, double from_s, double to_s, double gap_from, double gap_to, double factor) {
    ImuLog log;
    for (double k = std::ceil(from_s * rate_hz); k <= to_s * rate_hz; ++k) {
      const double t = k / rate_hz, middle = t - 0.5 / rate_hz;
      if (t > gap_from && t < gap_to) continue;
      log.t_s.push_back(t);
      for (std::size_t i = 0; i < 6; ++i)
        log.channels[i].push_back(factor * (1.0 + static_cast<double>(i)) * (middle - 3.0));
    }
    return log;
  };
  const ReferencePairs found =
      reference_pairs(log_of(100.0, 0.0, 20.0, 1e9, 0.0, 2.0), log_of(40.0, 2.0, 15.0, 7.0, 9.0, 1.0));
  Worst worst;
  std::size_t in_gap = 0;
  for (std::size_t k = 0; k < found.t_s.size(); ++k) {
    const double t = found.t_s[k];
    in_gap += t > 7.05 && t < 8.95 ? 1 : 0;
    worst.look(t >= 1.95 && t <= 15.05 ? 0.0 : kInfinity, 1.0);
    for (std::size_t triad = 0; triad < 2; ++triad)
      worst.look((found.measured[triad][k] - 2.0 * found.truth[triad][k]).norm(), 64.0 * kEpsilon * 200.0);
  }
  worst.look(in_gap == 0 && found.t_s.size() > 1000 ? 0.0 : kInfinity, 1.0);
  return worst.figure();
}

}  // namespace

std::vector<StressCase> unit_log_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "a triad's bias and gains, found again",
           "normal equations of a force far below its bias",
           "exact samples to their rounding; positions to the solver's tolerance", "of the bound"});
  for (const double size : {1e-3, 1.0, 1e3})
    rows.add("imu/calibrated_at_" + stress::text(size) + "_m_s2", [size] { return to_reference(size); });
  rows.add("imu/calibrated_by_gravity", to_gravity).add("imu/turned_log", turned_log);
  rows.of({StressGroup::kData, "what moves in a log at rest, and what its reference says",
           "means and scatters of one another's windows; a reference at another rate's stamps",
           "from and to the second, by its channel; linear motion at the middles of samples", "of the bound"});
  rows.add("imu/found_in_a_log", motion_found).add("imu/pairs_with_a_reference", pairs);
  return rows.take();
}

}  // namespace canyon::inertial

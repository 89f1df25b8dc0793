#include "canyon/inertial/calibration/log_fits.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "canyon/core/earth/gravity.h"
#include "canyon/core/process/progress.h"
#include "canyon/inertial/allan/deviation.h"
#include "canyon/inertial/calibration/resting_positions.h"

namespace canyon::inertial {
namespace {

constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

Status need_all_channels(const NamedLog& named) {
  for (int c = 0; c < 6; ++c)
    if (named.log.channels[static_cast<std::size_t>(c)].empty())
      return Error{named.path, 0, "", std::string("no ") + kChannelNames[c], "all six channels"};
  return Ok{};
}

/// A unit whose noise is that of the segments of `log`, which is what the file holds or what a fit left of it.
Result<FittedUnit> unit_of(const std::string& path, const ImuLog& log, const Sampling& sampling) {
  FittedUnit unit;
  CANYON_TRY(unit.noise, log_noise(log, sampling, {}));
  unit.log = file_name(path);
  unit.name = std::filesystem::path(path).stem().string();
  unit.rate_hz = 1.0 / sampling.interval_s;
  for (const Segment& s : sampling.segments)
    unit.duration_s += static_cast<double>(s.end - s.begin) * sampling.interval_s;
  return unit;
}

/// How well a position's mean is known shows where it is halved.
double sigma_of_means(const ImuLog& log, const std::vector<RestingPosition>& positions) {
  double square = 0.0;
  for (const auto& p : positions) {
    Eigen::Vector3d difference = Eigen::Vector3d::Zero();
    const std::size_t half = (p.end - p.begin) / 2;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = 0; k < half; ++k)
        difference[static_cast<Eigen::Index>(axis)] +=
            (log.channels[3 + axis][p.begin + k] - log.channels[3 + axis][p.begin + half + k]) /
            static_cast<double>(half);
    square += difference.squaredNorm() / 3.0 / 4.0;
  }
  return positions.empty() ? 1.0 : std::sqrt(square / static_cast<double>(positions.size()));
}

/// The gyroscope's bias from the same positions.
TriadCalibration resting_gyroscope(const std::vector<RestingPosition>& positions) {
  TriadCalibration gyro;
  const auto n = static_cast<double>(positions.size());
  for (const auto& p : positions) gyro.bias += p.rate / n;
  for (const auto& p : positions) {
    gyro.uncalibrated_rms += p.rate.squaredNorm() / (3.0 * n);
    gyro.residual_rms += (p.rate - gyro.bias).squaredNorm() / (3.0 * n);
  }
  gyro.uncalibrated_rms = std::sqrt(gyro.uncalibrated_rms);
  gyro.residual_rms = std::sqrt(gyro.residual_rms);
  // The Earth's rate turns with the positions and averages out of them only roughly: it is what is not known.
  gyro.bias_sigma.setConstant(gyro.residual_rms / std::sqrt(n));
  gyro.used = positions.size();
  return gyro;
}

LocalGravity gravity_of(const char* format, double m_s2) {
  char text[80];
  std::snprintf(text, sizeof text, format, m_s2);
  return {m_s2, text};
}

}  // namespace

LocalGravity given_gravity(double m_s2) {
  return gravity_of("gravity given as %.6g m/s^2", m_s2);
}

LocalGravity gravity_at(const Geodetic& place) {
  return gravity_of("WGS84 normal gravity there, %.6g m/s^2", gravity_E(ecef_from_geodetic(place)).norm());
}

ReferencePairs reference_pairs(const ImuLog& log, const ImuLog& truth) {
  const double log_s = sampling_of(log.t_s).interval_s, truth_s = sampling_of(truth.t_s).interval_s;
  const double later_s = 0.5 * (truth_s - log_s);
  ReferencePairs out;
  std::size_t j = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    const double t = log.t_s[k] + later_s;
    if (t < truth.t_s.front() || t > truth.t_s.back()) continue;
    while (j + 2 < truth.size() && truth.t_s[j + 1] <= t) ++j;
    const double width_s = truth.t_s[j + 1] - truth.t_s[j];
    if (width_s > 1.5 * truth_s) continue;
    const double share = (t - truth.t_s[j]) / width_s;
    out.t_s.push_back(log.t_s[k]);
    for (std::size_t triad = 0; triad < 2; ++triad) {
      Eigen::Vector3d measured, expected;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<Eigen::Index>(axis);
        const auto& x = truth.channels[3 * triad + axis];
        measured[i] = log.channels[3 * triad + axis][k];
        expected[i] = (1.0 - share) * x[j] + share * x[j + 1];
      }
      out.measured[triad].push_back(measured);
      out.truth[triad].push_back(expected);
    }
  }
  return out;
}

Result<FittedUnit> fit_at_rest(const NamedLog& named, const LocalGravity& gravity) {
  const ImuLog& log = named.log;
  if (log.channels[3].empty())
    return Error{named.path, 0, "", "no accelerometer",
                 "its three channels, and those of the gyroscope if there is one"};
  CANYON_TRY(FittedUnit unit, unit_of(named.path, log, sampling_of(log.t_s)));
  if (!log.channels[0].empty()) unit.bias[0] = resting_rate(log) / std::sqrt(3.0);
  unit.bias[1] = resting_force_error(log, gravity.m_s2);
  unit.bias_source = {"mean rate of " + unit.log + ", the Earth's in it, root mean square of the axes",
                      "mean specific force of " + unit.log + " against " + gravity.source + ": along the vertical"};
  return unit;
}

Result<FittedUnit> fit_to_truth(const NamedLog& log, const NamedLog& truth) {
  CANYON_TRY_STATUS(need_all_channels(log));
  CANYON_TRY_STATUS(need_all_channels(truth));
  const ReferencePairs pairs = reference_pairs(log.log, truth.log);
  std::array<TriadCalibration, 2> found;
  ImuLog rest;  // what the calibration leaves: the unit's noise, and the reference's
  rest.t_s = pairs.t_s;
  for (std::size_t triad = 0; triad < 2; ++triad) {
    const auto calibration = fit_to_reference(pairs.measured[triad], pairs.truth[triad]);
    if (!calibration) {
      Error error = calibration.error();
      error.file = truth.path;
      error.key = triad == 0 ? "gyroscope" : "accelerometer";
      return error;
    }
    found[triad] = *calibration;
    for (std::size_t k = 0; k < pairs.t_s.size(); ++k) {
      if (k % kSamplesPerLook == 0) throw_if_cancelled();
      const Eigen::Vector3d left = found[triad].corrected(pairs.measured[triad][k]) - pairs.truth[triad][k];
      for (std::size_t axis = 0; axis < 3; ++axis)
        rest.channels[3 * triad + axis].push_back(left[static_cast<Eigen::Index>(axis)]);
    }
  }
  CANYON_TRY(FittedUnit unit, unit_of(log.path, rest, sampling_of(rest.t_s)));
  for (std::size_t triad = 0; triad < 2; ++triad)
    take_calibration(unit, triad, found[triad],
                     "found in " + unit.log + " against the reference " + file_name(truth.path));
  return unit;
}

Result<FittedUnit> fit_to_positions(const NamedLog& named, const LocalGravity& gravity) {
  CANYON_TRY_STATUS(need_all_channels(named));
  const ImuLog& log = named.log;
  const auto positions = resting_positions(log);
  std::vector<Eigen::Vector3d> forces;
  for (const auto& p : positions) forces.push_back(p.force);
  const auto accel = fit_to_gravity(forces, std::max(sigma_of_means(log, positions), 1e-9), gravity.m_s2);
  if (!accel) {
    Error error = accel.error();
    error.file = named.path;
    return error;
  }
  // The noise is that of the rests.
  Sampling rests = sampling_of(log.t_s);
  rests.segments.clear();
  for (const auto& p : positions) rests.segments.push_back({p.begin, p.end});
  CANYON_TRY(FittedUnit unit, unit_of(named.path, log, rests));
  const std::string where = "found from " + std::to_string(positions.size()) + " resting positions in " + unit.log;
  take_calibration(unit, 0, resting_gyroscope(positions), where);
  take_calibration(unit, 1, *accel, where + " against " + gravity.source);
  return unit;
}

}  // namespace canyon::inertial

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/json.h"
#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/gnss_setup.h"
#include "canyon/apps/options/imu_log_options.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/files/files.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/inertial/allan/deviation.h"
#include "canyon/inertial/calibration/fitted_entry.h"
#include "canyon/inertial/calibration/resting_positions.h"

namespace canyon::apps {

namespace {

using inertial::TriadCalibration;

constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop

struct Options {
  CommonOptions common;
  ImuLogOptions log;
  std::string truth, truth_columns, at, name, out;
  double gravity_m_s2 = 0.0;
  bool at_rest = false, positions = false, force = false;
};

/// What one of the ways found, and the catalogue entry made of it.
struct Outcome {
  inertial::FittedUnit unit;
  std::string toml;
};

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

Status need_all_channels(const inertial::ImuLog& log, const std::string& path) {
  for (int c = 0; c < 6; ++c)
    if (log.channels[static_cast<std::size_t>(c)].empty())
      return Error{path, 0, "", std::string("no ") + inertial::kChannelNames[c], "all six channels"};
  return Ok{};
}

/// What the accelerometer is compared with, and how that is known.
struct LocalGravity {
  double m_s2 = kStandardGravity;
  std::string source;
};
Result<LocalGravity> gravity_of(const Options& options) {
  char text[80];
  if (options.gravity_m_s2 > 0.0) {
    std::snprintf(text, sizeof text, "gravity given as %.6g m/s^2", options.gravity_m_s2);
    return LocalGravity{options.gravity_m_s2, text};
  }
  if (options.at.empty()) return LocalGravity{kStandardGravity, "standard gravity, 9.80665 m/s^2"};
  CANYON_TRY(const Geodetic at, parse_place(options.at, "--at"));
  const double g = gravity_E(ecef_from_geodetic(at)).norm();
  std::snprintf(text, sizeof text, "WGS84 normal gravity there, %.6g m/s^2", g);
  return LocalGravity{g, text};
}

/// A unit whose log's noise is that of `sampling`'s segments.
Result<inertial::FittedUnit> unit_of(const Options& options, const inertial::ImuLog& log,
                                     const inertial::Sampling& sampling) {
  inertial::FittedUnit unit;
  CANYON_TRY(unit.noise, inertial::log_noise(log, sampling, {}));
  unit.log = file_name(options.log.log);
  unit.name = options.name.empty() ? std::filesystem::path(options.log.log).stem().string() : options.name;
  unit.rate_hz = 1.0 / sampling.interval_s;
  for (const inertial::Segment& s : sampling.segments)
    unit.duration_s += static_cast<double>(s.end - s.begin) * sampling.interval_s;
  return unit;
}

Result<Outcome> fit_at_rest(const Options& options, const inertial::ImuLog& log) {
  if (log.channels[3].empty())
    return Error{options.log.log, 0, "", "no accelerometer",
                 "its three channels, and those of the gyroscope if there is one"};
  CANYON_TRY(const LocalGravity gravity, gravity_of(options));
  Outcome out;
  CANYON_TRY(out.unit, unit_of(options, log, inertial::sampling_of(log.t_s)));
  if (!log.channels[0].empty()) out.unit.bias[0] = inertial::resting_rate(log) / std::sqrt(3.0);
  out.unit.bias[1] = inertial::resting_force_error(log, gravity.m_s2);
  out.unit.bias_source = {
      "mean rate of " + out.unit.log + ", the Earth's in it, root mean square of the axes",
      "mean specific force of " + out.unit.log + " against " + gravity.source + ": along the vertical"};
  return out;
}

/// Samples of the log and what the reference says at their times. Both hold means over the interval that ends at the
/// stamp, so a reference at another rate belongs to other middles; it is interpolated there, but not across its gaps.
struct Pairs {
  std::array<std::vector<Eigen::Vector3d>, 2> measured, truth;
  std::vector<double> t_s;
};
Pairs pairs_of(const inertial::ImuLog& log, const inertial::ImuLog& truth) {
  const double log_s = inertial::sampling_of(log.t_s).interval_s, truth_s = inertial::sampling_of(truth.t_s).interval_s;
  const double later_s = 0.5 * (truth_s - log_s);
  Pairs out;
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

Result<Outcome> fit_to_truth(const Options& options, const inertial::ImuLog& log) {
  CANYON_TRY_STATUS(need_all_channels(log, options.log.log));
  CANYON_TRY(const inertial::ImuLog truth,
             inertial::read_imu_log(options.truth,
                                    {.columns = options.truth_columns, .rate_hz = options.log.rate_hz, .live = false}));
  CANYON_TRY_STATUS(need_all_channels(truth, options.truth));
  tell_doubts(truth);
  const Pairs pairs = pairs_of(log, truth);
  std::array<TriadCalibration, 2> found;
  inertial::ImuLog rest;  // what the calibration leaves: the unit's noise, and the reference's
  rest.t_s = pairs.t_s;
  for (std::size_t triad = 0; triad < 2; ++triad) {
    const auto calibration = inertial::fit_to_reference(pairs.measured[triad], pairs.truth[triad]);
    if (!calibration) {
      Error error = calibration.error();
      error.file = options.truth;
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
  Outcome out;
  CANYON_TRY(out.unit, unit_of(options, rest, inertial::sampling_of(rest.t_s)));
  for (std::size_t triad = 0; triad < 2; ++triad)
    inertial::take_calibration(out.unit, triad, found[triad],
                               "found in " + out.unit.log + " against the reference " + file_name(options.truth));
  return out;
}

/// How well a position's mean is known shows where it is halved.
double sigma_of_means(const inertial::ImuLog& log, const std::vector<inertial::RestingPosition>& positions) {
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
TriadCalibration resting_gyroscope(const std::vector<inertial::RestingPosition>& positions) {
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

Result<Outcome> fit_to_positions(const Options& options, const inertial::ImuLog& log) {
  CANYON_TRY_STATUS(need_all_channels(log, options.log.log));
  CANYON_TRY(const LocalGravity gravity, gravity_of(options));
  const auto positions = inertial::resting_positions(log);
  std::vector<Eigen::Vector3d> forces;
  for (const auto& p : positions) forces.push_back(p.force);
  const auto accel = inertial::fit_to_gravity(forces, std::max(sigma_of_means(log, positions), 1e-9), gravity.m_s2);
  if (!accel) {
    Error error = accel.error();
    error.file = options.log.log;
    return error;
  }
  // The noise is that of the rests.
  inertial::Sampling rests = inertial::sampling_of(log.t_s);
  rests.segments.clear();
  for (const auto& p : positions) rests.segments.push_back({p.begin, p.end});
  Outcome out;
  CANYON_TRY(out.unit, unit_of(options, log, rests));
  const std::string where = "found from " + std::to_string(positions.size()) + " resting positions in " + out.unit.log;
  inertial::take_calibration(out.unit, 0, resting_gyroscope(positions), where);
  inertial::take_calibration(out.unit, 1, *accel, where + " against " + gravity.source);
  return out;
}

Json json_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
Json json_of(const Eigen::Matrix3d& m) {
  Json out = Json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.push_back(m(row, column));
  return out;
}
Json json_of(const TriadCalibration& c) {
  return {{"bias", json_of(c.bias)},
          {"bias_sigma", json_of(c.bias_sigma)},
          {"gain", json_of(c.gain)},
          {"gain_sigma", json_of(c.gain_sigma)},
          {"residual_rms", c.residual_rms},
          {"uncalibrated_rms", c.uncalibrated_rms},
          {"used", c.used}};
}

void print_triad(const char* name, const TriadCalibration& c, double unit, const char* unit_name) {
  std::printf("%s, from %zu\n  bias, %s:", name, c.used, unit_name);
  for (int i = 0; i < 3; ++i) std::printf("  %.4g +- %.2g", c.bias[i] / unit, c.bias_sigma[i] / unit);
  if (!c.gain.isZero(0.0)) {
    std::printf("\n  scale, ppm:");
    for (int i = 0; i < 3; ++i) std::printf("  %.5g +- %.2g", 1e6 * c.gain(i, i), 1e6 * c.gain_sigma(i, i));
    std::printf("\n  misalignment, mrad:");
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        if (row != column && c.gain_sigma(row, column) > 0.0)
          std::printf("  %c%c %.4g +- %.2g", "xyz"[row], "xyz"[column], 1e3 * c.gain(row, column),
                      1e3 * c.gain_sigma(row, column));
  }
  std::printf("\n  left over: %.3g %s, without calibration %.3g\n", c.residual_rms / unit, unit_name,
              c.uncalibrated_rms / unit);
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  OutputSet outputs(options.force);
  CANYON_TRY(StagedFile* const entry, outputs.file(options.out));
  CANYON_TRY(const inertial::ImuLog log, read_log(options.log, options.at_rest));
  tell_doubts(log);
  if (options.at_rest) tell_motion(options.log.log, inertial::find_motion(log));
  CANYON_TRY(Outcome found, options.at_rest     ? fit_at_rest(options, log)
                            : options.positions ? fit_to_positions(options, log)
                                                : fit_to_truth(options, log));
  CANYON_TRY(found.toml, inertial::catalogue_toml(found.unit));
  const auto& [gyro, accel] = found.unit.calibration;
  if (options.truth.empty() && options.at.empty() && options.gravity_m_s2 == 0.0)
    std::fprintf(stderr,
                 "note: gravity is taken as 9.80665 m/s^2; it differs by up to 0.03 from place to place: --at or "
                 "--gravity\n");
  if (entry != nullptr) CANYON_TRY_STATUS(entry->write(found.toml));
  CANYON_TRY_STATUS(outputs.commit());
  if (options.common.json) {
    Json out = {{"entry", found.toml}};
    if (gyro) out["gyro"] = json_of(*gyro);
    if (accel) out["accel"] = json_of(*accel);
    std::printf("%s\n", out.dump().c_str());
    return 0;
  }
  if (gyro) print_triad("Gyroscope", *gyro, kDegree / kHour, "deg/h");
  if (accel) print_triad("Accelerometer", *accel, kMilliG, "mg");
  if (entry == nullptr)
    std::printf("%s", found.toml.c_str());
  else
    std::printf("Entry: %s\n", entry->final_path().c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  declare_imu_log(arguments, options->log);
  Arguments ways = arguments.one_of("method");
  ways.flag("--static", options->at_rest, "the unit rests: noise and bias");
  ways.flag("--positions", options->positions,
            "the unit rests in nine or more positions: bias, scale and misalignment of the accelerometer against "
            "gravity, bias of the gyroscope");
  ways.option("--truth", options->truth,
              "log of a reference beside it, true rates or increments at the same times: bias, scale, misalignment");
  arguments.option("--truth-columns", options->truth_columns, "as --columns, of the reference");
  const auto at =
      arguments.option("--at", options->at, "LAT,LON,H of the log: normal gravity there; degrees, ellipsoidal metres");
  arguments.option("--gravity", options->gravity_m_s2, "local gravity, m/s^2; without it and --at standard gravity")
      .within(9.7, 9.9)
      .excludes(at);
  arguments.option("--name", options->name, "of the entry; default: the log's");
  arguments.option("--out", options->out, "file for the entry, which [imu] sensor and --sensor take: mine.toml");
  arguments.flag("--force", options->force, "replace an existing --out");
  return [options]() -> Result<int> { return run(*options); };
}

}  // namespace

Verb imu_fit_verb() {
  return {"imu fit", "figures of your own sensor, from its log", "canyon imu fit static.csv --static --out mine.toml",
          declare};
}

}  // namespace canyon::apps

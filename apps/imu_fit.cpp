#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "apps/imu_log_options.h"
#include "apps/json.h"
#include "apps/verb.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/units.h"
#include "inertial/calibration/fitted_entry.h"
#include "inertial/calibration/resting_positions.h"

namespace canyon::apps {

namespace {

using inertial::TriadCalibration;

struct Options {
  CommonOptions common;
  ImuLogOptions log;
  std::string truth, truth_columns, name, out;
  double gravity_m_s2 = kStandardGravity;
  bool at_rest = false, positions = false, force = false;
};

/// What one of the ways found; the entry only where noise could be fitted.
struct Outcome {
  inertial::FittedUnit unit;
  std::array<std::optional<TriadCalibration>, 2> calibration{};
  std::string toml;
};

Status need_all_channels(const inertial::ImuLog& log, const std::string& path) {
  for (int c = 0; c < 6; ++c)
    if (log.channels[static_cast<std::size_t>(c)].empty())
      return Error{path, 0, "", std::string("no ") + inertial::kChannelNames[c], "all six channels"};
  return Ok{};
}

Result<Outcome> fit_at_rest(const Options& options, const inertial::ImuLog& log) {
  if (log.channels[3].empty())
    return Error{options.log.log, 0, "", "no accelerometer",
                 "its three channels, and those of the gyroscope if there is one"};
  Outcome out;
  const auto sampling = inertial::sampling_of(log.t_s);
  CANYON_TRY(out.unit.noise, inertial::log_noise(log, sampling, {}));
  out.unit.log = std::filesystem::path(options.log.log).filename().string();
  out.unit.name = options.name.empty() ? std::filesystem::path(options.log.log).stem().string() : options.name;
  out.unit.duration_s = log.t_s.back() - log.t_s.front();
  out.unit.rate_hz = 1.0 / sampling.interval_s;
  if (!log.channels[0].empty()) out.unit.bias[0] = inertial::resting_rate(log) / std::sqrt(3.0);
  out.unit.bias[1] = inertial::resting_force_error(log, options.gravity_m_s2);
  out.unit.bias_source = {"mean rate of " + out.unit.log + ", the Earth's in it, root mean square of the axes",
                          "mean specific force of " + out.unit.log + " against gravity: along the vertical"};
  CANYON_TRY(out.toml, inertial::catalogue_toml(out.unit));
  return out;
}

/// Samples of the log at whose times the reference has one too, to a tenth of the interval; a reference at another rate
/// is interpolated.
struct Pairs {
  std::array<std::vector<Eigen::Vector3d>, 2> measured, truth;
};
Pairs pairs_of(const inertial::ImuLog& log, const inertial::ImuLog& truth) {
  Pairs out;
  std::size_t j = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    const double t = log.t_s[k];
    if (t < truth.t_s.front() || t > truth.t_s.back()) continue;
    while (j + 2 < truth.size() && truth.t_s[j + 1] <= t) ++j;
    const double share = (t - truth.t_s[j]) / (truth.t_s[j + 1] - truth.t_s[j]);
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
  const Pairs pairs = pairs_of(log, truth);
  Outcome out;
  for (std::size_t triad = 0; triad < 2; ++triad) {
    const auto found = inertial::fit_to_reference(pairs.measured[triad], pairs.truth[triad]);
    if (!found) {
      Error error = found.error();
      error.file = options.truth;
      error.key = triad == 0 ? "gyroscope" : "accelerometer";
      return error;
    }
    out.calibration[triad] = *found;
  }
  return out;
}

Result<Outcome> fit_to_positions(const Options& options, const inertial::ImuLog& log) {
  CANYON_TRY_STATUS(need_all_channels(log, options.log.log));
  const auto positions = inertial::resting_positions(log);
  std::vector<Eigen::Vector3d> forces;
  TriadCalibration gyro;
  for (const auto& p : positions) {
    forces.push_back(p.force);
    gyro.bias += p.rate / static_cast<double>(positions.size());
  }
  // How well a mean is known shows where one position is halved.
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
  const double sigma = positions.empty() ? 1.0 : std::sqrt(square / static_cast<double>(positions.size()));
  const auto accel = inertial::fit_to_gravity(forces, std::max(sigma, 1e-9), options.gravity_m_s2);
  if (!accel) {
    Error error = accel.error();
    error.file = options.log.log;
    return error;
  }
  for (const auto& p : positions) {
    gyro.uncalibrated_rms += p.rate.squaredNorm() / (3.0 * static_cast<double>(positions.size()));
    gyro.residual_rms += (p.rate - gyro.bias).squaredNorm() / (3.0 * static_cast<double>(positions.size()));
  }
  gyro.uncalibrated_rms = std::sqrt(gyro.uncalibrated_rms);
  gyro.residual_rms = std::sqrt(gyro.residual_rms);
  // The Earth's rate turns with the positions and averages out of them only roughly: it is what is not known.
  gyro.bias_sigma.setConstant(gyro.residual_rms / std::sqrt(static_cast<double>(positions.size())));
  gyro.used = positions.size();
  Outcome out;
  out.calibration = {gyro, *accel};
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

Status write_entry(const std::string& path, const std::string& toml, bool force) {
  if (!force && std::filesystem::exists(path)) return Error{path, 0, "", "exists", "another --out, or --force"};
  return write_text_file(path, toml);
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  if (!options.out.empty() && !options.at_rest)
    return Error{"--out", 0, "", "there is an entry to write only with --static", "--static"};
  CANYON_TRY(const inertial::ImuLog log, read_log(options.log, options.at_rest));
  CANYON_TRY(const Outcome found, options.at_rest     ? fit_at_rest(options, log)
                                  : options.positions ? fit_to_positions(options, log)
                                                      : fit_to_truth(options, log));
  if (!options.out.empty()) CANYON_TRY_STATUS(write_entry(options.out, found.toml, options.force));
  if (options.common.json) {
    Json out = Json::object();
    if (options.at_rest) out["entry"] = found.toml;
    if (found.calibration[0]) out["gyro"] = json_of(*found.calibration[0]);
    if (found.calibration[1]) out["accel"] = json_of(*found.calibration[1]);
    std::printf("%s\n", out.dump().c_str());
    return 0;
  }
  if (options.at_rest && options.out.empty()) std::printf("%s", found.toml.c_str());
  if (!options.out.empty()) std::printf("Entry: %s\n", options.out.c_str());
  if (found.calibration[0]) print_triad("Gyroscope", *found.calibration[0], kDegree / kHour, "deg/h");
  if (found.calibration[1]) print_triad("Accelerometer", *found.calibration[1], kMilliG, "mg");
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  declare_imu_log(arguments, options->log);
  Arguments ways = arguments.one_of("way");
  ways.flag("--static", options->at_rest, "the unit rests: noise and bias, as a catalogue entry");
  ways.flag("--positions", options->positions,
            "the unit rests in nine or more positions: bias, scale and misalignment of the accelerometer against "
            "gravity, bias of the gyroscope");
  ways.option("--truth", options->truth,
              "log of a reference beside it, true rates or increments at the same times: bias, scale, misalignment");
  arguments.option("--truth-columns", options->truth_columns, "as --columns, of the reference");
  arguments.option("--gravity", options->gravity_m_s2, "local gravity, m/s^2").within(9.7, 9.9).default_shown();
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

#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/gnss_setup.h"
#include "canyon/apps/options/imu_log_options.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/inertial/calibration/log_fits.h"

namespace canyon::apps {

namespace {

using inertial::TriadCalibration;

struct Options {
  CommonOptions common;
  ImuLogOptions log;
  std::string truth, truth_columns, at, name, out;
  double gravity_m_s2 = 0.0;
  bool at_rest = false, positions = false, force = false;
};

Result<inertial::LocalGravity> gravity_of(const Options& options) {
  if (options.gravity_m_s2 > 0.0) return inertial::given_gravity(options.gravity_m_s2);
  if (options.at.empty()) return inertial::LocalGravity{};
  CANYON_TRY(const Geodetic at, parse_place(options.at, "--at"));
  return inertial::gravity_at(at);
}

Result<inertial::FittedUnit> fit(const Options& options, const inertial::NamedLog& log) {
  if (!options.truth.empty()) {
    inertial::NamedLog truth{{}, options.truth};
    CANYON_TRY(truth.log, read_log({options.truth, options.truth_columns, options.log.rate_hz}, false));
    tell_doubts(truth.log);
    return inertial::fit_to_truth(log, truth);
  }
  CANYON_TRY(const inertial::LocalGravity gravity, gravity_of(options));
  return options.at_rest ? inertial::fit_at_rest(log, gravity) : inertial::fit_to_positions(log, gravity);
}

Json json_of(const TriadCalibration& c) {
  return {{"bias", vector_json(c.bias)},
          {"bias_sigma", vector_json(c.bias_sigma)},
          {"gain", matrix_json(c.gain)},
          {"gain_sigma", matrix_json(c.gain_sigma)},
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
  inertial::NamedLog log{{}, options.log.log};
  CANYON_TRY(log.log, read_log(options.log, options.at_rest));
  tell_doubts(log.log);
  if (options.at_rest) tell_motion(log.path, inertial::find_motion(log.log));
  CANYON_TRY(inertial::FittedUnit unit, fit(options, log));
  if (!options.name.empty()) unit.name = options.name;
  CANYON_TRY(const std::string toml, inertial::catalogue_toml(unit));
  const auto& [gyro, accel] = unit.calibration;
  if (options.truth.empty() && options.at.empty() && options.gravity_m_s2 == 0.0)
    std::fprintf(stderr,
                 "note: gravity is taken as 9.80665 m/s^2; it differs by up to 0.03 from place to place: --at or "
                 "--gravity\n");
  if (entry != nullptr) CANYON_TRY_STATUS(entry->write(toml));
  CANYON_TRY_STATUS(outputs.commit());
  if (options.common.json) {
    Json out = {{"entry", toml}};
    if (gyro) out["gyro"] = json_of(*gyro);
    if (accel) out["accel"] = json_of(*accel);
    std::printf("%s\n", json_text(out).c_str());
    return 0;
  }
  if (gyro) print_triad("Gyroscope", *gyro, kDegree / kHour, "deg/h");
  if (accel) print_triad("Accelerometer", *accel, kMilliG, "mg");
  if (entry == nullptr)
    std::printf("%s", toml.c_str());
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

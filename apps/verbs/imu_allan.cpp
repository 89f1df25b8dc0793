#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/json.h"
#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/imu_log_options.h"
#include "canyon/core/files/files.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/report/draw/deviation_plot.h"

namespace canyon::apps {

namespace {

using inertial::ChannelNoise;
using inertial::DeviationPoint;
using inertial::kChannelNames;

struct Options {
  CommonOptions common;
  ImuLogOptions log;
  std::string kinds, processes, out;
  int per_octave = 4;
  double confidence_percent = 95.0;
  bool force = false;
};

/// What was found.
struct Analysis {
  inertial::ImuLog log;
  inertial::Sampling sampling;
  inertial::MotionFound motion;  ///< of a log that ought to rest
  std::vector<ChannelNoise> channels;
  std::vector<std::string> kinds;                              ///< beside overlapping
  std::vector<std::vector<std::vector<DeviationPoint>>> more;  ///< [channel][kind]

  double duration_s() const { return log.t_s.back() - log.t_s.front() + sampling.interval_s; }
};

/// The names of a comma-separated list, each of which must be known.
Result<std::vector<std::string>> known_names(const std::string& list, const char* option,
                                             const std::vector<std::string>& known) {
  std::vector<std::string> names;
  if (list.empty()) return names;
  for (const std::string& name : split_list(list)) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      std::string all;
      for (const std::string& k : known) all += (all.empty() ? "of " : ", ") + k;
      return Error{option, 0, "", "\"" + name + "\" is none", all};
    }
    names.push_back(name);
  }
  return names;
}

Result<Analysis> analyse(const Options& options) {
  Analysis a;
  CANYON_TRY(a.kinds, known_names(options.kinds, "--kind", inertial::deviation_kinds()));
  CANYON_TRY(const auto processes, known_names(options.processes, "--processes", inertial::noise_process_names()));
  a.kinds.erase(std::remove(a.kinds.begin(), a.kinds.end(), "overlapping"), a.kinds.end());
  CANYON_TRY(a.log, read_log(options.log, true));
  a.sampling = inertial::sampling_of(a.log.t_s);
  a.motion = inertial::find_motion(a.log);
  const double confidence = options.confidence_percent / 100.0;
  CANYON_TRY(a.channels,
             inertial::log_noise(a.log, a.sampling,
                                 {.per_octave = options.per_octave, .confidence = confidence, .processes = processes}));
  const auto factors = inertial::averaging_factors(static_cast<std::int64_t>(a.log.size()), options.per_octave);
  for (const ChannelNoise& c : a.channels) {
    a.more.emplace_back();
    for (const std::string& kind : a.kinds)
      a.more.back().push_back(inertial::deviation(kind, a.log.channels[static_cast<std::size_t>(c.channel)], a.sampling,
                                                  factors, confidence));
  }
  return a;
}

Json json_of(const std::vector<DeviationPoint>& points, const char* name) {
  Json tau = Json::array(), value = Json::array(), low = Json::array(), high = Json::array();
  for (const DeviationPoint& p : points) {
    tau.push_back(p.tau_s);
    value.push_back(or_null(p.deviation));
    low.push_back(or_null(p.low));
    high.push_back(or_null(p.high));
  }
  const std::string key = name;
  return {{"tau_s", tau}, {key, value}, {key + "_low", low}, {key + "_high", high}};
}

/// What the second parameter of a process is; null where it has none.
const char* second_name(const std::string& process) {
  if (process == "white") return "neighbour_correlation";
  if (process == "gauss_markov") return "correlation_time_s";
  return process.ends_with("sinusoid") ? "frequency_hz" : nullptr;
}

Json json_of(const inertial::NoiseFit& fit) {
  Json out = Json::object();
  for (const inertial::FittedTerm& t : fit.terms) {
    Json& term = out[t.name];
    term = {{"value", t.determined ? Json(t.value) : Json(nullptr)},
            {"sigma", or_null(t.sigma)},
            {"determined", t.determined}};
    const char* second = second_name(t.name);
    if (!second) continue;
    term[second] = t.determined ? Json(t.second) : Json(nullptr);
    term[std::string(second) + "_sigma"] = t.determined ? or_null(t.second_sigma) : Json(nullptr);
  }
  out["chi_square_per_dof"] = fit.chi_square_per_dof;
  return out;
}

Json json_of(const Analysis& a, const Options& options) {
  Json out = {{"samples", a.log.size()},
              {"duration_s", a.duration_s()},
              {"interval_s", a.sampling.interval_s},
              {"jitter_s", a.sampling.jitter_s},
              {"gaps", a.sampling.segments.size() - 1},
              {"confidence", options.confidence_percent / 100.0}};
  Json moves = Json::array();
  for (const inertial::MovingInterval& m : a.motion.intervals)
    moves.push_back({{"from_s", m.from_s},
                     {"to_s", m.to_s},
                     {"channel", kChannelNames[m.channel]},
                     {"kind", m.shakes ? "scatter" : "mean"},
                     {"amount", m.amount},
                     {"unit", channel_unit(m.channel)}});
  out["moving_share"] = a.motion.share;
  out["moves"] = moves;
  Json axes = Json::object();
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    const ChannelNoise& c = a.channels[i];
    Json axis = json_of(c.points, "adev");
    axis["unit"] = channel_unit(c.channel);
    axis["fit"] = json_of(c.fit);
    for (std::size_t k = 0; k < a.kinds.size(); ++k) axis[a.kinds[k]] = json_of(a.more[i][k], "deviation");
    axes[kChannelNames[c.channel]] = axis;
  }
  out["axes"] = axes;
  return out;
}

std::string csv_of(const Analysis& a) {
  std::string out = "axis,kind,tau_s,samples,deviation,low,high,degrees_of_freedom,fit,unit\n";
  char line[240];
  const auto add = [&](const ChannelNoise& c, const std::string& kind, const DeviationPoint& p, bool fitted) {
    std::snprintf(line, sizeof line, "%s,%s,%.9g,%lld,%.9g,%.9g,%.9g,%.4g,", kChannelNames[c.channel], kind.c_str(),
                  p.tau_s, static_cast<long long>(p.m), p.deviation, p.low, p.high, p.edf);
    out += line;
    if (fitted) {
      std::snprintf(line, sizeof line, "%.9g", c.fit.deviation_at(p.tau_s));
      out += line;
    }
    out += std::string(",") + channel_unit(c.channel) + "\n";
  };
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    for (const DeviationPoint& p : a.channels[i].points) add(a.channels[i], "overlapping", p, true);
    for (std::size_t k = 0; k < a.kinds.size(); ++k)
      for (const DeviationPoint& p : a.more[i][k]) add(a.channels[i], a.kinds[k], p, false);
  }
  return out;
}

/// In the units that people speak in.
report::DeviationPanel panel_of(const Analysis& a, bool gyro) {
  const double unit = gyro ? kDegree / kHour : kMilliG;
  report::DeviationPanel panel{gyro ? "Gyroscope" : "Accelerometer", gyro ? "°/h" : "mg", {}};
  for (const ChannelNoise& c : a.channels) {
    if ((c.channel < 3) != gyro) continue;
    report::DeviationCurve curve{kChannelNames[c.channel], {}, {}, {}, {}, {}};
    for (const DeviationPoint& p : c.points) {
      curve.tau_s.push_back(p.tau_s);
      curve.deviation.push_back(p.deviation / unit);
      curve.low.push_back(p.low / unit);
      curve.high.push_back(p.high / unit);
      curve.fit.push_back(c.fit.deviation_at(p.tau_s) / unit);
    }
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

std::string subtitle_of(const Analysis& a, const Options& options) {
  char text[160];
  std::snprintf(text, sizeof text, "%.0f s at %.2f Hz, %zu gaps; points: measured, band: %g %%, line: fitted processes",
                a.duration_s(), 1.0 / a.sampling.interval_s, a.sampling.segments.size() - 1,
                options.confidence_percent);
  return text;
}

Status write_files(const Analysis& a, const Options& options) {
  CANYON_TRY(auto staged, StagedDirectory::create(options.out, options.force));
  std::vector<report::DeviationPanel> panels;
  for (const bool gyro : {true, false})
    if (auto panel = panel_of(a, gyro); !panel.curves.empty()) panels.push_back(std::move(panel));
  const std::string folder = staged.staging_path();
  const std::string title = "Allan deviation of " + std::filesystem::path(options.log.log).filename().string();
  CANYON_TRY_STATUS(write_text_file(folder + "/allan.csv", csv_of(a)));
  CANYON_TRY_STATUS(write_text_file(folder + "/allan.json", json_of(a, options).dump(1) + "\n"));
  CANYON_TRY_STATUS(
      write_text_file(folder + "/allan.svg", report::deviation_plot_svg(title, subtitle_of(a, options), panels)));
  return staged.commit();
}

/// One process in the units that people speak in: name, factor from SI, unit.
struct Spoken {
  const char* process;
  double gyro;
  const char* gyro_unit;
  double accel;
  const char* accel_unit;
};
const double kRootHour = 60.0;
const Spoken kSpoken[] = {
    {"quantization", 3600.0 / kDegree, "arcsec", 1e3, "mm/s"},
    {"white", kRootHour / kDegree, "deg/sqrt(h)", kRootHour, "m/s/sqrt(h)"},
    {"bias_instability", kHour / kDegree, "deg/h", 1e3 / kMilliG, "ug"},
    {"rate_random_walk", kHour* kRootHour / kDegree, "deg/h/sqrt(h)", 1e3 * kRootHour / kMilliG, "ug/sqrt(h)"},
    {"ramp", kHour* kHour / kDegree, "deg/h/h", 1e3 * kHour / kMilliG, "ug/h"},
    {"gauss_markov", kHour / kDegree, "deg/h", 1e3 / kMilliG, "ug"},
    {"sinusoid", kHour / kDegree, "deg/h", 1e3 / kMilliG, "ug"},
    {"second_sinusoid", kHour / kDegree, "deg/h", 1e3 / kMilliG, "ug"},
    {"third_sinusoid", kHour / kDegree, "deg/h", 1e3 / kMilliG, "ug"},
};

void print_fit(const ChannelNoise& c) {
  const bool gyro = c.channel < 3;
  for (const Spoken& s : kSpoken) {
    const auto& t = c.fit.term(s.process);
    if (!t.determined) continue;
    const double factor = gyro ? s.gyro : s.accel;
    std::printf("  %-3s %-17s %10.4g +- %-8.2g %-14s", kChannelNames[c.channel], s.process, t.value * factor,
                t.sigma * factor, gyro ? s.gyro_unit : s.accel_unit);
    if (t.name == "gauss_markov") std::printf("correlation time %.3g +- %.2g s", t.second, t.second_sigma);
    if (t.name.ends_with("sinusoid")) std::printf("at %.4g +- %.2g Hz", t.second, t.second_sigma);
    if (t.name == "white" && t.second > 0.0)
      std::printf("below the sensor's low-pass: neighbouring samples correlate by %.2f", t.second);
    std::printf("\n");
  }
}

/// Processes that no channel determines.
void print_undetermined(const Analysis& a) {
  std::string names;
  for (const Spoken& s : kSpoken)
    if (std::none_of(a.channels.begin(), a.channels.end(),
                     [&](const ChannelNoise& c) { return c.fit.term(s.process).determined; }))
      names += (names.empty() ? "" : ", ") + std::string(s.process);
  if (!names.empty()) std::printf("\nNot determined by this log on any axis: %s\n", names.c_str());
}

void print_text(const Analysis& a, const Options& options) {
  std::printf("%s: %zu samples, %.1f s at %.3f Hz, %zu gaps, times jitter by %.2g ms\n\n", options.log.log.c_str(),
              a.log.size(), a.duration_s(), 1.0 / a.sampling.interval_s, a.sampling.segments.size() - 1,
              a.sampling.jitter_s * 1e3);
  std::printf("  axis  least deviation         at       fit's misfit (1: as statistics explain)\n");
  for (const ChannelNoise& c : a.channels) {
    const auto least = std::min_element(c.points.begin(), c.points.end(),
                                        [](const auto& x, const auto& y) { return x.deviation < y.deviation; });
    const bool gyro = c.channel < 3;
    std::printf("  %-5s %10.4g %-8s %8.1f s   %.2f\n", kChannelNames[c.channel],
                least->deviation / (gyro ? kDegree / kHour : 1e-3 * kMilliG), gyro ? "deg/h" : "ug", least->tau_s,
                c.fit.chi_square_per_dof);
  }
  std::printf("\n");
  for (const ChannelNoise& c : a.channels) print_fit(c);
  print_undetermined(a);
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  CANYON_TRY(const Analysis a, analyse(options));
  tell_doubts(a.log);
  tell_motion(options.log.log, a.motion);
  if (!options.out.empty()) CANYON_TRY_STATUS(write_files(a, options));
  if (options.common.json)
    std::printf("%s\n", json_of(a, options).dump().c_str());
  else
    print_text(a, options);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  declare_imu_log(arguments, options->log);
  arguments.option("--kind", options->kinds, "deviations beside the overlapping one: modified,hadamard,total");
  arguments.option("--processes", options->processes,
                   "processes that the fit may use; default all: quantization,white,bias_instability,rate_random_walk,"
                   "ramp,gauss_markov,sinusoid,band_limit");
  arguments.option("--per-octave", options->per_octave, "points of the curves to an octave of averaging time")
      .within(1, 64)
      .default_shown();
  arguments.option("--confidence", options->confidence_percent, "of the intervals, per cent")
      .within(1.0, 99.99)
      .default_shown();
  arguments.option("--out", options->out, "directory for allan.csv, allan.json and allan.svg");
  arguments.flag("--force", options->force, "replace an existing --out");
  return [options]() -> Result<int> { return run(*options); };
}

}  // namespace

Verb imu_allan_verb() {
  return {"imu allan", "Allan deviation of a resting unit's log, and its noise processes",
          "canyon imu allan static.csv --out allan", declare};
}

}  // namespace canyon::apps

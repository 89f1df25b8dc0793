#include "canyon/apps/answers/allan.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "canyon/core/units.h"
#include "canyon/report/draw/picture.h"

namespace canyon::apps {

namespace {

using inertial::channel_unit;
using inertial::ChannelNoise;
using inertial::DeviationPoint;
using inertial::kChannelNames;
using inertial::LogAnalysis;

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

void print_fit(int channel, const inertial::NoiseFit& fit) {
  const bool gyro = channel < 3;
  for (const Spoken& s : kSpoken) {
    const auto& t = fit.term(s.process);
    if (!t.determined) continue;
    const double factor = gyro ? s.gyro : s.accel;
    std::printf("  %-3s %-17s %10.4g +- %-8.2g %-14s", kChannelNames[channel], s.process, t.value * factor,
                t.sigma * factor, gyro ? s.gyro_unit : s.accel_unit);
    if (t.name == "gauss_markov") std::printf("correlation time %.3g +- %.2g s", t.second, t.second_sigma);
    if (t.name.ends_with("sinusoid")) std::printf("at %.4g +- %.2g Hz", t.second, t.second_sigma);
    if (t.name == "white" && t.second > 0.0)
      std::printf("below the sensor's low-pass: neighbouring samples correlate by %.2f", t.second);
    std::printf("\n");
  }
}

bool is_fitted(const LogAnalysis& a) {
  return std::all_of(a.channels.begin(), a.channels.end(), [](const ChannelNoise& c) { return c.fit.has_value(); });
}

/// Processes that no channel determines.
void print_undetermined(const LogAnalysis& a) {
  std::string names;
  for (const Spoken& s : kSpoken)
    if (std::none_of(a.channels.begin(), a.channels.end(),
                     [&](const ChannelNoise& c) { return c.fit->term(s.process).determined; }))
      names += (names.empty() ? "" : ", ") + std::string(s.process);
  if (!names.empty()) std::printf("\nNot determined by this log on any axis: %s\n", names.c_str());
}

/// In the units that people speak in.
report::Panel panel_of(const LogAnalysis& a, bool gyro) {
  const double unit = gyro ? kDegree / kHour : kMilliG;
  report::Panel panel{.title = gyro ? "Gyroscope" : "Accelerometer", .unit = gyro ? "°/h" : "mg"};
  for (const ChannelNoise& c : a.channels) {
    if ((c.channel < 3) != gyro) continue;
    const std::size_t run = panel.bands.size();
    report::Line measured{.run = run, .name = kChannelNames[c.channel], .style = report::Line::Style::kPoints};
    report::Line fit{.run = run};
    report::Band band{.run = run};
    for (const DeviationPoint& p : c.points) {
      if (!(p.deviation > 0.0)) continue;
      for (auto* x : {&measured.x, &fit.x, &band.x}) x->push_back(p.tau_s);
      measured.y.push_back(p.deviation / unit);
      if (c.fit) fit.y.push_back(c.fit->deviation_at(p.tau_s) / unit);
      band.low.push_back(p.low / unit);
      band.high.push_back(p.high / unit);
    }
    panel.bands.push_back(std::move(band));
    panel.lines.push_back(std::move(measured));
    if (c.fit) panel.lines.push_back(std::move(fit));
  }
  return panel;
}

std::string subtitle_of(const LogAnalysis& a) {
  char text[160];
  std::snprintf(text, sizeof text, "%.0f s at %.2f Hz, %zu gaps; points: measured, band: %g %%%s", a.duration_s(),
                1.0 / a.sampling.interval_s, a.sampling.segments.size() - 1, 100.0 * a.options.noise.confidence,
                is_fitted(a) ? ", line: fitted processes" : "");
  return text;
}

}  // namespace

Json allan_json(const LogAnalysis& a) {
  Json out = {{"samples", a.log.size()},
              {"duration_s", a.duration_s()},
              {"interval_s", a.sampling.interval_s},
              {"jitter_s", a.sampling.jitter_s},
              {"gaps", a.sampling.segments.size() - 1},
              {"confidence", a.options.noise.confidence}};
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
    axis["fit"] = c.fit ? json_of(*c.fit) : Json(nullptr);
    for (std::size_t k = 0; k < a.options.kinds.size(); ++k)
      axis[a.options.kinds[k]] = json_of(a.more[i][k], "deviation");
    axes[kChannelNames[c.channel]] = axis;
  }
  out["axes"] = axes;
  if (!is_fitted(a)) out["no_fit"] = inertial::kNoNoiseFit;
  return out;
}

void print_allan(const LogAnalysis& a, const std::string& path) {
  std::printf("%s: %zu samples, %.1f s at %.3f Hz, %zu gaps, times jitter by %.2g ms\n\n", path.c_str(), a.log.size(),
              a.duration_s(), 1.0 / a.sampling.interval_s, a.sampling.segments.size() - 1, a.sampling.jitter_s * 1e3);
  const bool fitted = is_fitted(a);
  std::printf("  axis  least deviation         at%s\n", fitted ? "       fit's misfit (1: as statistics explain)" : "");
  for (const ChannelNoise& c : a.channels) {
    const auto least = std::min_element(c.points.begin(), c.points.end(),
                                        [](const auto& x, const auto& y) { return x.deviation < y.deviation; });
    const bool gyro = c.channel < 3;
    std::printf("  %-5s %10.4g %-8s %8.1f s", kChannelNames[c.channel],
                least->deviation / (gyro ? kDegree / kHour : 1e-3 * kMilliG), gyro ? "deg/h" : "ug", least->tau_s);
    if (c.fit) std::printf("   %.2f", c.fit->chi_square_per_dof);
    std::printf("\n");
  }
  std::printf("\n");
  if (!fitted) {
    std::printf("No processes: %s (CANYON_WITH_CERES)\n", inertial::kNoNoiseFit);
    return;
  }
  for (const ChannelNoise& c : a.channels) print_fit(c.channel, *c.fit);
  print_undetermined(a);
}

std::string allan_svg(const LogAnalysis& a, const std::string& path) {
  std::vector<report::Panel> panels;
  for (const bool gyro : {true, false})
    if (auto panel = panel_of(a, gyro); !panel.lines.empty()) panels.push_back(std::move(panel));
  return report::picture_svg(report::deviation_picture(
      "Allan deviation of " + std::filesystem::path(path).filename().string(), subtitle_of(a), std::move(panels)));
}

}  // namespace canyon::apps

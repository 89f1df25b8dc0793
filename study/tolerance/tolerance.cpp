#include "canyon/study/tolerance/tolerance.h"

#include <algorithm>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/core/output/json.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/mission/run.h"
#include "canyon/study/statistics/proportions.h"

namespace canyon::study {
namespace {

/// A size, ready to be driven.
struct Disturbed {
  mission::MissionConfig config;
  mission::PreparedMission mission;
};

Result<Disturbed> disturbed(const mission::MissionFile& file, const std::string& fidelity, Disturb* apply, double size,
                            mission::SceneCache& scenes) {
  mission::MissionFile copy = file;
  apply(copy, size);
  Disturbed out;
  CANYON_TRY(out.config, copy.resolve(fidelity));
  out.config.run.record_tape = false;  // nobody keeps it
  auto prepared = mission::prepare(out.config, scenes);
  if (!prepared) return copy.locate(prepared.error(), fidelity, fidelity);
  out.mission = *std::move(prepared);
  return out;
}

/// What is left out where nobody reads it.
mission::Omissions nobody_reads(const mission::MissionConfig& config) {
  mission::Omissions out;
  out.maps = true;
  out.keyframes = out.registration = !mission::takes_registered_poses(config);
  return out;
}

Result<std::string> outcome_of(const Disturbed& at, std::int64_t seed, Progress& progress) {
  mission::MissionConfig config = at.config;
  config.run.seed = seed;
  const mission::Omissions left_out = nobody_reads(config);
  mission::RunParts parts;
  parts.omissions = &left_out;
  CANYON_TRY(const mission::RunRecord record,
             mission::run_mission(mission::without(config, left_out), at.mission, &progress, std::move(parts)));
  return std::string(mission::name(*record.outcome));
}

}  // namespace

bool ToleranceCurve::monotone() const {
  std::vector<TolerancePoint> by_size = points;
  std::sort(by_size.begin(), by_size.end(),
            [](const TolerancePoint& a, const TolerancePoint& b) { return a.size < b.size; });
  double lowest = 1.0;  // upper end of an interval so far
  for (const TolerancePoint& point : by_size) {
    if (point.interval.low > lowest) return false;
    lowest = std::min(lowest, point.interval.high);
  }
  return true;
}

Result<ToleranceCurve> tolerance_curve(const mission::MissionFile& file, const std::string& fidelity,
                                       const std::string& disturbance, const std::vector<double>& sizes,
                                       std::int64_t seeds, bool show_progress) {
  CANYON_TRY(const auto* row, choose(disturbances(), disturbance, "--error"));
  mission::SceneCache scenes;
  std::vector<Disturbed> ready;
  double seconds = 0.0;
  for (const double size : sizes) {
    CANYON_TRY(Disturbed one, disturbed(file, fidelity, row->make, size, scenes));
    seconds += std::min(one.mission.nominal_s, one.mission.time_limit_s) * static_cast<double>(seeds);
    ready.push_back(std::move(one));
  }
  const std::size_t n = static_cast<std::size_t>(seeds), total = sizes.size() * n;
  Progress progress("driving " + std::to_string(total) + " missions", seconds, show_progress);
  ToleranceCurve curve{.disturbance = disturbance, .fidelity = fidelity, .autonomy = {}, .points = {}};
  if (!ready.empty()) {
    curve.autonomy = ready.front().config.autonomy.model.name;
    curve.first_seed = ready.front().config.run.seed;
  }
  std::vector<std::string> outcomes(total);
  std::vector<std::optional<Error>> errors(total);
  parallel_for(total, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::int64_t seed = curve.first_seed + static_cast<std::int64_t>(i % n);
      auto outcome = outcome_of(ready[i / n], seed, progress);
      if (outcome) {
        outcomes[i] = *std::move(outcome);
      } else {
        errors[i] = outcome.error();
      }
    }
  });
  for (const auto& error : errors)
    if (error) return *error;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    TolerancePoint point{.size = sizes[k], .interval = {}};
    point.outcomes.assign(outcomes.begin() + static_cast<std::ptrdiff_t>(k * n),
                          outcomes.begin() + static_cast<std::ptrdiff_t>((k + 1) * n));
    point.success = static_cast<int>(std::count(point.outcomes.begin(), point.outcomes.end(), "success"));
    // What [time] limit_s stopped has neither succeeded nor failed.
    point.n =
        static_cast<int>(n) - static_cast<int>(std::count(point.outcomes.begin(), point.outcomes.end(), "stopped"));
    point.interval = wilson_interval(point.success, point.n);
    curve.points.push_back(std::move(point));
  }
  return curve;
}

nlohmann::ordered_json tolerance_json(const ToleranceCurve& curve) {
  Json points = Json::array();
  for (const TolerancePoint& point : curve.points)
    points.push_back({{"size", point.size},
                      {"success", point.success},
                      {"n", point.n},
                      {"low", or_null(point.interval.low)},
                      {"high", or_null(point.interval.high)},
                      {"outcomes", point.outcomes}});
  return {{"error", curve.disturbance},     {"fidelity", curve.fidelity}, {"autonomy", curve.autonomy},
          {"first_seed", curve.first_seed}, {"points", points},           {"monotone", curve.monotone()}};
}

std::string tolerance_table(const ToleranceCurve& curve) {
  std::string out = curve.disturbance + ", fidelity " + curve.fidelity + ", autonomy " + curve.autonomy +
                    ", seeds from " + std::to_string(curve.first_seed) + " on\n";
  out += printed("%12s  %9s  %-14s  %s\n", "size", "success", "95 %", "how the others ended");
  for (const TolerancePoint& point : curve.points) {
    std::vector<std::string> others;
    for (const std::string& outcome : point.outcomes)
      if (outcome != "success" && std::find(others.begin(), others.end(), outcome) == others.end())
        others.push_back(outcome);
    std::string ends;
    for (const std::string& outcome : others)
      ends += (ends.empty() ? "" : ", ") +
              std::to_string(std::count(point.outcomes.begin(), point.outcomes.end(), outcome)) + " " + outcome;
    const std::string interval = point.n > 0 ? printed("%.2f to %.2f", point.interval.low, point.interval.high) : "-";
    out += printed("%12g  %4d / %-3d  %-14s  %s\n", point.size, point.success, point.n, interval.c_str(), ends.c_str());
  }
  const auto ended = std::count_if(curve.points.begin(), curve.points.end(), [](const auto& p) { return p.n > 0; });
  if (ended < 2) return out;  // nothing to compare
  out += curve.monotone() ? "Within their intervals, larger errors never succeed more often.\n"
                          : "A larger error succeeds more often than a smaller one, beyond their intervals.\n";
  return out;
}

std::string tolerance_csv(const ToleranceCurve& curve) {
  std::string out = "size,success,n,low,high\n";
  for (const TolerancePoint& point : curve.points) {
    out += printed("%.9g,%d,%d,", point.size, point.success, point.n);
    out += point.n > 0 ? printed("%.9g,%.9g\n", point.interval.low, point.interval.high) : std::string(",\n");
  }
  return out;
}

}  // namespace canyon::study

#include "canyon/study/registration_error/events/error_events.h"

#include <cmath>
#include <optional>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/mission/run.h"

namespace canyon::study {
namespace {

/// The mission at start k of `starts`, evenly over a day.
mission::PreparedMission at_start(const mission::PreparedMission& mission, std::int64_t k, std::int64_t starts) {
  constexpr std::int64_t kDay_ns = 86'400 * kNsPerSecond;
  mission::PreparedMission out = mission;
  out.start.ns += kDay_ns / starts * k;
  return out;
}

/// That there is a sky at every start, before time is spent on the first.
Status check_skies(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
                   std::int64_t starts) {
  for (std::int64_t k = 0; k < starts; ++k) {
    const mission::PreparedMission at = at_start(mission, k, starts);
    auto sensor = gnss::make_gnss_sensor(config.gnss, static_cast<std::uint64_t>(config.run.seed), at.start,
                                         at.start + tape.duration_s(), *at.scene);
    if (!sensor) return sensor.error();
  }
  return Ok{};
}

struct SeriesOfRun {
  ErrorSeries series;
  double cpu_s = 0.0;
};

Result<SeriesOfRun> series_of(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                              const Tape& tape) {
  SeriesRecorder recorder(*mission.scene, mission.start, config.run.map_range_m, config.gnss.rate_hz,
                          lidar::registers(config.registration));
  mission::Omissions nobody;
  nobody.autonomy = nobody.maps = true;
  CANYON_TRY(const mission::RunRecord record,
             mission::run_mission(config, mission, nullptr,
                                  {.tape = &tape, .recorder = &recorder, .autonomy = nullptr, .omissions = &nobody}));
  return SeriesOfRun{recorder.take(), record.clock.total_s()};
}

}  // namespace

std::vector<std::array<EventEffect, kErrorSeries.size()>> effects_of(const std::vector<SeedSeries>& seeds,
                                                                     std::uint64_t bootstrap_seed) {
  std::vector<std::array<EventEffect, kErrorSeries.size()>> out(map_event_kinds().size());
  for (std::size_t series = 0; series < kErrorSeries.size(); ++series) {
    const auto regressions = regress_events(seeds, series, bootstrap_seed);
    for (std::size_t k = 0; k < out.size(); ++k) {
      const MapEventKind kind = map_event_kinds()[k].make;
      EventEffect& effect = out[k][series];
      effect.average = average_events(seeds, kind, series, bootstrap_seed);
      effect.regression.kind = kind;
      for (const EventRegression& regression : regressions)
        if (regression.kind == kind) effect.regression = regression;
    }
  }
  return out;
}

Result<ErrorEvents> find_error_events(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                      const Tape& tape, const ErrorEventsOptions& options) {
  CANYON_TRY_STATUS(check_skies(config, mission, tape, options.starts));
  const auto starts = static_cast<std::size_t>(options.starts),
             total = static_cast<std::size_t>(options.seeds) * starts;
  std::vector<SeedSeries> seeds(static_cast<std::size_t>(options.seeds), SeedSeries(starts));
  std::vector<std::optional<Error>> errors(total);
  std::vector<double> cpu_s(total);
  Progress progress("driving " + std::to_string(total) + " times over the tape", static_cast<double>(total),
                    options.show_progress);
  parallel_for(total, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      mission::MissionConfig own = config;
      own.run.seed += static_cast<std::int64_t>(i / starts);
      own.run.record_tape = false;
      auto run = series_of(own, at_start(mission, static_cast<std::int64_t>(i % starts), options.starts), tape);
      if (run) {
        seeds[i / starts][i % starts] = std::move(run->series);
        cpu_s[i] = run->cpu_s;
      } else {
        errors[i] = run.error();
      }
      progress.advance(1);
    }
  });
  for (const auto& error : errors)
    if (error) return *error;
  ErrorEvents out;
  out.mission = config.run.name;
  out.fidelity = options.fidelity;
  out.tape = tape.source;
  out.registered = lidar::registers(config.registration);
  out.seed = config.run.seed;
  out.seeds = options.seeds;
  out.starts = options.starts;
  for (const double s : cpu_s) out.cpu_s += s;
  out.effects = effects_of(seeds, static_cast<std::uint64_t>(config.run.seed));
  return out;
}

}  // namespace canyon::study

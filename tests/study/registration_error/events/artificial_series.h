#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/study/registration_error/events/event_average.h"

namespace canyon::study::testing {

/// Seeds at four starts, a keyframe a second for 300 s, whose errors are what `place` says of the tape's second, plus
/// what every event does by the time since it, plus noise.
struct ArtificialRuns {
  std::size_t seeds = 20;
  double noise_m = 0.1;
  std::function<double(double t_s)> place = [](double) { return 0.0; };
  std::function<std::vector<MapEvent>(const RandomStream& stream, std::uint64_t run)> events;
  std::function<double(MapEventKind kind, double since_s)> effect;

  std::vector<SeedSeries> make() const {
    constexpr std::size_t kStarts = 4;
    const RandomStream stream(3, "test.artificial_series");
    std::vector<SeedSeries> out(seeds, SeedSeries(kStarts));
    for (std::size_t run = 0; run < seeds * kStarts; ++run) {
      ErrorSeries& series = out[run / kStarts][run % kStarts];
      series.events = events(stream, run);
      for (int k = 0; k < 300; ++k) {
        double value = place(k) + noise_m * stream.normal(1, run, static_cast<std::uint32_t>(k));
        for (const MapEvent& event : series.events) value += effect(event.kind, k - event.t_s);
        series.t_s.push_back(k);
        series.errors.push_back({value, value, value, value});
      }
    }
    return out;
  }
};

inline MapEvent event_at(MapEventKind kind, double t_s) {
  return {kind, t_s, t_s, t_s, 1.0};
}

}  // namespace canyon::study::testing

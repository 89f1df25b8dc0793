#include "canyon/study/registration_error/events/event_average.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "canyon/study/statistics/cluster_bootstrap.h"

namespace canyon::study {
namespace {

constexpr std::size_t kCurves = 4;  // event, placebo, contrast, null
const std::size_t kLags = static_cast<std::size_t>(std::lround((kBefore_s + kAfter_s) / kLagStep_s)) + 1;

/// Change from the mean before, by lag; NaN where nothing is mapped.
using Window = std::vector<double>;

std::optional<Window> window_around(const ErrorSeries& run, std::size_t series, double t_s) {
  const std::vector<double> lags = event_lags_s();
  Window window;
  double before = 0.0, count = 0.0;
  for (const double lag : lags) {
    window.push_back(run.at(series, t_s + lag));
    if (lag >= 0.0 || std::isnan(window.back())) continue;
    before += window.back();
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  for (double& value : window) value -= before / count;
  return window;
}

bool is_without(const ErrorSeries& run, MapEventKind kind, double t_s) {
  return std::none_of(run.events.begin(), run.events.end(), [&](const MapEvent& e) {
    return e.kind == kind && e.from_s <= t_s + kAfter_s && e.to_s >= t_s - kBefore_s;
  });
}

/// By lag the mean of those that have a value.
Window mean_of(const std::vector<Window>& windows, std::size_t from) {
  Window out;
  for (std::size_t i = 0; i < kLags; ++i) {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = from; k < windows.size(); ++k) {
      if (std::isnan(windows[k][i])) continue;
      sum += windows[k][i];
      count += 1.0;
    }
    out.push_back(count > 0.0 ? sum / count : kNaN);
  }
  return out;
}

/// Where the other one has a value.
Window where_known(Window window, const Window& other) {
  for (std::size_t i = 0; i < window.size(); ++i)
    if (std::isnan(other[i])) window[i] = kNaN;
  return window;
}

Window less(const Window& a, const Window& b) {
  Window out;
  for (std::size_t i = 0; i < a.size(); ++i) out.push_back(a[i] - b[i]);
  return out;
}

/// Sums over a seed's events by lag.
struct WindowSums {
  Window sum = Window(kLags, 0.0), count = Window(kLags, 0.0);
  void add(const Window& window) {
    for (std::size_t i = 0; i < kLags; ++i) {
      if (std::isnan(window[i])) continue;
      sum[i] += window[i];
      count[i] += 1.0;
    }
  }
};
struct SeedSums {
  std::array<WindowSums, kCurves> curves;
  int events = 0, matched = 0;
  double size = 0.0;
};

void add_event(const SeedSeries& runs, std::size_t own, const MapEvent& event, std::size_t series, SeedSums& sums) {
  ++sums.events;
  const auto with = window_around(runs[own], series, event.t_s);
  if (!with) return;
  std::vector<Window> placebos;
  // From its own start on, so that each other start is the first of the placebos equally often.
  for (std::size_t k = 1; k < runs.size(); ++k) {
    const ErrorSeries& other = runs[(own + k) % runs.size()];
    if (!is_without(other, event.kind, event.t_s)) continue;
    if (auto window = window_around(other, series, event.t_s)) placebos.push_back(*std::move(window));
  }
  if (placebos.empty()) return;
  ++sums.matched;
  sums.size += event.size;
  const Window placebo = mean_of(placebos, 0), contrast = less(*with, placebo);
  // Only where both are known: else the difference of the two curves would not be the contrast.
  sums.curves[0].add(where_known(*with, contrast));
  sums.curves[1].add(where_known(placebo, contrast));
  sums.curves[2].add(contrast);
  if (placebos.size() > 1) sums.curves[3].add(less(placebos.front(), mean_of(placebos, 1)));
}

/// Mean by lag of one curve when seed s counts times[s].
Window curve_mean(const std::vector<SeedSums>& seeds, std::size_t curve, std::span<const double> times) {
  Window sum(kLags, 0.0), count(kLags, 0.0);
  for (std::size_t s = 0; s < seeds.size(); ++s)
    for (std::size_t i = 0; i < kLags; ++i) {
      sum[i] += times[s] * seeds[s].curves[curve].sum[i];
      count[i] += times[s] * seeds[s].curves[curve].count[i];
    }
  for (std::size_t i = 0; i < kLags; ++i) sum[i] = count[i] > 0.0 ? sum[i] / count[i] : kNaN;
  return sum;
}

double effect_of(const Window& curve) {
  const std::vector<double> lags = event_lags_s();
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < kLags; ++i) {
    if (!(lags[i] > 0.0 && lags[i] <= kEffect_s) || std::isnan(curve[i])) continue;
    sum += curve[i];
    count += 1.0;
  }
  return count > 0.0 ? sum / count : kNaN;
}

struct DelayDuration {
  double delay_s = kNaN, duration_s = kNaN;
};
DelayDuration delay_duration(const Window& curve) {
  const std::vector<double> lags = event_lags_s();
  const double sign = effect_of(curve) < 0.0 ? -1.0 : 1.0;
  double peak = 0.0;
  std::size_t first = kLags;
  for (std::size_t i = 0; i < kLags; ++i)
    if (lags[i] >= 0.0 && sign * curve[i] > peak) peak = sign * curve[i];
  for (std::size_t i = 0; i < kLags && first == kLags; ++i)
    if (lags[i] >= 0.0 && peak > 0.0 && sign * curve[i] >= 0.5 * peak) first = i;
  if (first == kLags) return {};
  std::size_t end = first;
  while (end < kLags && !(sign * curve[end] < 0.5 * peak)) ++end;
  return {lags[first], kLagStep_s * static_cast<double>(end - first)};
}

/// All that has a band, one after the other: the curves, their effects, delay and duration.
std::vector<double> event_statistics(const std::vector<SeedSums>& seeds, std::span<const double> times) {
  std::vector<double> out, effects;
  DelayDuration shape;
  for (std::size_t c = 0; c < kCurves; ++c) {
    const Window mean = curve_mean(seeds, c, times);
    out.insert(out.end(), mean.begin(), mean.end());
    effects.push_back(effect_of(mean));
    if (c == 2) shape = delay_duration(mean);
  }
  out.insert(out.end(), effects.begin(), effects.end());
  out.push_back(shape.delay_s);
  out.push_back(shape.duration_s);
  return out;
}

EventAverage named(const std::vector<double>& values, const std::vector<Interval>& intervals) {
  EventAverage out;
  std::size_t next = 0;
  for (LagCurve* curve : {&out.event, &out.placebo, &out.contrast, &out.null})
    for (std::size_t i = 0; i < kLags; ++i, ++next) {
      curve->mean.push_back(values[next]);
      curve->band.push_back(intervals[next]);
    }
  for (EstimatedNumber* number :
       {&out.event_m, &out.placebo_m, &out.effect_m, &out.null_m, &out.delay_s, &out.duration_s}) {
    *number = {values[next], intervals[next]};
    ++next;
  }
  return out;
}

}  // namespace

std::vector<double> event_lags_s() {
  std::vector<double> out;
  for (std::size_t i = 0; i < kLags; ++i) out.push_back(-kBefore_s + kLagStep_s * static_cast<double>(i));
  return out;
}

EventAverage average_events(const std::vector<SeedSeries>& seeds, MapEventKind kind, std::size_t series,
                            std::uint64_t bootstrap_seed) {
  std::vector<SeedSums> sums(seeds.size());
  for (std::size_t s = 0; s < seeds.size(); ++s)
    for (std::size_t own = 0; own < seeds[s].size(); ++own)
      for (const MapEvent& event : seeds[s][own].events)
        if (event.kind == kind) add_event(seeds[s], own, event, series, sums[s]);
  const std::vector<double> once(seeds.size(), 1.0);
  EventAverage out = named(event_statistics(sums, once),
                           cluster_bootstrap(seeds.size(), bootstrap_seed, [&](std::span<const double> times) {
                             return event_statistics(sums, times);
                           }));
  double size = 0.0;
  for (const SeedSums& seed : sums) {
    out.events += seed.events;
    out.matched += seed.matched;
    size += seed.size;
  }
  if (out.matched > 0) out.mean_size = size / out.matched;
  return out;
}

}  // namespace canyon::study

#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/output/printed.h"
#include "canyon/study/registration_error/events/error_events.h"

namespace canyon::study {
namespace {

Json numbers_json(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double value : values) out.push_back(or_null(value));
  return out;
}

Json curve_json(const LagCurve& curve) {
  std::vector<double> low, high;
  for (const Interval& band : curve.band) {
    low.push_back(band.low);
    high.push_back(band.high);
  }
  return {{"mean_m", numbers_json(curve.mean)}, {"low_m", numbers_json(low)}, {"high_m", numbers_json(high)}};
}

Json estimated_json(const EstimatedNumber& number, const std::string& unit) {
  return {{"value_" + unit, or_null(number.value)},
          {"low_" + unit, or_null(number.interval.low)},
          {"high_" + unit, or_null(number.interval.high)}};
}

Json effect_json(const EventEffect& effect) {
  const EventAverage& average = effect.average;
  Json by_lag = Json::array();
  for (std::size_t j = 0; j < effect.regression.by_lag.size(); ++j) {
    Json range = estimated_json(effect.regression.by_lag[j], "m");
    range["from_s"] = kLagEdges_s[j + 1];
    range["to_s"] = kLagEdges_s[j + 2];
    by_lag.push_back(range);
  }
  return {{"events", average.events},
          {"matched", average.matched},
          {"mean_size", or_null(average.mean_size)},
          {"effect", estimated_json(average.effect_m, "m")},
          {"around_events", estimated_json(average.event_m, "m")},
          {"around_placebos", estimated_json(average.placebo_m, "m")},
          {"placebo_less_placebo", estimated_json(average.null_m, "m")},
          {"delay", estimated_json(average.delay_s, "s")},
          {"duration", estimated_json(average.duration_s, "s")},
          {"regression", {{"effect", estimated_json(effect.regression.effect_m, "m")}, {"by_lag", by_lag}}},
          {"curves",
           {{"event", curve_json(average.event)},
            {"placebo", curve_json(average.placebo)},
            {"contrast", curve_json(average.contrast)},
            {"null", curve_json(average.null)}}}};
}

std::string csv_cell(double value) {
  return std::isfinite(value) ? printed("%.9g", value) : "";
}

std::string with_band(const EstimatedNumber& number) {
  if (!std::isfinite(number.value)) return "-";
  return printed("%.3g", number.value) +
         (number.interval.defined() ? printed(" [%.3g, %.3g]", number.interval.low, number.interval.high) : "");
}

bool excludes_zero(const Interval& interval) {
  return interval.defined() && (interval.low > 0.0 || interval.high < 0.0);
}

std::string effect_line(const char* series, const EventEffect& effect) {
  const EventAverage& average = effect.average;
  std::string out = printed("  %-20s %-24s %-24s %-24s", series, with_band(average.effect_m).c_str(),
                            with_band(average.placebo_m).c_str(), with_band(effect.regression.effect_m).c_str());
  // When an effect that may be none comes and goes is nothing to tell.
  if (excludes_zero(average.effect_m.interval))
    out += printed(" after %.1f s, for %.1f s", average.delay_s.value, average.duration_s.value);
  return out + "\n";
}

}  // namespace

Json error_events_json(const ErrorEvents& events) {
  Json out{{"mission", events.mission}, {"fidelity", events.fidelity},     {"tape", events.tape},
           {"seed", events.seed},       {"seeds", events.seeds},           {"starts", events.starts},
           {"before_s", kBefore_s},     {"registered", events.registered}, {"effect_s", kEffect_s}};
  out["lag_s"] = numbers_json(event_lags_s());
  Json kinds = Json::object();
  for (std::size_t k = 0; k < events.effects.size(); ++k) {
    const auto& row = map_event_kinds()[k];
    Json kind{{"doc", row.doc}, {"events", events.effects[k][0].average.events}};
    for (std::size_t s = 0; s < kErrorSeries.size(); ++s) kind[kErrorSeries[s]] = effect_json(events.effects[k][s]);
    kinds[row.name] = kind;
  }
  out["kinds"] = kinds;
  out["timing"] = {{"cpu_s", events.cpu_s}};
  return out;
}

std::string error_events_csv(const ErrorEvents& events) {
  std::string out = "kind,series,lag_s";
  for (const char* curve : {"event", "placebo", "contrast", "null"})
    out += printed(",%s,%s_low,%s_high", curve, curve, curve);
  out += '\n';
  const std::vector<double> lags = event_lags_s();
  for (std::size_t k = 0; k < events.effects.size(); ++k)
    for (std::size_t s = 0; s < kErrorSeries.size(); ++s)
      for (std::size_t i = 0; i < lags.size(); ++i) {
        const EventAverage& average = events.effects[k][s].average;
        out += printed("%s,%s,%g", map_event_kinds()[k].name, kErrorSeries[s], lags[i]);
        for (const LagCurve* curve : {&average.event, &average.placebo, &average.contrast, &average.null})
          out +=
              ',' + csv_cell(curve->mean[i]) + ',' + csv_cell(curve->band[i].low) + ',' + csv_cell(curve->band[i].high);
        out += '\n';
      }
  return out;
}

std::string error_events_table(const ErrorEvents& events) {
  std::string out = printed(
      "%s, %s: %lld seed%s at %lld times of day on one true motion.\nWhat changes in the %.0f s after an event, m, "
      "from "
      "the mean of the %.0f s before it.\n",
      events.mission.c_str(), events.fidelity.c_str(), static_cast<long long>(events.seeds),
      events.seeds == 1 ? "" : "s", static_cast<long long>(events.starts), kEffect_s, kBefore_s);
  for (std::size_t k = 0; k < events.effects.size(); ++k) {
    const EventAverage& first = events.effects[k][0].average;
    out += printed("\n%s: %d event%s, %d with placebos", map_event_kinds()[k].name, first.events,
                   first.events == 1 ? "" : "s", first.matched);
    if (first.matched > 0) out += printed(", mean size %.3g", first.mean_size);
    out += '\n';
    if (first.matched == 0) continue;
    out += printed("  %-20s %-24s %-24s %-24s %s\n", "", "event less placebos", "placebos alone", "by regression",
                   "delay and duration");
    for (std::size_t s = 0; s < kErrorSeries.size(); ++s)
      if (events.registered || s % 2 == 0) out += effect_line(kErrorSeries[s], events.effects[k][s]);
  }
  return out;
}

}  // namespace canyon::study

#include "canyon/study/tradeoff/measuring/measure.h"

#include <algorithm>
#include <cmath>

#include "canyon/study/tradeoff/measuring/differences.h"
#include "canyon/study/tradeoff/measuring/front.h"
#include "canyon/study/tradeoff/measuring/observed_order.h"

namespace canyon::study {
namespace {

/// Steps of the rungs as an order is read off them: coarse to fine, falling. Rates count by their period.
struct Step {
  std::size_t rung;
  double h;
};
std::vector<Step> steps_of(const Contenders& c) {
  std::vector<Step> steps;
  for (std::size_t i = 0; i < c.names.size(); ++i)
    if (c.values[i]) steps.push_back({i, *c.values[i]});
  if (steps.size() > 1 && steps.front().h < steps.back().h)
    for (Step& step : steps) step.h = 1.0 / step.h;
  return steps;
}

double difference(const std::vector<Repeated>& runs, std::size_t a, std::size_t b) {
  return rms(differences(runs[a].first.samples, &runs[b].first.samples));
}

void read_orders(const Contenders& c, const std::vector<Repeated>& runs, MeasuredLadder& out) {
  const std::vector<Step> steps = steps_of(c);
  for (std::size_t i = 2; i < steps.size(); ++i) {
    const double e12 = difference(runs, steps[i - 2].rung, steps[i - 1].rung);
    const double e23 = difference(runs, steps[i - 1].rung, steps[i].rung);
    const double order = observed_order(steps[i - 2].h, steps[i - 1].h, steps[i].h, e12, e23, c.rounding);
    out.orders.push_back(order);
    if (std::isfinite(order)) out.order_observed = order;
  }
}

/// Of numbers by Richardson with the observed order, of a series by going on as it did. Against truth nothing is left.
double reference_error(const Contenders& c, const std::vector<Repeated>& runs, const MeasuredLadder& ladder) {
  if (!c.reference) return 0.0;
  if (!c.reference_is_rung) return kNaN;
  const std::vector<Step> steps = steps_of(c);
  // Below half an order values hardly converge, and going on with them tells nothing.
  if (steps.size() > 2 && steps.back().rung == *c.reference)
    return !(ladder.order_observed >= 0.5)
               ? kNaN
               : richardson_error(steps[steps.size() - 2].h, steps.back().h,
                                  difference(runs, steps[steps.size() - 2].rung, steps.back().rung),
                                  ladder.order_observed);
  std::vector<std::size_t> series;
  for (const std::string& name : c.series) {
    const auto found = std::find(c.names.begin(), c.names.end(), name);
    if (found != c.names.end()) series.push_back(static_cast<std::size_t>(found - c.names.begin()));
  }
  if (series.size() < 3 || series.back() != *c.reference) return kNaN;
  const std::size_t n = series.size();
  return extrapolated_error(difference(runs, series[n - 3], series[n - 2]),
                            difference(runs, series[n - 2], series[n - 1]));
}

MeasuredModel model_of(const Contenders& c, const std::vector<Repeated>& runs, std::size_t i, std::uint64_t seed) {
  const Repeated& run = runs[i];
  const Differences d = differences(run.first.samples, c.reference ? &runs[*c.reference].first.samples : nullptr);
  const RmsEstimate error = block_bootstrap_rms(d.samples, seed);
  MeasuredModel model;
  model.name = c.names[i];
  model.value = c.values[i];
  model.error = error.rms;
  model.error_sigma = error.sigma;
  model.error_interval = error.interval;
  model.undefined_share = d.undefined_share;
  model.simulated_s = run.first.simulated_s;
  model.cpu_s = run.median_s() / model.simulated_s;
  model.cpu_low_s = run.least_s() / model.simulated_s;
  model.cpu_high_s = run.most_s() / model.simulated_s;
  model.work = run.first.work;
  model.memory_mb = run.first.memory_mb;
  model.is_reference = c.reference && *c.reference == i;
  return model;
}

void compare_in_common(const std::vector<Repeated>& runs, std::vector<MeasuredModel>& models) {
  std::vector<const Samples*> all;
  for (const Repeated& run : runs) all.push_back(&run.first.samples);
  const std::vector<double> common = common_rms(all);
  for (std::size_t i = 0; i < models.size(); ++i) models[i].common_error = common[i];
}

}  // namespace

bool MeasuredLadder::order_holds() const {
  return !order_must_hold || !order_theory || std::abs(order_observed - *order_theory) <= 0.2;
}

Status measure(const Contenders& c, int repetitions, std::uint64_t seed, MeasuredLadder& out) {
  CANYON_TRY(const std::vector<Repeated> runs, repeat(c.probes, repetitions, seed));
  out.against_truth = !c.reference;
  read_orders(c, runs, out);
  out.reference_error = reference_error(c, runs, out);
  for (std::size_t i = 0; i < c.names.size(); ++i) {
    if (!c.reference_is_rung && c.reference == i) continue;
    out.models.push_back(model_of(c, runs, i, seed));
    MeasuredModel& model = out.models.back();
    model.resolved = model.is_reference || !(model.error < out.reference_error);
  }
  if (out.against_truth) compare_in_common(runs, out.models);
  mark_front(out.models);
  out.fit = fit_time(out.models);
  return Ok{};
}

Result<MeasuredLadder> measure(const RungList& list, const Measuring& with) {
  const Ladder& ladder = *list.ladder;
  const ModelRow<ProbeModel>& probe = model_row(probes(), ladder.probe);
  const ProbeModel& row = probe.make;
  MeasuredLadder out{.part = ladder.part,
                     .key = ladder.key,
                     .of = list.of,
                     .probe = ladder.probe,
                     .meaning = probe.doc,
                     .unit = row.unit,
                     .work_unit = row.work,
                     .reference = list.reference ? list.rungs[*list.reference].name : kTruth};
  out.left_out = list.left_out;
  out.order_must_hold = row.has_steps;
  const std::size_t samples =
      ladder.samples > 0 ? std::min(with.samples, static_cast<std::size_t>(ladder.samples)) : with.samples;
  Contenders c;
  c.reference_is_rung = list.reference_is_rung;
  c.series = ladder.series;
  c.rounding = row.rounding;
  std::vector<bool> in_use;
  for (std::size_t i = 0; i < list.rungs.size(); ++i) {
    const Rung& rung = list.rungs[i];
    const ProbeSetup setup{rung.config, with.mission, with.tape, samples, rung.own, with.recording};
    if (row.order != nullptr && !out.order_theory) out.order_theory = row.order(rung.own, rung.config);
    auto made = row.make(setup);
    if (!made) {
      if (list.reference == i) return made.error();
      out.left_out.push_back({rung.name, made.error().str()});
      continue;
    }
    if (list.reference == i) c.reference = c.names.size();
    c.names.push_back(rung.name);
    c.values.push_back(list.reference_is_rung || list.reference != i ? rung.value : std::nullopt);
    c.probes.push_back(*std::move(made));
    if (list.reference_is_rung || list.reference != i) in_use.push_back(rung.in_use);
  }
  if (c.probes.empty())
    return Error{
        .key = ladder.key, .what = "has no rung that can be measured here", .expected = out.left_out.back().reason};
  CANYON_TRY_STATUS(measure(c, with.repetitions, with.seed, out));
  for (std::size_t i = 0; i < out.models.size(); ++i) out.models[i].in_use = in_use[i];
  return out;
}

}  // namespace canyon::study

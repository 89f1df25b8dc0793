// What comes with which sample of a run: nodes, messages, loosening and states.
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/fusion/smoothing/graph/chain_builder.h"
#include "canyon/fusion/smoothing/run_filter.h"
#include "canyon/fusion/stress/parts/subjects.h"
#include "canyon/fusion/stress/simulated_drive.h"

namespace canyon::fusion {
namespace {

using stress::kInfinity;

/// Nodes where fixes come, and else where the interval is full; messages with the sample whose end is nearest, none of
/// before the start; and samples that do not follow one another named.
StressFigure coming() {
  int wrong = 0;
  Drive drive = simulated_drive(5, {.seconds = 4.0, .rate_hz = 20.0, .outage_from_s = 1e9});
  const SmootherInput run = drive.input();
  const auto samples = samples_of(run);
  if (!samples) return {kInfinity, 0.0};
  // Fixes each second, at 20, 40, 60, 80 samples; nodes each 0.4 s between.
  const ChainBuilder builder(run, *samples, 0.4);
  const std::vector<std::size_t> expected = {8, 16, 20, 28, 36, 40, 48, 56, 60, 68, 76, 80};
  wrong += builder.ends() == expected ? 0 : 1;
  std::vector<OdometerSample> wheels;
  for (const double t : {-0.2, -0.026, -0.024, 0.0, 0.024, 0.026, 0.1, 0.1, 3.9, 3.976, 4.024, 4.3}) {
    OdometerSample one;
    one.t = drive.start + t;
    wheels.push_back(one);
  }
  Queue<OdometerSample> queue(wheels);
  queue.begin(samples->front());
  std::vector<int> with(samples->size(), 0);
  for (std::size_t k = 0; k < samples->size(); ++k) with[k] = static_cast<int>(queue.with(*samples, k).size());
  // Those from half a sample before the start on come with the first, whose end is 0.05 s: up to 0.075.
  wrong += with[0] == 4 && with[1] == 2 && with[77] == 1 && with[78] == 0 && with[79] == 2 ? 0 : 1;
  int all = 0;
  for (const int count : with) all += count;
  wrong += all == 9 ? 0 : 1;
  // Samples of before the start are left out; those that do not follow are an error.
  SmootherInput later = run;
  later.start = drive.start + 1.0;
  wrong += samples_of(later).ok() && samples_of(later)->size() == samples->size() - 20 ? 0 : 1;
  later.start = drive.start + 1.02;
  wrong += samples_of(later).ok() && samples_of(later)->size() == samples->size() - 20 ? 0 : 1;
  later.start = drive.start + 5.0;
  wrong += samples_of(later).ok() ? 1 : 0;
  auto with_gap = drive.imu;
  with_gap.erase(with_gap.begin() + 30);
  SmootherInput gap = run;
  gap.imu = with_gap;
  wrong += samples_of(gap).ok() ? 1 : 0;
  auto slow = drive.imu;
  for (std::size_t k = 0; k < slow.size(); ++k)
    slow[k].dt_s = 0.25, slow[k].t = drive.start + 0.25 * static_cast<double>(k + 1);
  gap.imu = slow;
  wrong += samples_of(gap).ok() ? 1 : 0;
  // Loosening at ends of samples, each once, none of before the start; states after the first
  // sample and then each tenth of a second, or after each.
  const std::vector<Loosening> loosened = {{drive.start, 1.0, 1.0, 1.0}, {drive.imu[9].t, 0.01, 0.5, 0.2}};
  SmootherInput loose = run;
  loose.loosened = loosened, loose.fixes = {};
  ErrorStateFilter one = started_filter(loose), other = started_filter(loose);
  std::size_t after = 0;
  run_filter(loose, *samples, one, [&](const ImuSample& s) { wrong += s.t == drive.imu[after++].t ? 0 : 1; });
  for (std::size_t k = 0; k < samples->size(); ++k) {
    other.predict((*samples)[k]);
    if (k == 9) other.loosen(0.01, 0.5, 0.2);
  }
  wrong += one.covariance() == other.covariance() && after == samples->size() ? 0 : 1;
  drive.fixes.clear();
  wrong += smoothed_by("none", drive).states.size() == 41 &&
                   smoothed_by("none", drive, "smoothed_interval_s = 0").states.size() == 80 &&
                   smoothed_by("rts", drive, "smoothed_interval_s = 0.5").states.size() == 9
               ? 0
               : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> run_message_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "what comes with which sample",
           "a message of before the start, a node too late, a loosening twice", "by hand: exact", "wrong"});
  rows.add("runs/what_comes_when", coming);
  return rows.take();
}

}  // namespace canyon::fusion

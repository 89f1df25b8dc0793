#include "canyon/study/tradeoff/measuring/front.h"

#include <algorithm>
#include <cmath>

namespace canyon::study {
namespace {

bool measured(const MeasuredModel& m) {
  return std::isfinite(m.error) && std::isfinite(m.cpu_s);
}

bool overlap(const MeasuredModel& a, const MeasuredModel& b) {
  return a.cpu_low_s <= b.cpu_high_s && b.cpu_low_s <= a.cpu_high_s;
}

/// What is undefined more often may be so where others err most: it dominates nothing.
bool dominates(const MeasuredModel& a, const MeasuredModel& b) {
  const bool common = std::isfinite(a.common_error) && std::isfinite(b.common_error);
  const double of_a = common ? a.common_error : a.error, of_b = common ? b.common_error : b.error;
  return of_a <= of_b && a.cpu_s <= b.cpu_s && a.undefined_share <= b.undefined_share &&
         (of_a < of_b || a.cpu_s < b.cpu_s);
}

}  // namespace

void mark_front(std::vector<MeasuredModel>& models) {
  for (MeasuredModel& model : models) {
    model.tied_with.clear();
    model.on_front = measured(model);
    for (const MeasuredModel& other : models) {
      if (&other == &model || !measured(other) || !measured(model)) continue;
      if (dominates(other, model)) model.on_front = false;
      if (overlap(other, model)) model.tied_with.push_back(other.name);
    }
  }
}

TimeFit fit_time(const std::vector<MeasuredModel>& models) {
  // Weights 1 / t^2: sum of (1 - (a + b w) / t)^2.
  double n = 0, s1 = 0, s11 = 0, sw = 0, sww = 0, s1w = 0;
  std::int64_t least = 0, most = 0;
  for (const MeasuredModel& model : models) {
    const double t = model.cpu_s * model.simulated_s;
    if (!(t > 0.0)) continue;
    const double u = 1.0 / t, v = static_cast<double>(model.work) / t;
    least = n == 0 ? model.work : std::min(least, model.work);
    most = n == 0 ? model.work : std::max(most, model.work);
    n += 1, s1 += u, sw += v, s11 += u * u, sww += v * v, s1w += u * v;
  }
  const double det = s11 * sww - s1w * s1w;
  TimeFit fit;
  if (n < 3 || least == most || !(det > 1e-12 * s11 * sww)) return fit;
  fit.fixed_s = (s1 * sww - sw * s1w) / det;
  fit.per_work_s = (s11 * sw - s1w * s1) / det;
  fit.worst_ratio = 1.0;
  for (const MeasuredModel& model : models) {
    const double t = model.cpu_s * model.simulated_s;
    const double fitted = fit.fixed_s + fit.per_work_s * static_cast<double>(model.work);
    if (t > 0.0) fit.worst_ratio = fitted > 0.0 ? std::max({fit.worst_ratio, fitted / t, t / fitted}) : INFINITY;
  }
  return fit;
}

}  // namespace canyon::study

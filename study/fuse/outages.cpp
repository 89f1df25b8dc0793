#include "canyon/study/fuse/outages.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace canyon::study {

Result<OutagePlan> parse_outage_plan(const std::string& text, const std::string& option) {
  OutagePlan plan;
  int used = 0;
  const bool read =
      std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &plan.length_s, &plan.every_s, &plan.first_s, &used) == 3;
  const auto good = [](double seconds, double least) { return seconds >= least && seconds <= 1e6; };
  if (!read || used != static_cast<int>(text.size()) || !good(plan.length_s, 1e-3) || !good(plan.every_s, 1e-3) ||
      !good(plan.first_s, 0.0) || plan.every_s < plan.length_s)
    return Error{option, 0, "", "\"" + text + "\"", "LENGTH,EVERY,FIRST in seconds, EVERY at least LENGTH"};
  return plan;
}

Outages::Outages(const OutagePlan& plan, GpsTime begin, GpsTime end) {
  GpsTime first = begin + plan.first_s;
  if (first > end) first = GpsTime::from_week_sow(begin.week(), 0.0) + plan.first_s;
  if (first < begin) return;
  for (int k = 0;; ++k) {
    const GpsTime from = first + k * plan.every_s;
    if (from + plan.length_s > end) return;
    windows_.push_back({.begin = from, .end = from + plan.length_s});
  }
}

const OutageWindow* Outages::window_at(GpsTime t) const {
  const auto after = std::lower_bound(windows_.begin(), windows_.end(), t,
                                      [](const OutageWindow& w, GpsTime a) { return w.begin < a; });
  if (after == windows_.begin()) return nullptr;
  const OutageWindow& window = *(after - 1);
  return t <= window.end ? &window : nullptr;
}

void Outages::add(GpsTime t, double horizontal_m, double vertical_m) {
  auto* window = const_cast<OutageWindow*>(window_at(t));
  if (window == nullptr) return;
  ++window->instants;
  window->horizontal_max_m = std::max(window->horizontal_max_m, horizontal_m);
  window->vertical_max_m = std::max(window->vertical_max_m, vertical_m);
}

OutageScore outage_score(const std::vector<OutageWindow>& windows) {
  OutageScore out{};
  for (const OutageWindow& w : windows) {
    if (w.instants == 0) continue;
    ++out.count;
    out.horizontal_rms_of_max_m += w.horizontal_max_m * w.horizontal_max_m;
    out.vertical_rms_of_max_m += w.vertical_max_m * w.vertical_max_m;
    out.horizontal_mean_of_max_m += w.horizontal_max_m;
    out.vertical_mean_of_max_m += w.vertical_max_m;
  }
  const double n = out.count > 0 ? static_cast<double>(out.count) : std::numeric_limits<double>::quiet_NaN();
  out.horizontal_rms_of_max_m = std::sqrt(out.horizontal_rms_of_max_m / n);
  out.vertical_rms_of_max_m = std::sqrt(out.vertical_rms_of_max_m / n);
  out.horizontal_mean_of_max_m /= n;
  out.vertical_mean_of_max_m /= n;
  return out;
}

}  // namespace canyon::study

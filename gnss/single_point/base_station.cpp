#include "canyon/gnss/single_point/base_station.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/solver/receiver_clocks.h"

namespace canyon::gnss {

const BaseDifferences::Epoch* BaseDifferences::near(GpsTime t, double longest_age_s) const {
  const auto after =
      std::lower_bound(epochs.begin(), epochs.end(), t, [](const Epoch& e, GpsTime at) { return e.t < at; });
  const Epoch* best = nullptr;
  double age_s = longest_age_s;
  const auto take = [&](const Epoch& e) {
    if (std::abs(e.t - t) > age_s) return;
    age_s = std::abs(e.t - t);
    best = &e;
  };
  if (after != epochs.begin()) take(*std::prev(after));
  if (after != epochs.end()) take(*after);
  return best;
}

double take_out_clock(BaseDifferences::Epoch& epoch) {
  if (epoch.satellites.empty()) return 0.0;
  GnssSystem first = clock_system(epoch.satellites.begin()->first.system);
  for (const auto& [sv, of] : epoch.satellites) first = std::min(first, clock_system(sv.system));
  std::vector<double> sorted_m;
  for (const auto& [sv, of] : epoch.satellites)
    if (clock_system(sv.system) == first) sorted_m.push_back(of.m);
  std::sort(sorted_m.begin(), sorted_m.end());
  const double clock_m = 0.5 * (sorted_m[(sorted_m.size() - 1) / 2] + sorted_m[sorted_m.size() / 2]);
  for (auto& [sv, of] : epoch.satellites) of.m -= clock_m;
  return clock_m;
}

double base_code_sigma_m(double elevation_rad) {
  return 0.16 + 1.07 * std::exp(-elevation_rad / (15.5 * kDegree));
}

}  // namespace canyon::gnss

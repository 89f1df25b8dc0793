#include "canyon/gnss/single_point/base_station.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

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

double base_code_sigma_m(double elevation_rad) {
  return 0.16 + 1.07 * std::exp(-elevation_rad / (15.5 * kDegree));
}

}  // namespace canyon::gnss

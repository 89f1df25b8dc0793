#include "canyon/gnss/products/clock_datum.h"

#include "canyon/gnss/signal.h"

namespace canyon::gnss {

BandPair precise_clock_bands(GnssSystem system) {
  if (system == GnssSystem::kGalileo) return {1, 5};
  if (system == GnssSystem::kBeidou) return {2, 6};
  return {1, 2};
}

CombinationWeights ionosphere_free(GnssSystem system, BandPair bands) {
  const double f1 = carrier_hz(system, bands.first), f2 = carrier_hz(system, bands.second);
  const double first = f1 * f1 / (f1 * f1 - f2 * f2);
  return {first, 1.0 - first};
}

double delay_of_precise_clock_s(GnssSystem system, const std::array<double, 10>& group_delay_s) {
  if (system == GnssSystem::kGlonass) return 0.0;
  const BandPair bands = precise_clock_bands(system);
  const CombinationWeights w = ionosphere_free(system, bands);
  return w.first * group_delay_s[static_cast<std::size_t>(bands.first)] +
         w.second * group_delay_s[static_cast<std::size_t>(bands.second)];
}

}  // namespace canyon::gnss

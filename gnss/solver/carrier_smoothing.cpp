#include "canyon/gnss/solver/carrier_smoothing.h"

#include <algorithm>
#include <cmath>

namespace canyon::gnss {
namespace {

constexpr double kLongestGapS = 120.0;
constexpr double kSlipM = 15.0;

}  // namespace

CarrierSmoothing::Output CarrierSmoothing::smooth(SatelliteId sv, GpsTime t, const Input& in) {
  if (time_constant_s_ <= 0.0 || !std::isfinite(in.phase_m)) {
    means_.erase(sv);
    return {in.code_m, 1.0};
  }
  // Code and phase with the modelled ionosphere taken off each, which has opposite signs in the two.
  const double phase_m = in.phase_m + in.ionosphere_m;
  const double difference_m = in.code_m - in.ionosphere_m - phase_m;
  Mean& mean = means_[sv];
  const double step_s = mean.count > 0.0 ? t - mean.t : 0.0;
  const bool anew = mean.count == 0.0 || in.loss_of_lock || step_s <= 0.0 || step_s > kLongestGapS ||
                    (mean.step_s > 0.0 && step_s > 3.0 * mean.step_s) ||
                    std::abs(difference_m - mean.code_minus_phase_m) > kSlipM;
  if (anew) {
    mean = {t, difference_m, 1.0, 0.0};
    return {in.code_m, 1.0};
  }
  mean.count = std::min(mean.count + 1.0, std::max(1.0, time_constant_s_ / step_s));
  mean.t = t;
  mean.step_s = step_s;
  mean.code_minus_phase_m += (difference_m - mean.code_minus_phase_m) / mean.count;
  return {mean.code_minus_phase_m + phase_m + in.ionosphere_m, mean.count};
}

}  // namespace canyon::gnss

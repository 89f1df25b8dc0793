#pragma once

#include <memory>
#include <span>

#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"

namespace canyon::gnss {

/// What is known of one range's quality.
struct RangeQuality {
  GnssSystem system = GnssSystem::kGps;
  double elevation_rad = 0.0;  ///< held at 5 deg from below
  double cn0_dbhz = kNaN;      ///< NaN: not known, taken as what a clear satellite of that elevation has
  double ionosphere_m = 0.0;   ///< what a model of the ionosphere subtracts; 0 = no model
  double code_factor = 1.0;    ///< of the code's own noise: 2 to 3 for an ionosphere-free combination
  double accuracy_m = kNaN;    ///< of the satellite's orbit and clock (URA, SISA), NaN: not known
  bool differential = false;   ///< corrected by a base near by, so that the code's own error is what is left
};

/// 1-sigma that a solver assumes for a corrected pseudorange.
class RangeWeighting {
 public:
  virtual ~RangeWeighting() = default;
  virtual double sigma_m(const RangeQuality& q) const = 0;
};

struct RangeWeightingParameters {
  double sigma_m = 0.5;  ///< of a clear satellite at the zenith, 45 dB-Hz
};

using MakeRangeWeighting = std::unique_ptr<RangeWeighting>(const ModelParameters& own,
                                                           const RangeWeightingParameters& p);
ModelTable<MakeRangeWeighting> range_weightings();

}  // namespace canyon::gnss

#include "canyon/gnss/receiver/modes/air_between.h"

#include "canyon/gnss/atmosphere/niell.h"

namespace canyon::gnss {

AirBetween::AirBetween(const DgpsParameters& p, const ReceiverModeSetup& at)
    : p_(p),
      has_ionosphere_(at.ionosphere),
      has_troposphere_(at.troposphere),
      ionosphere_(at.seed, "gnss.dgps.ionosphere", 1800.0),
      troposphere_(at.seed, "gnss.dgps.troposphere", 3600.0) {}

double AirBetween::ionosphere_m(const CorrectionInput& in, double distance_km) const {
  if (!has_ionosphere_) return 0.0;
  return 1e-3 * p_.ionosphere_gradient_mm_per_km * distance_km * ionosphere_.at(in.sv.entity(), in.t) *
         single_layer_obliquity(in.true_view.elevation_rad) * in.ionosphere_from_l1;
}

double AirBetween::troposphere_m(const CorrectionInput& in, double distance_km) const {
  if (!has_troposphere_) return 0.0;
  return 1e-3 * p_.troposphere_gradient_mm_per_km * distance_km * troposphere_.at(0, in.t) *
         niell_wet(in.true_view.elevation_rad, in.true_view.receiver.lat_rad);
}

}  // namespace canyon::gnss

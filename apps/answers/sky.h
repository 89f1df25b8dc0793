#pragma once

#include <string>
#include <vector>

#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/output/json.h"
#include "canyon/gnss/paths/obstruction.h"
#include "canyon/gnss/sensor/simulation/sky.h"

namespace canyon::apps {

/// What `gnss sky` says: as JSON, as text, as a drawing.
struct SkyAnswer {
  const GnssSetup& setup;
  Geodetic place;
  double duration_s, step_s;  ///< of the epochs
  std::vector<gnss::SkyEpoch> epochs;
  gnss::ObstructionMask mask;
};
Json sky_json(const SkyAnswer& answer);
void print_sky(const SkyAnswer& answer);
std::string sky_svg(const SkyAnswer& answer);

}  // namespace canyon::apps

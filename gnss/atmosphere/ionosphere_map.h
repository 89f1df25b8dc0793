#pragma once

#include <memory>

#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/sky_view.h"

namespace canyon::gnss {

/// Slant delay at L1, m, of the map at the point where the line of sight meets its shell: vertical TEC there over the
/// cosine of the zenith angle at the shell. NaN outside the time of the maps.
double ionosphere_map_delay_m(const IonexMaps& maps, const SkyView& view);

/// The same as a model. Where the maps have no value a thin shell of `vtec_tecu` stands in.
std::unique_ptr<IonosphereModel> make_mapped_ionosphere(std::shared_ptr<const IonexMaps> maps, double vtec_tecu);

}  // namespace canyon::gnss

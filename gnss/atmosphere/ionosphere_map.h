#pragma once

#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/sky_view.h"

namespace canyon::gnss {

/// Slant delay at L1, m, of the map at the point where the line of sight meets its shell: vertical TEC there over the
/// cosine of the zenith angle at the shell. NaN outside the time of the maps.
double ionosphere_map_delay_m(const IonexMaps& maps, const SkyView& view);

}  // namespace canyon::gnss

#include "canyon/gnss/single_point/recorded_data.h"

#include "canyon/gnss/products/precise_products.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"

namespace canyon::gnss {
namespace {

Result<std::unique_ptr<Constellation>> constellation_of(const RecordedFiles& files, const SinglePointConfig& config,
                                                        const NavigationData& navigation,
                                                        const ObservationHeader& header,
                                                        std::vector<std::string>& warnings) {
  if (files.sp3.empty()) {
    BroadcastOptions broadcast;
    broadcast.systems = config.systems;
    broadcast.choice = config.ephemeris;
    return make_broadcast(navigation, broadcast);
  }
  CANYON_TRY(const auto products, read_precise_products(files.sp3, "", files.antex));
  warnings.insert(warnings.end(), products.orbits.warnings.begin(), products.orbits.warnings.end());
  PreciseOptions precise = products.options(config.systems);
  precise.broadcast = &navigation;
  precise.glonass_channels = header.glonass_channels;
  if (!products.antennas)
    warnings.push_back(products.orbits.names() +
                       ": without --antex its positions are taken as those of the antennas; IGS products give the "
                       "centre of mass, and ranges err by metres");
  return make_precise(products.orbits, precise);
}

}  // namespace

Result<RecordedData> read_recorded_data(const RecordedFiles& files, const SinglePointConfig& config) {
  RecordedData out;
  CANYON_TRY(out.navigation, read_navigation_files(files.navigation));
  CANYON_TRY(out.observations, read_observation_file(files.observations));
  out.warnings = out.navigation.warnings;
  CANYON_TRY(out.constellation, constellation_of(files, config, out.navigation, out.observations.header, out.warnings));
  if (!files.ionex.empty()) {
    CANYON_TRY(out.ionosphere_maps, read_ionex_file(files.ionex));
    out.warnings.insert(out.warnings.end(), out.ionosphere_maps->warnings.begin(), out.ionosphere_maps->warnings.end());
  }
  if (!files.base.empty()) {
    CANYON_TRY(ObservationFile observations, read_observation_file(files.base));
    out.warnings.insert(out.warnings.end(), observations.warnings.begin(), observations.warnings.end());
    out.base = BaseRecording{std::move(observations), files.base_E.value()};
  }
  return out;
}

}  // namespace canyon::gnss

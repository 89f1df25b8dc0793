#include "canyon/gnss/sensor/sensor.h"

#include <cmath>

#include "canyon/gnss/sensor/gnss_config.h"

namespace canyon::gnss {
namespace {

std::vector<Need> no_path_needs(const GnssConfig&, const GnssSurroundings&, const RouteSegment&) {
  return {};
}
std::vector<Need> no_delay_needs(const GnssConfig&, const GnssSurroundings&) {
  return {};
}
constexpr SensorNeeds kNoNeeds{no_path_needs, no_delay_needs};

constexpr ModelRow<MakeSensor> kSensors[] = {
    {"pseudorange",
     {make_pseudorange_sensor, &kPseudorangeNeeds},
     "satellites, delays, paths in the scene, receiver and solver"},
    {"truth_plus_isotropic",
     {make_isotropic_sensor, &kNoNeeds},
     "truth plus a random direction times U(min, max), independent per fix",
     isotropic_parameters},
    {"truth_plus_white",
     {make_white_noise_sensor, &kNoNeeds},
     "truth plus white Gaussian noise per axis",
     white_noise_parameters},
    {"satellite_count",
     {make_satellite_count_sensor},
     "Balaguer & Carpin (2008): truth plus noise that falls with the number of satellites in sight",
     satellite_count_parameters},
};

}  // namespace

ModelTable<MakeSensor> sensor_models() {
  return kSensors;
}

std::int64_t epoch_index(const GnssConfig& config, double t_s) {
  return std::llround(t_s * config.rate_hz);
}

Result<std::unique_ptr<GnssSensor>> make_gnss_sensor(const GnssConfig& config, std::uint64_t seed, GpsTime start,
                                                     GpsTime end, const scene::Scene& scene,
                                                     std::optional<std::uint64_t> noise_seed) {
  return config.model.make("gnss.model", SensorSetup{config, seed, start, end, scene, noise_seed.value_or(seed)});
}

}  // namespace canyon::gnss

#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "canyon/core/model_choice.h"
#include "canyon/core/motion/route_segment.h"
#include "canyon/core/need.h"
#include "canyon/gnss/sensor/sensor.h"

namespace canyon::gnss {

/// What sensors are built from beside their own keys.
struct SensorSetup {
  const GnssConfig& config;
  std::uint64_t seed;
  GpsTime start, end;
  const scene::Scene& scene;
  std::uint64_t noise_seed;  ///< of what a receiver draws anew at every epoch
};

struct GnssSurroundings;
/// States which effects of the sensor that depend on places act along a piece of a route (gnss/sensor/sensor_need.h).
using StatePlaceNeeds = std::vector<Need>(const GnssConfig& config, const GnssSurroundings& around,
                                          const RouteSegment& segment);
/// States how far leaving out a delay moves a range, wherever the antenna is along the route.
using StateRangeNeeds = std::vector<Need>(const GnssConfig& config, const GnssSurroundings& around);
struct SensorNeeds {
  StatePlaceNeeds* places;
  StateRangeNeeds* ranges;
};
using MakeSensor = MakerAndNeed<Result<std::unique_ptr<GnssSensor>>(const ModelParameters& own, const SensorSetup& at),
                                const SensorNeeds>;
ModelTable<MakeSensor> sensor_models();

/// The least that a fix whose noise is a key claims, 1-sigma per axis: whoever weighs it needs a covariance with an
/// inverse.
inline constexpr double kLeastClaimed_m = 1e-3;

/// truth_plus_isotropic: the fix is the truth plus an isotropic direction times U(min, max); see isotropic_sensor.cpp.
Result<std::unique_ptr<GnssSensor>> make_isotropic_sensor(const ModelParameters& own, const SensorSetup& at);
void isotropic_parameters(ModelParameters& section);

/// truth_plus_white: the fix is the truth plus white Gaussian noise; see white_noise_sensor.cpp.
Result<std::unique_ptr<GnssSensor>> make_white_noise_sensor(const ModelParameters& own, const SensorSetup& at);
void white_noise_parameters(ModelParameters& section);

/// satellite_count: noise by the number of satellites in sight; see satellite_count_sensor.cpp.
Result<std::unique_ptr<GnssSensor>> make_satellite_count_sensor(const ModelParameters& own, const SensorSetup& at);
void satellite_count_parameters(ModelParameters& section);

/// pseudorange: satellites, delays, paths, receiver and solver; see pseudorange_sensor.cpp.
Result<std::unique_ptr<GnssSensor>> make_pseudorange_sensor(const ModelParameters& own, const SensorSetup& at);
StatePlaceNeeds pseudorange_path_needs;
StateRangeNeeds pseudorange_delay_needs;
inline constexpr SensorNeeds kPseudorangeNeeds{pseudorange_path_needs, pseudorange_delay_needs};

}  // namespace canyon::gnss

#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "canyon/core/model_table.h"
#include "canyon/gnss/sensor/sensor.h"

namespace canyon::gnss {

using MakeSensor = Result<std::unique_ptr<GnssSensor>>(const GnssConfig&, std::uint64_t, GpsTime start, GpsTime end,
                                                       const scene::Scene&);
std::span<const ModelRow<MakeSensor>> sensor_models();

/// truth_plus_isotropic: the fix is the truth plus an isotropic direction times U(min, max); see isotropic_sensor.cpp.
Result<std::unique_ptr<GnssSensor>> make_isotropic_sensor(const GnssConfig& config, std::uint64_t seed, GpsTime start,
                                                          GpsTime end, const scene::Scene& scene);

/// truth_plus_white: the fix is the truth plus white Gaussian noise; see white_noise_sensor.cpp.
Result<std::unique_ptr<GnssSensor>> make_white_noise_sensor(const GnssConfig& config, std::uint64_t seed, GpsTime start,
                                                            GpsTime end, const scene::Scene& scene);

/// satellite_count: noise by the number of satellites in sight; see satellite_count_sensor.cpp.
Result<std::unique_ptr<GnssSensor>> make_satellite_count_sensor(const GnssConfig& config, std::uint64_t seed,
                                                                GpsTime start, GpsTime end, const scene::Scene& scene);

/// pseudorange: satellites, delays, paths, receiver and solver; see pseudorange_sensor.cpp.
Result<std::unique_ptr<GnssSensor>> make_pseudorange_sensor(const GnssConfig& config, std::uint64_t seed, GpsTime start,
                                                            GpsTime end, const scene::Scene& scene);

}  // namespace canyon::gnss

#pragma once

#include <cstdint>
#include <memory>

#include "lidar/beam_table.h"
#include "lidar/scanner.h"

/// Makers of the scanner models; each is defined in the model's own .cpp and has its row in lidar/scanner.cpp.
namespace canyon::lidar {

std::unique_ptr<Scanner> make_single_ray(const LidarConfig& config, const BeamTable& table, std::uint64_t seed);

}  // namespace canyon::lidar

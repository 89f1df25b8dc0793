#pragma once

#include <span>
#include <string>

#include "canyon/core/result.h"
#include "canyon/lidar/files/map_cloud.h"

namespace canyon::lidar {

/// Binary PCD v0.7 with fields x y z intensity error; error_m[i] is of point i.
Status write_pcd(const std::string& path, const MapCloud& cloud, std::span<const float> error_m);

}  // namespace canyon::lidar

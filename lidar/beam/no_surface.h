#pragma once

#include <cstdint>

namespace canyon::lidar {

/// Material and object of a return that no surface of the scene sent (a drop, another sensor's pulse), in
/// LidarPointTruth.
inline constexpr std::uint16_t kNoMaterial = 0xffff;
inline constexpr std::uint32_t kNoObject = 0xffffffff;

}  // namespace canyon::lidar

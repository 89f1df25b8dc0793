#include "canyon/lidar/files/cloud_files.h"

#include <array>
#include <cstring>

#include "canyon/core/files/files.h"
#include "canyon/core/files/pcd.h"

namespace canyon::lidar {

Status write_pcd(const std::string& path, std::span<const MapPoint> points) {
  std::string bytes = pcd_header(
      {{.name = "x"}, {.name = "y"}, {.name = "z"}, {.name = "intensity"}, {.name = "error"}}, points.size());
  bytes.reserve(bytes.size() + points.size() * 20);
  for (const MapPoint& point : points) {
    const std::array<float, 5> values{point.p_W.x(), point.p_W.y(), point.p_W.z(), point.intensity, point.error_m};
    std::array<char, sizeof(values)> raw;
    std::memcpy(raw.data(), values.data(), sizeof(values));
    bytes.append(raw.data(), raw.size());
  }
  return write_text_file(path, bytes);
}

}  // namespace canyon::lidar

#include "canyon/lidar/files/cloud_files.h"

#include <array>
#include <cstring>

#include "canyon/core/check.h"
#include "canyon/core/files/file_writer.h"
#include "canyon/core/files/pcd.h"

namespace canyon::lidar {
namespace {

std::string rows(std::span<const MapPoint> points, std::span<const float> error_m) {
  std::string bytes;
  bytes.reserve(points.size() * 20);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [p_W, intensity] = points[i];
    const std::array<float, 5> values{p_W.x(), p_W.y(), p_W.z(), intensity, error_m[i]};
    std::array<char, sizeof(values)> raw;
    std::memcpy(raw.data(), values.data(), sizeof(values));
    bytes.append(raw.data(), raw.size());
  }
  return bytes;
}

}  // namespace

Status write_pcd(const std::string& path, const MapCloud& cloud, std::span<const float> error_m) {
  CANYON_CHECK(error_m.size() == cloud.size(), "points = ", cloud.size(), ", errors = ", error_m.size());
  CANYON_TRY(auto file, FileWriter::create(path));
  CANYON_TRY_STATUS(file.write(pcd_header(
      {{.name = "x"}, {.name = "y"}, {.name = "z"}, {.name = "intensity"}, {.name = "error"}}, cloud.size())));
  for (std::size_t k = 0; k < cloud.blocks(); ++k) {
    const auto points = cloud.block(k);
    CANYON_TRY_STATUS(file.write(rows(points, error_m.subspan(k * MapCloud::kBlock, points.size()))));
  }
  return file.close();
}

}  // namespace canyon::lidar

#include "canyon/lidar/files/map_files.h"

#include <algorithm>
#include <limits>

#include "canyon/lidar/files/clouds/read_cloud.h"

namespace canyon::lidar {

Result<ReadMap> read_map(const std::string& path) {
  CANYON_TRY(const CloudPlaces cloud, read_cloud(path));
  ReadMap out;
  for (const Eigen::Vector3d& p : cloud.points) {
    if (p.allFinite() && p.cwiseAbs().maxCoeff() < 1e7)
      out.points.push_back(p.cast<float>());
    else
      ++out.not_finite;
  }
  if (out.points.empty()) return Error{path, 0, "", "holds no finite point", "a map"};
  return out;
}

Result<ReadMap> read_prior_map(const std::string& path) {
  constexpr float kFar_m = 50e3F;
  CANYON_TRY(ReadMap map, read_map(path));
  float nearest_m = std::numeric_limits<float>::infinity();
  for (const Eigen::Vector3f& p : map.points) nearest_m = std::min(nearest_m, p.norm());
  if (nearest_m < kFar_m) return map;
  return Error{path, 0, "", "no point is within 50 km of the scene's centre", "metres east, north and up of it (W)"};
}

}  // namespace canyon::lidar

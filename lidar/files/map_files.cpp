#include "canyon/lidar/files/map_files.h"

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

}  // namespace canyon::lidar

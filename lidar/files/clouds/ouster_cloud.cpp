#include <algorithm>

#include "canyon/lidar/files/clouds/read_cloud.h"
#include "canyon/lidar/ouster/recording.h"

namespace canyon::lidar {

Result<CloudPlaces> read_ouster_cloud(const std::string& path, const std::string& metadata_path) {
  CANYON_TRY(const ouster::Metadata metadata, ouster::read_metadata(metadata_path));
  CANYON_TRY(const auto frames, ouster::read_frames(path, metadata));
  // The first that is as full as any: a capture may begin within a turn, and packets may be lost.
  const auto fullest =
      std::max_element(frames.begin(), frames.end(),
                       [](const ouster::Frame& a, const ouster::Frame& b) { return a.columns < b.columns; });
  CloudPlaces out;
  for (const ouster::Return& r : fullest->returns) out.points.push_back(r.p_m);
  if (out.points.empty()) return Error{path, 0, "", "holds no return", "a cloud of points"};
  return out;
}

}  // namespace canyon::lidar

#pragma once

#include <span>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/core/truth.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {

/// A structured cloud as a file: x y z (m, in whatever frame the points are), intensity 0..1, time (s, relative to the
/// stamp), ring, return (0 = nearest of its shot).
struct CloudFormat {
  const char* name;  ///< also the extension: "pcd"
  std::string (*text)(GpsTime stamp, std::span<const LidarPoint> points);
  const char* doc;
};
/// pcd: binary PCD 0.7. ply: binary little-endian PLY. las: LAS 1.2, point format 1, coordinates in steps of 0.1 mm,
/// intensity times 65535, ring as user data, GPS time adjusted (less 1e9 s); a ring beyond 255 is written as 255.
const std::vector<CloudFormat>& cloud_formats();
/// The row of a name; the error names the option that it was given to.
Result<const CloudFormat*> cloud_format(const std::string& name, const std::string& option);

/// What a registration analysis needs of each point and autonomy never sees, line by line as the points:
/// `true_range_m,cos_incidence,material,object`; names are empty where no surface sent the return.
std::string truth_csv(std::span<const LidarPointTruth> truth, const scene::SceneAt& scene);

}  // namespace canyon::lidar

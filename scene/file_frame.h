#pragma once

#include <optional>
#include <vector>

#include "canyon/scene/elevation/terrain_file.h"
#include "canyon/scene/import.h"
#include "canyon/scene/importers/raw_scene.h"
#include "canyon/scene/projection.h"

namespace canyon::scene {

/// What was read of a scene's files, in their own coordinates.
struct FileScenes {
  std::vector<RawScene> scenes;
  std::vector<std::optional<Projection>> projections;  ///< of each; none: local metres
};

/// W among the coordinates of files.
struct FileFrame {
  LocalFrame frame;
  double undulation_m = 0.0;  ///< what is added to the files' heights, to be above the ellipsoid
  Eigen::Vector3d file_origin_m = Eigen::Vector3d::Zero();  ///< of local metres: what lies at W's origin
  std::optional<TerrainFile> terrain;  ///< the elevation model, where the origin's height was looked up in it
};

/// W's origin: the middle of what was read (or center_deg), at the median of the ground's heights, in whole metres. Of
/// local metres `origin`. `report` is told what heights are above.
Result<FileFrame> find_frame(const FileScenes& files, const ImportConfig& config, const Geodetic& origin,
                             ImportReport& report);

/// Sets a file down in W. Returns how many points lie outside the coordinate system's domain: their surfaces are left
/// out.
int set_down(RawScene& scene, const std::optional<Projection>& projection, const FileFrame& at);

}  // namespace canyon::scene

#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "canyon/scene/scene_at.h"

namespace canyon::gnss {

/// Which parts of the sky the scene hides from a point: one ray per square degree, tree crowns not counted (they
/// attenuate, see SceneAt::foliage_m).
class ObstructionMask {
 public:
  static constexpr int kAzimuths = 360;
  static constexpr int kElevations = 90;

  /// `up_W`, `north_W`: unit vectors of the local horizon at the point.
  ObstructionMask(const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& up_W, const Eigen::Vector3d& north_W,
                  const scene::SceneAt& scene);

  /// Of the cell from azimuth_deg (from north, clockwise, 0..359) and elevation_deg (0..89), both plus one.
  bool blocked(int azimuth_deg, int elevation_deg) const {
    return blocked_[static_cast<std::size_t>(azimuth_deg * kElevations + elevation_deg)] != 0;
  }
  /// Open share of the solid angle above an elevation, 0..1.
  double open_share(int above_elevation_deg) const;

 private:
  std::vector<std::uint8_t> blocked_;
};

}  // namespace canyon::gnss

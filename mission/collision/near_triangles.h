#pragma once

#include <cstdint>
#include <vector>

#include "canyon/scene/scene_at.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::mission {

/// A triangle found near a place: its index as SceneAt counts them, and its corners in W.
struct NearTriangle {
  std::uint32_t index = 0;
  scene::Triangle corners;
};

/// Which triangles are near the vehicle, those of moving things included. It keeps those of a square around the last
/// places in cells, and looks through the scene's again where the vehicle leaves it; so its memory does not grow with
/// the scene. One per run; the scene must outlive it.
class NearTriangles {
 public:
  explicit NearTriangles(const scene::SceneAt& scene) : scene_(scene) {}

  /// All triangles within max_m of p, each once, by their index; valid until the next call. max_m <= kMost_m.
  const std::vector<NearTriangle>& near(const Eigen::Vector3d& p_W, double max_m);
  static constexpr double kMost_m = 160.0;

 private:
  static constexpr double kHalf_m = 256.0, kCell_m = 4.0;
  static constexpr int kCells = static_cast<int>(2.0 * kHalf_m / kCell_m);

  void gather(const Eigen::Vector2d& centre_W);
  int cell(double from_centre_m) const;

  const scene::SceneAt& scene_;
  bool gathered_ = false;
  Eigen::Vector2d centre_W_{0, 0};
  std::vector<std::uint32_t> members_, first_;  ///< triangles by cell; where each cell's begin
  std::vector<std::uint32_t> found_;
  std::vector<NearTriangle> near_;
};

}  // namespace canyon::mission

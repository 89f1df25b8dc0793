#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "canyon/scene/scene_at.h"

namespace canyon::lidar {

/// Where a point lies to the nearest true surface.
struct SurfaceOffset {
  bool found = false;  ///< a surface is nearer than the cap; else nothing below holds
  /// Signed: positive in front of the surface (outside of a body), negative behind it. Exact to the single precision of
  /// the scene's corners.
  double distance_m = 0.0;
  Eigen::Vector3d offset_W = Eigen::Vector3d::Zero();  ///< from the surface to the point; its length is |distance_m|
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  ///< unit, outward, of the nearest triangle
  std::uint32_t triangle = 0;                          ///< of equally near ones that with the lowest index

  double up_m() const { return offset_W.z(); }
  double across_m() const { return offset_W.head<2>().norm(); }
};

/// Signed distances to a static scene. The sign at edges and corners, where the nearest point belongs to several
/// triangles, is that of the sum of their normals, each weighted with its angle there (Baerentzen & Aanaes, IEEE
/// Trans. Vis. Comput. Graph. 11 (2005) 243, which proves it right for closed bodies). Corners that lie within 0.1 mm
/// of one another are one. Thread-safe once made.
class SignedDistance {
 public:
  explicit SignedDistance(const scene::Scene& scene);
  ~SignedDistance();
  SignedDistance(const SignedDistance&) = delete;
  SignedDistance& operator=(const SignedDistance&) = delete;

  /// p must be finite, cap_m > 0.
  SurfaceOffset at(const Eigen::Vector3d& p_W, double cap_m) const;
  /// The same where the nearest surface within cap_m is known.
  SurfaceOffset at(const Eigen::Vector3d& p_W, double cap_m, const scene::NearestSurface& nearest) const;

 private:
  struct Corners;
  Eigen::Vector3d pseudo_normal(const Eigen::Vector3d& nearest_W, std::uint32_t triangle) const;

  scene::SceneAt scene_;
  std::unique_ptr<Corners> corners_;
};

}  // namespace canyon::lidar

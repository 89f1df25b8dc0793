#pragma once

#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "canyon/core/earth/earth.h"
#include "canyon/core/result.h"
#include "canyon/scene/importers/raw_scene.h"

namespace canyon::scene {

struct MapTransform;

/// From the coordinates of a map to WGS84 and back: any coordinate system that PROJ knows, with the best of its
/// transformations that need no further files. Heights are left alone: only what they mean is told.
class Projection {
 public:
  /// `file` and `key` are named in the error.
  static Result<Projection> make(const SourceFrame& frame, const std::string& file, const std::string& key);

  /// Latitude and longitude of a point, with the height handed through; nullopt outside of the system's domain.
  std::optional<Geodetic> to_geodetic(const Eigen::Vector3d& p) const;
  /// Back, without the height.
  std::optional<Eigen::Vector2d> from_geodetic(const Geodetic& g) const;

  /// What the heights are above, as the system says: "NAP height", "ellipsoid"; empty if it says nothing.
  const std::string& vertical() const;
  bool ellipsoidal() const { return vertical() == "ellipsoid"; }
  const std::string& name() const;

 private:
  std::shared_ptr<const MapTransform> transform_;
};

}  // namespace canyon::scene

#pragma once

#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "canyon/core/earth/earth.h"
#include "canyon/core/process/library_part.h"
#include "canyon/scene/importers/raw_scene.h"

namespace canyon::scene {

/// From the coordinates of a map to WGS84 and back. Heights are left alone.
struct MapTransform {
  virtual ~MapTransform() = default;
  virtual std::optional<Geodetic> to_geodetic(const Eigen::Vector3d& p) const = 0;
  virtual std::optional<Eigen::Vector2d> from_geodetic(const Geodetic& g) const = 0;
  std::string name, vertical;
};

/// What stands on PROJ (core/process/library_part.h).
struct ProjPart {
  /// Null for a coordinate system that PROJ does not know.
  std::shared_ptr<const MapTransform> (*make)(const SourceFrame& frame);
};
extern "C" [[gnu::weak]] const ProjPart canyon_proj_part;

}  // namespace canyon::scene

#include "canyon/scene/projection.h"

#include "canyon/scene/proj_part.h"

namespace canyon::scene {

Result<Projection> Projection::make([[maybe_unused]] const SourceFrame& frame, const std::string& file,
                                    const std::string& key) {
#ifndef CANYON_WITH_PROJ
  return Error{file, 0, key, "this canyon was built without map projections", "a build with CANYON_WITH_PROJ=ON"};
#else
  Projection out;
  out.transform_ = library_part("proj", &canyon_proj_part).make(frame);
  if (!out.transform_)
    return Error{file, 0, key, "PROJ knows no coordinate system \"" + frame.crs + "\"",
                 "an EPSG code, WKT or PROJ string"};
  return out;
#endif
}

std::optional<Geodetic> Projection::to_geodetic(const Eigen::Vector3d& p) const {
  if (!p.allFinite()) return std::nullopt;
  return transform_->to_geodetic(p);
}

std::optional<Eigen::Vector2d> Projection::from_geodetic(const Geodetic& g) const {
  return transform_->from_geodetic(g);
}

const std::string& Projection::vertical() const {
  return transform_->vertical;
}

const std::string& Projection::name() const {
  return transform_->name;
}

}  // namespace canyon::scene

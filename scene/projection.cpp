#include "canyon/scene/projection.h"

#include <proj.h>

#include <cmath>

#include "canyon/core/units.h"

namespace canyon::scene {

struct Projection::Proj {
  PJ_CONTEXT* context = proj_context_create();
  PJ* transform = nullptr;
  ~Proj() {
    proj_destroy(transform);
    proj_context_destroy(context);
  }
};

Result<Projection> Projection::make(const SourceFrame& frame, const std::string& file, const std::string& key) {
  Projection out;
  out.proj_ = std::make_shared<Proj>();
  PJ_CONTEXT* context = out.proj_->context;
  proj_log_level(context, PJ_LOG_NONE);
  proj_context_set_enable_network(context, 0);
  const auto unknown = [&] {
    return Error{file, 0, key, "PROJ knows no coordinate system \"" + frame.crs + "\"",
                 "an EPSG code, WKT or PROJ string"};
  };
  const auto owned = [](PJ* pj) { return std::unique_ptr<PJ, PJ* (*)(PJ*)>(pj, proj_destroy); };
  auto crs = owned(proj_create(context, frame.crs.c_str()));
  if (!crs || proj_is_crs(crs.get()) == 0) return unknown();
  out.name_ = proj_get_name(crs.get());
  if (proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS) {
    if (const auto vertical = owned(proj_crs_get_sub_crs(context, crs.get(), 1)))
      out.vertical_ = proj_get_name(vertical.get());
    crs = owned(proj_crs_get_sub_crs(context, crs.get(), 0));
    if (!crs) return unknown();
  } else if (proj_get_type(crs.get()) == PJ_TYPE_GEOGRAPHIC_3D_CRS) {
    out.vertical_ = "ellipsoid";
  }
  const auto wgs84 = owned(proj_create(context, "OGC:CRS84"));
  CANYON_CHECK(wgs84 != nullptr, "PROJ lacks its database");
  PJ* transform = proj_create_crs_to_crs_from_pj(context, crs.get(), wgs84.get(), nullptr, nullptr);
  if (transform != nullptr && !frame.authority_order) {
    PJ* east_north = proj_normalize_for_visualization(context, transform);
    proj_destroy(transform);
    transform = east_north;
  }
  if (transform == nullptr) return unknown();
  out.proj_->transform = transform;
  return out;
}

std::optional<Geodetic> Projection::to_geodetic(const Eigen::Vector3d& p) const {
  if (!p.allFinite()) return std::nullopt;
  const PJ_COORD at = proj_trans(proj_->transform, PJ_FWD, proj_coord(p.x(), p.y(), 0.0, 0.0));
  if (!std::isfinite(at.xy.x) || !std::isfinite(at.xy.y)) return std::nullopt;
  return Geodetic{at.xy.y * kDegree, at.xy.x * kDegree, p.z()};
}

std::optional<Eigen::Vector2d> Projection::from_geodetic(const Geodetic& g) const {
  const PJ_COORD at =
      proj_trans(proj_->transform, PJ_INV, proj_coord(g.lon_rad / kDegree, g.lat_rad / kDegree, 0.0, 0.0));
  if (!std::isfinite(at.xy.x) || !std::isfinite(at.xy.y)) return std::nullopt;
  return Eigen::Vector2d(at.xy.x, at.xy.y);
}

}  // namespace canyon::scene

#include <proj.h>

#include <cmath>
#include <memory>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/scene/proj_part.h"

namespace canyon::scene {
namespace {

using OwnedPj = std::unique_ptr<PJ, PJ* (*)(PJ*)>;

class ProjTransform final : public MapTransform {
 public:
  explicit ProjTransform(const SourceFrame& frame) : context_(proj_context_create(), proj_context_destroy) {
    PJ_CONTEXT* const context = context_.get();
    proj_log_level(context, PJ_LOG_NONE);
    proj_context_set_enable_network(context, 0);
    OwnedPj crs = owned(proj_create(context, frame.crs.c_str()));
    if (!crs || proj_is_crs(crs.get()) == 0) return;
    name = proj_get_name(crs.get());
    if (proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS) {
      if (const auto height = owned(proj_crs_get_sub_crs(context, crs.get(), 1)))
        vertical = proj_get_name(height.get());
      crs = owned(proj_crs_get_sub_crs(context, crs.get(), 0));
      if (!crs) return;
    } else if (proj_get_type(crs.get()) == PJ_TYPE_GEOGRAPHIC_3D_CRS) {
      vertical = "ellipsoid";
    }
    const OwnedPj wgs84 = owned(proj_create(context, "OGC:CRS84"));
    CANYON_CHECK(wgs84 != nullptr, "PROJ lacks its database");
    transform_ = owned(proj_create_crs_to_crs_from_pj(context, crs.get(), wgs84.get(), nullptr, nullptr));
    if (transform_ && !frame.authority_order)
      transform_ = owned(proj_normalize_for_visualization(context, transform_.get()));
  }

  bool known() const { return transform_ != nullptr; }

  std::optional<Geodetic> to_geodetic(const Eigen::Vector3d& p) const override {
    const PJ_COORD at = proj_trans(transform_.get(), PJ_FWD, proj_coord(p.x(), p.y(), 0.0, 0.0));
    if (!std::isfinite(at.xy.x) || !std::isfinite(at.xy.y)) return std::nullopt;
    return Geodetic{at.xy.y * kDegree, at.xy.x * kDegree, p.z()};
  }

  std::optional<Eigen::Vector2d> from_geodetic(const Geodetic& g) const override {
    const PJ_COORD at =
        proj_trans(transform_.get(), PJ_INV, proj_coord(g.lon_rad / kDegree, g.lat_rad / kDegree, 0.0, 0.0));
    if (!std::isfinite(at.xy.x) || !std::isfinite(at.xy.y)) return std::nullopt;
    return Eigen::Vector2d(at.xy.x, at.xy.y);
  }

 private:
  static OwnedPj owned(PJ* pj) { return OwnedPj(pj, proj_destroy); }

  std::unique_ptr<PJ_CONTEXT, PJ_CONTEXT* (*)(PJ_CONTEXT*)> context_;
  OwnedPj transform_{nullptr, proj_destroy};
};

std::shared_ptr<const MapTransform> make(const SourceFrame& frame) {
  const auto transform = std::make_shared<ProjTransform>(frame);
  if (!transform->known()) return nullptr;
  return transform;
}

}  // namespace

extern "C" const ProjPart canyon_proj_part{make};

}  // namespace canyon::scene

#include <cmath>

#include "core/check.h"
#include "core/units.h"
#include "gnss/atmosphere/ionosphere.h"
#include "gnss/products/ionex_file.h"

namespace canyon::gnss {
namespace {

/// Vertical electron content of global ionosphere maps, where the line of sight pierces their shell, by the shell's own
/// obliquity 1 / sqrt(1 - (R cos e / (R + h))^2). Where the maps have no value the constant `vtec_tecu` stands in.
class IonexIonosphere final : public IonosphereModel {
 public:
  explicit IonexIonosphere(const IonosphereParameters& p) : maps_(p.maps), fallback_tecu_(p.vtec_tecu) {
    CANYON_CHECK(maps_ != nullptr, "no maps");
  }

  double delay_m(const SkyView& v) const override {
    const double sin_zenith =
        maps_->base_radius_m / (maps_->base_radius_m + maps_->shell_height_m) * std::cos(v.elevation_rad);
    // Angle at the Earth's centre between receiver and pierce point.
    const double psi = 0.5 * kPi - v.elevation_rad - std::asin(sin_zenith);
    const double sin_lat = std::sin(v.receiver.lat_rad), cos_lat = std::cos(v.receiver.lat_rad);
    const double east = std::sin(psi) * std::sin(v.azimuth_rad),
                 out = std::cos(psi) * cos_lat - std::sin(psi) * std::cos(v.azimuth_rad) * sin_lat,
                 up = std::cos(psi) * sin_lat + std::sin(psi) * std::cos(v.azimuth_rad) * cos_lat;
    const double lat_rad = std::atan2(up, std::hypot(east, out));
    const double lon_rad = std::remainder(v.receiver.lon_rad + std::atan2(east, out), 2.0 * kPi);
    double tecu = maps_->vtec_tecu(lat_rad, lon_rad, v.t);
    if (!std::isfinite(tecu)) tecu = fallback_tecu_;
    return vertical_ionosphere_m(tecu) / std::sqrt(1.0 - sin_zenith * sin_zenith);
  }

 private:
  std::shared_ptr<const IonexMaps> maps_;
  double fallback_tecu_;
};

}  // namespace

std::unique_ptr<IonosphereModel> make_ionex(const IonosphereParameters& p) {
  return std::make_unique<IonexIonosphere>(p);
}

}  // namespace canyon::gnss

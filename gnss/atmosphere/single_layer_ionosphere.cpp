#include <cmath>

#include "canyon/gnss/atmosphere/ionosphere.h"

namespace canyon::gnss {
namespace {

class SingleLayer final : public IonosphereModel {
 public:
  explicit SingleLayer(double zenith_m) : zenith_m_(zenith_m) {}
  double delay_m(const SkyView& view) const override { return zenith_m_ * single_layer_obliquity(view.elevation_rad); }

 private:
  double zenith_m_;
};

}  // namespace

double single_layer_obliquity(double elevation_rad) {
  constexpr double kEarthKm = 6378.137, kShellKm = 350.0;
  const double sin_zenith = kEarthKm / (kEarthKm + kShellKm) * std::cos(elevation_rad);
  return 1.0 / std::sqrt(1.0 - sin_zenith * sin_zenith);
}

std::unique_ptr<IonosphereModel> make_single_layer(double vtec_tecu) {
  return std::make_unique<SingleLayer>(vertical_ionosphere_m(vtec_tecu));
}

}  // namespace canyon::gnss

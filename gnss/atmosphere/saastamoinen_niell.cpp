#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/atmosphere/zenith_delay.h"

namespace canyon::gnss {
namespace {

double slant_m(const Weather& weather, const SkyView& v) {
  const double lat = v.receiver.lat_rad, h = v.receiver.h_m;
  const double dry_m = zenith_hydrostatic_m(weather.pressure_hpa, lat, h);
  const double wet_m = zenith_wet_m(weather.temperature_c, vapour_pressure_hpa(weather));
  return dry_m * niell_hydrostatic(v.elevation_rad, lat, h, v.t.day_of_year()) +
         wet_m * niell_wet(v.elevation_rad, lat);
}

class SaastamoinenNiell final : public TroposphereModel {
 public:
  explicit SaastamoinenNiell(const MeasuredWeather& measured) : measured_(measured) {}
  double delay_m(const SkyView& view) const override { return slant_m(measured_.at(view.receiver.h_m), view); }

 private:
  MeasuredWeather measured_;
};

}  // namespace

std::unique_ptr<TroposphereModel> make_saastamoinen_niell(const MeasuredWeather& measured) {
  return std::make_unique<SaastamoinenNiell>(measured);
}

double standard_troposphere_m(const SkyView& view) {
  return slant_m(standard_weather(view.receiver.h_m), view);
}

}  // namespace canyon::gnss

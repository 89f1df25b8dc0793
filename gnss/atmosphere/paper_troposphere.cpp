#include <cmath>

#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/atmosphere/zenith_delay.h"

namespace canyon::gnss {
namespace {

/// Durst & Goodin (2012), eqs. for dR_trop,wet and dR_trop,dry, as printed. The wet term is Niell's bare mapping taken
/// as metres: it lacks the zenith wet delay (0.12 m), so it is about ten times too large. The dry term is a zenith
/// delay without mapping; its units are not printed: P in hPa gives millimetres, and the height term 0.0028 (the
/// literature has 0.00028 per km) blows up near h = 357 if h is in metres, so h is taken in km. The pressure is taken
/// as given, at any height.
class PaperPrinted final : public TroposphereModel {
 public:
  explicit PaperPrinted(const MeasuredWeather& measured) : measured_(measured) {}
  double delay_m(const SkyView& v) const override {
    return niell_wet(v.elevation_rad, v.receiver.lat_rad) +
           paper_dry_delay_m(measured_.weather.pressure_hpa, v.receiver.lat_rad, v.receiver.h_m, 0.0028);
  }

 private:
  MeasuredWeather measured_;
};

/// The same two terms made physical: zenith wet delay times the wet mapping; dry with 0.00028 per km and the
/// hydrostatic mapping.
class PaperCorrected final : public TroposphereModel {
 public:
  explicit PaperCorrected(const MeasuredWeather& measured) : measured_(measured) {}
  double delay_m(const SkyView& v) const override {
    const double lat = v.receiver.lat_rad, h = v.receiver.h_m;
    const Weather weather = measured_.at(h);
    const double wet_m = zenith_wet_m(weather.temperature_c, vapour_pressure_hpa(weather));
    return wet_m * niell_wet(v.elevation_rad, lat) + paper_dry_delay_m(weather.pressure_hpa, lat, h, 0.00028) *
                                                         niell_hydrostatic(v.elevation_rad, lat, h, v.t.day_of_year());
  }

 private:
  MeasuredWeather measured_;
};

}  // namespace

double paper_dry_delay_m(double pressure_hpa, double lat_rad, double height_m, double per_km) {
  return 1e-3 * 2.2779 * pressure_hpa / (1.0 - 0.00266 * std::cos(2.0 * lat_rad) - per_km * 1e-3 * height_m);
}

std::unique_ptr<TroposphereModel> make_paper_printed_troposphere(const MeasuredWeather& measured) {
  return std::make_unique<PaperPrinted>(measured);
}

std::unique_ptr<TroposphereModel> make_paper_corrected_troposphere(const MeasuredWeather& measured) {
  return std::make_unique<PaperCorrected>(measured);
}

}  // namespace canyon::gnss

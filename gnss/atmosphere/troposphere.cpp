#include "canyon/gnss/atmosphere/troposphere.h"

namespace canyon::gnss {
namespace {

class NoTroposphere final : public TroposphereModel {
 public:
  double delay_m(const SkyView&) const override { return 0.0; }
  bool acts() const override { return false; }
};

/// What a receiver without weather sensors assumes, taken for the truth.
class StandardTroposphere final : public TroposphereModel {
 public:
  double delay_m(const SkyView& view) const override { return standard_troposphere_m(view); }
};

std::unique_ptr<TroposphereModel> make_standard(const ModelParameters&) {
  return std::make_unique<StandardTroposphere>();
}

std::unique_ptr<TroposphereModel> make_none(const ModelParameters&) {
  return std::make_unique<NoTroposphere>();
}

/// Delays that fall with elevation and with height. Niell's mapping depends on the day of the year too, by less than
/// 1 % of it at 10 degrees, and on the latitude by less than that within a mission.
double falling_delay_m(const TroposphereModel& model, const SkyView& lowest) {
  return 1.01 * model.delay_m(lowest);
}

template <auto Make>
std::unique_ptr<TroposphereModel> of_weather(const ModelParameters& own) {
  return Make(own.get<SiteWeather>().measured);
}

constexpr ModelRow<MakeTroposphere> kTropospheres[] = {
    {"none", {make_none, falling_delay_m}, "no delay"},
    {"standard",
     {make_standard, falling_delay_m},
     "Saastamoinen and Niell for the ICAO standard atmosphere at the receiver's height"},
    {"saastamoinen_niell",
     {of_weather<make_saastamoinen_niell>, falling_delay_m},
     "Saastamoinen zenith delays of the weather, carried to the receiver's height; Niell (1996) mappings",
     parameters_of<SiteWeather>},
    {"paper_printed", of_weather<make_paper_printed_troposphere>,
     "as printed: bare wet mapping as metres, dry delay without mapping", parameters_of<SiteWeather>},
    {"paper_corrected", of_weather<make_paper_corrected_troposphere>,
     "the paper's terms with zenith delay, mapping and units put right", parameters_of<SiteWeather>},
};

}  // namespace

void visit(FieldVisitor& f, SiteWeather& c) {
  Weather& air = c.measured.weather;
  f.number("pressure_hpa", air.pressure_hpa, {100.0, 1100.0}, "air pressure at weather_height_m");
  f.number("temperature_c", air.temperature_c, {-80.0, 60.0}, "air temperature there");
  f.number("relative_humidity", air.relative_humidity, {0.0, 1.0}, "relative humidity there");
  f.number("weather_height_m", c.measured.height_m, {-500.0, 9000.0},
           "height at which the weather was measured; the standard atmosphere carries it to the receiver's");
}

ModelTable<MakeTroposphere> troposphere_models() {
  return kTropospheres;
}

}  // namespace canyon::gnss

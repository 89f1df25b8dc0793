#pragma once

#include <memory>
#include <span>

#include "canyon/core/model_choice.h"
#include "canyon/core/need.h"
#include "canyon/gnss/atmosphere/weather.h"
#include "canyon/gnss/sky_view.h"

namespace canyon::gnss {

/// Delay of the neutral atmosphere along the line of sight.
class TroposphereModel {
 public:
  virtual ~TroposphereModel() = default;
  /// m, for elevations in [0, pi/2].
  virtual double delay_m(const SkyView& view) const = 0;
  /// False if there is none: then nothing is corrected, and none is left.
  virtual bool acts() const { return true; }
};

/// Keys of the models that take the weather.
struct SiteWeather {
  MeasuredWeather measured{{1022.0, 12.8, 0.80}, 0.0};
};
void visit(FieldVisitor& f, SiteWeather& c);

/// The largest delay that a model gives anywhere at or above a view's elevation, and at or above its height.
using LargestTroposphere = double(const TroposphereModel& model, const SkyView& lowest);

using MakeTroposphere = MakerAndNeed<std::unique_ptr<TroposphereModel>(const ModelParameters& own), LargestTroposphere>;
ModelTable<MakeTroposphere> troposphere_models();

std::unique_ptr<TroposphereModel> make_saastamoinen_niell(const MeasuredWeather& measured);
std::unique_ptr<TroposphereModel> make_paper_printed_troposphere(const MeasuredWeather& measured);
std::unique_ptr<TroposphereModel> make_paper_corrected_troposphere(const MeasuredWeather& measured);

/// The paper's dry delay, m: 2.2779 P / (1 - 0.00266 cos 2 lat - per_km h), P in hPa, h in km, result printed in mm.
double paper_dry_delay_m(double pressure_hpa, double lat_rad, double height_m, double per_km);

/// Saastamoinen and Niell with standard_weather(height of the receiver): what a receiver corrects with.
double standard_troposphere_m(const SkyView& view);

}  // namespace canyon::gnss

#include "canyon/lidar/beam/weather.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/lidar/lidar_config.h"

namespace canyon::lidar {
namespace {

constexpr double kPerDbPerKm = 1e-3 / 4.342944819032518;  // dB/km as 1/m: 10 log10(e) dB per unit of optical depth

/// Particle kinds: extinction over backscatter, sr.
constexpr double kWaterRatio_sr = 18.8;  // cloud droplets at 905 nm: Pinnick et al. 1983; O'Connor et al. 2004
constexpr double kSnowRatio_sr = 20.0;   // assumption: for ice 10 to 30 sr are reported
constexpr double kDustRatio_sr = 50.0;   // assumption: for mineral dust near 900 nm 45 to 60 sr are reported

/// Visibility in km and wavelength in nm to an exponent, after Kruse et al. 1962.
double kruse_exponent(double v_km) {
  if (v_km > 50.0) return 1.6;
  return v_km > 6.0 ? 1.3 : 0.585 * std::cbrt(v_km);
}
/// Kim et al. 2001: no wavelength dependence in thick fog.
double kim_exponent(double v_km) {
  if (v_km > 50.0) return 1.6;
  if (v_km > 6.0) return 1.3;
  if (v_km > 1.0) return 0.16 * v_km + 0.34;
  return std::max(0.0, v_km - 0.5);
}
/// Through less than a millimetre nothing comes anyway, and the powers of it overflow.
constexpr double kLeastVisibility_m = 1e-3;

double by_visibility(double visibility_m, double wavelength_nm, double exponent) {
  return 3.912 / std::max(visibility_m, kLeastVisibility_m) *
         std::pow(wavelength_nm / 550.0, -exponent);  // 2 % contrast at 550 nm
}

}  // namespace

ModelTable<ExtinctionLaw> rain_laws() {
  static constexpr ModelRow<ExtinctionLaw> kRows[] = {
      {"marshall_palmer", [](double r, double) { return 3.6e-4 * std::pow(r, 0.63); },
       "3.6e-4 R^0.63 1/m: drops of Marshall and Palmer 1948 with twice their cross-section"},
      {"carbonneau", [](double r, double) { return 1.076 * kPerDbPerKm * std::pow(r, 0.67); },
       "1.076 R^0.67 dB/km: optical links, Carbonneau and Wisely 1998, as Al Naboulsi et al. 2005 quote it"},
      {"goodin_2019", [](double r, double) { return 0.01 * std::pow(r, 0.6); },
       "0.01 R^0.6 1/m: empirical, some twenty times stronger; Goodin et al. 2019"},
  };
  return kRows;
}

ModelTable<ExtinctionLaw> fog_laws() {
  static constexpr ModelRow<ExtinctionLaw> kRows[] = {
      {"kruse", [](double v, double l) { return by_visibility(v, l, kruse_exponent(1e-3 * v)); },
       "Kruse 1962, as for haze"},
      {"kim", [](double v, double l) { return by_visibility(v, l, kim_exponent(1e-3 * v)); },
       "Kim 2001: thick fog dims all wavelengths alike"},
  };
  return kRows;
}

ModelTable<ExtinctionLaw> snow_laws() {
  static constexpr ModelRow<ExtinctionLaw> kRows[] = {
      {"wet", [](double s, double l) { return (1.023e-4 * l + 3.7855466) * kPerDbPerKm * std::pow(s, 0.72); },
       "ITU-R P.1817-1 table 2, wet snow"},
      {"dry", [](double s, double l) { return (5.42e-5 * l + 5.4958776) * kPerDbPerKm * std::pow(s, 1.38); },
       "ITU-R P.1817-1 table 2, dry snow"},
  };
  return kRows;
}

// Coefficients as remembered from Esmail et al. 2017 (a free-space optical link in dust storms), not checked against
// it.
double dust_extinction_1_m(double visibility_m) {
  return 52.0 * kPerDbPerKm * std::pow(1e-3 * std::max(visibility_m, kLeastVisibility_m), -1.05);  // dB/km by km
}

void visit(FieldVisitor& f, WeatherConfig& c) {
  f.number("rain_mm_h", c.rain_mm_h, {0, 500}, "rain rate; 0 = none");
  f.choice("rain_law", c.rain_law, model_names(rain_laws()), with_rows("extinction by rain", rain_laws()).c_str());
  f.number("fog_visibility_m", c.fog_visibility_m, {0, 1e5}, "visibility in fog or haze (2 % contrast); 0 = none");
  f.choice("fog_law", c.fog_law, model_names(fog_laws()),
           with_rows("how extinction depends on visibility and wavelength", fog_laws()).c_str());
  f.number("snow_mm_h", c.snow_mm_h, {0, 100}, "snowfall as water; 0 = none");
  f.choice("snow_law", c.snow_law, model_names(snow_laws()), with_rows("extinction by snow", snow_laws()).c_str());
  f.number("dust_visibility_m", c.dust_visibility_m, {0, 1e5}, "visibility in dust; 0 = none");
  f.flag("false_returns", c.false_returns, "drops, flakes and dust also send light back");
}

Weather::Weather(const LidarConfig& config, std::uint64_t seed)
    : signal_(config.signal), min_range_m_(config.report.min_range_m), stream_(seed, "lidar.weather") {
  const WeatherConfig& w = config.weather;
  const auto add = [this](double extinction_1_m, double ratio_sr) {
    extinction_1_m_ += extinction_1_m;
    backscatter_1_m_sr_ += extinction_1_m / ratio_sr;
  };
  if (w.rain_mm_h > 0) add(model_row(rain_laws(), w.rain_law).make(w.rain_mm_h, config.wavelength_nm), kWaterRatio_sr);
  if (w.fog_visibility_m > 0)
    add(model_row(fog_laws(), w.fog_law).make(w.fog_visibility_m, config.wavelength_nm), kWaterRatio_sr);
  if (w.snow_mm_h > 0) add(model_row(snow_laws(), w.snow_law).make(w.snow_mm_h, config.wavelength_nm), kSnowRatio_sr);
  if (w.dust_visibility_m > 0) add(dust_extinction_1_m(w.dust_visibility_m), kDustRatio_sr);
  if (clear() || !w.false_returns) return;
  double silent = 1.0;
  for (double cell_m = min_range_m_; cell_m < config.report.max_range_m; cell_m += signal_.pulse_m) {
    silent *= 1.0 - std::exp(-1.0 / mean_signal(cell_m + 0.5 * signal_.pulse_m));
    answered_.push_back(1.0 - silent);
  }
}

double Weather::mean_signal(double range_m) const {
  const double reflectivity = kPi * backscatter_1_m_sr_ * signal_.pulse_m;
  return reflectivity * signal_gain(signal_, range_m) * std::exp(-2.0 * extinction_1_m_ * range_m);
}

double Weather::false_return_probability(double range_m) const {
  const double cells = (range_m - min_range_m_) / signal_.pulse_m;
  if (answered_.empty() || cells <= 0) return 0.0;
  const auto k = static_cast<std::size_t>(cells);
  if (k >= answered_.size()) return answered_.back();
  const double before = k == 0 ? 0.0 : answered_[k - 1];
  return before + (cells - static_cast<double>(k)) * (answered_[k] - before);
}

Echo Weather::false_return(std::uint32_t laser, std::uint64_t draw, double surface_m) const {
  const double u = stream_.uniform(laser, draw, 0);
  if (u >= answered_.back()) return {};
  const auto cell = std::upper_bound(answered_.begin(), answered_.end(), u) - answered_.begin();
  const double range_m = min_range_m_ + signal_.pulse_m * (static_cast<double>(cell) + stream_.uniform(laser, draw, 1));
  if (range_m >= surface_m) return {};
  const double signal = 1.0 - mean_signal(range_m) * std::log(1.0 - stream_.uniform(laser, draw, 2));
  return {{static_cast<float>(range_m), 1.0f, kNoMaterial, kNoObject},
          static_cast<float>(signal / signal_gain(signal_, range_m))};
}

void Weather::apply(const Volley& volley, Echoes& echoes) const {
  if (clear()) return;
  for (std::size_t k = 0; k < echoes.layers(); ++k) {
    for (EchoPacket& packet : echoes.layer(k)) {
      for (std::size_t i = 0; i < EchoPacket::kShots; ++i)
        packet.reflectivity[i] *= static_cast<float>(std::exp(-2.0 * extinction_1_m_ * packet.range_m[i]));
    }
  }
  if (answered_.empty()) return;
  for (std::size_t shot = 0; shot < volley.shots(); ++shot) {
    const std::size_t packet = shot / Volley::kLanes, lane = shot % Volley::kLanes;
    const float reach_m = volley.rays[packet].max_m[lane];
    if (!(reach_m > 0)) continue;
    const float surface_m = std::min(reach_m, echoes.layer(0)[packet].range_m[lane]);
    echoes.insert(shot,
                  false_return(static_cast<std::uint32_t>(Volley::laser_of(shot)), volley.draw_of(shot), surface_m));
  }
}

}  // namespace canyon::lidar

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "canyon/core/model_table.h"
#include "canyon/core/random/random.h"
#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/signal.h"
#include "canyon/lidar/beam/volley.h"

namespace canyon::lidar {

struct LidarConfig;

/// [lidar.weather]: what is in the air between sensor and surfaces. Several may be at once; 0 = none.
struct WeatherConfig {
  double rain_mm_h = 0.0;
  std::string rain_law = "marshall_palmer";
  double fog_visibility_m = 0.0;
  std::string fog_law = "kruse";
  double snow_mm_h = 0.0;  ///< as water
  std::string snow_law = "wet";
  double dust_visibility_m = 0.0;
  bool false_returns = true;  ///< drops, flakes and dust also send light back
};
void visit(FieldVisitor& f, WeatherConfig& c);

/// Extinction by one kind of particle, 1/m.
using ExtinctionLaw = double(double amount, double wavelength_nm);
/// By rain rate, mm/h.
ModelTable<ExtinctionLaw> rain_laws();
/// By visibility, m; held at 1 mm from below, here and of dust.
ModelTable<ExtinctionLaw> fog_laws();
/// By snowfall as water, mm/h.
ModelTable<ExtinctionLaw> snow_laws();
/// By visibility, m.
double dust_extinction_1_m(double visibility_m);

/// What the air does to the echoes: every one is weaker by exp(-2 extinction range), and the particles send light back.
///
/// False returns. Particles in a pulse's length at range r are as bright on average as a surface of reflectivity pi
/// beta pulse, with the backscatter beta = extinction / lidar ratio, before the way there and back weakens it. The sum
/// of few scatterers fluctuates exponentially about that mean m (in units of the detection threshold of a radiometric
/// detector), so that a cell of one pulse's length answers with probability exp(-1 / m), and then with 1 + m e, e
/// exponential. The first cell that does, if it is nearer than the first surface, is an echo of its own.
///
/// Stream "lidar.weather", entity = laser, index = firing cycle, n = 0: which cell, 1: where in it, 2: how strong.
class Weather {
 public:
  Weather(const LidarConfig& config, std::uint64_t seed);

  double extinction_1_m() const { return extinction_1_m_; }
  double backscatter_1_m_sr() const { return backscatter_1_m_sr_; }
  bool clear() const { return extinction_1_m_ == 0.0; }
  /// Probability that the air answers before range_m, if no surface is nearer.
  double false_return_probability(double range_m) const;

  void apply(const Volley& volley, Echoes& echoes) const;

 private:
  /// A false return of the shot nearer than `surface_m`, or none.
  Echo false_return(std::uint32_t laser, std::uint64_t draw, double surface_m) const;
  double mean_signal(double range_m) const;

  SignalConfig signal_;
  double min_range_m_;
  double extinction_1_m_ = 0.0, backscatter_1_m_sr_ = 0.0;
  std::vector<double> answered_;  ///< probability that one of cells 0..k answers
  RandomStream stream_;
};

}  // namespace canyon::lidar

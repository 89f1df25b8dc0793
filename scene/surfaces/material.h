#pragma once

#include <complex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"

namespace canyon {
class FieldVisitor;
}

namespace canyon::scene {

/// What radio and light see of a surface. One table for the whole product: scene/materials.toml.
struct Material {
  std::string name;
  /// ITU-R P.2040-3 table 3: relative permittivity a f^b, conductivity c f^d S/m, f in GHz.
  double itu_a = 1.0, itu_b = 0.0, itu_c = 0.0, itu_d = 0.0;
  bool rf_absorbing = false;  ///< reflects nothing (for studies; "absorber")
  double thickness_m = 0.0;   ///< of the slab that radio meets; 0: so thick that nothing comes through
  double roughness_m = 0.0;   ///< standard deviation of the surface's height, for radio
  /// Of an upright wall: field that it scatters over field that it gives back, and the exponent of the lobe that this
  /// goes into (gnss/paths/scatter/).
  double scatter_coefficient = 0.4;
  int scatter_lobe = 3;

  double lidar_reflectance = 0.3;  ///< diffuse (Lambertian) reflectance at 905 nm, 0..1
  /// The same at 850 and 1550 nm; none: as at 905 nm.
  std::optional<double> lidar_reflectance_850, lidar_reflectance_1550;
  double lidar_slope_deg = 0.0;  ///< standard deviation of the matt facets' slope (Oren & Nayar 1994); 0: Lambertian
  /// Standard deviation of the diffuse reflectance from place to place of one surface, relative to its mean, 0..0.3,
  /// and how far apart places are that have nothing to do with one another: for [lidar] brightness = "varied".
  double lidar_spread = 0.0, lidar_grain_m = 0.5;
  double lidar_specular = 0.0;           ///< share of the light that is reflected as by a mirror, 0..1
  double lidar_specular_lobe_deg = 2.0;  ///< standard deviation of the mirror's slope
  /// Coefficient of retroreflection R_A, cd/(lx m^2), that is 1/sr: light sent back to where it came from. A white
  /// Lambertian surface has 1/pi.
  double lidar_retro_1_sr = 0.0;
  double lidar_transmittance = 0.0;  ///< share of the light that passes straight through at normal incidence, 0..1
  std::string source;                ///< where the figures come from

  /// Complex relative permittivity eta = eps_r - j 17.98 sigma / f_GHz.
  std::complex<double> permittivity(double frequency_hz) const;
  /// Diffuse reflectance at a wavelength: linear between 850, 905 and 1550 nm, constant outside.
  double reflectance(double wavelength_nm) const;
  /// The brightest and the darkest place of a surface differ from its mean by so much, relative to it: 3.18 spreads,
  /// since noise that is interpolated linearly between the corners of cubes has (2/3)^3 of their variance, and theirs
  /// is that of a uniform distribution, a third of its half width's square.
  double widest() const;
};

void visit(FieldVisitor& f, Material& m);

/// The built-in table.
const std::vector<Material>& builtin_materials();
/// Reads [[material]] tables (keys as the fields above, and itu = [a, b, c, d]). Unknown keys, values out of range,
/// more light given back and let through than comes in, missing or repeated names are errors with their line.
Result<std::vector<Material>> parse_materials(std::string_view toml, const std::string& file_name);
/// The built-in table and over it the user's files: a row of a known name replaces that row whole, others are added.
Result<std::vector<Material>> load_materials(const std::vector<std::string>& paths);

}  // namespace canyon::scene

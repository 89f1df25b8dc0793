#pragma once

#include <complex>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace canyon {
class FieldVisitor;
}

namespace canyon::scene {

/// What radio and light see of a surface. One table for the whole product: scene/materials.toml.
struct Material {
  std::string name;
  /// ITU-R P.2040-3 table 3: relative permittivity a f^b, conductivity c f^d S/m, f in GHz.
  double itu_a = 1.0, itu_b = 0.0, itu_c = 0.0, itu_d = 0.0;
  bool rf_absorbing = false;       ///< reflects nothing (for studies; "absorber")
  double lidar_reflectance = 0.3;  ///< diffuse (Lambertian) reflectance at 905 nm, 0..1
  std::string source;              ///< where the figures come from

  /// Complex relative permittivity eta = eps_r - j 17.98 sigma / f_GHz.
  std::complex<double> permittivity(double frequency_hz) const;
};

void visit(FieldVisitor& f, Material& m);

/// The built-in table.
const std::vector<Material>& builtin_materials();
/// Reads [[material]] tables (keys: name, itu = [a, b, c, d], rf_absorbing, lidar_reflectance, source). Unknown keys,
/// values out of range, missing or repeated names are errors with their line.
Result<std::vector<Material>> parse_materials(std::string_view toml, const std::string& file_name);

}  // namespace canyon::scene

#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/earth.h"
#include "canyon/core/random/random.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/solver/gauss_newton.h"

/// A place, satellites over it by number and epoch, and ranges to them with noise: epochs for cases to work on.
namespace canyon::gnss::made {

inline const Geodetic kPlace{0.7, -1.2, 300.0};

inline constexpr GnssSystem kOfSky[] = {GnssSystem::kGps,     GnssSystem::kGlonass, GnssSystem::kGps,
                                        GnssSystem::kGalileo, GnssSystem::kGlonass, GnssSystem::kGps,
                                        GnssSystem::kQzss,    GnssSystem::kGalileo, GnssSystem::kGps,
                                        GnssSystem::kBeidou,  GnssSystem::kGps,     GnssSystem::kBeidou};

inline Eigen::Vector3d place_in_sky(std::uint64_t k, std::uint64_t of) {
  const RandomStream draws(31, "stress.epochs");
  const Eigen::Vector3d at_E = ecef_from_geodetic(kPlace);
  const double e = draws.uniform(0.12, 1.5, static_cast<std::uint32_t>(k), of), a = 2.4 * static_cast<double>(k);
  return at_E + 2.3e7 * (rotation_E_from_enu(kPlace) *
                         Eigen::Vector3d(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)));
}

inline std::vector<RangeMeasurement> some_ranges(std::uint64_t epoch, std::size_t count, bool one_system, bool shared) {
  const RandomStream draws(32, "stress.epochs");
  const Eigen::Vector3d at_E = ecef_from_geodetic(kPlace);
  std::vector<RangeMeasurement> out;
  for (std::uint64_t k = 0; k < count; ++k) {
    RangeMeasurement r;
    r.p_E = place_in_sky(k, epoch);
    r.system = one_system ? GnssSystem::kGps : kOfSky[k];
    r.sigma_m = draws.uniform(0.5, 4.0, 0, 16 * epoch + k);
    r.shared_m = shared ? draws.uniform(0.5, 3.0, 1, 16 * epoch + k) : 0.0;
    r.range_m = line_of_sight(r.p_E, at_E).range_m + 1000.0 +
                70.0 * static_cast<double>(r.system == GnssSystem::kQzss ? GnssSystem::kGps : r.system) +
                r.sigma_m * draws.normal(2, 16 * epoch + k);
    out.push_back(r);
  }
  return out;
}

}  // namespace canyon::gnss::made

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/errors/ephemeris_error.h"
#include "canyon/gnss/errors/gauss_markov.h"

namespace canyon::gnss {
namespace {

/// Second moments of broadcast minus precise, GPS.
struct OrbitClockStatistics {
  double radial_m, along_m, cross_m, clock_m;
  double radial_clock_correlation;
};

// Broadcast minus IGS final orbits and clocks, 1 July 2010, 31 satellites every 15 minutes: RMS 1.07 / 1.48 / 0.52 m,
// clock (against the epoch's median) 1.13 m, correlation of radial and clock 0.51. Together a signal-in-space range
// error of 1.11 m: sqrt(var(0.98 R - T) + (A^2 + C^2) / 49).
constexpr OrbitClockStatistics k2010{1.07, 1.48, 0.52, 1.13, 0.506};
// 0.89 m, the constellation's figure of 2021: the same proportions.
constexpr double k2021Scale = 0.89 / 1.11;

/// Error of orbit (radial, along, cross) and clock of each satellite as correlated Gaussian processes, projected on the
/// line of sight, so that it depends on where the satellite stands: overhead the radial and clock parts act, which
/// cancel in part; low in the sky up to a quarter of the along and cross-track parts comes in.
///
/// Times of correlation from the same day's autocorrelation: the radial error hardly changes (0.97 after three hours:
/// it is each satellite's own), along-track 0.77 after 1 h and 0.41 after 8 h, cross-track 0.56 after 2 h, clock 0.87
/// after 1 h and 0.51 after 8 h, where a quarter of its variance goes with the radial part. The jumps at changes of
/// ephemeris (every two hours) and the cross-track part's swing with the orbit are not modelled.
class OrbitClockProcess final : public EphemerisError {
 public:
  OrbitClockProcess(std::uint64_t seed, const OrbitClockStatistics& statistics, double scale)
      : s_(statistics),
        scale_(scale),
        radial_(seed, "gnss.orbit.radial", 120.0 * 3600.0),
        along_(seed, "gnss.orbit.along", 8.0 * 3600.0),
        cross_(seed, "gnss.orbit.cross", 3.0 * 3600.0),
        clock_(seed, "gnss.orbit.clock", 6.0 * 3600.0) {}

  double range_m(SatelliteId sv, const SatelliteState& satellite, const Eigen::Vector3d& receiver_E,
                 GpsTime t) const override {
    const std::uint32_t entity = sv.entity();
    const double g_radial = radial_.at(entity, t), rho = s_.radial_clock_correlation;
    const double clock_m = s_.clock_m * (rho * g_radial + std::sqrt(1.0 - rho * rho) * clock_.at(entity, t));
    const Eigen::Vector3d v_inertial =
        satellite.v_E + kEarthRate * Eigen::Vector3d(-satellite.p_E.y(), satellite.p_E.x(), 0.0);
    const Eigen::Vector3d radial = satellite.p_E.normalized(), cross = satellite.p_E.cross(v_inertial).normalized(),
                          along = cross.cross(radial);
    const Eigen::Vector3d orbit_E = s_.radial_m * g_radial * radial + s_.along_m * along_.at(entity, t) * along +
                                    s_.cross_m * cross_.at(entity, t) * cross;
    const Eigen::Vector3d line = (satellite.p_E - receiver_E).normalized();
    return scale_ * (clock_m - line.dot(orbit_E));
  }

 private:
  static constexpr double kEarthRate = 7.2921151467e-5;  // only to tell along from across track

  OrbitClockStatistics s_;
  double scale_;
  GaussMarkov radial_, along_, cross_, clock_;
};

/// Normal, and widest where the satellite stands lowest: the line of sight is off its radius by 14 degrees at most
/// (GPS from the horizon). There radial and clock parts cancel least, and the others come in most.
double largest_m(const OrbitClockStatistics& s, double scale) {
  constexpr double kSin = 0.25, kCos = 0.96;
  const double rho = s.radial_clock_correlation;
  const double shared_m =
      std::max(std::abs(rho * s.clock_m - kCos * s.radial_m), std::abs(rho * s.clock_m - s.radial_m));
  const double own_m = std::sqrt(1.0 - rho * rho) * s.clock_m;
  const double across_m = kSin * std::max(s.along_m, s.cross_m);
  return GaussMarkov::kMostSigmas * scale * std::sqrt(shared_m * shared_m + own_m * own_m + across_m * across_m);
}

}  // namespace

double largest_orbit_clock_2010_m(const ModelParameters&) {
  return largest_m(k2010, 1.0);
}
double largest_orbit_clock_2021_m(const ModelParameters&) {
  return largest_m(k2010, k2021Scale);
}

std::unique_ptr<EphemerisError> make_orbit_clock_2010(std::uint64_t seed) {
  return std::make_unique<OrbitClockProcess>(seed, k2010, 1.0);
}
std::unique_ptr<EphemerisError> make_orbit_clock_2021(std::uint64_t seed) {
  return std::make_unique<OrbitClockProcess>(seed, k2010, k2021Scale);
}

}  // namespace canyon::gnss

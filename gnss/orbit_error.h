#pragma once

#include <map>
#include <string>
#include <vector>

#include "canyon/gnss/products/precise_orbits.h"

namespace canyon::gnss {

/// Broadcast minus precise, one satellite at one epoch.
struct OrbitErrorSample {
  SatelliteId sv;
  GpsTime t;
  /// Along the axes of the precise orbit: outwards; in the orbital plane, forwards; along the angular momentum.
  double radial_m = 0.0, along_m = 0.0, cross_m = 0.0;
  double clock_m = 0.0;  ///< c times (broadcast - precise), minus its median over the system's satellites of that epoch
  double range_m = 0.0;  ///< w_R R - c dT, minus its median over the system's satellites of that epoch
};

/// Root mean squares, and the signal-in-space range error.
struct OrbitErrorFigures {
  int samples = 0, satellites = 0;
  double radial_mean_m = kNaN;
  double radial_rms_m = kNaN, along_rms_m = kNaN, cross_rms_m = kNaN, rms_3d_m = kNaN, clock_rms_m = kNaN;
  /// SISRE^2 = mean[(w_R R - c dT)^2 + w_AC (A^2 + C^2)], weights of Montenbruck et al. 2015, table 4 (GPS: 0.98,
  /// 1/49).
  double sisre_m = kNaN;
  double sisre_unbiased_m = kNaN;  ///< the same with each satellite's mean of (w_R R - c dT) removed
  /// The same with the epoch's median removed from (w_R R - c dT) as a whole instead of from dT alone: the part common
  /// to all satellites, which a receiver's clock absorbs, also where it comes from the orbits or the antennas.
  double sisre_receiver_m = kNaN;
};

struct OrbitErrors {
  std::vector<OrbitErrorSample> samples;  ///< by epoch, then by satellite
  int without_clock = 0;                  ///< precise positions left out because their clock is not known

  OrbitErrorFigures figures() const { return figures_of(samples); }
  OrbitErrorFigures of_satellite(SatelliteId sv) const;
  OrbitErrorFigures of_system(char letter) const;
  /// Those of which there are samples, ascending, by the letter of their system.
  std::map<char, std::vector<SatelliteId>> satellites() const;

 private:
  static OrbitErrorFigures figures_of(const std::vector<OrbitErrorSample>& samples);
};

/// Compares a broadcast constellation with the precise orbits at the epochs of the SP3 files (nothing is interpolated
/// but the clocks of a clock file). Both clocks refer to the two-frequency combination (precise_clock_bands()) and
/// carry the periodic relativity. Without options.antennas the precise position is the centre of mass and the broadcast
/// one the antenna: the radial mean then shows the antenna's offset. Unhealthy and expired satellites have no broadcast
/// state and do not count.
OrbitErrors orbit_errors(const Constellation& broadcast, const PreciseOrbits& precise,
                         const PreciseOptions& options = {});

/// One row per sample: gps_week,sow,satellite,radial_m,along_m,cross_m,clock_m.
std::string orbit_error_csv(const OrbitErrors& errors);

}  // namespace canyon::gnss

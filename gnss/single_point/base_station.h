#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/gnss/rinex/observation/observation_file.h"

namespace canyon::gnss {

/// A receiver at a known place, recorded beside the one that is to be positioned.
struct BaseRecording {
  ObservationFile observations;
  Eigen::Vector3d p_E;  ///< of its antenna, in the frame of the orbits
};

/// What a base's corrected ranges are longer than its distance to the satellites, m: what the models leave of orbit,
/// satellite clock and atmosphere, its own errors, and what is left of its clock.
struct BaseDifferences {
  struct Of {
    double m = 0.0;
    int band = 0;
    double elevation_rad = 0.0;
  };
  struct Epoch {
    GpsTime t;
    std::map<SatelliteId, Of> satellites;
  };
  std::vector<Epoch> epochs;  ///< in the order of time

  /// The epoch nearest to t, if it is within longest_age_s. All differences of a fix come from one epoch, since what
  /// is left of the base's clock may step between two.
  const Epoch* near(GpsTime t, double longest_age_s) const;
};

/// Takes the base's clock out of the differences of an epoch: the median of the first system's, in the order of
/// GnssSystem, from all, so that a filter finds its own clock in the ranges, and systems keep their distance from one
/// another when a satellite rises. A metre or so is left, what half of the satellites' errors exceed. Returns what was
/// taken out; 0, and nothing is, where the epoch has no satellite.
double take_out_clock(BaseDifferences::Epoch& epoch);

/// 1-sigma of a base's code noise and multipath after 100 s of smoothing, m: ground accuracy designator B (McGraw et
/// al. 2000).
double base_code_sigma_m(double elevation_rad);

}  // namespace canyon::gnss

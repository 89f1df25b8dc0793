#pragma once

#include <limits>
#include <string>
#include <vector>

#include "canyon/core/files/place_files.h"
#include "canyon/core/messages.h"
#include "canyon/gnss/single_point/recorded_data.h"
#include "canyon/scene/scene.h"

namespace canyon::study {

/// A signal that a receiver tracked, beside what geometry says of it. Errors are of the free direct signal's range and
/// range rate; NaN where the epoch has too few satellites in sight to tell the receiver's clock, or no Doppler.
struct DriveSignal {
  SatelliteId sv;
  bool in_sight = true;  ///< nothing of the scene stands in the straight way from the true antenna
  double elevation_rad = 0.0, azimuth_rad = 0.0;
  double cn0_dbhz = kNaN;
  double error_m = kNaN, rate_error_m_s = kNaN;
};

struct DriveEpoch {
  GpsTime t;
  std::vector<DriveSignal> signals;
};

/// The stretch of a drive that is looked at.
struct DriveStretch {
  const PlacePath& truth;  ///< of the antenna
  const scene::Scene& scene;
  double from_sow = 0.0, to_sow = 604800.0;

  bool holds(GpsTime t) const { return t.sow_s() >= from_sow && t.sow_s() <= to_sow; }
};

/// What was observed on the stretch, epoch by epoch: signals of the systems asked for above the mask.
///
/// Error of a range: pseudorange - geometric range at the true antenna + satellite clock - group delay - Klobuchar's
/// ionosphere - Saastamoinen's troposphere - receiver clock. The clock is the median of those in sight of the epoch,
/// of two at least, after each system's own offset (median over the drive, against the first system seen) is taken
/// out; that of range rates likewise, without offsets. The same for recorded and simulated observations.
std::vector<DriveEpoch> drive_signals(const gnss::ObservationFile& observations,
                                      const gnss::Constellation& constellation, const gnss::NavigationData& navigation,
                                      const gnss::SinglePointConfig& config, const DriveStretch& stretch);

}  // namespace canyon::study

#pragma once

#include "gnss/paths/path_model.h"

namespace canyon::gnss {

/// Carrier-to-noise density of direct and reflected signals.
struct LinkBudget {
  double cn0_zenith_dbhz = 45.0;  ///< of a clear satellite overhead
  double antenna_horizon_loss_db = 7.0;
  double lhcp_rejection_db = 10.0;  ///< gain for left-hand below right-hand polarization, at every elevation
  double foliage_db_per_m = 0.25;   ///< specific attenuation gamma
  double foliage_max_db = 28.0;     ///< A_m

  /// Gain of the antenna relative to the zenith, dB: -loss (1 - sin e). A patch antenna's usual fall of 6 to 8 dB to
  /// the horizon; arrivals from below lose up to twice that. The satellites' shaped beams make up for free-space
  /// spreading.
  double antenna_gain_db(double elevation_rad) const;
  /// ITU-R P.833: A_m (1 - exp(-d gamma / A_m)).
  double foliage_db(double length_m) const;
  /// `field`: amplitude relative to a free direct signal; none gives about -150 dB-Hz, so that figures stay finite.
  double direct_cn0_dbhz(double elevation_rad, double foliage_m, double field = 1.0) const;
};

/// A reflected or diffracted signal as the receiver gets it.
struct ReceivedReflection {
  double excess_m = 0.0;
  double cn0_dbhz = 0.0;  ///< what it would have alone
  double phase_rad =
      0.0;  ///< carrier, relative to the free direct signal: phase of the field - 2 pi excess / wavelength
};

/// `up_W`: unit vertical at the antenna. Co- and cross-polar parts add in power (the antenna's relative phase of the
/// two is not known); the carrier phase is that of the stronger one.
ReceivedReflection receive(const SignalPath& path, const LinkBudget& link, const Eigen::Vector3d& up_W);

}  // namespace canyon::gnss

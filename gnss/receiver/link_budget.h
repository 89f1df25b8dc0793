#pragma once

#include <memory>

#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/receiver/receiver_antenna.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {

/// Carrier-to-noise density of direct and reflected signals.
struct LinkBudget {
  double cn0_zenith_dbhz = 45.0;   ///< of a clear satellite overhead
  double foliage_db_per_m = 0.25;  ///< specific attenuation gamma
  double foliage_max_db = 28.0;    ///< A_m
  std::shared_ptr<const ReceiverAntenna> antenna = make_sine_antenna({});

  /// ITU-R P.833: A_m (1 - exp(-d gamma / A_m)).
  double foliage_db(double length_m) const;
  /// The satellites' shaped beams make up for free-space spreading, so only the antenna's pattern tells elevations
  /// apart. `field`: amplitude relative to a free direct signal; none gives about -150 dB-Hz, so that figures stay
  /// finite.
  double direct_cn0_dbhz(double elevation_rad, double foliage_m, double field = 1.0) const;
};

/// Keys of the link.
struct LinkConfig {
  double cn0_zenith_dbhz = 45.0;
  double foliage_db_per_m = 0.25;
  double foliage_max_db = 28.0;
  ModelChoice<antenna_models> antenna{"sine"};
  bool antenna_phase_centre = false;  ///< the antenna's phase centre is off its nominal point

  Result<LinkBudget> budget() const;
};
void visit(FieldVisitor& f, LinkConfig& c);

/// A signal, direct, reflected or diffracted, as the receiver gets it.
struct ReceivedSignal {
  double excess_m = 0.0;  ///< longer than the straight way by this
  double cn0_dbhz = 0.0;  ///< what it would have alone
  double phase_rad =
      0.0;  ///< carrier, relative to the free direct signal: phase of the field - 2 pi excess / wavelength
  double doppler_hz = 0.0;  ///< frequency above that of the direct signal
};

/// Echo at an antenna that moves with v_A_W; `to_satellite_W` and `up_W` are unit vectors at the antenna. Co- and
/// cross-polar parts add in power (the antenna's relative phase of the two is not known); the carrier phase is that of
/// the stronger one. Reflectors are at rest, so an echo's way shortens by the antenna's motion towards where it comes
/// from. An echo of many scatterers fades as the antenna moves through their field; loops average that over about 1 s,
/// and their powers add. At speed v its power is w that of the field where the antenna stands and 1 - w the sum of its
/// scatterers' own, w = 1 / (1 + (f / f0)^2), f = v spread / wavelength, f0 = 2 x 0.25 Hz / pi (first-order loop of
/// that noise bandwidth).
ReceivedSignal receive(const SignalPath& path, const LinkBudget& link, const Eigen::Vector3d& up_W,
                       const Eigen::Vector3d& to_satellite_W = Eigen::Vector3d::UnitZ(),
                       const Eigen::Vector3d& v_A_W = Eigen::Vector3d::Zero(), double wavelength_m = kL1WavelengthM);

}  // namespace canyon::gnss

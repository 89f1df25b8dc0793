#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>

#include "canyon/core/model_choice.h"

namespace canyon::gnss {

/// Receiving antenna, mounted level, with the same pattern at every azimuth.
class ReceiverAntenna {
 public:
  virtual ~ReceiverAntenna() = default;
  /// Gain for right- and for left-hand circular polarization, dB relative to right-hand at the zenith. Elevations in
  /// [-pi/2, pi/2].
  virtual double rhcp_db(double elevation_rad) const = 0;
  virtual double lhcp_db(double elevation_rad) const = 0;
  /// What the phase centre adds to a range measured to the antenna's nominal point, m: the offset of the mean phase
  /// centre, projected on the line of sight, with its sign, and the variation with elevation (IGS ANTEX conventions).
  /// `to_satellite_enu`: unit.
  virtual double phase_centre_m(const Eigen::Vector3d& to_satellite_enu) const = 0;
};

/// Keys of the model sine.
struct SineAntennaParameters {
  double horizon_loss_db = 7.0;
  double lhcp_rejection_db = 10.0;
};
void visit(FieldVisitor& f, SineAntennaParameters& c);

using MakeAntenna = std::shared_ptr<const ReceiverAntenna>(const ModelParameters& own);
ModelTable<MakeAntenna> antenna_models();

/// Right-hand: -loss (1 - sin e), so arrivals from below lose up to twice the loss; left-hand the rejection below that
/// at every elevation; one phase centre.
std::shared_ptr<const ReceiverAntenna> make_sine_antenna(const SineAntennaParameters& p);

}  // namespace canyon::gnss

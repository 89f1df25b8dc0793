#pragma once

#include <Eigen/Core>

#include "canyon/fusion/error_state.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/fusion/propagation/error_propagation.h"

namespace canyon::fusion {

/// An accepted measurement as a filter took it: its error is then (I - K H) times what it was plus K times the noise,
/// and its attitude error is counted from the corrected attitude.
struct Correction {
  const Measurement& measurement;  ///< R as it was weighed
  Eigen::MatrixXd gain;            ///< K, padded as H is
  Eigen::MatrixXd S_inverse;       ///< of the innovation's covariance
  bool of_position = false;        ///< of a fix
};

/// Follows an error-state filter: is told of every step and every correction as it happens, in turn. One-level
/// interface.
class FilterObserver {
 public:
  virtual ~FilterObserver() = default;
  /// From now on it follows a filter with this state, which outlives it.
  virtual void begin(const ErrorState& state) = 0;
  /// One step of the IMU; the state has not been moved yet.
  virtual void predicted(ErrorPropagation& step) = 0;
  /// The state has not been corrected yet.
  virtual void corrected(const Correction& correction) = 0;
  /// States of blocks have been renewed, in part or as a whole.
  virtual void renewed(std::span<const Renewal> states) = 0;
  /// A filter that was lost has taken its place from a fix: position and velocity of before are forgotten, attitude and
  /// sensor errors stay.
  virtual void restarted(const Measurement& fix) = 0;
};

}  // namespace canyon::fusion

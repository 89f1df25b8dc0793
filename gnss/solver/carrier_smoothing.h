#pragma once

#include <map>

#include "canyon/core/messages.h"

namespace canyon::gnss {

/// Smoothing of a code by its own carrier phase (Hatch 1982): a running mean, over at most `time_constant_s`, of code
/// minus phase, put back onto the phase. Noise and multipath of the code average out; the ionosphere, which delays the
/// code as much as it advances the phase, does not, so a bias of twice its change over the time constant appears. Where
/// the modelled delay is given, only its error's change counts.
class CarrierSmoothing {
 public:
  /// 0 s: values pass through.
  explicit CarrierSmoothing(double time_constant_s) : time_constant_s_(time_constant_s) {}

  struct Input {
    double code_m = kNaN, phase_m = kNaN;  ///< NaN phase: the code passes, and the mean begins anew
    double ionosphere_m = 0.0;             ///< modelled delay of the code, for the divergence
    bool loss_of_lock = false;
  };
  struct Output {
    double code_m = kNaN;
    double averaged = 1.0;  ///< how many epochs the mean holds, at most the time constant's
  };
  /// To be called once per epoch and satellite, in the order of time. The mean begins anew after a gap of more than
  /// three sampling intervals or 120 s, when lock was lost, and where code and phase disagree by more than 15 m with
  /// the mean: a cycle slip that nobody told of, as large as matters here.
  Output smooth(SatelliteId sv, GpsTime t, const Input& in);

 private:
  struct Mean {
    GpsTime t;
    double code_minus_phase_m = 0.0, count = 0.0, step_s = 0.0;
  };
  double time_constant_s_;
  std::map<SatelliteId, Mean> means_;
};

}  // namespace canyon::gnss

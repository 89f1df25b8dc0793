#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/code_loop_memory.h"
#include "canyon/gnss/receiver/loop_noise.h"
#include "canyon/gnss/receiver/reports/cn0_estimator.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/pseudorange_parts.h"
#include "canyon/gnss/sensor/satellites_in_view.h"

namespace canyon::gnss {

/// What all signals of an epoch have in common: the antenna, and the receiver's clock.
struct ReceivingAntenna {
  std::int64_t index;           ///< of the epoch
  Eigen::Vector3d up_W, v_A_W;  ///< unit; m/s
  double clock_m, clock_rate_m_s;
};

/// What all signals of one satellite have in common: what a range is made of but for paths and noise.
struct ArrivingRange {
  double rate_m_s;        ///< of the geometric range
  RangeDelays delays;     ///< with the ionosphere of the system's first band
  double phase_centre_m;  ///< of the antenna
};

/// What the receiver measures of one signal; NaN while it is not tracked.
struct SignalMeasurement {
  bool tracked = false, slipped = false;
  double pseudorange_m = kNaN, doppler_hz = kNaN, carrier_phase_cycles = kNaN, cn0_dbhz = kNaN;
  double noise_m = 0.0, ambiguity_cycles = 0.0;  ///< in the pseudorange; of the carrier
  Reception reception;
};

/// Tracks one signal of each satellite: what the multipath rule makes of its paths, its lock, and its noise.
class SignalTracker {
 public:
  /// Streams are named by the prefix. `parts` outlives it.
  SignalTracker(const std::string& prefix, const GnssConfig& config, const PseudorangeParts& parts);

  /// Every lock is lost.
  void restart() {
    memory_.locks.restart();
    memory_.code.restart();
  }
  void begin_epoch(std::int64_t index) { memory_.locks.begin_epoch(index); }
  struct Memory {
    SignalLocks locks;
    CodeLoopMemory code;
  };
  /// So that an epoch can be measured twice.
  const Memory& memory() const { return memory_; }
  void set_memory(const Memory& memory) { memory_ = memory; }

  SignalMeasurement measure(const ReceivingAntenna& antenna, const Sight& sight, const SignalPaths& paths, int band,
                            const ArrivingRange& range);

 private:
  const Channel& channel(GnssSystem system, int band) const;
  Reception receive_signals(const ReceivingAntenna& antenna, const Sight& sight, const SignalPaths& paths,
                            const Channel& channel, double wavelength_m) const;
  /// What [gnss] hidden_signals and multipath_scale leave of it.
  Reception with_cuts(Reception r, const Sight& sight, const SignalPaths& paths) const;

  TrackingConfig config_;
  const PseudorangeParts& parts_;
  LoopNoise code_;
  RandomStream carrier_, doppler_;
  Cn0Estimator cn0_;
  Memory memory_;
};

}  // namespace canyon::gnss

#pragma once

#include <cstdint>
#include <map>

#include "canyon/core/config/config.h"
#include "canyon/core/messages.h"
#include "canyon/core/random/random.h"

namespace canyon::gnss {

/// Keys of when signals are lost and found.
struct LockConfig {
  double tracking_threshold_dbhz = 25.0;
  double reacquisition_margin_db = 3.0;
  double reacquisition_s = 1.0;
};
void visit(FieldVisitor& f, LockConfig& c);

struct SignalLockParameters {
  std::uint64_t seed = 0;
  double interval_s = 1.0;               ///< between epochs
  double threshold_dbhz = 25.0;          ///< below, lock is lost
  double reacquisition_margin_db = 3.0;  ///< a lost signal is found again only above the threshold by this
  double reacquisition_s = 1.0;          ///< and must have been there so long
  double carrier_loop_hz = 15.0;
  double integration_s = 0.020;
  bool slips = true;  ///< cycle slips by thermal noise
};

/// Which satellites the receiver is locked to, and the carrier's count of cycles since. It has a memory:
///
/// - A signal that falls below the threshold is lost. It is tracked again once it has stood `reacquisition_margin_db`
///   above the threshold at every epoch of `reacquisition_s`.
/// - At every start of tracking, and when the tracked peak moves to another signal (direct to reflected or back), the
///   carrier's whole-cycle ambiguity is drawn anew.
/// - In lock, the carrier loop slips by a cycle up or down with the probability of a phase-lock loop's first-order
///   theory (Viterbi 1966), mean time between slips pi^2 rho I0(rho)^2 / (2 B) with rho = 1 / (4 sigma^2) for a Costas
///   loop and sigma^2 = B / (C/N0) (1 + 1 / (2 T C/N0)): about 1000 s at 25 dB-Hz, 6 s at 22, never above 30.
///
/// At the first epoch, and after restart(), the receiver has been running for long: whatever stands above the threshold
/// is tracked.
class SignalLocks {
 public:
  explicit SignalLocks(const SignalLockParameters& p);

  /// Forgets everything; the next epoch is a first one.
  void restart();
  /// Opens the epoch of that index, which follows the one before.
  void begin_epoch(std::int64_t index);

  struct State {
    bool tracked = false;
    bool slipped = false;  ///< the carrier phase does not continue the previous epoch's
    double ambiguity_cycles = 0.0;
  };
  /// Once per epoch and satellite in view. `cn0_dbhz` NaN: nothing to track. `source` identifies the signal whose peak
  /// is tracked; see Reception::source.
  State update(SatelliteId sv, double cn0_dbhz, std::uint64_t source);

 private:
  struct Channel {
    bool locked = false;
    std::int64_t seen_since = -1;  ///< epoch from which it stands above the acquisition threshold; -1: it does not
    std::int64_t updated = -1;
    std::uint64_t source = 0;
    double ambiguity_cycles = 0.0;
  };

  SignalLockParameters p_;
  RandomStream ambiguity_, slip_;
  std::map<SatelliteId, Channel> channels_;
  std::int64_t index_ = -1;
  bool first_ = true;
  std::int64_t reacquisition_epochs_;
};

/// Mean time between cycle slips of a Costas loop, s; see SignalLocks.
double mean_time_to_slip_s(double cn0_dbhz, double carrier_loop_hz, double integration_s);

}  // namespace canyon::gnss

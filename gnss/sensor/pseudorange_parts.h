#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/errors/ephemeris_error.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/receiver/link_budget.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"
#include "canyon/gnss/receiver/multipath_rule.h"
#include "canyon/gnss/receiver/receiver_clock.h"
#include "canyon/gnss/receiver/signal_lock.h"
#include "canyon/gnss/solver/position_solver.h"
#include "canyon/gnss/solver/weighting.h"

namespace canyon::gnss {

/// One kind of signal in the receiver: how it is tracked, and how noisy that is.
struct Channel {
  std::unique_ptr<MultipathRule> multipath;
  std::unique_ptr<CodeTracking> tracking;
};

/// All that a pseudorange is made of; one model per effect.
struct PseudorangeParts {
  std::shared_ptr<const Constellation> constellation;
  std::unique_ptr<IonosphereModel> ionosphere;
  std::unique_ptr<TroposphereModel> troposphere;
  std::unique_ptr<EphemerisError> ephemeris_error;
  std::unique_ptr<PathModel> paths;
  std::array<Channel, kModulations> channels;  ///< by Modulation
  std::unique_ptr<ReceiverClock> clock;
  std::unique_ptr<ReceiverMode> mode;
  std::unique_ptr<PositionSolver> solver;
  std::unique_ptr<RangeWeighting> weighting;
  LinkBudget link;
  SignalLockParameters locks;
  std::vector<std::string> warnings;
};

/// Builds the models that the configuration names; an Error names the key.
Result<PseudorangeParts> make_pseudorange_parts(const GnssConfig& config, std::uint64_t seed, GpsTime start,
                                                GpsTime end);

/// The band beside first_band() that a dual-frequency receiver measures: second_frequency "L2" or "L5".
int second_band(GnssSystem system, const std::string& second_frequency);

}  // namespace canyon::gnss

#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/sensor_models.h"

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
  PathParameters path_limits;                  ///< that they were made with
  std::array<Channel, kModulations> channels;  ///< by Modulation
  std::unique_ptr<ReceiverClock> clock;
  std::unique_ptr<ReceiverMode> mode;
  std::unique_ptr<PositionSolver> solver;
  std::unique_ptr<RangeWeighting> weighting;
  std::unique_ptr<RangeErrorReport> reported_covariance;
  LinkBudget link;
  SignalLockParameters locks;
  std::uint64_t noise_seed = 0;  ///< of the noise of code, carrier, Doppler and C/N0
  std::vector<std::string> warnings;
};

/// Builds what tracks signals, channels, link, locks and clock, as the configuration names it; an Error names the key.
Status add_tracking(const GnssConfig& config, std::uint64_t seed, std::uint64_t noise_seed, PseudorangeParts& parts);

/// Builds the models that the configuration names; an Error names the key.
Result<PseudorangeParts> make_pseudorange_parts(const SensorSetup& at);

}  // namespace canyon::gnss

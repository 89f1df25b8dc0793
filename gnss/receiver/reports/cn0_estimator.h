#pragma once

#include <cstdint>
#include <string>

#include "canyon/core/config/config.h"
#include "canyon/gnss/receiver/loop_noise.h"

namespace canyon::gnss {

/// Keys of what the receiver says of a signal's strength.
struct Cn0ReportConfig {
  double averaging_s = 0.0;    ///< of the estimate; 0: it is exact
  double resolution_db = 0.0;  ///< of the output; 0: as finely as computed
};
void visit(FieldVisitor& f, Cn0ReportConfig& c);

/// 1-sigma, dB, of a C/N0 that is estimated from the prompt correlations of `averaging_s`, each integrated over
/// integration_s: the Cramer-Rao bound of a signal in complex white noise,
///
///   10 / ln 10 sqrt((1 + 2 / rho) / K),  rho = C/N0 T,  K = averaging / T
///
/// (Pauluzzi & Beaulieu 2000, section II, for the variance rho (rho + 2) / K of rho). About 0.6 dB for 1 s of 20 ms.
double cn0_noise_db(double cn0_dbhz, double averaging_s, double integration_s);

/// The C/N0 that a receiver reports: the signal's own with the estimator's noise, which lasts as long as it averages,
/// rounded as it is given out. Tracking does not hang on it; weights, and what others make of the message, do.
class Cn0Estimator {
 public:
  Cn0Estimator(std::uint64_t seed, const std::string& name, const Cn0ReportConfig& config, double integration_s,
               double interval_s);
  /// Entity and epoch as in LoopNoise. Not below 0.
  double reported_dbhz(double cn0_dbhz, std::uint32_t entity, std::int64_t index) const;

 private:
  Cn0ReportConfig config_;
  double integration_s_;
  LoopNoise noise_;
};

}  // namespace canyon::gnss

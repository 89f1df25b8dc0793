#pragma once

#include "canyon/gnss/errors/gauss_markov.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"

namespace canyon::gnss {

/// What the air over a rover delays its ranges by, less what it does over a base that is `distance_km` away; m.
///
/// - ionosphere: vertical gradient x distance x thin-shell obliquity, per satellite (their pierce points differ),
///   correlated over half an hour. On quiet days the gradient is 1 to 2 mm/km (1-sigma);
/// - troposphere: difference of the zenith wet delay x Niell's wet mapping, one for all satellites, correlated over an
///   hour.
///
/// 0 for an effect that is switched off.
class AirBetween {
 public:
  AirBetween(const DgpsParameters& p, const ReceiverModeSetup& at);

  double ionosphere_m(const CorrectionInput& in, double distance_km) const;
  double troposphere_m(const CorrectionInput& in, double distance_km) const;

 private:
  DgpsParameters p_;
  bool has_ionosphere_, has_troposphere_;
  GaussMarkov ionosphere_, troposphere_;
};

}  // namespace canyon::gnss

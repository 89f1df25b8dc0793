#pragma once

#include <memory>
#include <vector>

#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/study/tradeoff/probes/probe.h"
#include "canyon/study/tradeoff/recorded/recorded_drive.h"

/// What the probes on a recorded drive share.
namespace canyon::study {

/// An Error where there is no recording.
Status check_recording(const ProbeSetup& setup);

/// The rung's [gnss] with the satellites and the mask of the recording.
gnss::GnssConfig recorded_gnss(const ProbeSetup& setup);
Result<std::unique_ptr<gnss::GnssSensor>> recorded_sensor(const ProbeSetup& setup, const gnss::GnssConfig& config);

/// The rung's models of the atmosphere.
class RecordedAtmosphere {
 public:
  static Result<RecordedAtmosphere> make(const ProbeSetup& setup, const gnss::GnssConfig& config);
  double ionosphere_m(const RecordedEpoch& epoch, const RecordedSatellite& satellite) const;
  double delay_m(const RecordedEpoch& epoch, const RecordedSatellite& satellite) const;

 private:
  std::shared_ptr<const gnss::IonosphereModel> ionosphere_;
  std::shared_ptr<const gnss::TroposphereModel> troposphere_;
};

/// Takes the median of each system's satellites out of their residuals: the receiver's clock, which may differ between
/// systems.
void take_out_clocks(const std::vector<RecordedSatellite>& satellites, std::vector<double>& residuals_m);

}  // namespace canyon::study

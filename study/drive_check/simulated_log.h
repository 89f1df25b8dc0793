#pragma once

#include "canyon/study/drive_check/drive_check.h"

namespace canyon::study {

/// The log that the simulated receiver writes where and when the real one observed, read back from RINEX; and the
/// satellites that it was made with.
struct SimulatedLog {
  gnss::SatelliteSource source;
  gnss::ObservationFile observations;
};

/// `epochs`: instants of the real log within the stretch, growing. Epochs at most 1.6 intervals of their median apart
/// follow one another without a gap for the receiver's loops; after a longer one it starts anew.
Result<SimulatedLog> simulated_log(const DriveCheckInputs& inputs, const PlacePath& truth,
                                   const std::vector<GpsTime>& epochs, std::vector<std::string>& warnings);

}  // namespace canyon::study

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/core/tables/passed_over.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::study {

/// A recorded IMU as what it put out: increments over the interval that ends at each stamp, in forward-left-up.
struct ImuRecording {
  std::string path;
  std::vector<ImuSample> samples;
  bool kf_gins = false;  ///< the file is the KF-GINS text format
  double interval_s = 0.0;
  Occurrences gaps;                    ///< each at the first sample after it
  std::vector<std::size_t> after_gap;  ///< the first sample after each of them
  PassedOver passed_over;              ///< rows of the file, where the format lets them be
};

struct ImuRecordingFormat {
  std::string columns = {};         ///< as ImuLogFormat; empty: the file's header, or KF-GINS text if it has none
  bool forward_right_down = false;  ///< axes of the file; KF-GINS text has its own
  int gps_week = 0;                 ///< of which the stamps are seconds
  double gap_factor = 5.0;          ///< from so many usual intervals on it is a gap, unless what follows makes it up
  bool mend = false;                ///< as of inertial::ImuLogFormat
  bool instantaneous = false;       ///< rates are those at the stamp, and not means over the interval that ends there
};

/// The first interval and those after gaps are as long as usual. A channel that is dead or saturated can still be
/// integrated: `warn` gets a line on that, as on units that look mistaken. All six channels must be there, and the
/// stamps within the 292 years that nanoseconds in 64 bits hold.
Result<ImuRecording> read_imu_recording(const std::string& path, const ImuRecordingFormat& format,
                                        const std::function<void(const std::string&)>& warn);

/// Gravity must pull down in the first second after `initial`, or as long as the unit keeps its attitude by half a
/// radian; an axis convention mistaken turns it round. `advice`: what the error expects.
Status check_axes(const ImuRecording& recording, const fusion::NavState& initial, const std::string& advice);

}  // namespace canyon::study

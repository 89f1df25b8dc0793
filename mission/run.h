#pragma once

#include <memory>

#include "canyon/core/process/progress.h"
#include "canyon/core/result.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/lidar/scanner.h"
#include "canyon/mission/autonomy/autonomy.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/omissions.h"
#include "canyon/mission/recorder/recorder.h"
#include "canyon/mission/recorder/run_record.h"

namespace canyon::mission {

/// From some moment of a run on, other sensors or another view of the truth; until then the run is the same to the bit.
/// What would have been, had something been taken away there.
struct LaterParts {
  MissionConfig config;      ///< [gnss], [imu], run.truth_as_pose and run.truth_as_height hold from then on
  double from_s = 0.0;       ///< after the start, >= 0; what is measured then is still as it was
  std::uint64_t noise_seed;  ///< of noise and of wheels' slip from then on; delays, biases, gains stay
};

/// What a run takes from its caller instead of making it from the configuration.
struct RunParts {
  const Tape* tape = nullptr;          ///< the true motion; must outlive the run
  Recorder* recorder = nullptr;        ///< gets what the run gives as it comes; null: nobody does
  std::unique_ptr<Autonomy> autonomy;  ///< who drives
  /// What it leaves out; null: nothing. The configuration must be without() it; must outlive the run.
  const Omissions* omissions = nullptr;
  /// Null: all stays as it is. Must outlive the run.
  const LaterParts* later = nullptr;
  /// Its receiver, as one that hands out what was measured on this tape before; null: made of the configuration.
  std::unique_ptr<gnss::GnssSensor> receiver = nullptr;
  /// Its LIDAR, as one that adds what no model does; null: made of the configuration.
  std::unique_ptr<lidar::Scanner> scanner = nullptr;
  /// How it registers, as one that hands out clouds that were prepared before; null: made of the configuration.
  std::unique_ptr<lidar::Registration> registration = nullptr;
};

/// Drives one mission. The master step is the vehicle's own (Vehicle::kStep_ns); within it everything else is due at
/// its own ticks (mission/motion/schedule.h): IMU, GNSS, LIDAR, autonomy in this order at equal times. Commands take
/// effect at the next master step. A fix or a scan between two IMU samples is used once the filter has come there, in
/// the middle of the next sample. The only loop is estimate -> drive: truth goes to sensors and scorer alone.
///
/// With a tape the loop is open: the true motion is the tape's, whatever the autonomy asks for, and the run goes on to
/// its end. There is then no outcome and no waypoint is scored.
///
/// Errors only for what the user can mend (a navigation file that cannot be read), and, with exit status 1, where a
/// part gives what is not finite (mission/boundaries.h); a failed mission is a result. Throws Cancelled after Ctrl-C.
/// `progress` (may be null) advances by simulated seconds.
Result<RunRecord> run_mission(const MissionConfig& config, const PreparedMission& mission, Progress* progress = nullptr,
                              RunParts given = {});

}  // namespace canyon::mission

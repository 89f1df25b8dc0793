#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/study/dead_reckoning/recording.h"
#include "canyon/study/fuse/config.h"
#include "canyon/study/fuse/logs/aiding_logs.h"

namespace canyon::study {

/// Names of the files that `canyon fuse` reads; empty: none.
struct FuseFiles {
  std::string imu, gnss, odometer = {}, heading = {}, poses = {}, truth = {};
  std::vector<std::string> navigation = {};  ///< RINEX: then `gnss` holds observations
};

/// A reference solution, of the point that `[truth] of` names, turned to forward-left-up in E.
struct FuseTruth {
  std::string path;
  std::vector<fusion::NavState> states;  ///< in order of time; without a velocity NaN
  bool has_attitude = false, has_velocity = false;
  TruthPoint of = TruthPoint::kImu;
};

/// The ranges of an epoch, and when they come; the epoch's own time is by the receiver's clock.
struct DueRanges {
  GpsTime due;
  GnssEpoch epoch;
};

/// Everything that a filter is run on, and what was wrong with it.
struct FuseInputs {
  ImuRecording imu;            ///< axes of B
  std::vector<GnssFix> fixes;  ///< in order of time; of one time in that of the file
  /// The same index: when each came, which is the latest time that stands before it in its file.
  std::vector<GpsTime> fixes_came;
  std::vector<DueRanges> ranges;  ///< in order of time; of RINEX observations, or of a run that measured with ranges
  std::vector<OdometerSample> odometer;
  std::vector<HeadingSample> heading;            ///< of logs alone, as the next
  std::vector<StampedMapPose> poses;             ///< in a map that was there before
  std::vector<BarometerSample> barometer;        ///< of recorded runs alone, as the next
  std::vector<MagnetometerSample> magnetometer;  ///< axes of U
  FuseTruth truth;
  std::string gnss_path, odometer_path, heading_path, poses_path;  ///< of the log, for messages; empty: none
  std::string of_run;                                              ///< of a results directory; empty: logs
  /// What was passed over or mended, by its key in summary.json; those of nothing are left out.
  std::map<std::string, std::size_t> diagnoses;

  GpsTime begin() const { return imu.samples.front().t - imu.samples.front().dt_s; }
  GpsTime end() const { return imu.samples.back().t; }
};

using Warn = std::function<void(const std::string&)>;

/// Reads all files in the axes and units of `config`. A file without GPS weeks takes that of another one. `warn` gets a
/// line on each thing that was mended. Errors: as of the readers; logs that do not overlap; axes upside down; a truth
/// in another frame than the fixes; a measurement that `config` names without its sensor; headings or poses that no
/// measurement takes.
Result<FuseInputs> read_fuse_inputs(const FuseFiles& files, const FuseConfig& config, const Warn& warn);

/// What must hold of inputs, wherever they are from; part of read_fuse_inputs().
Status check_fuse_inputs(const FuseInputs& inputs, const FuseConfig& config);

/// The rows of the filter go together, and what it is told to measure with by name is among the inputs. Of a `filter`
/// set it is left out.
Status check_fuse_filter(const FuseInputs& inputs, const FuseConfig& config);

}  // namespace canyon::study

#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/smoothing/smoother.h"
#include "canyon/fusion/timeline/filter_timeline.h"
#include "canyon/fusion/verdict/run_evidence.h"
#include "canyon/study/fuse/inputs.h"
#include "canyon/study/fuse/outages.h"
#include "canyon/study/fuse/score.h"

namespace canyon::study {

/// What a filter is run with, beside its inputs.
struct FusePlan {
  fusion::FilterConfig filter;  ///< its initial uncertainty is that of the start
  ImuNoise noise;
  LocalFrame frame;
  Eigen::Vector3d lever_U_B = Eigen::Vector3d::Zero(), lever_A_B = Eigen::Vector3d::Zero();
  std::string start_from;  ///< how the start was found
  GpsTime start;
  Pose X_WB;
  Eigen::Vector3d v_WB_W = Eigen::Vector3d::Zero();

  double interval_s = 0.0;  ///< the usual one of the samples
  double bridge_s = 1.0;
  double skip_s = 0.0;
  double rate_hz = 10.0;  ///< states kept per second, at samples; 0: at `epochs` alone
  std::optional<OutagePlan> outages;
  /// Aligns anew on what is left of the inputs, after a long gap; null: every gap is bridged.
  const FuseConfig* realign = nullptr;
  /// Instants at which the estimate is kept; a sample that holds one is divided there, as a mission does.
  std::vector<GpsTime> epochs;
  /// When the samples were due by the master clock, if their stamps are by a clock of the unit's own; as many as
  /// samples.
  std::vector<GpsTime> due;
  bool keep_segments = false;       ///< for a smoother: 80 bytes a sample
  fusion::TimelineConfig timeline;  ///< what is made of what is late, missing or wrong
};

/// The plan of a configuration: finds the start. Errors: as of fusion::alignments(), no truth to start from.
Result<FusePlan> plan_fuse(const FuseInputs& inputs, const FuseConfig& config,
                           const std::optional<OutagePlan>& outages);

/// Where the plan's heading is not known (1-sigma from 60 degrees on), starts along the one of eight headings around
/// which the fixes fit best, once they have moved; part of plan_fuse().
Status settle_heading(const FuseInputs& inputs, FusePlan& plan);

/// A state that is kept.
struct FuseEpoch {
  fusion::NavState nav;  ///< of the IMU
  NavEstimate estimate;  ///< of B
  /// Of [rotation, right perturbation in B; position; velocity, both in W], of the IMU.
  Eigen::Matrix<double, 9, 9> covariance;
};

/// What the innovations of one measurement were.
struct MeasurementScore {
  std::size_t count = 0, accepted = 0;
  double nis_sum = 0.0, dimensions = 0.0;
  double nis_mean() const { return dimensions > 0.0 ? nis_sum / dimensions : kNaN; }
};

/// What a filter was given between one start and the next, for a smoother.
struct FuseSegment {
  GpsTime start;
  Pose X_WB;
  Eigen::Vector3d v_WB_W;
  std::vector<ImuSample> steps;  ///< as it took them: divided, and bridged; by the clock of the messages
  std::vector<GnssFix> fixes;
  std::vector<fusion::Loosening> loosened;
};

/// What the run has made of one state beside attitude, position and velocity, at its end; SI.
struct FuseParameter {
  std::string name;  ///< "mounting z"
  double value = 0.0, sigma = 0.0, sigma_at_start = 0.0;
};

struct Fused {
  std::string start_from;
  GpsTime start, end;
  LocalFrame frame;
  std::vector<std::string> states, measurements;  ///< rows of the filter
  std::vector<FuseEpoch> epochs;
  std::vector<FuseParameter> parameters;
  std::vector<fusion::UpdateReport> updates;
  std::map<std::string, MeasurementScore> by_measurement;
  std::vector<FuseError> errors;
  std::vector<OutageWindow> windows;
  std::vector<FuseSegment> segments;  ///< none unless they are wanted
  fusion::VerdictNumbers verdict;
  fusion::Incidents incidents;  ///< what was wrong with what came, and was mended
  std::size_t samples = 0, fixes_given = 0, fixes_accepted = 0, fixes_withheld = 0, messages_outside = 0;
  std::size_t gaps_bridged = 0, restarts = 0;
  double bridged_s = 0.0;    ///< for which samples were missing
  std::int64_t replays = 0;  ///< how often the filter went back, for messages that came late
};

/// Runs the filter over the samples on a fusion::FilterTimeline. Messages come in the order of their files, of one time
/// odometer, heading, barometer, magnetometer, pose in a map, fix, ranges, epoch, and after the sample that ends there;
/// one within a sample divides it there, rate and force being constant over it. A fix that stands behind a later one in
/// its file comes when that does, and is taken in its place. After a gap longer than bridge_s the filter starts anew,
/// in motion. An Error (exit status 1) where the estimate is no number any more.
Result<Fused> fuse(const FuseInputs& inputs, const FusePlan& plan);

}  // namespace canyon::study

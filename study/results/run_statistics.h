#pragma once

#include <cstdint>
#include <string>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/files/row_store.h"
#include "canyon/mission/recorder/recorder.h"
#include "canyon/study/statistics/batch_means.h"

namespace canyon::study {

/// Statistics of an error over time; NaN without samples.
struct ErrorStatistics {
  double rms = kNaN, p95 = kNaN, max = kNaN;
};

/// Root of the mean square, and the largest size, of values as they come; NaN without any.
class RunningError {
 public:
  void add(double x);
  double rms() const;
  double max() const { return count_ > 0 ? max_ : kNaN; }

 private:
  double sum_squares_ = 0.0, max_ = 0.0;
  std::int64_t count_ = 0;
};

/// Error of the estimated position at one epoch, in W.
struct EpochError {
  GpsTime t;
  double east_m, north_m, up_m;

  double norm_m() const { return Eigen::Vector3d(east_m, north_m, up_m).norm(); }
};

struct RunSummary;

/// |dGDOP| beyond which consecutive epochs count as a jump.
inline constexpr double kDopJump = 2.0;

/// Takes from a run as it comes what its figures need, in memory that does not grow with it: percentiles and medians
/// are exact all the same, from rows in a file without a name.
class RunStatistics final : public mission::Recorder {
 public:
  /// `directory` takes that file.
  RunStatistics(const LocalFrame& frame, const std::string& directory)
      : frame_(frame), errors_(directory), dilutions_(directory) {}

  Status epoch(const mission::NavRow& row) override;
  Status gnss(const mission::GnssRow& row) override;
  Status keyframe(const mission::KeyframeRow& row) override;

  const RowStore<EpochError>& errors() const { return errors_; }
  /// Once the run has ended. `registers`: its keyframes were registered.
  Status fill(RunSummary& out, bool registers) const;

 private:
  struct Dilution {
    double gdop, pdop;
  };
  Status fill_gnss(RunSummary& out) const;

  LocalFrame frame_;
  RowStore<EpochError> errors_;
  RunningError east_m_, north_m_, up_m_, position_m_, roll_deg_, pitch_deg_, yaw_deg_;
  GpsTime first_;
  BatchMeans position_square_m2_;

  RowStore<Dilution> dilutions_;  // of the fixes that have any
  RunningError gdop_, fix_m_;
  bool has_satellites_ = false;
  int fixes_due_ = 0, fixes_ = 0, dop_jumps_ = 0;
  std::int64_t satellites_ = 0, tracked_ = 0, nlos_ = 0, multipath_ = 0;
  bool had_fix_ = false;
  double last_gdop_ = kNaN;

  RunningError prior_m_, registered_m_;
  int keyframes_ = 0, tried_ = 0, converged_ = 0;
};

}  // namespace canyon::study

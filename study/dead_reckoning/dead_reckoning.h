#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "canyon/fusion/dead_reckoning.h"
#include "canyon/fusion/rounding_growth.h"
#include "canyon/study/dead_reckoning/recording.h"
#include "canyon/study/dead_reckoning/reference.h"

namespace canyon::study {

/// Free inertial navigation on a recording, and how it drifts.
struct DeadReckoning {
  ImuRecording recording;
  std::string integrator, gravity;        ///< rows of strapdown_models() and of gravity_names()
  std::vector<fusion::NavState> states;   ///< the start, and at every sample after it
  std::vector<fusion::NavError> errors;   ///< against the reference; empty without one
  fusion::HeldErrors held;                ///< those of position and velocity that rounding leaves
  fusion::NavErrorStatistics statistics;  ///< of all errors
  fusion::NavErrorStatistics held_ones;   ///< of those that hold

  std::span<const fusion::NavError> held_errors() const { return std::span(errors).first(held.count); }
  bool holds() const { return !held.until.has_value(); }
  double since_start_s(GpsTime t) const { return t - states.front().t; }
};
DeadReckoning dead_reckon(ImuRecording recording, const Reference& reference, const std::string& integrator,
                          const std::string& gravity);

/// Times of the log that no reference state speaks for, before and after those that are scored. There must be errors.
struct Unscored {
  double before_s = 0.0, behind_s = 0.0;
};
Unscored unscored(const DeadReckoning& result);

/// Why position and velocity are not given over the whole time.
std::string rounding_reason(const DeadReckoning& result);

/// What each gyroscope says by itself, without any navigation: the paper's dead-reckoned "heading" of three orthogonal
/// gyroscopes is the plain integral of each one's rate. Of the samples after the start.
struct PlainIntegrals {
  std::vector<double> t_s;
  std::vector<double> rate_deg_s[3], angle_deg[3];

  explicit PlainIntegrals(const DeadReckoning& result);
};

}  // namespace canyon::study

#pragma once

#include <optional>

#include "canyon/fusion/verdict/verdict.h"

namespace canyon::fusion {

/// An estimate minus the truth, and what the filter says of it; NaN where the truth is not known.
struct NavigationError {
  Eigen::Vector3d attitude_rad;  ///< about the axes of the body
  Eigen::Matrix3d attitude_covariance;
  Eigen::Vector3d position_enu_m;
  Eigen::Matrix3d position_covariance;
  Eigen::Vector3d velocity_enu_m_s;
  Eigen::Matrix3d velocity_covariance;
};

/// All that the verdict on one run's filter stands on, gathered while it runs: running sums, whose memory grows with
/// the logarithm of the run. Changes nothing of the filter.
class RunEvidence {
 public:
  RunEvidence() : errors_(ErrorRecord::navigation()) {}
  RunEvidence(const RunEvidence&) = delete;
  RunEvidence& operator=(const RunEvidence&) = delete;

  /// Who watches the filter from now on, for what prediction alone would make of it. Call follow() first, after
  /// initialize(); the evidence must outlive the filter's use of it.
  PredictionAlone& follow(ErrorStateFilter& filter);

  void innovation(const UpdateReport& report) { innovations_.add(report); }
  /// What the filter says of its states: taken in once a second.
  void look(const ErrorStateFilter& filter);
  void error(GpsTime t, const NavigationError& error);
  /// A fix minus the true place of the antenna, with the covariance that it states, both in the same axes.
  void fix(GpsTime t, const Eigen::Vector3d& error_m, const Eigen::Matrix3d& covariance_m2) {
    fixes_.add(t, error_m, covariance_m2);
  }

  VerdictNumbers numbers() const;

 private:
  PredictionAlone alone_;
  InnovationRecord innovations_;
  ErrorRecord errors_;
  FixRecord fixes_;
  StateRecord states_;
  std::optional<GpsTime> looked_;
};

}  // namespace canyon::fusion

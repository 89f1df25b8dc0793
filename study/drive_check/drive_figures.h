#pragma once

#include <array>
#include <vector>

#include "canyon/study/drive_check/drive_signals.h"

namespace canyon::study {

/// A fix of a drive beside the reference; NaN: there was none.
struct DriveFix {
  double horizontal_m = kNaN;
  /// Horizontal error, squared, in units of the covariance that came with the fix: chi-square of two degrees if that
  /// is honest.
  double normalised2 = kNaN;
  GpsTime t{};  ///< of the reference
};

/// What a drive looked like to its receiver. Quantiles are linear between ranks; NaN where nothing was there to count.
struct DriveFigures {
  double tracked_in_sight = kNaN, tracked_hidden = kNaN;         ///< mean per epoch
  std::array<double, 3> cn0_in_sight_dbhz{}, cn0_hidden_dbhz{};  ///< 10, 50, 90 %
  double cn0_auc = kNaN;                   ///< probability that one in sight is stronger than a hidden one, ties half
  std::array<double, 2> hidden_error_m{};  ///< absolute, 50 and 95 %
  std::array<double, 3> hidden_signed_m{}, in_sight_signed_m{};  ///< 5, 50, 95 %
  double hidden_positive_share = kNaN;
  double in_sight_error_p95_m = kNaN;  ///< absolute
  /// Of the error of hidden ones and of those in sight, about its mean, 1, 5 and 10 s apart: pairs of one satellite
  /// that stays hidden, or in sight, at both.
  std::array<double, 3> hidden_autocorrelation{}, in_sight_autocorrelation{};
  std::array<double, 2> hidden_rate_m_s{};    ///< absolute range-rate error, 50 and 95 %
  double fix_h50_m = kNaN, fix_h95_m = kNaN;  ///< over every instant of the reference; infinite where it is no fix
  int instants = 0, fixes = 0;
  double beyond_3_sigma = kNaN;  ///< share of the fixes outside the 99.73 % ellipse of their covariance
};

DriveFigures drive_figures(const std::vector<DriveEpoch>& epochs, const std::vector<DriveFix>& fixes);

/// Linear between ranks, p in [0, 1]; NaN of none. Infinite values sort last.
double drive_quantile(std::vector<double> values, double p);

}  // namespace canyon::study

#pragma once

#include <span>
#include <string>

#include "canyon/tests/lidar/registration/trials/runs.h"

namespace canyon::lidar::trials {

/// What many trials came to.
struct Tally {
  int trials = 0, converged = 0, silent = 0, outside = 0;  ///< outside of their own ellipsoid, of the silent
  int right = 0, refused_good = 0;                         ///< of the right, not converged and not ambiguous in truth
  int ambiguous = 0, recalled = 0;                         ///< in truth; and said so, or directions called open
  int wide = 0;                                            ///< converged with 3 sigma over 0.5 m
  /// Converged with no more directions open than the place leaves open; and with the pose itself within the bounds in
  /// all that the place determines, as pcl_right is judged.
  int all_closed = 0, all_right = 0;
  int pcl_converged = 0, pcl_right = 0, pcl_silent = 0;
  double nees = 0;  ///< per closed direction, sum over converged
  int judged = 0, within_95 = 0;

  void add(const Outcome& outcome);
  void add(const Tally& other);
  double nees_mean() const { return judged > 0 ? nees / judged : kNaN; }
  double coverage() const { return judged > 0 ? static_cast<double>(within_95) / judged : kNaN; }
};

/// Of one form of covariance alone: NEES and coverage.
Tally of_form(std::span<const Outcome> outcomes, std::size_t form);

std::string table_head();
std::string table_row(const std::string& name, const Tally& tally);

/// Of each assertion that leaves room for chance.
inline constexpr double kAlarm = 1e-4;
/// The most successes in n of probability p that come up but for a false alarm of probability `alarm`.
int binomial_most(int n, double p, double alarm);
/// The fewest.
int binomial_fewest(int n, double p, double alarm);

}  // namespace canyon::lidar::trials

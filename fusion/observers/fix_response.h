#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/fusion/filter_observer.h"

namespace canyon::fusion {

/// How the estimate of an error-state filter depends on the fixes that it has been given: the derivative of its present
/// state by each of them, carried along with the filter's own linearization and gains. The sum of their norms is the
/// filter's summed absolute impulse response: what fixes that are moved by up to so much each, in whatever directions,
/// move the estimate by at most.
///
/// First order: gains, and the attitude and force about which the filter linearizes, count as unmoved; so does what
/// re-linearizing about a corrected attitude turns, which is of second order in the correction.
class FixResponse final : public FilterObserver {
 public:
  using Columns3 = Eigen::Matrix<double, Eigen::Dynamic, 3>;

  /// How far the next fix may be moved, m: its weight in the sums.
  void expect(double moved_m) { moved_m_ = moved_m; }

  void begin(const ErrorState& state) override;
  void predicted(ErrorPropagation& step) override;
  void corrected(const Correction& correction) override;
  void renewed(std::span<const Renewal> states) override;
  /// The antenna is where the fix says, at the lever arm whose dependence on the attitude is H's first three columns.
  /// Attitude and sensor errors stay, and with them what earlier fixes did to them.
  void restarted(const Measurement& fix) override;

  /// How far a place in E is moved at most, m, that depends on the present errors of theta, p and v as J says.
  struct Moved {
    double any_m = 0.0;  ///< in space
    double up_m = 0.0;   ///< along up_E
  };
  Moved moved(const Eigen::Matrix<double, 3, 9>& J, const Eigen::Vector3d& up_E) const;

 private:
  double moved_m_ = 1.0;
  ErrorMatrix since_;                // transition since the last fix
  std::vector<Columns3> responses_;  // right after the last fix, of each fix, times its moved_m
};

}  // namespace canyon::fusion

#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/fusion/filter_observer.h"
#include "canyon/fusion/strapdown/strapdown_omissions.h"

namespace canyon::fusion {

/// What comes of effects that act on an error-state filter step by step (StepMove): by what its estimate is off without
/// each of them, carried along with the filter's own linearization and gains. Unlike FixResponse it knows the sign of
/// what acts, and adds it up as it is: an effect of the same sign in each step, as the Earth's turning, is mostly taken
/// up by the estimated biases, and the sum of its absolute responses would say nothing.
///
/// What comes of noise in the steps is another draw in another run. How much it may be there is known beside it: the
/// covariance of the same, were each step's move of either sign by chance, whatever that of the others.
///
/// First order, as FixResponse.
class StepResponse final : public FilterObserver {
 public:
  /// What acts in the next step, effect by effect; as many in every step.
  void expect(std::vector<StepMove> moves) { moves_ = std::move(moves); }

  void begin(const ErrorState& state) override;
  void predicted(ErrorPropagation& step) override;
  void corrected(const Correction& correction) override;
  void renewed(std::span<const Renewal> states) override;
  void restarted(const Measurement& fix) override;

  /// By what a place in E is off without that effect, m, which depends on the present errors of theta, p and v as J
  /// says.
  Eigen::Vector3d moved_E(std::size_t effect, const Eigen::Matrix<double, 3, 9>& J) const;
  /// Its covariance if signs were chance, m^2.
  Eigen::Matrix3d by_chance_E(std::size_t effect, const Eigen::Matrix<double, 3, 9>& J) const;

 private:
  std::vector<StepMove> moves_;
  ErrorMatrix errors_;                  // a column an effect
  std::vector<ErrorMatrix> by_chance_;  // of each effect
};

}  // namespace canyon::fusion

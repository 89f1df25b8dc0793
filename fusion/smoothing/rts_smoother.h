#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/filter_observer.h"
#include "canyon/fusion/smoothing/later_evidence.h"
#include "canyon/fusion/smoothing/smoothed_state.h"

namespace canyon::fusion {

/// Records what an error-state filter does and goes back over it: Rauch-Tung-Striebel estimates (later_evidence.h)
/// about the filter's own, of any set of its states. Each correction was injected into the state and the attitude error
/// counted anew from there; the way back undoes the same, to first order in the correction as the filter does.
///
///   RtsSmoother smoother;
///   filter.initialize(...);
///   filter.watch(&smoother);
///   for each sample: filter.predict(); filter.update(); smoother.keep(filter) at the instants that are wanted
///   smoother.smooth()
///
/// Where a filter that was lost starts again from a fix, what comes later says nothing of what was before.
///
/// It keeps, for each instant and each correction, how the errors moved since the one before (9 n + n - 9 numbers for n
/// states), for an instant the covariance too (n (n + 1) / 2) and for a correction gain and measurement matrix (6 n):
/// at 15 states 2.5 kB for an instant, 2 kB for a correction, at 33 states 7.6 and 4.5 kB. All instants of 100 Hz are
/// 0.25 and 0.76 MB for a second of the run.
class RtsSmoother final : public FilterObserver {
 public:
  void begin(const ErrorState& state) override;
  void predicted(ErrorPropagation& step) override;
  void corrected(const Correction& correction) override;
  void renewed(std::span<const Renewal> states) override;
  void restarted(const Measurement& fix) override;

  /// The state as the filter now has it will be smoothed.
  void keep(const ErrorStateFilter& filter);
  /// The same as the filter has it, with its covariance.
  static SmoothedState filtered(const ErrorStateFilter& filter);

  /// Smoothed states with values and covariance of all states of the filter, the latest first.
  using Take = std::function<void(const SmoothedState&, const Eigen::VectorXd& values, const Eigen::MatrixXd& P)>;
  void smooth(const Take& take) const;
  /// The same in the order of time.
  std::vector<SmoothedState> smooth() const;

 private:
  struct Instant {
    SmoothedState filtered;
    Eigen::VectorXd values;    // of the states after the first nine
    Eigen::VectorXd packed_P;  // lower triangle, column by column
  };
  struct Taken {
    Eigen::MatrixXd K, H, S_inverse;
    Eigen::VectorXd residual;
  };
  struct Record {
    Transition since;
    std::optional<Instant> instant;
    std::optional<Taken> taken;
    bool restart = false;
  };

  Record& add_record();
  SmoothedState corrected_by(const Instant& instant, const Eigen::VectorXd& error) const;

  const ErrorState* state_ = nullptr;
  Eigen::Index states_ = 0;
  std::vector<int> bias_blocks_;
  ErrorMatrix since_;
  std::vector<Record> records_;
};

}  // namespace canyon::fusion

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/filter_observer.h"
#include "canyon/fusion/verdict/normal_series.h"

namespace canyon::fusion {

/// Covariance of a filter's errors as it would be had nothing been measured since: the same steps, and no correction.
/// Watches the filter; beyond 1e20 in any moving state it stays as it is.
class PredictionAlone final : public FilterObserver {
 public:
  /// Call after initialize(). Must outlive the filter's use of it.
  void follow(ErrorStateFilter& filter);

  void begin(const ErrorState&) override {}
  void predicted(ErrorPropagation& step) override;
  void corrected(const Correction&) override {}
  /// Stationary as such states are, nothing becomes of their covariance.
  void renewed(std::span<const Renewal>) override {}
  void restarted(const Measurement&) override {}

  const ErrorMatrix& covariance() const { return P_; }

 private:
  ErrorMatrix P_;
};

/// What a run has told of one state.
struct StateHistory {
  std::string block, name;  ///< "mounting", "mounting x"
  /// 1-sigma over what it would be by prediction alone; now, and at its least.
  double share = 1.0, least_share = 1.0;
  /// When that first fell to a half, s since the first look; none: it is not observed.
  std::optional<double> halved_after_s;
  /// Of a state beside attitude, position and velocity, wherever it is observed: the estimate over the 1-sigma that it
  /// should have, sqrt(sigma_alone^2 - sigma^2), since an optimal estimate and its error are uncorrelated. Unit normal
  /// if the state's own process is what the filter is told.
  NormalSeries estimate;
  std::vector<double> shares;  ///< over time, at StateRecord::times_s()
};

/// The states of a filter over a run. Shares are kept at up to kInstants of its looks, evenly spread from the first on.
class StateRecord {
 public:
  /// From this share of sigma on a state counts as observed.
  static constexpr double kObserved = 0.5;
  static constexpr std::size_t kInstants = 50;

  void add(const ErrorStateFilter& filter, const PredictionAlone& alone);
  const std::vector<StateHistory>& states() const { return states_; }
  const std::vector<double>& times_s() const { return times_s_; }  ///< since the first look

 private:
  void keep_shares(double elapsed_s);

  GpsTime first_;
  std::vector<StateHistory> states_;
  std::vector<bool> with_prior_;
  std::vector<double> times_s_;
  std::size_t looks_ = 0, every_ = 1;  ///< of which so many one is kept
};

/// Name of each state: "roll", "east velocity", "accel x", "mounting z"; attitude about the IMU's axes, position and
/// velocity along east, north, up.
struct StateName {
  std::string block, name;
};
std::vector<StateName> state_names(const ErrorState& state);

}  // namespace canyon::fusion

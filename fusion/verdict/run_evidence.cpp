#include "canyon/fusion/verdict/run_evidence.h"

#include "canyon/core/units.h"

namespace canyon::fusion {
namespace {

constexpr double kLook_s = 1.0;

}  // namespace

PredictionAlone& RunEvidence::follow(ErrorStateFilter& filter) {
  alone_.follow(filter);
  return alone_;
}

void RunEvidence::look(const ErrorStateFilter& filter) {
  const GpsTime t = filter.nav_state().t;
  if (looked_ && t - *looked_ < kLook_s - 1e-6) return;
  looked_ = t;
  states_.add(filter, alone_);
}

void RunEvidence::error(GpsTime t, const NavigationError& e) {
  errors_.add(ErrorRecord::kAttitude, t, e.attitude_rad / kDegree, e.attitude_covariance / (kDegree * kDegree));
  errors_.add(ErrorRecord::kPosition, t, e.position_enu_m.head<2>(), e.position_covariance.topLeftCorner<2, 2>());
  errors_.add(ErrorRecord::kHeight, t, e.position_enu_m.tail<1>(), e.position_covariance.bottomRightCorner<1, 1>());
  errors_.add(ErrorRecord::kVelocity, t, e.velocity_enu_m_s, e.velocity_covariance);
}

VerdictNumbers RunEvidence::numbers() const {
  return verdict_numbers({.innovations = &innovations_, .errors = &errors_, .fixes = &fixes_, .states = &states_});
}

}  // namespace canyon::fusion

#include "gnss/receiver/range_rate.h"

#include "core/units.h"
#include "gnss/signal.h"

namespace canyon::gnss {

double range_rate_m_s(const Transmission& signal, const Eigen::Vector3d& p_E, const Eigen::Vector3d& v_E) {
  // range = |R(tau) s(t - tau) - p(t)|, tau = range / c, R the turn by -w tau about z. With u the unit line of sight,
  // range' = u . (R s' (1 - tau') - w z x (R s) tau' - v), which is linear in tau' = range' / c.
  const Eigen::Vector3d s = signal.p_E();
  const Eigen::Vector3d u = (s - p_E).normalized();
  const Eigen::Vector3d satellite = signal.v_E();
  const Eigen::Vector3d turn = kGpsEarthRate * Eigen::Vector3d(-s.y(), s.x(), 0.0);
  return u.dot(satellite - v_E) / (1.0 + u.dot(satellite + turn) / kSpeedOfLight);
}

}  // namespace canyon::gnss

#pragma once

#include "gnss/satellites/transmission.h"

namespace canyon::gnss {

/// Derivative of Transmission::range_m by the time of reception, m/s, for an antenna at p_E that moves with v_E
/// relative to the Earth. Exact: the light time's own change and the Earth's turning under way are in it (without them
/// 2 cm/s would be missing).
double range_rate_m_s(const Transmission& signal, const Eigen::Vector3d& p_E, const Eigen::Vector3d& v_E);

}  // namespace canyon::gnss

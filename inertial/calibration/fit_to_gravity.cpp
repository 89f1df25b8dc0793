#include "canyon/inertial/ceres_part.h"

namespace canyon::inertial {

#ifdef CANYON_WITH_CERES

Result<TriadCalibration> fit_to_gravity(std::span<const Eigen::Vector3d> positions, double sigma_m_s2,
                                        double gravity_m_s2) {
  return ceres_part().fit_to_gravity(positions, sigma_m_s2, gravity_m_s2);
}

#else

Result<TriadCalibration> fit_to_gravity(std::span<const Eigen::Vector3d>, double, double) {
  return Error{"", 0, "", "this build has no calibration from positions", "a build with CANYON_WITH_CERES=ON"};
}

#endif

}  // namespace canyon::inertial

#include "canyon/inertial/mounting.h"

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::inertial {

std::optional<Eigen::Quaterniond> mounting(const ImuConfig& config, std::uint64_t seed) {
  if (config.mounting_error_deg == 0.0) return std::nullopt;
  return so3_exp(config.mounting_error_deg * kDegree * RandomStream(seed, "imu.mounting").normal3(0));
}

ImuSample seen_askew(ImuSample sample, const Eigen::Quaterniond& R_BU) {
  sample.dtheta_U = R_BU.conjugate() * sample.dtheta_U;
  sample.dv_U = R_BU.conjugate() * sample.dv_U;
  return sample;
}

}  // namespace canyon::inertial

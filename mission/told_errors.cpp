#include "canyon/mission/told_errors.h"

#include <cmath>

#include "canyon/core/units.h"

namespace canyon::mission {
namespace {

constexpr std::uint32_t kStepEntity = 0, kDriftEntity = 1;

}  // namespace

ToldErrorDraws::ToldErrorDraws(const ToldErrors& config, std::uint64_t seed, GpsTime start)
    : config_(config), stream_(seed, "mission.told_errors"), start_(start) {}

Eigen::Vector3d ToldErrorDraws::direction(std::uint32_t entity, std::uint64_t index) const {
  const double yaw = stream_.uniform(-kPi, kPi, entity, index);
  return {std::cos(yaw), std::sin(yaw), 0.0};
}

void ToldErrorDraws::lay_over(NavEstimate& estimate) const {
  const double t_s = estimate.t - start_;
  const double steps = std::floor(t_s / config_.step_every_s);
  if (config_.step_m > 0.0 && steps >= 1.0)
    estimate.X_WB.p += config_.step_m * direction(kStepEntity, static_cast<std::uint64_t>(steps));
  if (config_.drift_m_s > 0.0) estimate.X_WB.p += t_s * config_.drift_m_s * direction(kDriftEntity, 0);
  if (config_.heading_deg != 0.0) {
    const Eigen::AngleAxisd turned(-config_.heading_deg * kDegree, Eigen::Vector3d::UnitZ());
    estimate.X_WB.R = (Eigen::Quaterniond(turned) * estimate.X_WB.R).normalized();
  }
}

}  // namespace canyon::mission

#pragma once

#include "canyon/core/messages.h"
#include "canyon/core/random/random.h"
#include "canyon/mission/config/mission_config.h"

namespace canyon::mission {

/// Errors laid over the pose that the autonomy is told, by seeded directions (ToldErrors): what it takes of each kind
/// is measured with them alone (study/tolerance). Velocities stay what they are.
class ToldErrorDraws {
 public:
  ToldErrorDraws(const ToldErrors& config, std::uint64_t seed, GpsTime start);

  void lay_over(NavEstimate& estimate) const;

 private:
  Eigen::Vector3d direction(std::uint32_t entity, std::uint64_t index) const;

  ToldErrors config_;
  RandomStream stream_;
  GpsTime start_;
};

}  // namespace canyon::mission

#include "canyon/mission/omissions.h"

#include "canyon/core/check.h"

namespace canyon::mission {

bool can_leave_out(const MissionConfig& config, const Omissions& omissions) {
  if (omissions.registration && takes_registered_poses(config)) return false;
  const bool registers = lidar::registers(config.registration) && !omissions.registration;
  if (omissions.unkept_rays && !omissions.keyframes) return false;
  return !omissions.keyframes || (omissions.maps && !registers);
}

MissionConfig without(MissionConfig config, const Omissions& omissions) {
  CANYON_CHECK(can_leave_out(config, omissions), "what is left out is read");
  if (omissions.registration) {
    config.registration.method.name = "none";
    config.registration.prior_map.clear();
  }
  return config;
}

}  // namespace canyon::mission

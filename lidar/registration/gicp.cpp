#include "canyon/lidar/registration/pcl_part.h"
#include "canyon/lidar/registration/registration_methods.h"

namespace canyon::lidar {

std::unique_ptr<Registration> make_gicp(const RegistrationConfig& config) {
  return library_part("pcl", &canyon_pcl_part).make_gicp(config);
}

}  // namespace canyon::lidar

#include "canyon/lidar/registration/pcl_part.h"
#include "canyon/lidar/registration/registration_methods.h"

namespace canyon::lidar {

std::unique_ptr<Registration> make_gicp(const ModelParameters& own) {
  return library_part("pcl", &canyon_pcl_part).make_gicp(own.get<MatchingParameters>());
}

}  // namespace canyon::lidar

#include "canyon/lidar/registration/engine/engine_registration.h"
#include "canyon/lidar/registration/registration_methods.h"

namespace canyon::lidar {

std::unique_ptr<Registration> make_gicp(const ModelParameters& own) {
  return make_engine({plane_to_plane, 0.0}, own);
}

}  // namespace canyon::lidar

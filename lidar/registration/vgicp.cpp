#include "canyon/lidar/registration/engine/engine_registration.h"
#include "canyon/lidar/registration/registration_methods.h"

namespace canyon::lidar {

std::unique_ptr<Registration> make_vgicp(const ModelParameters& own) {
  return make_engine({plane_to_plane, 2.0}, own);
}

}  // namespace canyon::lidar

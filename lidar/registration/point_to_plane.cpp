#include "canyon/lidar/registration/engine/engine_registration.h"
#include "canyon/lidar/registration/registration_methods.h"

namespace canyon::lidar {

std::unique_ptr<Registration> make_point_to_plane(const ModelParameters& own) {
  return make_engine({to_target_plane, 0.0}, own);
}

}  // namespace canyon::lidar

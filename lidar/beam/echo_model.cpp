#include "canyon/lidar/beam/echo_model.h"

namespace canyon::lidar {

const std::vector<EchoModelRow>& echo_models() {
  static const std::vector<EchoModelRow> kRows{
      {"single_ray", &make_single_ray, "one infinitely thin ray per shot"},
      {"footprint", &make_footprint, "a beam of `divergence_mrad`, 16 rays: mixed pixels, several returns"},
  };
  return kRows;
}

}  // namespace canyon::lidar

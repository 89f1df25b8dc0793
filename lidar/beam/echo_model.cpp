#include "canyon/lidar/beam/echo_model.h"

namespace canyon::lidar {

ModelTable<MakeEchoModel> echo_models() {
  static constexpr ModelRow<MakeEchoModel> kRows[] = {
      {"single_ray", make_single_ray, "one infinitely thin ray per shot"},
      {"footprint", make_footprint, "a beam of `divergence_mrad`, 16 rays: mixed pixels, several returns",
       footprint_parameters},
  };
  return kRows;
}

}  // namespace canyon::lidar

#include "canyon/inertial/ceres_part.h"

namespace canyon::inertial {

extern "C" const CeresPart canyon_ceres_part{fit_noise_with_ceres, fit_to_gravity_with_ceres};

}  // namespace canyon::inertial

#include "canyon/fusion/divided_sample.h"

namespace canyon::fusion {

ImuSample take_share(ImuSample& sample, double share) {
  ImuSample first = sample;
  first.dt_s *= share;
  first.dtheta_U *= share;
  first.dv_U *= share;
  sample.dt_s -= first.dt_s;
  sample.dtheta_U -= first.dtheta_U;
  sample.dv_U -= first.dv_U;
  first.t = sample.t - sample.dt_s;
  return first;
}

}  // namespace canyon::fusion

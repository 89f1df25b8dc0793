#include "canyon/lidar/registration/engine/robust_kernels.h"

#include <cmath>

namespace canyon::lidar {
namespace {

double square(double) {
  return 1.0;
}
double huber(double u) {
  return u <= 1.0 ? 1.0 : 1.0 / std::sqrt(u);
}
double cauchy(double u) {
  return 1.0 / (1.0 + u);
}
double geman_mcclure(double u) {
  return 1.0 / ((1.0 + u) * (1.0 + u));
}

constexpr ModelRow<RobustKernel> kKernels[] = {
    {"none", square, "least squares"},
    {"huber", huber, "linear beyond the width"},
    {"cauchy", cauchy, "logarithmic beyond the width"},
    {"geman_mcclure", geman_mcclure, "bounded: far residuals count for nothing"},
};

}  // namespace

ModelTable<RobustKernel> robust_kernels() {
  return kKernels;
}

}  // namespace canyon::lidar

#pragma once

#include "canyon/core/model_table.h"

namespace canyon::lidar {

/// Weight of a residual in iteratively reweighted least squares: rho'(u), u = (residual / width)^2, 1 at u = 0.
using RobustKernel = double(double u);
/// none, huber (Huber 1964), cauchy, geman_mcclure (Geman and McClure 1985).
ModelTable<RobustKernel> robust_kernels();

}  // namespace canyon::lidar

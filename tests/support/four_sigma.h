#pragma once

#include <cmath>

namespace canyon::testing {

/// Four standard deviations of a mean square over n independent normals, as a share of it: false alarm 6e-5.
inline double four_sigma_of_variance(double n) {
  return 4.0 * std::sqrt(2.0 / n);
}

}  // namespace canyon::testing

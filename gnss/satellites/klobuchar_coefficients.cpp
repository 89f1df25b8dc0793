#include "canyon/gnss/satellites/klobuchar_coefficients.h"

#include <algorithm>
#include <cmath>

namespace canyon::gnss {

bool is_sane(const KlobucharCoefficients& c) {
  const auto within = [](const std::array<double, 4>& k, double limit) {
    return std::all_of(k.begin(), k.end(), [limit](double x) { return std::abs(x) <= limit; });
  };
  return within(c.alpha, 1e-4) && within(c.beta, 1e8);
}

}  // namespace canyon::gnss

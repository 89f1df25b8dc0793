#include "canyon/study/registration_error/response/half_healed.h"

#include <cmath>
#include <limits>

#include "canyon/core/check.h"

namespace canyon::study {

double half_healed_size(std::span<const double> sizes, std::span<const double> healed) {
  CANYON_CHECK(sizes.size() == healed.size(), sizes.size(), " sizes, ", healed.size(), " shares");
  std::size_t below = 0;  // the first of which less than half is healed
  while (below < sizes.size() && healed[below] >= 0.5) ++below;
  if (below == 0) return 0.0;
  if (below == sizes.size()) return std::numeric_limits<double>::infinity();
  const double low = healed[below - 1], high = std::isnan(healed[below]) ? 0.0 : healed[below];
  const double share = (low - 0.5) / (low - high);
  return sizes[below - 1] * std::pow(sizes[below] / sizes[below - 1], share);
}

}  // namespace canyon::study

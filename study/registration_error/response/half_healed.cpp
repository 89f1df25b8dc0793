#include "canyon/study/registration_error/response/half_healed.h"

#include <cmath>
#include <limits>

#include "canyon/core/check.h"

namespace canyon::study {

double half_healed_size(std::span<const double> sizes, std::span<const double> healed) {
  CANYON_CHECK(sizes.size() == healed.size(), sizes.size(), " sizes, ", healed.size(), " shares");
  std::size_t above = sizes.size();  // one past the largest size that is healed by half
  while (above > 0 && !(healed[above - 1] >= 0.5)) --above;
  if (above == 0) return 0.0;
  if (above == sizes.size()) return std::numeric_limits<double>::infinity();
  const double low = healed[above - 1], high = std::isnan(healed[above]) ? 0.0 : healed[above];
  const double share = (low - 0.5) / (low - high);
  return sizes[above - 1] * std::pow(sizes[above] / sizes[above - 1], share);
}

}  // namespace canyon::study

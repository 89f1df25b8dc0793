#pragma once

#include <cmath>

#include "canyon/core/messages.h"

namespace canyon::study {

/// A 95 % confidence interval; NaN where there is none.
struct Interval {
  double low = kNaN, high = kNaN;
  bool defined() const { return std::isfinite(low) && std::isfinite(high); }
};

/// 97.5 % quantile of the standard normal distribution, of which every interval here is made.
inline constexpr double kNormal975 = 1.959963984540054;

}  // namespace canyon::study

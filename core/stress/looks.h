#pragma once

#include "canyon/core/stress_rows.h"

namespace canyon::stress {

/// Worst of many looks, of numbers against others and of what is merely right or wrong.
class Looks : public Worst {
 public:
  void near(double found, double expected, double bound) { look(found - expected, bound); }
  /// To so many epsilons of the expected value.
  void close(double found, double expected, double epsilons) {
    const double size = std::abs(expected);
    look(found - expected, epsilons * kEpsilon * (size > 1e-300 ? size : 1e-300));
  }
  void right(bool holds) { look(holds ? 0.0 : kInfinity, 1.0); }
};

}  // namespace canyon::stress

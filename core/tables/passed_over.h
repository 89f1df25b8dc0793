#pragma once

#include <cstddef>
#include <limits>

namespace canyon {

/// How often something is wrong in a file, and where it is so first.
struct Occurrences {
  std::size_t count = 0;
  int line = 0;                                               ///< of the file; 0: of none
  double t_s = std::numeric_limits<double>::quiet_NaN();      ///< as the file counts; NaN: it has no time
  double after_s = std::numeric_limits<double>::quiet_NaN();  ///< the latest time that stands before it; NaN: none does

  /// What comes first in the file must be added first.
  void add(int at_line, double at_s, double latest_s) {
    if (count++ > 0) return;
    line = at_line;
    t_s = at_s;
    after_s = latest_s;
  }
};

/// Rows of a file that were passed over.
struct PassedOver {
  Occurrences not_finite;  ///< t_s is NaN
  Occurrences duplicates;
  Occurrences reversed;
  std::size_t all() const { return not_finite.count + duplicates.count + reversed.count; }
};

}  // namespace canyon

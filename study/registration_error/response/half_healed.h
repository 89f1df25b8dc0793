#pragma once

#include <span>

namespace canyon::study {

/// Up to which size of an error registration takes at least half of it away: where the healed share falls below one
/// half for good, linear in the logarithm of the size between the two sizes there. `sizes` > 0 ascend, one share each.
/// 0: not even at the smallest; infinite: still at the largest. Shares that are NaN count as below.
double half_healed_size(std::span<const double> sizes, std::span<const double> healed);

}  // namespace canyon::study

#pragma once

#include <span>

namespace canyon::study {

/// Up to which size of an error, from the smallest on, registration takes at least half of it away: where the healed
/// share first falls below one half, linear in the logarithm of the size between the two sizes there. What is healed of
/// larger ones again does not count. `sizes` > 0 ascend, one share each. 0: less than half of the smallest already;
/// infinite: half of all of them. Shares that are NaN count as below.
double half_healed_size(std::span<const double> sizes, std::span<const double> healed);

}  // namespace canyon::study

#pragma once

namespace canyon::report {

/// No figure, coordinate or time of a results directory is larger in size; what is was damaged, and its squares and
/// sums would leave the range of numbers.
inline constexpr double kLargestNumber = 1e15;

}  // namespace canyon::report

#pragma once

namespace canyon::report {

/// No figure, coordinate or time of a results directory is larger in size; what is was damaged, and its squares and
/// sums would leave the range of numbers.
inline constexpr double kLargestNumber = 1e15;

/// What is smaller in size than any figure can be is zero: powers of ten that small do not exist, and a logarithmic
/// axis cannot begin there.
inline double without_dust(double value) {
  return value < 1e-100 && value > -1e-100 ? 0.0 : value;
}

}  // namespace canyon::report

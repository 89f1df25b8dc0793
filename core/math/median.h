#pragma once

#include <vector>

namespace canyon {

/// Middle value, of an even number the mean of the two in the middle; NaN of none, and where one is NaN.
double median(std::vector<double> values);

}  // namespace canyon

#pragma once

#include <vector>

#include "canyon/study/statistics/interval.h"

/// What a few independent values say of the distribution they come from.
namespace canyon::study {

/// Interval of the median between two of the values, whatever their distribution: the innermost pair of equal ranks
/// from both ends that holds the median with at least 95 % (Hahn & Meeker, Statistical Intervals, section 5.2). None
/// for fewer than six values.
Interval median_interval(std::vector<double> values);

/// Student's interval of the mean: exact for normal values, for others as good as their mean is normal. None for fewer
/// than two values.
Interval mean_interval(const std::vector<double>& values);
double mean(const std::vector<double>& values);

/// 97.5 % quantile of Student's t: Cornish-Fisher expansion about the normal's (Abramowitz & Stegun 26.7.5), within 1 %
/// from 3 degrees of freedom on; the first two are exact.
double student_975(int degrees);

}  // namespace canyon::study

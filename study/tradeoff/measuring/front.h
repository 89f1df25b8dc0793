#pragma once

#include <vector>

#include "canyon/study/tradeoff/result.h"

namespace canyon::study {

/// Says of each model whether it is on the front: none is both at least as quick (by the medians) and at least as
/// exact (over what all have, where they are compared with the truth) and defined, and better in one. And which models
/// it is tied with: those whose least and most times overlap with its own. The least and the most of n >= 5 repetitions
/// hold the median with 1 - 2^(1 - n) >= 94 % (Hahn & Meeker, Statistical Intervals, section 5.2), so what overlaps may
/// change places when measured again. A model without error or time is on no front.
void mark_front(std::vector<MeasuredModel>& models);

/// Least squares of time over work, times of both divided by the time, so that cheap and dear models count alike; none
/// with fewer than three models, or work that is the same in all.
TimeFit fit_time(const std::vector<MeasuredModel>& models);

}  // namespace canyon::study

#pragma once

#include "canyon/fusion/strapdown.h"
#include "canyon/study/tradeoff/probes/probe.h"

namespace canyon::study {

enum class SmoothFigure { kPosition, kVelocity, kAttitude };

/// A row of a table of integrators on the smooth motion (smooth_motion.h), at so many increments a second. `row` must
/// outlive the probe: the program's are fusion's, a test's may be its own.
std::unique_ptr<Probe> make_smooth_probe(const fusion::StrapdownRow& row, int rate_hz, SmoothFigure figure);

/// The order that a row claims for that figure.
std::optional<double> claimed_order(const fusion::StrapdownRow& row, SmoothFigure figure);

}  // namespace canyon::study

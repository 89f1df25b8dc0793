#pragma once

#include "canyon/study/compare.h"
#include "canyon/study/tradeoff/result.h"

namespace canyon::study {

/// Whole runs in an open loop over the tape's first minute, one per run of the comparison: what each fidelity errs in
/// position, map and registration, and what it costs. Repeated as probes are (measuring/repetitions.h).
Result<std::vector<MeasuredFidelity>> measure_fidelities(const Comparison& comparison, int repetitions,
                                                         std::uint64_t seed);

}  // namespace canyon::study

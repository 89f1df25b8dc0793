#pragma once

#include <functional>

#include "canyon/core/result.h"
#include "canyon/fusion/smoothing/graph/chain_builder.h"
#include "canyon/fusion/smoothing/graph/chain_solver.h"

namespace canyon::fusion {

/// Adds node after node, solves with each, and takes out what is more than `lag_s` older than the last; `leaves` is
/// called while the first node is still there.
Status solve_with_lag(ChainBuilder& builder, double lag_s, const SolveOptions& options,
                      const std::function<void()>& leaves);

}  // namespace canyon::fusion

#pragma once

#include <string>

#include "canyon/study/plan/cost.h"
#include "canyon/study/plan/plan.h"
#include "canyon/study/plan/verify.h"

namespace canyon::study {

/// A plan for a terminal: what is left out and what is kept, where, why, and what it saves; then the cost of the
/// nominal mission in full and as planned.
std::string plan_table(const Plan& plan, const PredictedCost& cost, double nominal_s);

/// What a verification found, one line per effect.
std::string verification_table(const Verification& verification);

}  // namespace canyon::study

#pragma once

#include <string>
#include <vector>

#include "canyon/core/stress_case.h"

namespace canyon::study {

enum class CaseVerdict {
  kHolds,  ///< figure and bound are numbers, it is not over the bound, and the bound is tight
  kFails,
  kOpen  ///< does not hold, and an issue says that it is to be mended
};
const char* name(CaseVerdict verdict);

/// What came of one case.
struct CaseResult {
  StressCase stress_case;
  StressFigure found;  ///< NaN where it threw
  CaseVerdict verdict = CaseVerdict::kFails;
  std::string thrown{};  ///< what it threw, if it did
  double cpu_s = 0.0;    ///< of all threads
};

CaseResult run_case(const StressCase& one);

/// One after the other, with a progress bar if asked for. Throws Cancelled.
std::vector<CaseResult> run_cases(const std::vector<StressCase>& cases, bool show_progress);

/// Whether the bound is over 1000 times a figure that is not 0.
bool bound_needs_a_reason(const CaseResult& result);

/// Whether the bound says something of the figure: it is not over 1000 times as large, or the case says why.
bool bound_is_tight(const CaseResult& result);

/// How many different things may break in them.
std::size_t mechanisms(const std::vector<StressCase>& cases);

}  // namespace canyon::study

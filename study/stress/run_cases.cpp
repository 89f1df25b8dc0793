#include "canyon/study/stress/run_cases.h"

#include <cmath>
#include <exception>
#include <set>

#include "canyon/core/messages.h"
#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/progress.h"

namespace canyon::study {
namespace {

CaseVerdict judge(const CaseResult& result) {
  const bool holds = result.thrown.empty() && std::isfinite(result.found.figure) && std::isfinite(result.found.bound) &&
                     result.found.figure <= result.found.bound && bound_is_tight(result);
  if (holds) return CaseVerdict::kHolds;
  return result.stress_case.open.empty() ? CaseVerdict::kFails : CaseVerdict::kOpen;
}

}  // namespace

const char* name(CaseVerdict verdict) {
  return verdict == CaseVerdict::kHolds ? "holds" : verdict == CaseVerdict::kOpen ? "open" : "fails";
}

CaseResult run_case(const StressCase& one) {
  CaseResult result{.stress_case = one, .found = {kNaN, kNaN}};
  CpuAccount account;
  {
    const ChargeCpu charge(&account);
    try {
      result.found = one.run();
    } catch (const std::exception& error) {
      result.thrown = error.what();
    }
  }
  result.cpu_s = account.seconds();
  result.verdict = judge(result);
  return result;
}

std::vector<CaseResult> run_cases(const std::vector<StressCase>& cases, bool show_progress) {
  Progress progress("stress", static_cast<double>(cases.size()), show_progress);
  std::vector<CaseResult> results;
  for (const StressCase& one : cases) {
    throw_if_cancelled();
    results.push_back(run_case(one));
    progress.advance(1.0);
  }
  return results;
}

bool bound_needs_a_reason(const CaseResult& result) {
  const auto& [figure, bound] = result.found;
  return figure != 0.0 && !(std::abs(bound) <= 1000.0 * std::abs(figure));
}

bool bound_is_tight(const CaseResult& result) {
  return !bound_needs_a_reason(result) || !result.stress_case.loose.empty();
}

std::size_t mechanisms(const std::vector<StressCase>& cases) {
  std::set<std::string> texts;
  for (const StressCase& one : cases) texts.insert(one.mechanism);
  return texts.size();
}

}  // namespace canyon::study

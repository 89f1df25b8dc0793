#pragma once

#include <string>
#include <vector>

#include "canyon/core/model_table.h"
#include "canyon/core/result.h"
#include "canyon/core/stress_case.h"

namespace canyon::study {

ModelTable<StressGroup> stress_groups();

/// Of a case's name what stands before the "/".
std::string stress_subject(const std::string& name);

/// The cases of all floors, lowest first.
std::vector<StressCase> all_stress_cases();

/// Which of them are asked for.
struct CaseChoice {
  std::vector<std::string> names;  ///< of cases, or of a subject: what stands before the "/"; none: all
  std::string group;               ///< empty: all
  bool long_form = false;          ///< also those that take long; those that are named run in any case
};

/// Those, in their order. An Error for a name or a group that there is not, with the nearest, and for names that have
/// nothing of the group.
Result<std::vector<StressCase>> choose_cases(std::vector<StressCase> all, const CaseChoice& choice);

}  // namespace canyon::study

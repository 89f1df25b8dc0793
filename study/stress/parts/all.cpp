#include <utility>

#include "canyon/study/stress/parts/subjects.h"

namespace canyon::study {

std::vector<StressCase> study_stress_cases() {
  std::vector<StressCase> all = share_cases();
  for (StressCase& one : cause_cases()) all.push_back(std::move(one));
  return all;
}

}  // namespace canyon::study

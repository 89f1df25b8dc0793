#include "canyon/fusion/stress/stress_cases.h"

#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (auto* const subject :
       {consistency_cases, covariance_cases, dead_reckoning_cases, fix_cases, sample_cases, unaided_cases})
    for (StressCase& one : subject()) all.push_back(std::move(one));
  return all;
}

}  // namespace canyon::fusion

#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "canyon/core/imu_noise.h"

namespace canyon::testing {

/// A parameter of the filter of MatchedWorld that may be told wrongly.
struct WrongParameter {
  std::string name;
  std::string key;       ///< of [fusion], whose value is multiplied; empty: none
  std::string fallback;  ///< lines that stand for a key which is not there
  void (*unit)(ImuNoise& told, double factor) = nullptr;
  std::set<std::string> subjects;  ///< of findings that name it
};
std::vector<WrongParameter> wrong_parameters();

/// Subjects of all faults that are found with the filter of one world, 100 s long, its errors looked at once a second.
/// `wrong`: what it is told `factor` times too large; null: all is right.
std::set<std::string> faults_of_run(std::uint64_t seed, const WrongParameter* wrong, double factor);

/// Whether one of them names it.
bool names(const std::set<std::string>& faults, const WrongParameter& wrong);

}  // namespace canyon::testing

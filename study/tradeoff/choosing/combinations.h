#pragma once

#include <cstddef>
#include <vector>

namespace canyon::study {

/// One way to set one key, by what it was seen to change alone.
struct Option {
  double cpu_s = 0.0;   ///< more than the setting in use, per simulated second; below 0 where it saves
  double change = 0.0;  ///< of the figure, size
};

/// One option of each key together.
struct Combination {
  std::vector<std::size_t> options;
  double cpu_s = 0.0, change = 0.0;  ///< sums: an upper bound of the change if keys do not amplify one another
};

/// Those of all combinations that no other is both cheaper and closer than, by growing cost. Keys are joined one after
/// the other and what is dominated is dropped at once, so that it takes time in the size of the front, not of the
/// product (the front of a sum is among the sums of the fronts). At most `largest` are kept, evenly along the front.
std::vector<Combination> best_combinations(const std::vector<std::vector<Option>>& keys, std::size_t largest = 2000);

}  // namespace canyon::study

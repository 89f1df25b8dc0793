#pragma once

#include <string>
#include <vector>

#include "canyon/study/causes/causes.h"

namespace canyon::study::testing {

/// A failure whose cause is known, because it was put there: a drive of some 100 m up a street that succeeds without
/// it.
struct Plant {
  const char* name;
  /// Of those removals that take it away, the names that count as right; empty: no source of navigation is to blame.
  std::vector<std::string> causes;
  enum class Kind { kOwnSwitch, kNoSwitch, kTwoTogether, kNone } kind;
  std::vector<const char*> toml;  ///< laid over the drive, in this order
};
/// Those of kNone fail whatever is drawn and whatever is taken away: a cause is hardly named of them by mistake.
const std::vector<Plant>& plants();
/// Failures that no source of navigation is to blame for and that hang on the draws, so that some redraws succeed. Each
/// removal changes what comes of some of them, and may so seem to rescue.
const std::vector<Plant>& plants_of_chance();

/// The drive with a plant and a seed. All but the plant is as good as perfect.
Result<Comparison> planted(const Plant& plant, std::int64_t seed);

}  // namespace canyon::study::testing

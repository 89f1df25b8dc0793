#pragma once

#include "canyon/study/tradeoff/ladders/rungs.h"
#include "canyon/study/tradeoff/tradeoff.h"

namespace canyon::study {

/// A key that may be moved, with its rungs laid over the fidelity and nothing else: what the fidelity has comes first,
/// the others in the order of their ladder.
struct MovableKey {
  std::string key;
  std::vector<std::string> names;               ///< first what is in use
  std::vector<mission::MissionConfig> configs;  ///< of each alone
  std::size_t finest = 0;                       ///< index of what errors of the ladder are measured against
};

/// Of the ladders of the parts asked for, those that are keys of the mission and may be moved. Rungs that cannot be
/// made are left out; keys of which nothing else is left too.
Result<std::vector<MovableKey>> movable_keys(const mission::MissionFile& file, const TradeoffOptions& options);

/// The fidelity with several keys set.
Result<mission::MissionConfig> with_settings(const mission::MissionFile& file, const std::string& fidelity,
                                             const std::vector<std::pair<std::string, std::string>>& settings);

}  // namespace canyon::study

#include "canyon/study/tradeoff/choosing/movable_keys.h"

#include <algorithm>

#include "canyon/gnss/sensor/sensor.h"
#include "canyon/study/tradeoff/ladders/config_keys.h"
#include "canyon/study/tradeoff/probes/probe.h"

namespace canyon::study {
namespace {

/// The ladder without what is fixed while it is measured by itself: here it is moved where it stands.
Ladder alone(Ladder ladder) {
  ladder.fixed.clear();
  if (ladder.values.empty()) return ladder;
  // The finest rung counts, whether an order is read off it or not.
  ladder.reference = kTruth;
  return ladder;
}

}  // namespace

Result<mission::MissionConfig> with_settings(const mission::MissionFile& file, const std::string& fidelity,
                                             const std::vector<std::pair<std::string, std::string>>& settings) {
  mission::MissionFile with = file;
  for (const auto& [key, value] : settings) with.set_option(key, setting_node(value), "tradeoff");
  return with.resolve(fidelity);
}

Result<std::vector<MovableKey>> movable_keys(const mission::MissionFile& file, const TradeoffOptions& options) {
  CANYON_TRY(mission::MissionConfig config, file.resolve(options.fidelity));
  const std::vector<ConfigKey> known = config_keys_of(config);
  std::vector<MovableKey> out;
  for (const Ladder& ladder : built_in_ladders().ladder) {
    const bool asked = std::find(options.parts.begin(), options.parts.end(), ladder.part) != options.parts.end();
    const ConfigKey* key = find_key(known, ladder.key);
    if (!asked || !ladder.chosen || key == nullptr || !ladder.for_each.empty()) continue;
    const Ladder own = alone(ladder);
    const auto lists = make_rungs(own, file, options.fidelity, probe_keys());
    if (!lists) continue;
    MovableKey movable{.key = ladder.key, .names = {key->value}, .configs = {config}};
    const RungList& list = lists->front();
    for (std::size_t i = 0; i < list.rungs.size(); ++i) {
      const bool finest = own.values.empty() ? list.reference == i : i + 1 == list.rungs.size();
      if (!list.rungs[i].in_use) {
        movable.names.push_back(list.rungs[i].name);
        movable.configs.push_back(list.rungs[i].config);
        if (finest) movable.finest = movable.names.size() - 1;
      }
    }
    if (movable.names.size() > 1) out.push_back(std::move(movable));
  }
  return out;
}

}  // namespace canyon::study

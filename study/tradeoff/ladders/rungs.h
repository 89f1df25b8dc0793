#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "canyon/mission/config/mission_file.h"
#include "canyon/study/tradeoff/ladders/config_keys.h"
#include "canyon/study/tradeoff/ladders/ladder.h"

namespace canyon::study {

/// One model of a ladder, as it is to be measured.
struct Rung {
  std::string name;                        ///< a row's, or the number
  mission::MissionConfig config;           ///< the fidelity with the ladder's fixed settings and this rung's own
  std::map<std::string, std::string> own;  ///< settings that are the probe's, not the mission's, by key
  std::optional<double> value;             ///< of ladders of numbers
  bool in_use = false;                     ///< what the fidelity itself has
};

/// A rung that cannot be, and why: a model that wants a file, a rate that a sensor refuses.
struct LeftOut {
  std::string name, reason;
};

/// A ladder with what its rungs are here.
struct RungList {
  const Ladder* ladder = nullptr;
  std::string of;                          ///< for_each: "fusion.integrator=euler"; else empty
  std::vector<Rung> rungs{};               ///< the reference among them, unless it is truth
  std::optional<std::size_t> reference{};  ///< none: truth
  bool reference_is_rung = true;           ///< false: the last of `rungs` is the reference and not of the ladder
  std::vector<LeftOut> left_out{};
};

/// What a ladder is in this mission at this fidelity: one list, or with for_each one per row. `probe_keys` are the keys
/// that are no mission's. An Error only for what no rung can be made with.
Result<std::vector<RungList>> make_rungs(const Ladder& ladder, const mission::MissionFile& file,
                                         const std::string& fidelity, const std::vector<ConfigKey>& probe_keys);

/// A setting of the mission file as an option lays it over: "2.5", "true", "specular1".
ConfigNode setting_node(const std::string& value);

}  // namespace canyon::study

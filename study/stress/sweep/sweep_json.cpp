#include <nlohmann/json.hpp>

#include "canyon/core/output/json.h"
#include "canyon/study/stress/sweep/sweep.h"

namespace canyon::study {

nlohmann::ordered_json sweep_json(const Sweep& sweep) {
  Json failures = Json::array();
  for (const SweepFailure& failure : sweep.failures) {
    Json settings = Json::object();
    for (const auto& [key, value] : failure.settings) settings[key] = value;
    failures.push_back({{"settings", settings}, {"what", failure.what}});
  }
  return {{"keys_tried", sweep.keys_tried},         {"values_tried", sweep.values_tried},
          {"pairs_tried", sweep.pairs_tried},       {"refused", sweep.refused},
          {"not_tried", sweep.not_tried},           {"interrupted", sweep.interrupted},
          {"keys_not_tried", sweep.keys_not_tried}, {"failures", failures}};
}

}  // namespace canyon::study

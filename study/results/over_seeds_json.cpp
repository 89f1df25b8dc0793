#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/study/results/over_seeds.h"

namespace canyon::study {

using Json = nlohmann::ordered_json;

namespace {

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json shares_json(const OverSeeds& found) {
  if (found.open_loop) return nullptr;
  Json out = Json::array();
  for (const Share& share : found.shares)
    out.push_back({{"fidelity", share.fidelity},
                   {"success", share.success},
                   {"n", share.n},
                   {"low", number(share.interval.low)},
                   {"high", number(share.interval.high)},
                   {"outcomes", share.outcomes}});
  return out;
}

/// Medians of what depends on the machine stand under `timing`, as everywhere.
Json figures_json(const std::vector<FigureOverSeeds>& of_run, bool timing) {
  Json out = Json::object();
  for (const FigureOverSeeds& row : of_run)
    if (row.figure->timing == timing)
      out[row.figure->key] = {{"n", row.n},
                              {"median", number(row.median.value)},
                              {"low", number(row.median.interval.low)},
                              {"high", number(row.median.interval.high)},
                              {"min", number(row.lowest)},
                              {"max", number(row.highest)}};
  return out;
}

}  // namespace

void write_over_seeds(const OverSeeds& found, Json& out) {
  out["seeds"] = found.seeds;
  out["shares"] = shares_json(found);
  out["paired"] = Json::array();
  for (const PairedDifference& pair : found.paired)
    out["paired"].push_back({{"a", pair.a},
                             {"b", pair.b},
                             {"figure", pair.figure},
                             {"n", pair.n},
                             {"difference", number(pair.difference)},
                             {"low", number(pair.interval.low)},
                             {"high", number(pair.interval.high)},
                             {"p", number(pair.p)}});
  out["over_seeds"] = Json::array();
  for (std::size_t run = 0; run < found.fidelities.size(); ++run)
    out["over_seeds"].push_back({{"fidelity", found.fidelities[run]},
                                 {"figures", figures_json(found.figures[run], false)},
                                 {"timing", figures_json(found.figures[run], true)}});
}

}  // namespace canyon::study

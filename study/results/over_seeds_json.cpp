#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/output/json.h"
#include "canyon/study/results/over_seeds.h"

namespace canyon::study {

namespace {

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json shares_json(const OverSeeds& found) {
  if (found.open_loop) return nullptr;
  Json out = Json::array();
  for (const Share& share : found.shares)
    out.push_back({{"fidelity", share.fidelity},
                   {"success", share.success},
                   {"n", share.n},
                   {"low", number_or_null(share.interval.low)},
                   {"high", number_or_null(share.interval.high)},
                   {"outcomes", share.outcomes}});
  return out;
}

/// Medians of what depends on the machine stand under `timing`, as everywhere.
Json figures_json(const std::vector<FigureOverSeeds>& of_run, bool timing) {
  Json out = Json::object();
  for (const FigureOverSeeds& row : of_run)
    if (row.figure->timing == timing)
      out[row.figure->key] = {{"n", row.n},
                              {"median", number_or_null(row.median.value)},
                              {"low", number_or_null(row.median.interval.low)},
                              {"high", number_or_null(row.median.interval.high)},
                              {"min", number_or_null(row.lowest)},
                              {"max", number_or_null(row.highest)}};
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
                             {"difference", number_or_null(pair.difference)},
                             {"low", number_or_null(pair.interval.low)},
                             {"high", number_or_null(pair.interval.high)},
                             {"p", number_or_null(pair.p)}});
  out["over_seeds"] = Json::array();
  for (std::size_t run = 0; run < found.fidelities.size(); ++run)
    out["over_seeds"].push_back({{"fidelity", found.fidelities[run]},
                                 {"figures", figures_json(found.figures[run], false)},
                                 {"timing", figures_json(found.figures[run], true)}});
}

}  // namespace canyon::study

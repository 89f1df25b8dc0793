#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/output/json.h"
#include "canyon/study/tradeoff/output/tradeoff_output.h"

namespace canyon::study {
namespace {

Json optional_json(const std::optional<double>& value) {
  return value ? or_null(*value) : Json(nullptr);
}

Json model_json(const MeasuredModel& model, const MeasuredLadder& ladder) {
  Json out;
  out["name"] = model.name;
  out["value"] = optional_json(model.value);
  out["error"] = or_null(model.error);
  out["error_unit"] = ladder.unit;
  out["error_sigma"] = or_null(model.error_sigma);
  out["error_low"] = or_null(model.error_interval.low);
  out["error_high"] = or_null(model.error_interval.high);
  out["undefined_share"] = model.undefined_share;
  out["common_error"] = or_null(model.common_error);
  out["cpu_s"] = or_null(model.cpu_s);
  out["cpu_low_s"] = or_null(model.cpu_low_s);
  out["cpu_high_s"] = or_null(model.cpu_high_s);
  out["cpu_spread_s"] = or_null(model.cpu_high_s - model.cpu_low_s);
  out["simulated_s"] = or_null(model.simulated_s);
  out["work"] = model.work;
  out["memory_mb"] = or_null(model.memory_mb);
  out["on_front"] = model.on_front;
  out["tied_with"] = model.tied_with;
  out["in_use"] = model.in_use;
  out["is_reference"] = model.is_reference;
  out["resolved"] = model.resolved;
  return out;
}

Json left_out_json(const std::vector<LeftOut>& left_out) {
  Json out = Json::array();
  for (const LeftOut& one : left_out) out.push_back({{"name", one.name}, {"reason", one.reason}});
  return out;
}

Json ladder_json(const MeasuredLadder& ladder) {
  Json out;
  out["part"] = ladder.part;
  out["key"] = ladder.key;
  out["of"] = ladder.of.empty() ? Json(nullptr) : Json(ladder.of);
  out["probe"] = ladder.probe;
  out["meaning"] = ladder.meaning;
  out["error_unit"] = ladder.unit;
  out["error_is"] = ladder.against_truth ? "error" : "difference to finest";
  out["reference"] = ladder.reference;
  out["reference_error"] = or_null(ladder.reference_error);
  out["cpu_unit"] = "s per simulated s";
  out["work_unit"] = ladder.work_unit;
  out["models"] = Json::array();
  for (const MeasuredModel& model : ladder.models) out["models"].push_back(model_json(model, ladder));
  out["left_out"] = left_out_json(ladder.left_out);
  out["order_observed"] = or_null(ladder.order_observed);
  out["order_theory"] = optional_json(ladder.order_theory);
  out["orders"] = Json::array();
  for (const double order : ladder.orders) out["orders"].push_back(or_null(order));
  out["order_must_hold"] = ladder.order_must_hold && ladder.order_theory.has_value();
  out["order_holds"] = ladder.order_holds();
  out["time_fit"] = {{"fixed_s", or_null(ladder.fit.fixed_s)},
                     {"per_work_s", or_null(ladder.fit.per_work_s)},
                     {"worst_ratio", or_null(ladder.fit.worst_ratio)}};
  return out;
}

Json outcomes_json(const MeasuredOutcomes& found) {
  Json out;
  out["success"] = found.share.success;
  out["n"] = found.share.n;
  out["low"] = or_null(found.share.interval.low);
  out["high"] = or_null(found.share.interval.high);
  out["outcomes"] = found.share.outcomes;
  out["mission_cpu_s"] = or_null(found.cpu_s);
  out["mission_cpu_low_s"] = or_null(found.cpu_low_s);
  out["mission_cpu_high_s"] = or_null(found.cpu_high_s);
  return out;
}

Json fidelity_json(const MeasuredFidelity& run) {
  Json out;
  out["fidelity"] = run.name;
  out["planned"] = run.planned;
  out["position_error_rms_m"] = or_null(run.position_error_rms_m);
  out["map_error_rms_m"] = or_null(run.map_error_rms_m);
  out["registration_error_rms_m"] = or_null(run.registration_error_rms_m);
  out["tape_s"] = or_null(run.tape_s);
  out["cpu_s"] = or_null(run.cpu_s);
  out["cpu_low_s"] = or_null(run.cpu_low_s);
  out["cpu_high_s"] = or_null(run.cpu_high_s);
  out["simulated_s"] = or_null(run.simulated_s);
  out["work"] = run.work;
  out["closed_loop"] = run.outcomes ? outcomes_json(*run.outcomes) : Json(nullptr);
  return out;
}

Json chosen_json(const Chosen& chosen) {
  Json out;
  out["figure"] = chosen.figure;
  out["unit"] = chosen.unit;
  out["tolerance"] = or_null(chosen.tolerance);
  out["budget_cpu_s"] = or_null(chosen.budget_cpu_s);
  out["found"] = chosen.found;
  out["settings"] = chosen.found ? Json::object() : Json(nullptr);
  for (const auto& [key, value] : chosen.settings) out["settings"][key] = value;
  out["error"] = or_null(chosen.error);
  out["cpu_s"] = or_null(chosen.cpu_s);
  out["cpu_reference_s"] = or_null(chosen.cpu_reference_s);
  out["validated_seeds"] = chosen.validated_seeds;
  out["refused"] = chosen.refused;
  return out;
}

}  // namespace

Json tradeoff_json(const Tradeoff& tradeoff) {
  Json out;
  out["kind"] = "tradeoff";
  out["mission"] = tradeoff.mission;
  out["fidelity"] = tradeoff.fidelity;
  out["seed"] = tradeoff.seed;
  out["tape"] = tradeoff.tape;
  out["samples"] = tradeoff.samples;
  out["repetitions"] = tradeoff.repetitions;
  out["threads"] = tradeoff.threads;
  out["ladders"] = Json::array();
  for (const MeasuredLadder& ladder : tradeoff.ladders) out["ladders"].push_back(ladder_json(ladder));
  out["skipped"] = left_out_json(tradeoff.skipped);
  out["fidelities"] = Json::array();
  for (const MeasuredFidelity& run : tradeoff.fidelities) out["fidelities"].push_back(fidelity_json(run));
  out["chosen"] = tradeoff.chosen ? chosen_json(*tradeoff.chosen) : Json(nullptr);
  return out;
}

}  // namespace canyon::study

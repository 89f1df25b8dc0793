#include <algorithm>
#include <cmath>

#include "canyon/core/config/text.h"
#include "canyon/core/output/printed.h"
#include "canyon/study/tables/text_table.h"
#include "canyon/study/tradeoff/output/tradeoff_output.h"

namespace canyon::study {
namespace {

/// Three significant digits; "-" where it is undefined.
std::string three(double value) {
  if (!std::isfinite(value)) return "-";
  return value == 0.0 ? "0" : printed("%.3g", value);
}

std::string error_text(const MeasuredModel& model) {
  std::string text = model.is_reference ? "(reference)" : three(model.error);
  if (std::isfinite(model.error_sigma) && !model.is_reference) text += " +- " + three(model.error_sigma);
  return text;
}

/// Their names, or how many there are.
std::string few_of(const std::vector<std::string>& names) {
  if (names.size() > 3) return std::to_string(names.size()) + " others";
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

/// What a reader should know of a model beside its numbers.
std::string remarks(const MeasuredModel& model) {
  std::string text;
  const auto add = [&](const std::string& one) { text += (text.empty() ? "" : ", ") + one; };
  if (model.on_front) add("front");
  if (model.in_use) add("in use");
  if (!model.resolved) add("unresolved");
  if (!model.tied_with.empty()) add("tied in time with " + few_of(model.tied_with));
  return text;
}

std::string order_text(const MeasuredLadder& ladder) {
  if (!std::isfinite(ladder.order_observed) && !ladder.order_theory) return "";
  std::string text =
      "  order: observed " + (std::isfinite(ladder.order_observed) ? printed("%.2f", ladder.order_observed)
                                                                   : std::string("none above rounding"));
  if (ladder.order_theory) text += ", theory " + number_text(*ladder.order_theory);
  if (!ladder.order_holds()) text += "  <- NOT WHAT ITS ROW SAYS";
  return text + "\n";
}

std::string ladder_table(const MeasuredLadder& ladder) {
  const std::string of = ladder.of.empty() ? "" : " of " + ladder.of;
  std::string out = ladder.part + ": " + ladder.key + of + "\n  " + ladder.meaning + "\n";
  const bool undefined = std::any_of(ladder.models.begin(), ladder.models.end(),
                                     [](const MeasuredModel& model) { return model.undefined_share > 0.0; });
  const bool common = undefined && ladder.against_truth;
  std::vector<std::string> head{(ladder.against_truth ? "error, " : "difference to finest, ") + ladder.unit};
  if (undefined) head.emplace_back("undefined");
  if (common) head.emplace_back("where all are defined");
  for (const char* column : {"CPU, ms per s", "spread", "work", "MB"}) head.emplace_back(column);
  TextTable table(head, "");
  for (const MeasuredModel& model : ladder.models) {
    std::vector<std::string> cells{error_text(model)};
    if (undefined) cells.push_back(printed("%.3g %%", 100.0 * model.undefined_share));
    if (common) cells.push_back(three(model.common_error));
    for (const std::string& cell : {three(1e3 * model.cpu_s), three(1e3 * (model.cpu_high_s - model.cpu_low_s)),
                                    std::to_string(model.work), three(model.memory_mb)})
      cells.push_back(cell);
    table.line("  " + model.name, cells, "  " + remarks(model));
  }
  out += table.str();
  if (!ladder.against_truth)
    out +=
        "  the reference, " + ladder.reference + ", itself errs " +
        (std::isfinite(ladder.reference_error) ? three(ladder.reference_error) + " " + ladder.unit + " (extrapolated)"
                                               : "by an amount that nothing here tells") +
        "\n";
  out += order_text(ladder);
  for (const LeftOut& one : ladder.left_out) out += "  left out: " + one.name + ": " + one.reason + "\n";
  return out + "\n";
}

std::string fidelity_table(const std::vector<MeasuredFidelity>& runs) {
  if (runs.empty()) return "";
  TextTable table({"position, m", "map, m", "registration, m", "CPU, s per s", "least", "most"}, "");
  for (const MeasuredFidelity& run : runs)
    table.line("  " + run.name,
               {fixed(run.position_error_rms_m, 3), fixed(run.map_error_rms_m, 3),
                fixed(run.registration_error_rms_m, 3), three(run.cpu_s), three(run.cpu_low_s), three(run.cpu_high_s)});
  return "The mission as a whole, open loop: errors (RMS) over " + fixed(runs.front().tape_s, 0) +
         " s against CPU time of the first " + fixed(runs.front().simulated_s, 0) + " s\n" + table.str() + "\n";
}

std::string outcome_table(const std::vector<MeasuredFidelity>& runs) {
  if (runs.empty() || !runs.front().outcomes) return "";
  TextTable table({"success", "share, 95 %", "CPU, s a mission", "least", "most"}, "");
  for (const MeasuredFidelity& run : runs) {
    const auto& [share, cpu_s, least_s, most_s] = *run.outcomes;
    std::string how;
    for (const auto& [outcome, count] : share.outcomes)
      how += (how.empty() ? "  " : ", ") + outcome + " " + std::to_string(count);
    table.line("  " + run.name,
               {share.text(),
                share.n > 0 ? printed("%.0f-%.0f %%", 100.0 * share.interval.low, 100.0 * share.interval.high) : "-",
                three(cpu_s), three(least_s), three(most_s)},
               how);
  }
  int seeds = 0;
  for (const auto& [outcome, count] : runs.front().outcomes->share.outcomes) seeds += count;
  return "The mission as a whole, closed loop, " + std::to_string(seeds) + " seeds: outcomes against CPU time\n" +
         table.str() + "\n";
}

std::string chosen_text(const Chosen& chosen) {
  const std::string asked = std::isfinite(chosen.tolerance)
                                ? chosen.figure + " within " + number_text(chosen.tolerance) + " " + chosen.unit
                                : "at most " + number_text(chosen.budget_cpu_s) + " CPU s per simulated s";
  std::string refused;
  if (chosen.refused > 0)
    refused = printed("  (%d that ranked before did not hold on seeds that had not chosen them)\n", chosen.refused);
  if (!chosen.found) return "Asked: " + asked + ": none held\n" + refused;
  std::string out = "Asked: " + asked + "\n";
  for (const auto& [key, value] : chosen.settings) out += "  " + key + " = " + value + "\n";
  if (chosen.settings.empty()) out += "  nothing to change: the fidelity's own settings\n";
  out += "  " + chosen.figure + " changes by at most " + three(chosen.error) + " " + chosen.unit + " on " +
         std::to_string(chosen.validated_seeds.size()) + " seeds that did not choose it\n  CPU " + three(chosen.cpu_s) +
         " s per simulated s, " + three(chosen.cpu_reference_s) + " without\n";
  return out + refused;
}

}  // namespace

std::string tradeoff_table(const Tradeoff& tradeoff) {
  std::string out;
  for (const MeasuredLadder& ladder : tradeoff.ladders) out += ladder_table(ladder);
  for (const LeftOut& one : tradeoff.skipped) out += one.name + ": not measured here: " + one.reason + "\n";
  out += fidelity_table(tradeoff.fidelities) + outcome_table(tradeoff.fidelities);
  if (tradeoff.chosen) out += chosen_text(*tradeoff.chosen);
  return out;
}

}  // namespace canyon::study

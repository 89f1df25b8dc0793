#include "canyon/study/plan/plan_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "canyon/core/math/median.h"

namespace canyon::study {

namespace {

template <class... Values>
std::string table_text(const char* format, Values... values) {
  char out[400];
  std::snprintf(out, sizeof out, format, values...);
  return out;
}

/// All stretches of an effect of which the same was found.
struct Row {
  std::string effect, where, reason;
  bool whole_run = false;
  double length_m = 0.0, bound = 0.0, saved_s = 0.0;
  std::string unit;
  bool measured = true;
};

/// Those left out with an effect, or all others of a verdict.
std::vector<Row> rows(const Plan& plan, Verdict verdict, bool with_effect) {
  std::vector<Row> out;
  for (const PlannedEffect& line : plan.effects) {
    const bool acts = line.need.verdict == Verdict::kNotNeeded && line.need.bound > 0.0;
    if (line.need.verdict != verdict || acts != with_effect) continue;
    auto row = std::find_if(out.begin(), out.end(), [&](const Row& r) { return r.effect == line.need.effect; });
    if (row == out.end()) {
      out.push_back(
          {.effect = line.need.effect, .where = {}, .reason = line.need.reason, .unit = line.need.bound_unit});
      row = out.end() - 1;
    } else if (row->reason != line.need.reason && row->reason.find(", and the like") == std::string::npos) {
      row->reason += ", and the like";
    }
    row->whole_run = line.whole_run();
    row->length_m += line.end_m - line.start_m;
    row->bound = std::max(row->bound, line.need.bound);
    row->measured = row->measured && std::isfinite(line.saved_cpu_s);
    row->saved_s += std::isfinite(line.saved_cpu_s) ? line.saved_cpu_s : 0.0;
  }
  double route_m = 0.0;
  for (const PlannedEffect& line : plan.effects) route_m = std::max(route_m, line.end_m);
  for (Row& row : out)
    row.where = row.whole_run                  ? "whole run"
                : row.length_m > route_m - 0.5 ? "whole route"
                                               : table_text("%.0f of %.0f m", row.length_m, route_m);
  return out;
}

void add_rows(const Plan& plan, Verdict verdict, const char* title, std::string& out, bool with_effect = false) {
  const std::vector<Row> found = rows(plan, verdict, with_effect);
  if (found.empty()) return;
  const bool left_out = verdict == Verdict::kNotNeeded;
  out += table_text("%-30s %-14s %9s  %s\n", title, "where", left_out ? "saves" : "", "why");
  for (const Row& row : found) {
    const std::string saved = !left_out ? "" : !row.measured ? "-" : table_text("%.2f s", row.saved_s);
    out += table_text("  %-28s %-14s %9s  ", row.effect.c_str(), row.where.c_str(), saved.c_str());
    if (with_effect && row.unit == "m") out += table_text("a range by %.2g m at most: ", row.bound);
    out += row.reason + "\n";
  }
  out += "\n";
}

/// What the tolerances come to.
std::string tolerances_text(const Plan& plan) {
  std::string out;
  for (const auto& [figure, tolerance] : plan.tolerances) {
    const auto bound = plan.figure_bounds.find(figure);
    out += table_text("%s moves by %.3g at most, the tolerance is %.3g.\n", figure.c_str(),
                      bound == plan.figure_bounds.end() ? 0.0 : bound->second, tolerance);
  }
  if (!plan.epoch_bound_m.empty())
    out +=
        table_text("The estimate of position moves by %.3g m at most in the median epoch, by %.3g m in the worst.\n",
                   median(plan.epoch_bound_m), *std::max_element(plan.epoch_bound_m.begin(), plan.epoch_bound_m.end()));
  return out + (out.empty() ? "" : "\n");
}

std::string outputs_text(const Plan& plan) {
  std::string out;
  for (const Output output : plan.outputs) out += (out.empty() ? "" : ", ") + std::string(name(output));
  return out;
}

}  // namespace

std::string plan_table(const Plan& plan, const PredictedCost& cost, double nominal_s) {
  std::string out =
      "Plan for " + plan.mission + ", fidelity " + plan.fidelity + ". Read will be: " + outputs_text(plan) + ".\n\n";
  add_rows(plan, Verdict::kNotNeeded, "Left out, with no effect at all", out);
  add_rows(plan, Verdict::kNotNeeded, "Left out, as it acts by less", out, true);
  add_rows(plan, Verdict::kNeeded, "Needed", out);
  add_rows(plan, Verdict::kUndecidable, "Kept, as it may act", out);
  out += tolerances_text(plan);
  if (std::isfinite(cost.full_s))
    out += table_text(
        "CPU time of the nominal mission (%.0f s), predicted: %.1f s in full, %.1f s as planned (%.2f x less).\n",
        nominal_s, cost.full_s, cost.planned_s, cost.full_s / cost.planned_s);
  if (!plan.omissions.corridor.empty())
    out += table_text(
        "What is left out along the route holds within %g m of it. A vehicle that goes farther gets everything\n"
        "back from that step on, and the run says when.\n",
        plan.half_width_m);
  return out;
}

std::string verification_table(const Verification& verification) {
  std::string out = table_text("%-44s %16s %11s  %s\n", "Verified: left out", "epochs", "violations",
                               "largest difference, and the bound");
  for (const VerifiedEffect& effect : verification.effects)
    out += table_text(
        "  %-42s %16s %11lld  %s\n", effect.effect.c_str(),
        table_text("%lld of %lld", static_cast<long long>(effect.epochs), static_cast<long long>(effect.replayed))
            .c_str(),
        static_cast<long long>(effect.violations),
        (effect.bound > 0.0
             ? table_text("%.3g %s of %.3g", effect.largest_difference, effect.unit.c_str(), effect.bound)
         : effect.violations == 0 ? std::string("none, to the bit")
                                  : table_text("%g", effect.largest_difference))
            .c_str());
  if (verification.effects.empty()) out += "  nothing is left out\n";
  if (std::isfinite(verification.tightness()))
    out +=
        table_text("Tightness, the median of bound / largest difference: %.1f in their own units, %.1f of positions\n",
                   verification.tightness(), verification.position_tightness());
  return out;
}

}  // namespace canyon::study

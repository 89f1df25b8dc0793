#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/output/printed.h"
#include "canyon/study/registration_error/error_budget.h"

namespace canyon::study {
namespace {

Json shares_json(const BudgetFigure& figure) {
  const std::string unit = "_" + figure.unit;
  Json shares = Json::array();
  for (const SourceShare& s : figure.shares)
    shares.push_back({{"source", s.source},
                      {"acts", s.acts},
                      {"share" + unit, or_null(s.share)},
                      {"low" + unit, or_null(s.over_seeds.low)},
                      {"high" + unit, or_null(s.over_seeds.high)},
                      {"order_sigma" + unit, or_null(s.order_sigma)}});
  return {{"total" + unit, or_null(figure.total)}, {"floor" + unit, or_null(figure.floor)}, {"shares", shares}};
}

/// The map's own keys stand by themselves, those of the other figures under their names.
Json budget_json(const Budget& budget) {
  Json out = shares_json(budget.figures.front());
  for (std::size_t i = 1; i < budget.figures.size(); ++i) out[budget.figures[i].key] = shares_json(budget.figures[i]);
  return out;
}

std::string number(double value) {
  return std::isfinite(value) ? printed("%.9g", value) : "";
}

/// "0.31 (62 %) [0.2, 0.4] +- 0.02": the share and its part of total - floor, over seeds, and its 1-sigma by orders.
std::string share_words(const BudgetFigure& figure, const SourceShare& s) {
  if (!s.acts) return "0";
  const double percent = 100.0 * s.share / (figure.total - figure.floor);
  return printed("%.4g (%.0f %%)", s.share, percent) +
         (s.over_seeds.defined() ? printed(" [%.4g, %.4g]", s.over_seeds.low, s.over_seeds.high) : "") +
         (std::isfinite(s.order_sigma) ? printed(" +- %.1g", s.order_sigma) : "");
}

}  // namespace

Json error_budget_json(const ErrorBudget& budget) {
  Json out = budget.budgets.empty() ? Json::object() : budget_json(budget.budgets.front());
  for (const Budget& b : budget.budgets) out["hidden_" + std::string(name(b.hidden))] = budget_json(b);
  out["mission"] = budget.mission;
  out["fidelity"] = budget.fidelity;
  out["map"] = budget.registered ? "registered" : "prior";
  out["tape"] = budget.tape;
  out["seed"] = budget.seed;
  out["seeds"] = budget.seeds;
  out["permutations"] = budget.permutations;
  out["runs"] = budget.runs;
  Json docs = Json::object();
  for (const ErrorSource& source : error_sources()) docs[source.name] = source.doc;
  out["sources"] = docs;
  out["timing"] = {{"cpu_s", budget.cpu_s},
                   {"plain_run_cpu_s", budget.plain_cpu_s},
                   {"cost_factor", or_null(budget.cost_factor())},
                   {"receivers_measured", budget.receivers},
                   {"scans_made", budget.scans.scans_made},
                   {"scans_taken", budget.scans.scans_taken},
                   {"clouds_taken", budget.scans.clouds_taken},
                   {"kept_mb", 1e-6 * static_cast<double>(budget.scans.kept_bytes)}};
  return out;
}

std::string error_budget_csv(const ErrorBudget& budget) {
  std::string out = "hidden,figure,unit,source,share,order_sigma,low,high,total,floor\n";
  for (const Budget& b : budget.budgets)
    for (const BudgetFigure& f : b.figures)
      for (const SourceShare& s : f.shares)
        out += std::string(name(b.hidden)) + ',' + f.key + ',' + f.unit + ',' + s.source + ',' + number(s.share) + ',' +
               number(s.order_sigma) + ',' + number(s.over_seeds.low) + ',' + number(s.over_seeds.high) + ',' +
               number(f.total) + ',' + number(f.floor) + '\n';
  return out;
}

std::string error_budget_table(const ErrorBudget& budget) {
  std::string out = printed("%s, %s: %lld seed%s, %lld orders, %lld runs on one true motion; %s map\n",
                            budget.mission.c_str(), budget.fidelity.c_str(), static_cast<long long>(budget.seeds),
                            budget.seeds == 1 ? "" : "s", static_cast<long long>(budget.permutations),
                            static_cast<long long>(budget.runs), budget.registered ? "registered" : "prior");
  for (const Budget& b : budget.budgets) {
    out += printed("\nMean square errors in m^2 and who causes them; hidden signals %s\n", name(b.hidden));
    for (std::size_t k = 0; k < 3; ++k) {
      const BudgetFigure& f = b.figures[k];
      out += printed("  %-10s %.4g, of which nobody's %.4g\n", f.key.c_str(), f.total, f.floor);
      for (const SourceShare& s : f.shares)
        out += printed("    %-18s %s\n", s.source.c_str(), share_words(f, s).c_str());
    }
  }
  out += printed("\nCost: %.1f times one plain run of each seed\n", budget.cost_factor());
  return out;
}

}  // namespace canyon::study

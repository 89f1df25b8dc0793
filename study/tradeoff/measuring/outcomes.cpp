#include <algorithm>

#include "canyon/core/math/median.h"
#include "canyon/study/seeds/further_seeds.h"
#include "canyon/study/tradeoff/measuring/fidelities.h"

namespace canyon::study {

Result<std::vector<MeasuredOutcomes>> measure_outcomes(const Comparison& comparison, std::int64_t seeds,
                                                       bool show_progress) {
  Comparison closed = comparison;
  closed.tape.reset();
  CANYON_TRY_STATUS(check_seeds(closed, seeds));
  CANYON_TRY(Results results, compare(closed, "", show_progress));
  if (seeds > 1) CANYON_TRY_STATUS(add_further_seeds(closed, seeds - 1, "", show_progress, results));
  const auto runs = runs_by_seed(results);
  const OverSeeds found = over_seeds(runs);
  std::vector<MeasuredOutcomes> out;
  for (std::size_t i = 0; i < found.shares.size(); ++i) {
    std::vector<double> cpu_s;
    for (const auto& of_seed : runs) cpu_s.push_back(of_seed[i].cpu_s);
    const auto [least, most] = std::minmax_element(cpu_s.begin(), cpu_s.end());
    MeasuredOutcomes one{.share = found.shares[i], .cpu_low_s = *least, .cpu_high_s = *most};
    one.cpu_s = median(cpu_s);
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace canyon::study

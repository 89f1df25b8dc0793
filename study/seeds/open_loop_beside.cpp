#include "canyon/study/seeds/open_loop_beside.h"

#include "canyon/study/results/over_seeds.h"
#include "canyon/study/seeds/further_seeds.h"

namespace canyon::study {

Result<Comparison> open_loop_beside(const Comparison& closed, const TapeChoice& choice) {
  Comparison open;
  for (std::size_t i = 0; i < closed.plan.size(); ++i) {
    if (closed.plan[i].gnss != closed.plan[i].imu) continue;
    open.plan.push_back(closed.plan[i]);
    open.configs.push_back(closed.configs[i]);
    open.missions.push_back(closed.missions[i]);
  }
  CANYON_TRY_STATUS(choose_tape(choice, open));
  return open;
}

Result<OpenLoopRuns> drive_open_loop(const Comparison& open, std::int64_t seeds, const std::string& scratch,
                                     bool show_progress) {
  CANYON_TRY(Results results, compare(open, "", show_progress));
  if (seeds > 1) CANYON_TRY_STATUS(add_further_seeds(open, seeds - 1, scratch, show_progress, results));
  std::vector<std::string> warnings;
  for (const mission::RunRecord& record : results.records)
    warnings.insert(warnings.end(), record.warnings.begin(), record.warnings.end());
  return OpenLoopRuns{.tape_source = open.tape->source,
                      .duration_s = open.tape->duration_s(),
                      .by_seed = runs_by_seed(results),
                      .paired = std::move(results.paired),
                      .warnings = std::move(warnings),
                      .wall_s = results.wall_s};
}

}  // namespace canyon::study

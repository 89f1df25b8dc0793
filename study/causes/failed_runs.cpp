#include "canyon/study/causes/failed_runs.h"

namespace canyon::study {

std::vector<FailedRun> failed_runs(const Results& results, std::optional<std::int64_t> most) {
  std::vector<FailedRun> failed;
  std::vector<std::int64_t> of_run(results.summaries.size(), 0);
  const auto add = [&](const std::vector<RunSummary>& runs) {
    for (std::size_t run = 0; run < runs.size(); ++run) {
      if (!runs[run].failure || runs[run].outcome == mission::Outcome::kStopped) continue;
      if (most && of_run[run] >= *most) continue;
      ++of_run[run];
      failed.push_back({run, runs[run].seed, *runs[run].failure});
    }
  };
  add(results.summaries);
  for (const auto& runs : results.further_seeds) add(runs);
  return failed;
}

}  // namespace canyon::study

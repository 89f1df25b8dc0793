#include "canyon/apps/answers/tradeoff_files.h"

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/process/progress.h"
#include "canyon/report/tradeoff/tradeoff_page.h"
#include "canyon/study/tradeoff/output/tradeoff_output.h"

namespace canyon::apps {

Status write_tradeoff_files(const study::Tradeoff& tradeoff, const StagedDirectory& staged) {
  const std::string folder = staged.staging_path();
  const std::string summary = json_text(study::tradeoff_json(tradeoff), 2) + "\n";
  CANYON_TRY_STATUS(write_text_file(folder + "/summary.json", summary));
  CANYON_TRY_STATUS(write_text_file(folder + "/tradeoff.csv", study::tradeoff_csv(tradeoff)));
  if (!tradeoff.fidelities.empty())
    CANYON_TRY_STATUS(write_text_file(folder + "/fidelities.csv", study::fidelities_csv(tradeoff)));
  CANYON_TRY(const std::string page, report::tradeoff_page(folder + "/summary.json"));
  CANYON_TRY_STATUS(write_text_file(folder + "/report.html", page));
  throw_if_cancelled();
  return Ok{};
}

}  // namespace canyon::apps

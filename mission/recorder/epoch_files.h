#pragma once

#include <string>

#include "canyon/core/result.h"
#include "canyon/mission/recorder/run_record.h"

namespace canyon::mission {

/// The CSV files of one run, into directory/epochs.
Status write_epochs(const std::string& directory, const RunRecord& record);

}  // namespace canyon::mission

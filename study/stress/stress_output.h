#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/study/stress/run_cases.h"

namespace canyon::study {

/// For a terminal: a line per case under its subject, and the count of what holds, fails and is open.
std::string stress_table(const std::vector<CaseResult>& results);

/// `cases` of `canyon stress --json`: {name, group, mechanism, figure, bound, unit, pass, open, thrown, seconds}.
nlohmann::ordered_json stress_json(const std::vector<CaseResult>& results);

/// The mechanisms as docs/stress.md lists them, in Markdown; nothing is run.
std::string stress_list(const std::vector<StressCase>& cases);

}  // namespace canyon::study

#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "canyon/study/tradeoff/result.h"

namespace canyon::study {

/// summary.json of a tradeoff, which is also what --json prints: undefined values are null (docs/tradeoff.md).
nlohmann::ordered_json tradeoff_json(const Tradeoff& tradeoff);

/// tradeoff.csv: one row per model of every ladder.
std::string tradeoff_csv(const Tradeoff& tradeoff);

/// fidelities.csv: one row per whole mission; the header alone where none was measured.
std::string fidelities_csv(const Tradeoff& tradeoff);

/// For the terminal: a table per ladder, then the fidelities and the answer to the question.
std::string tradeoff_table(const Tradeoff& tradeoff);

}  // namespace canyon::study

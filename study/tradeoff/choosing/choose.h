#pragma once

#include "canyon/study/tradeoff/choosing/question.h"
#include "canyon/study/tradeoff/tradeoff.h"

namespace canyon::study {

/// Answers the question for the fidelity in hand. Change of a figure: of a run in an open loop over the tape's first
/// options.question_s, against the same with the fidelity's own settings, same true motion, same draws.
///
/// Every key that ladders.toml lets it move is moved alone, rung by rung, on the tape in hand; sums of what was seen
/// rank the combinations. The first on the list is then run as a whole on tapes of `seeds` seeds that follow the
/// mission's own and have chosen nothing: the change must be within the tolerance on every one of them (or the cost
/// within the budget), else the next on the list is tried. So the answer is a combination that held, or none.
///
/// Errors (exit 2): a tolerance below what the fidelity's own settings err in that figure, which is the sum of the
/// changes that the finest rung of each key makes; a budget below the cheapest combination; a figure that is undefined
/// in an open loop.
Result<Chosen> choose_settings(const Question& question, const mission::MissionFile& file,
                               const TradeoffOptions& options, const Comparison& comparison, int seeds);

/// The answer with what it was found on, and nothing measured beside it.
Result<Tradeoff> choose_and_describe(const Question& question, const mission::MissionFile& file,
                                     const TradeoffOptions& options, const Comparison& comparison, int seeds);

/// That the answer can be written there, asked before anything is measured: paths in a mission file hold from its own
/// folder only, and a fidelity "tradeoff" must not be there yet. `path` empty: the built-in mission.
Status check_writable(const std::string& path, const mission::MissionFile& file, const std::string& written_to);

/// A mission file that names the answer: what `path` holds (empty: the built-in mission), and after it a fidelity
/// "tradeoff" laid over the one that was asked for. It is read back before it is given.
Result<std::string> mission_with(const Chosen& chosen, const std::string& fidelity, const std::string& path,
                                 const std::string& written_to);

}  // namespace canyon::study

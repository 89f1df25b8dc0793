#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/study/stress/sweep/key_values.h"
#include "canyon/study/stress/sweep/trial.h"

namespace canyon::study {

struct SweepOptions {
  TrialSetup setup;
  std::uint64_t seed = 1;  ///< of the pairs, and of the order where time is limited
  std::int64_t pairs = 500;
  bool singles = true;               ///< each value by itself too; these are the same for any seed
  std::optional<double> budget_s{};  ///< wall time; what has not ended by then counts as not tried. None: all are
  bool show_progress = true;
};

struct SweepFailure {
  Settings settings;  ///< none: the mission as it stands
  std::string what;
};

struct Sweep {
  std::int64_t keys_tried = 0, values_tried = 0, pairs_tried = 0;
  std::int64_t refused = 0;                 ///< of all trials
  std::int64_t not_tried = 0;               ///< for lack of time, or since it was interrupted
  bool interrupted = false;                 ///< by the user: what had ended by then is here
  std::vector<std::string> keys_not_tried;  ///< of which no value has been, by itself
  std::vector<SweepFailure> failures;
};

/// What is tried, in the order of the keys, unless only pairs are, then the pairs: two different keys with a value
/// each, drawn from the stream "stress.pairs" of the seed. With a budget all of it shuffled, by the stream
/// "stress.order".
std::vector<Settings> sweep_settings(const std::vector<SweptKey>& keys, const SweepOptions& options);

/// Drives the mission for some seconds as it stands, then with every one of them, each in a process of its own, as many
/// side by side as there are processors. If the first fails or is refused, that is all that is found. An Error if there
/// is no place for the trials' files. What fails is told on stderr at once. Interrupted it gives what it has, if the
/// first had ended, else throws Cancelled; it leaves nothing behind.
Result<Sweep> sweep_mission(const std::vector<SweptKey>& keys, const SweepOptions& options);

std::string sweep_table(const Sweep& sweep);
/// {keys_tried, values_tried, pairs_tried, refused, not_tried, interrupted, keys_not_tried: [..],
/// failures: [{settings, what}]}
nlohmann::ordered_json sweep_json(const Sweep& sweep);

}  // namespace canyon::study

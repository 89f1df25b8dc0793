#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "canyon/report/read/results.h"

/// What happened in a run, out of its epochs.
namespace canyon::report {

/// "success" or the failure's kind with spaces, for tables.
std::string outcome_label(const std::string& outcome);
/// "good", "bad", or of a run that was stopped, which neither succeeded nor failed, "neither": the class of what shows
/// it.
std::string outcome_class(const std::string& outcome);
/// The same as a mark: a tick, a cross, a circle.
std::string outcome_mark(const std::string& outcome);

/// Row of the epoch nearest to t; nullopt if the table is empty.
std::optional<std::size_t> row_at(const EpochTable& table, double t_s);

/// 3-D error of a row out of its components; NaN if one is undefined.
double error_norm_m(const EpochTable& table, std::size_t row);

/// The row with the greatest defined horizontal error.
std::optional<std::size_t> worst_horizontal_row(const EpochTable& nav);

/// Reception in the interval [from, to] of gnss epochs.
struct Reception {
  std::size_t epochs = 0, without_fix = 0;
  std::string last_reason = {};                       ///< why the last epoch without a fix had none
  double satellites_min = 0.0, satellites_max = 0.0;  ///< in fixes; NaN if undefined throughout, as are the next two
  double gdop_max = 0.0;
  double multipath_max_m = 0.0;
};
Reception reception(const EpochTable& gnss, double from_s, double to_s);

/// Share of the errors E, N and Up of all epochs with |error| <= k sigma, as the filter believed it; NaN if undefined
/// throughout.
double share_within_sigma(const EpochTable& nav, double k);

/// The last time of any epoch of any run; 0 if there are none.
double last_epoch_s(const Results& results);

}  // namespace canyon::report

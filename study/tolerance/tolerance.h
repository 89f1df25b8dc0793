#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/core/model_table.h"
#include "canyon/core/result.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/statistics/interval.h"

namespace canyon::study {

/// One kind of error of navigation, laid on a mission by size: what a mission takes of it is asked. A new one is a
/// function and a row.
using Disturb = void(mission::MissionFile& file, double size);
/// Their names, which begin with a word and end with the unit of the size ("step_m"), and what they are.
ModelTable<Disturb> disturbances();
/// Sizes that are asked for where nobody says which.
std::vector<double> usual_sizes(const std::string& disturbance);

/// How often missions succeed with an error of that size.
struct TolerancePoint {
  double size = 0.0;
  int success = 0, n = 0;               ///< of how many that ended by themselves: not by [time] limit_s
  Interval interval;                    ///< Wilson's, of the share
  std::vector<std::string> outcomes{};  ///< by seed
};

struct ToleranceCurve {
  std::string disturbance, fidelity, autonomy;
  std::int64_t first_seed = 0;
  std::vector<TolerancePoint> points;
  /// No point's interval lies above that of a smaller error.
  bool monotone() const;
};

/// Drives the mission at each size with `seeds` seeds from its own on, the same for every size. Maps and registration,
/// which nobody reads, are left out. An Error as of the mission file.
Result<ToleranceCurve> tolerance_curve(const mission::MissionFile& file, const std::string& fidelity,
                                       const std::string& disturbance, const std::vector<double>& sizes,
                                       std::int64_t seeds, bool show_progress);

nlohmann::ordered_json tolerance_json(const ToleranceCurve& curve);
std::string tolerance_table(const ToleranceCurve& curve);
/// size,success,n,low,high
std::string tolerance_csv(const ToleranceCurve& curve);

}  // namespace canyon::study

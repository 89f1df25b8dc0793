#include "canyon/study/drive_check/drive_distributions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

namespace canyon::study {
namespace {

struct OfSignals {
  const char* key;
  bool in_sight;
  double DriveSignal::*value;
};
constexpr OfSignals kOfSignals[] = {
    {"cn0_in_sight_dbhz", true, &DriveSignal::cn0_dbhz},
    {"cn0_hidden_dbhz", false, &DriveSignal::cn0_dbhz},
    {"in_sight_error_m", true, &DriveSignal::error_m},
    {"hidden_error_m", false, &DriveSignal::error_m},
    {"in_sight_rate_error_m_s", true, &DriveSignal::rate_error_m_s},
    {"hidden_rate_error_m_s", false, &DriveSignal::rate_error_m_s},
};

Json side_json(const std::vector<double>& values) {
  Json percentiles = Json::array();
  for (int percent = 0; percent <= 100 && !values.empty(); ++percent)
    percentiles.push_back(or_null(drive_quantile(values, 0.01 * percent)));
  return Json{{"count", values.size()}, {"percentiles", std::move(percentiles)}};
}

}  // namespace

std::vector<DriveDistribution> drive_distributions(const std::vector<DriveEpoch>& epochs,
                                                   const std::vector<DriveFix>& fixes) {
  std::vector<DriveDistribution> out;
  for (const OfSignals& row : kOfSignals) {
    DriveDistribution& of = out.emplace_back(DriveDistribution{row.key, {}});
    for (const DriveEpoch& epoch : epochs)
      for (const DriveSignal& s : epoch.signals)
        if (s.in_sight == row.in_sight && std::isfinite(s.*row.value)) of.values.push_back(s.*row.value);
  }
  DriveDistribution& of_fixes = out.emplace_back(DriveDistribution{"fix_horizontal_error_m", {}});
  for (const DriveFix& fix : fixes)
    of_fixes.values.push_back(std::isnan(fix.horizontal_m) ? std::numeric_limits<double>::infinity()
                                                           : fix.horizontal_m);
  for (DriveDistribution& of : out) std::sort(of.values.begin(), of.values.end());
  return out;
}

Json drive_distributions_json(const std::vector<DriveDistribution>& simulated,
                              const std::vector<DriveDistribution>& measured) {
  Json out = Json::object();
  for (std::size_t k = 0; k < simulated.size(); ++k)
    out[simulated[k].key] =
        Json{{"simulated", side_json(simulated[k].values)}, {"measured", side_json(measured[k].values)}};
  return out;
}

}  // namespace canyon::study

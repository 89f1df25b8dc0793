#include "canyon/study/drive_check/drive_satellites.h"

#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"

namespace canyon::study {
namespace {

Json thousandths(double value) {
  return or_null(std::round(value * 1e3) / 1e3);
}

}  // namespace

Json drive_satellites_json(const std::vector<DriveEpoch>& simulated, const std::vector<DriveEpoch>& measured) {
  Json out = Json::object();
  const auto add = [&](const char* side, const std::vector<DriveEpoch>& epochs) {
    for (const DriveEpoch& epoch : epochs) {
      throw_if_cancelled();
      for (const DriveSignal& s : epoch.signals) {
        Json& of = out[s.sv.str()][side];
        of["sow"].push_back(thousandths(epoch.t.sow_s()));
        of["in_sight"].push_back(s.in_sight);
        of["elevation_deg"].push_back(thousandths(s.elevation_rad / kDegree));
        of["azimuth_deg"].push_back(thousandths(s.azimuth_rad / kDegree));
        of["cn0_dbhz"].push_back(thousandths(s.cn0_dbhz));
        of["error_m"].push_back(thousandths(s.error_m));
        of["rate_error_m_s"].push_back(thousandths(s.rate_error_m_s));
      }
    }
  };
  add("simulated", simulated);
  add("measured", measured);
  return out;
}

}  // namespace canyon::study

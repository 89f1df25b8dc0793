#include "canyon/gnss/rinex/navigation/simulated_navigation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "canyon/core/process/progress.h"
#include "canyon/gnss/rinex/navigation/navigation_writer.h"
#include "canyon/gnss/satellites/ephemerides/ephemeris_fit.h"

namespace canyon::gnss {
namespace {

constexpr double kMarginS = 10.0;      // for light times and receiver clocks
constexpr double kFitMarginS = 600.0;  // the same, and no fit ends where it is needed
constexpr double kStepS = 300.0, kLargestM = 1.0;

bool whole_second(GpsTime t) {
  return t.ns % kNsPerSecond == 0;
}

/// The records of the file that count in that time and can be written.
NavigationData records_of(const NavigationData& broadcast, const std::string& systems, GpsTime start, GpsTime end) {
  NavigationData data = used_records(broadcast, {.systems = systems});
  const GpsTime first = start - kMarginS, last = end + kMarginS;
  std::set<SatelliteId> unwritable;
  for (const auto& r : data.kepler)
    if (!is_in_rinex3(r.message) || !whole_second(r.toc)) unwritable.insert(r.sv);
  for (const auto& r : data.glonass)
    if (!whole_second(r.toe)) unwritable.insert(r.sv);
  std::erase_if(data.kepler, [&](const KeplerEphemeris& r) {
    return r.toe + r.valid_after_s < first || r.toe - r.valid_before_s > last || unwritable.count(r.sv) > 0;
  });
  std::erase_if(data.glonass, [&](const GlonassEphemeris& r) {
    return r.toe + GlonassEphemeris::kValidS < first || r.toe - GlonassEphemeris::kValidS > last ||
           unwritable.count(r.sv) > 0;
  });
  return data;
}

std::vector<SatelliteId> without_record(const Constellation& constellation, const NavigationData& data) {
  std::set<SatelliteId> known;
  for (const auto& r : data.kepler) known.insert(r.sv);
  for (const auto& r : data.glonass) known.insert(r.sv);
  std::vector<SatelliteId> out;
  for (const SatelliteId sv : constellation.satellites())
    if (known.count(sv) == 0) out.push_back(sv);
  return out;
}

/// Warnings of satellites that the records do not show; an Error for one that they show elsewhere.
Result<std::vector<std::string>> differences(const Constellation& constellation, const NavigationData& data,
                                             const std::string& systems, GpsTime start, GpsTime end) {
  const auto written = make_broadcast(data, {.systems = systems});
  const int steps = static_cast<int>(std::ceil((end - start) / kStepS));
  std::vector<std::string> warnings;
  for (const SatelliteId sv : constellation.satellites()) {
    int simulated = 0, missing = 0;
    for (int k = 0; k <= steps; ++k) {
      throw_if_cancelled();
      const GpsTime t = start + std::min(k * kStepS, end - start);
      const auto state = constellation.state(sv, t);
      if (!state) continue;
      ++simulated;
      const auto shown = written->state(sv, t);
      if (!shown) {
        ++missing;
        continue;
      }
      const double away_m = (shown->p_E - state->p_E).norm();
      if (away_m > kLargestM) {
        Error error{"", 0, "",
                    sv.str() + ": at " + t.iso(0) + " its navigation record is " + std::to_string(away_m) +
                        " m from the orbit that was simulated",
                    "at most 1 m"};
        error.exit_code = 1;
        return error;
      }
    }
    if (missing > 0)
      warnings.push_back(sv.str() + " was simulated, but no navigation record describes it" +
                         (missing < simulated ? " for a part of the time" : ""));
  }
  return warnings;
}

}  // namespace

Result<SimulatedNavigation> simulated_navigation(const Constellation& constellation, const NavigationData& broadcast,
                                                 const std::string& systems, GpsTime start, GpsTime end) {
  SimulatedNavigation out;
  out.data = records_of(broadcast, systems, start, end);
  out.data.append(fit_navigation_data(constellation, without_record(constellation, out.data), start - kFitMarginS,
                                      end + kFitMarginS));
  CANYON_TRY(out.warnings, differences(constellation, out.data, systems, start, end));
  return out;
}

}  // namespace canyon::gnss

#include "canyon/gnss/single_point/satellite_warnings.h"

namespace canyon::gnss {

void MissingEphemerides::add(SatelliteId sv, int line, GpsTime t) {
  auto& m = by_satellite_[sv];
  if (m.count++ == 0) m = {1, line, t};
}

std::vector<std::string> MissingEphemerides::list() const {
  std::vector<std::string> out;
  for (const auto& [sv, m] : by_satellite_)
    out.push_back(Error{file_, m.line, "", sv.str() + " has no valid healthy ephemeris at " + m.t.iso(0)}.str() +
                  (m.count > 1 ? " and " + std::to_string(m.count - 1) + " other epochs" : "") + "; not used");
  return out;
}

void Shortcomings::add(SatelliteId sv, int line) {
  if (satellites_.empty()) line_ = line;
  satellites_.insert(sv);
}

void Shortcomings::append_to(std::vector<std::string>& warnings) const {
  if (satellites_.empty()) return;
  std::string names;
  for (const SatelliteId sv : satellites_) names += (names.empty() ? "" : ", ") + sv.str();
  warnings.push_back(Error{file_, line_, "", names + ": " + what_}.str());
}

}  // namespace canyon::gnss

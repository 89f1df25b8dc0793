#include "canyon/apps/options/gnss_errors.h"

#include <algorithm>
#include <set>

#include "canyon/gnss/sensor/gnss_config.h"

namespace canyon::apps {

namespace {

/// Switches one error off.
using SwitchOff = void(gnss::GnssConfig&);

constexpr ModelRow<SwitchOff> kSwitches[] = {
    {"ionosphere", [](gnss::GnssConfig& c) { c.ionosphere.name = "none"; }, "delay of the ionosphere"},
    {"troposphere", [](gnss::GnssConfig& c) { c.troposphere.name = "none"; }, "delay of the troposphere"},
    {"ephemeris", [](gnss::GnssConfig& c) { c.ephemeris_error.name = "none"; }, "broadcast orbit and clock"},
    {"receiver_clock", [](gnss::GnssConfig& c) { c.receiver_clock.name = "none"; }, "the receiver's clock"},
    {"multipath",
     [](gnss::GnssConfig& c) {
       if (c.propagation.paths.name != "none") c.propagation.paths.name = "visibility";
       c.propagation.diffraction.name = "none";
       c.propagation.ground_reflection = false;
       c.propagation.scatter.name = "none";
       c.propagation.clutter.name = "none";
     },
     "reflections, diffraction, scattering and what the street has beside the scene"},
    {"noise", [](gnss::GnssConfig& c) { c.tracking.thermal_noise_scale = 0.0; }, "thermal noise"},
    {"antenna", [](gnss::GnssConfig& c) { c.link.antenna_phase_centre = false; }, "phase centre"},
    {"base_station", [](gnss::GnssConfig& c) { c.mode.own.get<gnss::DgpsParameters>().base_error_scale = 0.0; },
     "the base station's own error"},
};
const ModelTable<SwitchOff> kTable(kSwitches);

}  // namespace

std::vector<std::string> gnss_error_names() {
  return model_names(kTable);
}

Status keep_errors(const std::string& list, gnss::GnssConfig& config) {
  if (list == "all") return Ok{};
  std::set<std::string> keep;
  for (std::size_t begin = 0; list != "none" && begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, end - begin);
    if (find_model(kTable, name) == nullptr) {
      std::string all = "none, all, or of";
      for (const std::string& known : gnss_error_names()) all += " " + known;
      return Error{"--errors", 0, "", "\"" + name + "\" is not an error", all};
    }
    keep.insert(name);
    begin = end + 1;
  }
  for (const auto& row : kTable)
    if (!keep.contains(row.name)) row.make(config);
  return Ok{};
}

}  // namespace canyon::apps

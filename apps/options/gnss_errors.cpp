#include "canyon/apps/options/gnss_errors.h"

#include <algorithm>
#include <set>

namespace canyon::apps {

namespace {

/// One error and how it is switched off.
struct Switch {
  const char* name;
  void (*off)(gnss::GnssConfig&);
};

constexpr Switch kSwitches[] = {
    {"ionosphere", [](gnss::GnssConfig& c) { c.ionosphere = "none"; }},
    {"troposphere", [](gnss::GnssConfig& c) { c.troposphere = "none"; }},
    {"ephemeris", [](gnss::GnssConfig& c) { c.ephemeris_error = "none"; }},
    {"receiver_clock", [](gnss::GnssConfig& c) { c.receiver_clock = "none"; }},
    {"multipath",
     [](gnss::GnssConfig& c) {
       if (c.paths != "none") c.paths = "visibility";
       c.diffraction = "none";
       c.ground_reflection = false;
     }},
    {"noise", [](gnss::GnssConfig& c) { c.thermal_noise_scale = 0.0; }},
    {"antenna", [](gnss::GnssConfig& c) { c.antenna_phase_centre = false; }},
    {"base_station", [](gnss::GnssConfig& c) { c.base_error_scale = 0.0; }},
};

}  // namespace

std::vector<std::string> gnss_error_names() {
  std::vector<std::string> names;
  for (const Switch& s : kSwitches) names.emplace_back(s.name);
  return names;
}

Status keep_errors(const std::string& list, gnss::GnssConfig& config) {
  if (list == "all") return Ok{};
  std::set<std::string> keep;
  for (std::size_t begin = 0; list != "none" && begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, end - begin);
    if (std::none_of(std::begin(kSwitches), std::end(kSwitches), [&](const Switch& s) { return name == s.name; })) {
      std::string all = "none, all, or of";
      for (const std::string& known : gnss_error_names()) all += " " + known;
      return Error{"--errors", 0, "", "\"" + name + "\" is not an error", all};
    }
    keep.insert(name);
    begin = end + 1;
  }
  for (const Switch& s : kSwitches)
    if (!keep.contains(s.name)) s.off(config);
  return Ok{};
}

}  // namespace canyon::apps

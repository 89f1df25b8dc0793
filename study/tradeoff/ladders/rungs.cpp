#include "canyon/study/tradeoff/ladders/rungs.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "canyon/core/config/text.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::study {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

constexpr const char* kLinksKey = "imu.leave_out";
constexpr const char* kNothingLeftOut = "nothing left out";
constexpr std::string_view kWithout = "without ";

std::optional<double> number_of(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// What the rungs of one list are made from.
struct Maker {
  const Ladder& ladder;
  const mission::MissionFile& file;
  const std::string& fidelity;
  const std::vector<ConfigKey>& mission_keys;
  const std::vector<ConfigKey>& probe_keys;

  std::vector<std::string> rows_of(const std::string& key) const {
    const ConfigKey* found = find_key(mission_keys, key);
    if (found == nullptr) found = find_key(probe_keys, key);
    CANYON_CHECK(found != nullptr && !found->choices.empty(), "no choice: ", key);
    return found->choices;
  }

  Result<Rung> rung(std::string name, const Settings& settings) const {
    Rung made;
    mission::MissionFile with = file;
    for (const auto& [key, value] : settings) {
      if (key == kLinksKey) {
        ConfigNode list;
        list.value_ = ConfigNode::Array{};
        if (value != kNothingLeftOut)
          std::get<ConfigNode::Array>(list.value_).push_back(ConfigNode::of(value.substr(kWithout.size())));
        with.set_option(key, std::move(list), "tradeoff");
      } else if (find_key(mission_keys, key) != nullptr) {
        with.set_option(key, setting_node(value), "tradeoff");
      } else {
        CANYON_CHECK(find_key(probe_keys, key) != nullptr, "no key of a mission or a probe: ", key);
        made.own[key] = value;
      }
    }
    CANYON_TRY(made.config, with.resolve(fidelity));
    const ConfigKey* now = find_key(mission_keys, ladder.key);
    made.in_use = now != nullptr && now->value == name;
    made.value = ladder.values.empty() ? std::nullopt : number_of(name);
    made.name = std::move(name);
    return made;
  }

  /// Names of the rungs, the fidelity's own number among them.
  std::vector<std::string> names() const {
    if (ladder.rungs == std::vector<std::string>{"rows"}) return rows_of(ladder.key);
    if (ladder.rungs == std::vector<std::string>{"links"}) {
      std::vector<std::string> names = model_names(inertial::error_links());
      for (std::string& name : names) name.insert(0, kWithout);
      names.insert(names.begin(), kNothingLeftOut);
      return names;
    }
    if (ladder.values.empty()) return ladder.rungs;
    std::vector<double> values = ladder.values;
    const ConfigKey* now = find_key(mission_keys, ladder.key);
    const auto own = now == nullptr ? std::nullopt : number_of(now->value);
    if (own && *own > 0 && std::find(values.begin(), values.end(), *own) == values.end()) {
      const bool falls = values.front() > values.back();
      const auto place =
          std::find_if(values.begin(), values.end(), [&](double v) { return falls ? v < *own : v > *own; });
      // Beyond the finest rung nothing would be finer than what it is measured against.
      if (place != values.end()) values.insert(place, *own);
    }
    std::vector<std::string> names;
    for (const double value : values) names.push_back(number_text(value));
    return names;
  }

  Result<RungList> list(const std::string& of) const {
    RungList out{.ladder = &ladder, .of = of};
    Settings settings;
    for (const std::string& fixed : ladder.fixed) settings.push_back(cut_setting(fixed));
    if (!of.empty()) settings.push_back(cut_setting(of));
    const auto add = [&](const std::string& name, const std::string& key, const std::string& value) {
      Settings with = settings;
      with.emplace_back(key, value);
      auto made = rung(name, with);
      if (made)
        out.rungs.push_back(*std::move(made));
      else
        out.left_out.push_back({name, made.error().str()});
    };
    for (const std::string& name : names()) add(name, ladder.key, name);
    if (ladder.reference.find('=') != std::string::npos) {
      const auto [key, value] = cut_setting(ladder.reference);
      add(value, key, value);
      out.reference_is_rung = false;
    }
    if (ladder.reference == kTruth) return out;
    const std::string wanted = out.reference_is_rung ? ladder.reference : cut_setting(ladder.reference).second;
    for (std::size_t i = 0; i < out.rungs.size(); ++i)
      if (out.rungs[i].name == wanted) out.reference = i;
    if (!out.reference)
      return Error{.key = ladder.key,
                   .what = "has no rung " + wanted + " to measure against here",
                   .expected = out.left_out.empty() ? "" : "other settings: " + out.left_out.back().reason};
    return out;
  }
};

}  // namespace

ConfigNode setting_node(const std::string& value) {
  if (value == "true" || value == "false") return ConfigNode::of(value == "true");
  const auto number = number_of(value);
  if (!number && value.find('+') == std::string::npos) return ConfigNode::of(value);
  if (!number) {
    ConfigNode list;
    auto& names = list.value_.emplace<ConfigNode::Array>();
    std::istringstream rest(value);
    for (std::string name; std::getline(rest, name, '+');) names.push_back(ConfigNode::of(name));
    return list;
  }
  if (*number == std::floor(*number) && std::abs(*number) < 9e15)
    return ConfigNode::of(static_cast<std::int64_t>(*number));
  return ConfigNode::of(*number);
}

Result<std::vector<RungList>> make_rungs(const Ladder& ladder, const mission::MissionFile& file,
                                         const std::string& fidelity, const std::vector<ConfigKey>& probe_keys) {
  CANYON_TRY(mission::MissionConfig config, file.resolve(fidelity));
  const std::vector<ConfigKey> mission_keys = config_keys_of(config);
  const Maker maker{ladder, file, fidelity, mission_keys, probe_keys};
  std::vector<RungList> lists;
  if (ladder.for_each.empty()) {
    CANYON_TRY(RungList list, maker.list(""));
    lists.push_back(std::move(list));
    return lists;
  }
  for (const std::string& row : maker.rows_of(ladder.for_each)) {
    CANYON_TRY(RungList list, maker.list(ladder.for_each + "=" + row));
    lists.push_back(std::move(list));
  }
  return lists;
}

}  // namespace canyon::study

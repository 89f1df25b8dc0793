#include "canyon/study/stress/cases.h"

#include <algorithm>
#include <set>

#include "canyon/core/config/text.h"
#include "canyon/core/stress/stress_cases.h"
#include "canyon/fusion/stress/stress_cases.h"
#include "canyon/gnss/stress/stress_cases.h"
#include "canyon/inertial/stress/stress_cases.h"
#include "canyon/lidar/stress/stress_cases.h"
#include "canyon/mission/stress/stress_cases.h"
#include "canyon/scene/stress/stress_cases.h"
#include "canyon/study/stress/parts/subjects.h"

namespace canyon::study {
namespace {

constexpr ModelRow<StressGroup> kGroups[] = {
    {"stiff", StressGroup::kStiff, "time constants and steps that do not fit each other"},
    {"geometry", StressGroup::kGeometry, "places, attitudes and shapes at their borders"},
    {"data", StressGroup::kData, "values and orders of messages that nobody expects"},
    {"long", StressGroup::kLong, "hours, years and large counts"},
};

/// Of an option that is no model's.
Error unknown_case(const std::string& name, const std::set<std::string>& subjects,
                   const std::vector<StressCase>& cases) {
  std::vector<std::string> known(subjects.begin(), subjects.end());
  const std::vector<std::string> listed = known;
  for (const StressCase& one : cases) known.push_back(one.name);
  const std::string nearest = nearest_word(name, known);
  std::string expected = "a case, or all of a subject: " + plain_list(listed);
  if (!nearest.empty()) expected += "; nearest is \"" + nearest + "\"";
  return Error{.file = "case", .what = "\"" + name + "\" is unknown", .expected = expected};
}

bool named(const std::vector<std::string>& names, const StressCase& one) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return name == one.name || name == stress_subject(one.name); });
}

/// Of cases that are none of that group: those that they have.
Error none_of_group(const CaseChoice& choice, const std::vector<StressCase>& all) {
  std::set<std::string> has;
  for (const StressCase& one : all)
    if (named(choice.names, one)) has.insert(row_of(stress_groups(), one.group).name);
  return Error{.file = "--group",
               .what = "none of " + plain_list(choice.names) + " is of group \"" + choice.group + "\"",
               .expected = "one of " + quoted_list({has.begin(), has.end()})};
}

}  // namespace

std::string stress_subject(const std::string& name) {
  return name.substr(0, name.find('/'));
}

ModelTable<StressGroup> stress_groups() {
  return kGroups;
}

std::vector<StressCase> all_stress_cases() {
  std::vector<StressCase> all;
  for (std::vector<StressCase>& floor :
       std::vector{stress_cases(), scene::stress_cases(), gnss::stress_cases(), inertial::stress_cases(),
                   lidar::stress_cases(), fusion::stress_cases(), mission::stress_cases(), study_stress_cases()})
    std::move(floor.begin(), floor.end(), std::back_inserter(all));
  return all;
}

Result<std::vector<StressCase>> choose_cases(std::vector<StressCase> all, const CaseChoice& choice) {
  std::set<std::string> subjects;
  for (const StressCase& one : all) subjects.insert(stress_subject(one.name));
  for (const std::string& name : choice.names)
    if (std::none_of(all.begin(), all.end(), [&](const StressCase& one) { return named({name}, one); }))
      return unknown_case(name, subjects, all);
  if (!choice.group.empty()) CANYON_TRY_STATUS(choose(stress_groups(), choice.group, "--group"));
  const std::vector<StressCase> before = all;
  std::erase_if(all, [&](const StressCase& one) {
    if (!choice.group.empty() && row_of(stress_groups(), one.group).name != choice.group) return true;
    return choice.names.empty() ? one.long_running && !choice.long_form : !named(choice.names, one);
  });
  if (all.empty() && !choice.names.empty()) return none_of_group(choice, before);
  return all;
}

}  // namespace canyon::study

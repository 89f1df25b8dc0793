#include "canyon/mission/autonomy/planning/speed_rule.h"

namespace canyon::mission {
namespace {

constexpr ModelRow<MakeSpeedRule> kSpeedRules[] = {
    {"stopping_distance", make_stopping_distance, "from which it halts within what it sees to be free",
     stopping_distance_parameters},
};

}  // namespace

ModelTable<MakeSpeedRule> speed_rules() {
  return kSpeedRules;
}

}  // namespace canyon::mission

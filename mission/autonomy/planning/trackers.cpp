#include "canyon/mission/autonomy/planning/tracker.h"

namespace canyon::mission {
namespace {

constexpr ModelRow<MakeTracker> kTrackers[] = {
    {"pure_pursuit", make_pure_pursuit, "an arc to a point ahead (Coulter 1992)", pure_pursuit_parameters},
    {"stanley", make_stanley, "the front axle's heading and offset (Hoffmann et al. 2007)", stanley_parameters},
};

}  // namespace

ModelTable<MakeTracker> trackers() {
  return kTrackers;
}

}  // namespace canyon::mission

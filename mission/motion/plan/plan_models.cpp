#include "canyon/mission/motion/plan/plan_model.h"

namespace canyon::mission {
namespace {

constexpr ModelRow<MakePlanModel> kPlanModels[] = {
    {"kinematic_bicycle", make_kinematic_bicycle, "it goes where its wheels point", kinematic_bicycle_parameters},
    {"dynamic_bicycle", make_dynamic_bicycle, "its tyres slip, and hold so much", dynamic_bicycle_parameters},
    {"skid_steer", make_skid_steer, "its sides turn at speeds of their own", skid_steer_parameters},
};

}  // namespace

ModelTable<MakePlanModel> plan_models() {
  return kPlanModels;
}

}  // namespace canyon::mission

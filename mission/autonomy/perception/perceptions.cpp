#include "canyon/mission/autonomy/perception/perception.h"

namespace canyon::mission {
namespace {

constexpr ModelRow<MakePerception> kPerceptions[] = {
    {"ground_grid", make_ground_grid, "cells by their height above the ground of the same scan",
     ground_grid_parameters},
};

}  // namespace

ModelTable<MakePerception> perceptions() {
  return kPerceptions;
}

}  // namespace canyon::mission

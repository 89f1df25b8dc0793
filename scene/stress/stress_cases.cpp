#include "canyon/scene/stress/stress_cases.h"

#include <utility>

#include "canyon/scene/stress/city/subjects.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (const auto& subject :
       {ray_cases,           far_cases,       surface_cases,        ground_cases,     crown_cases,
        index_cases,         frame_cases,     city_cases,           street_cases,     shape_cases,
        elevation_cases,     tile_cases,      block_cases,          inspection_cases, facet_cases,
        fitted_ground_cases, city_plan_cases, garden_wall_cases,    house_cases,      moving_thing_cases,
        street_thing_cases,  terrain_cases,   modelled_ground_cases})
    for (StressCase& one : subject()) all.push_back(std::move(one));
  return all;
}

}  // namespace canyon::scene

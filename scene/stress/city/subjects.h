#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject: the parts of the built-in city, each on a plan of its own.
namespace canyon::scene {

std::vector<StressCase> city_plan_cases();
std::vector<StressCase> garden_wall_cases();
std::vector<StressCase> house_cases();
std::vector<StressCase> moving_thing_cases();
std::vector<StressCase> street_thing_cases();
std::vector<StressCase> terrain_cases();

}  // namespace canyon::scene

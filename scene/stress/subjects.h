#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// One subject a file; stress_cases() joins them.
namespace canyon::scene {

std::vector<StressCase> elevation_cases();
std::vector<StressCase> ray_cases();
std::vector<StressCase> far_cases();
std::vector<StressCase> surface_cases();
std::vector<StressCase> ground_cases();
std::vector<StressCase> city_cases();
std::vector<StressCase> crown_cases();
std::vector<StressCase> frame_cases();
std::vector<StressCase> index_cases();
std::vector<StressCase> street_cases();
std::vector<StressCase> fitted_ground_cases();
std::vector<StressCase> tile_cases();
std::vector<StressCase> inspection_cases();
std::vector<StressCase> facet_cases();
std::vector<StressCase> block_cases();
std::vector<StressCase> shape_cases();
std::vector<StressCase> modelled_ground_cases();

}  // namespace canyon::scene
